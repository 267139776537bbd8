// What the user can do in the window besides steering.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace app {

class MainWindow;

enum class Menu { File, View, Terrain, Benchmark, Tools, Help };
constexpr const char* menuTitles[] = {"&File", "&View", "&Terrain", "&Benchmark", "T&ools", "&Help"};

/// One thing to do: an entry of a menu, a key and a line of Help > Keys at once.
struct Command {
    using Run = std::function<void(MainWindow&)>;
    using Ask = std::function<bool(const MainWindow&)>;

    std::string id;    ///< for tests and settings: lower case, words joined by -; empty: a line between groups
    Menu menu;         ///< in the order of the table
    std::string text;  ///< in the menu, & before the letter that Alt chooses, ... when a dialog follows
    std::string keys;  ///< as QKeySequence spells them, separated by blanks; the first stands in the menu. May be empty
    std::string help;  ///< what it does: status bar, Help > Keys
    Run run;
    Ask isOn = nullptr;        ///< not null: the entry has a check mark
    Ask isPossible = nullptr;  ///< null: always
    bool isChoice = false;     ///< one of its menu's choices excludes the others
    bool repeats = false;      ///< again and again while the key is held
};

/// The rows of the menu Tools, which are part of the table.
std::vector<Command> toolCommands();
/// The table, which Commands.cpp holds and explains.
const std::vector<Command>& commands();

}  // namespace app
