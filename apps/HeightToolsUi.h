// The height tools in the window: clicks, the profile's dock, files.
#pragma once

#include <optional>
#include <string>

#include <Inventor/SbVec2s.h>

#include "HeightSession.h"

class QDockWidget;
class QLabel;

namespace app {

class MainWindow;
class ProfilePlot;

class HeightToolsUi {
public:
    /// What a click on the ground does.
    enum class Mode { Look, Pick, Measure, Mark, Unmark };

    /// The window and the scene outlive it.
    HeightToolsUi(MainWindow& window, Scene& scene);

    Mode mode() const { return mode_; }
    /// Clicks do this from now on, or nothing any more if they did.
    void toggle(Mode mode);
    /// A click at a pixel of the picture, counted from its lower left corner. `picks`: whatever the mode, it asks for height and
    /// slope.
    void click(const SbVec2s& pixel, const SbVec2s& pictureSize, bool picks);
    /// To be called before each frame.
    void follow();
    /// Forgets pick, line and markers.
    void clear();

    void showProfile(bool on);
    bool showsProfile() const;
    bool hasLine() const { return session_.line().corners.size() > 1; }
    bool hasMarkers() const { return !session_.markers().empty(); }
    void exportProfile();  ///< as CSV
    void exportPlot();     ///< as PNG
    void openMarkers();
    void saveMarkers();
    /// What the options ask for, which is told on standard output. Error: a file can't be written.
    std::optional<terrain::Error> apply(const Options& options);

private:
    void makeDock();
    void lineChanged();
    void removeMarkerAt(glm::dvec2 place);
    std::string askForName() const;
    void tell(const std::optional<terrain::Error>& problem, const std::string& done);

    MainWindow& window_;
    HeightSession session_;
    Mode mode_ = Mode::Look;
    bool continues_ = false;  ///< the next click adds to the line
    QDockWidget* dock_ = nullptr;
    ProfilePlot* plot_ = nullptr;
    QLabel* figures_ = nullptr;
};

}  // namespace app
