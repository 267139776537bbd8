// The height tools at work in one scene: what was picked, measured and marked, and its drawing.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "HeightTools.h"
#include "Options.h"
#include "SceneGround.h"
#include "ToolsDrawing.h"

namespace app {

class HeightSession {
public:
    /// The scene outlives it.
    explicit HeightSession(Scene& scene) : scene_(scene), ground_(scene), drawing_(scene) {}

    /// Finds out about a place, marks it, and says so; outside of the ground says that, and marks nothing.
    std::string pick(glm::dvec2 place);
    void forgetPick();

    /// Adds a corner to the line and measures it.
    void addCorner(glm::dvec2 place);
    void setLine(std::vector<glm::dvec2> corners);
    const MeasuredLine& line() const { return line_; }
    /// Its figures in words; empty for less than two corners.
    std::string lineText() const;
    /// Writes its profile as CSV.
    std::optional<terrain::Error> writeProfile(const std::string& path) const;
    /// Shows a place at this distance from the start of the line, and says what is there; nothing hides it.
    std::string showAt(std::optional<double> distance);

    /// Says where it stands. A name of its own if none is given. Where there is no ground it is not added.
    std::string addMarker(Marker marker);
    /// Removes the one nearest to a place. False without any.
    bool removeMarker(glm::dvec2 near);
    void setMarkers(std::vector<Marker> markers);
    const std::vector<Marker>& markers() const { return markers_; }

    /// What the options ask for, in lines of words. Error: the profile can't be written.
    terrain::Result<std::string> apply(const Options& options);

    /// To be called before each frame: the drawing goes with the terrain, and all is forgotten with the scene. True where it was.
    bool follow();
    GroundText text() const { return {ground_, reference()}; }
    const Scene& scene() const { return scene_; }
    const Ground& ground() const { return ground_; }

private:
    std::optional<Georeference> reference() const;
    void measure();

    Scene& scene_;
    SceneGround ground_;
    ToolsDrawing drawing_;
    NodePtr<SoSeparator> root_{scene_.root()};  ///< of the scene that it is about
    MeasuredLine line_;
    std::vector<Marker> markers_;
};

}  // namespace app
