#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#ifdef HAVE_SOQT

#include "DebugCommands.h"

#include "DebugViews.h"
#include "MainWindow.h"

namespace app {

std::vector<Command> debugCommands() {
    const auto isPossible = [](const MainWindow& w) { return canDebug(w.scene()); };
    std::vector<Command> rows{{"", Menu::View, "", "", "", nullptr}};
    constexpr int firstKey = 5;
    for (const DebugPicture& picture : debugPictures()) {
        const std::string key = "F" + std::to_string(firstKey + int(rows.size()) - 1);
        rows.push_back({std::string("debug-") + picture.name, Menu::View, picture.title, key, picture.help,
                        [&picture](MainWindow& w) { setDebugPicture(w.scene(), picture.value); },
                        [&picture](const MainWindow& w) { return debugPicture(w.scene()) == picture.value; }, isPossible, true});
    }
    rows.push_back({"", Menu::View, "", "", "", nullptr});
    rows.push_back({"edges", Menu::View, "E&dges over it", "O",
                    "Draw the edges of the triangles over the terrain or the picture of it",
                    [](MainWindow& w) { setEdges(w.scene(), !hasEdges(w.scene())); },
                    [](const MainWindow& w) { return hasEdges(w.scene()); }, isPossible});
    rows.push_back({"freeze", Menu::View, "Free&ze mesh", "Z",
                    "Keep the mesh for this view, to fly around it; again: follow the view",
                    [](MainWindow& w) { setFrozen(w.scene(), !isFrozen(w.scene())); },
                    [](const MainWindow& w) { return isFrozen(w.scene()); }, isPossible});
    return rows;
}

}  // namespace app

#endif
