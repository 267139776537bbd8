// The main window of SoTerrainTest: menus, status bar and dialogs around the render area.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <QMainWindow>

#include "Commands.h"
#include "FlyArea.h"
#include "Options.h"
#include "RunLog.h"
#include "Scene.h"

class QAction;
class QDialog;
class QLabel;

namespace app {

class MainWindow : public QMainWindow {
public:
    /// The scene and the log outlive the window.
    MainWindow(const Options& options, Scene& scene, RunLog& log, Animation animation, double loadMs);
    ~MainWindow() override;

    FlyArea& area() { return *area_; }
    const FlyArea& area() const { return *area_; }
    Scene& scene() { return scene_; }
    const Scene& scene() const { return scene_; }

    /// Does what a command says, and brings menus, status and picture up to date.
    void run(const Command& command);
    /// A message in the status bar, for some seconds.
    void say(const std::string& message);
    void toggleFullScreen();
    void showKeys();
    void showAbout();

protected:
    void closeEvent(QCloseEvent* event) override;

private:
    struct Entry {
        const Command* command;
        QAction* action;
    };

    void addMenus();
    QAction* addCommand(const Command& command);
    void refresh();
    void setStatus(const std::string& text);
    void fitToScreen();

    Options options_;
    Scene& scene_;
    std::unique_ptr<FlyArea> area_;
    std::vector<Entry> entries_;
    QLabel* status_;
    QDialog* keys_ = nullptr;
    QRect windowed_;  ///< geometry outside full screen
};

}  // namespace app
