#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#ifdef HAVE_SOQT

#include "Commands.h"

#include "DebugCommands.h"
#include "FlyArea.h"
#include "MainWindow.h"

namespace app {

namespace {

Command line(Menu menu) {
    return {"", menu, "", "", "", nullptr};
}

// Possible where the terrain node has this field.
Command::Ask has(const char* field) {
    return [field](const MainWindow& window) { return window.area().hasField(field); };
}

bool mayReplay(const MainWindow& window) {
    return !window.area().endsByItself();
}

// A new command is one row here: its menu entry, its key and its line in Help > Keys follow from it. What it does belongs into
// FlyArea (what is seen), Scene (what is drawn) or MainWindow (dialogs), or a file of its own; the row calls it. Afterwards the
// picture, the menus' check marks and the status bar are brought up to date by MainWindow::run(). Then tell of the key in Help.cpp
// and man/SoTerrainTest.1. Keys that are held to steer (W A S D Q E, arrows, PgUp, PgDn) are FlyArea's and can't be used here.
std::vector<Command> makeCommands() {
    using W = MainWindow;
    return {
        {"open", Menu::File, "&Open...", "Ctrl+O", "Open a height map or a scene", [](W& w) { w.chooseFiles(); }, nullptr,
         [](const W& w) { return w.canOpen(); }},
        {"open-texture", Menu::File, "Open &texture...", "Ctrl+T", "Lay a picture over the height map",
         [](W& w) { w.chooseTexture(); }, nullptr, [](const W& w) { return w.canTexture(); }},
        {"no-texture", Menu::File, "&No texture", "", "Show the height map without a picture", [](W& w) { w.setTexture(""); },
         nullptr, [](const W& w) { return w.canTexture() && !w.options().texture.empty(); }},
        line(Menu::File),
        {"save-picture", Menu::File, "&Save picture", "F12", "Write the picture to soterrain-0001.png, or the next free number",
         [](W& w) { w.savePicture(); }, nullptr, [](const W& w) { return w.canOpen(); }},
        {"save-picture-as", Menu::File, "Save picture &as...", "Ctrl+S", "Write the picture to a file of your choice",
         [](W& w) { w.choosePicture(); }, nullptr, [](const W& w) { return w.canOpen(); }},
        line(Menu::File),
        {"quit", Menu::File, "&Quit", "Esc Ctrl+Q", "Leave the program", [](W& w) { w.close(); }},

        {"full-screen", Menu::View, "&Full screen", "Alt+Return Alt+Enter F11", "Use the whole screen, without menus",
         [](W& w) { w.toggleFullScreen(); }, [](const W& w) { return w.fillsScreen(); }},
        line(Menu::View),
        {"wireframe", Menu::View, "&Wireframe", "L", "Show the edges of the triangles alone",
         [](W& w) { w.scene().setWireframe(!w.scene().wireframe()); }, [](const W& w) { return w.scene().wireframe(); }},
        {"meters", Menu::View, "&Meters", "G", "Show graphs of what frames take: times, triangles, frames in a second, memory",
         [](W& w) { w.area().toggleMeters(); }, [](const W& w) { return w.area().showsMeters(); }},
        line(Menu::View),
        {"home", Menu::View, "Camera &home", "Tab", "Put the camera where it was at the start", [](W& w) { w.area().goHome(); }},
        {"constant-height", Menu::View, "&Constant height", "Space", "Keep the height over the ground",
         [](W& w) { w.area().toggleConstantHeight(); }, [](const W& w) { return w.area().constantHeight(); }},

        {"coarser", Menu::Terrain, "&Greater pixel error", "+", "Allow a greater error on screen: fewer triangles",
         [](W& w) { w.area().scalePixelError(1); }, nullptr, has("pixelError"), false, true},
        {"finer", Menu::Terrain, "S&maller pixel error", "-", "Ask for a smaller error on screen: more triangles",
         [](W& w) { w.area().scalePixelError(-1); }, nullptr, has("pixelError"), false, true},
        {"full-detail", Menu::Terrain, "Full &detail", "Return Enter", "Draw without any error, or with the former one again",
         [](W& w) { w.area().toggleDetail(); }, [](const W& w) { return w.area().fullDetail(); }, has("pixelError")},
        {"culling", Menu::Terrain, "Frustum &culling", "F", "Leave out what is not in view", [](W& w) { w.area().toggleCulling(); },
         [](const W& w) { return w.area().culling(); }, has("frustumCulling")},
        {"settings", Menu::Terrain, "&Settings...", "Ctrl+,", "Algorithm, errors, sizes, heights", [](W& w) { w.showSettings(); },
         nullptr, [](const W& w) { return w.canOpen(); }},
        line(Menu::Terrain),
        {"more-levels", Menu::Terrain, "One level &finer", "]", "One level more of a clipmap",
         [](W& w) { w.area().changeLevels(1); }, nullptr, has("activeLevels")},
        {"fewer-levels", Menu::Terrain, "One level c&oarser", "[", "One level less of a clipmap",
         [](W& w) { w.area().changeLevels(-1); }, nullptr, has("activeLevels")},
        {"all-levels", Menu::Terrain, "&All levels", "0", "As many levels of a clipmap as the view needs",
         [](W& w) { w.area().changeLevels(0); }, nullptr, has("activeLevels")},

        {"record", Menu::Benchmark, "&Record flight", "R",
         "Record the camera until R is pressed again, then write soterrain-flight.csv (-2, -3 ... when it is there)",
         [](W& w) { w.area().toggleRecord(); }, [](const W& w) { return w.area().isRecording(); }},
        {"play", Menu::Benchmark, "&Play record", "P", "Replay the latest record, with a profile in soterrain-replay.csv",
         [](W& w) { w.area().replay(1); }, [](const W& w) { return w.area().isReplaying() && !w.area().isBenchmarking(); },
         mayReplay},
        {"benchmark", Menu::Benchmark, "&Five repetitions", "Shift+P",
         "Replay the latest record five times: means of every frame and a summary in soterrain-benchmark files",
         [](W& w) { w.area().replay(5); }, [](const W& w) { return w.area().isBenchmarking(); }, mayReplay},

        {"keys", Menu::Help, "&Keys", "F1", "Show what the keys do", [](W& w) { w.showKeys(); }},
        {"about", Menu::Help, "&About SoTerrainTest", "", "Versions and graphics", [](W& w) { w.showAbout(); }},
    };
}

// One for each algorithm, with a number key, in the order of their table.
std::vector<Command> algorithmCommands() {
    std::vector<Command> rows;
    for (const Algorithm& algorithm : algorithms()) {
        const std::string key = std::to_string(rows.size() + 1), title = algorithm.title;
        rows.push_back({"algorithm-" + std::string(algorithm.name), Menu::Terrain, title, key, "Draw the terrain with " + title,
                        [&algorithm](MainWindow& w) { w.setAlgorithm(algorithm); },
                        [&algorithm](const MainWindow& w) { return w.scene().shows(algorithm); },
                        [&algorithm](const MainWindow& w) { return w.canSwitchTo(algorithm); }, true});
    }
    rows.push_back(line(Menu::Terrain));
    return rows;
}

}  // namespace

const std::vector<Command>& commands() {
    static const std::vector<Command> table = [] {
        std::vector<Command> rows = algorithmCommands();
        const std::vector<Command> others = makeCommands();
        rows.insert(rows.end(), others.begin(), others.end());
        const std::vector<Command> debugs = debugCommands();
        rows.insert(rows.end(), debugs.begin(), debugs.end());
        const std::vector<Command> tools = toolCommands();
        rows.insert(rows.end(), tools.begin(), tools.end());
        return rows;
    }();
    return table;
}

}  // namespace app

#endif
