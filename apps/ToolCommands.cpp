// The menu Tools.
#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#ifdef HAVE_SOQT

#include "Commands.h"
#include "HeightToolsUi.h"
#include "MainWindow.h"

namespace app {

namespace {

using W = MainWindow;
using Mode = HeightToolsUi::Mode;

bool hasGround(const W& window) {
    return window.scene().terrain() && !window.area().endsByItself();
}

Command mode(const char* id, const char* text, const char* key, const char* help, Mode mode, Command::Ask isPossible = hasGround) {
    return {id,
            Menu::Tools,
            text,
            key,
            help,
            [mode](W& w) { w.tools().toggle(mode); },
            [mode](const W& w) { return w.tools().mode() == mode; },
            std::move(isPossible)};
}

bool hasMarkers(const W& window) {
    return window.tools().hasMarkers();
}

bool hasLine(const W& window) {
    return window.tools().hasLine();
}

}  // namespace

std::vector<Command> toolCommands() {
    const Command line{"", Menu::Tools, "", "", "", nullptr};
    return {
        mode("pick", "&Height and slope", "K", "Clicks on the ground show position, height and slope, as Ctrl+click always does",
             Mode::Pick),
        mode("measure", "&Measure a line", "M",
             "Clicks are the corners of a line over the ground: its lengths and its height profile", Mode::Measure),
        mode("marker", "&Place markers", "N", "Clicks place markers with names on the ground", Mode::Mark),
        mode("remove-marker", "&Remove markers", "", "A click removes the nearest marker", Mode::Unmark, hasMarkers),
        line,
        {"profile", Menu::Tools, "Height &profile", "Ctrl+P", "Show the heights along the line",
         [](W& w) { w.tools().showProfile(!w.tools().showsProfile()); }, [](const W& w) { return w.tools().showsProfile(); }},
        {"profile-csv", Menu::Tools, "Save profile as &CSV...", "", "Write distances, places and heights along the line",
         [](W& w) { w.tools().exportProfile(); }, nullptr, hasLine},
        {"profile-png", Menu::Tools, "Save profile as P&NG...", "", "Write the plot of the profile as a picture",
         [](W& w) { w.tools().exportPlot(); }, nullptr, hasLine},
        line,
        {"open-markers", Menu::Tools, "&Open markers...", "", "Read markers from a CSV or .iv file",
         [](W& w) { w.tools().openMarkers(); }, nullptr, hasGround},
        {"save-markers", Menu::Tools, "&Save markers...", "", "Write markers to a CSV or .iv file",
         [](W& w) { w.tools().saveMarkers(); }, nullptr, hasMarkers},
        line,
        {"clear-tools", Menu::Tools, "Clear &all", "Del", "Forget what was picked, measured and marked",
         [](W& w) { w.tools().clear(); }, nullptr, hasGround},
    };
}

}  // namespace app

#endif
