// The window's commands for pictures of the mesh.
#pragma once

#include <vector>

#include "Commands.h"

namespace app {

/// Rows for the table in Commands.cpp, after a line.
std::vector<Command> debugCommands();

}  // namespace app
