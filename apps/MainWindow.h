// The main window of SoTerrainTest: menus, status bar and dialogs around the render area.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <QMainWindow>

#include "Commands.h"
#include "FlyArea.h"
#include "HeightToolsUi.h"
#include "Options.h"
#include "RunLog.h"
#include "Scene.h"
#include "Settings.h"

class QAction;
class QDialog;
class QLabel;
class QMenu;
class QProgressBar;

namespace app {

class SettingsDialog;

class MainWindow : public QMainWindow {
public:
    /// The scene and the log outlive the window.
    MainWindow(const Options& options, Scene& scene, RunLog& log, Animation animation, double loadMs);
    ~MainWindow() override;

    FlyArea& area() { return *area_; }
    const FlyArea& area() const { return *area_; }
    Scene& scene() { return scene_; }
    const Scene& scene() const { return scene_; }
    HeightToolsUi& tools() { return *tools_; }
    const HeightToolsUi& tools() const { return *tools_; }

    /// Does what a command says, and brings menus, status and picture up to date.
    void run(const Command& command);
    /// Shows other files: a height map or a scene, and with it, or for the present map, a picture as texture. What can't be read
    /// leaves the present scene and is told.
    void openFiles(const std::vector<std::string>& paths);
    void chooseFiles();
    void chooseTexture();
    void setTexture(const std::string& path);  ///< empty: none
    /// Writes the picture, without menus and status, to the next free file of a row, or to one that the user names.
    void savePicture();
    void choosePicture();
    bool canOpen() const;
    bool canTexture() const;
    /// Draws the terrain with another algorithm; camera, texture and settings stay.
    void setAlgorithm(const Algorithm& algorithm);
    /// Shows the present terrain by other options.
    void showAgain(const Options& next);
    void showSettings();
    bool canSwitchTo(const Algorithm& algorithm) const;
    /// A message in the status bar, for some seconds.
    void say(const std::string& message);
    void toggleFullScreen();
    bool fillsScreen() const { return fillsScreen_; }
    void showKeys();
    void showAbout();

    const Options& options() const { return options_; }

protected:
    void closeEvent(QCloseEvent* event) override;
    void dragEnterEvent(QDragEnterEvent* event) override;
    void dropEvent(QDropEvent* event) override;

private:
    struct Entry {
        const Command* command;
        QAction* action;
    };

    void addMenus();
    QAction* addCommand(const Command& command);
    void refresh();
    void setStatus(const std::string& text);
    void placeWindow();
    void fail(const terrain::Error& problem);
    bool showScene(const Options& next, bool keepCamera);
    void openFile(const RecentFile& file);
    void noteFile();
    Errand errand();
    void announce(const char* what);
    void endAnnouncement();
    void showStreaming();
    void fillRecentFiles();
    void writePicture(const std::string& path);
    QString folder() const;

    Options options_;  ///< what is shown, and how
    Settings settings_;
    Scene& scene_;
    std::unique_ptr<FlyArea> area_;
    std::unique_ptr<HeightToolsUi> tools_;
    std::vector<Entry> entries_;
    QLabel* status_;
    QMenu* recent_;
    QDialog* keys_ = nullptr;
    SettingsDialog* settingsDialog_ = nullptr;
    std::string fileName_;
    QProgressBar* streaming_;
    int mostPending_ = 0;  ///< tiles, since streaming began
    bool isBusy_ = false;       ///< a file is being read
    bool isCancelled_ = false;  ///< and was not, because the user did not want it any more
    bool isAnnounced_ = false;  ///< the next frame takes long
    bool fillsScreen_ = false;
    QRect windowed_;  ///< geometry outside full screen
};

}  // namespace app
