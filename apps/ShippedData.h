// Finds the files that come with the programs.
#pragma once

#include <string>

namespace app {

/// `name` itself where such a file is, or where none of that name is installed either; else the installed one, $(pkgdatadir)/name.
std::string findShipped(const std::string& name);

}  // namespace app
