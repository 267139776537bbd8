// Finds the files that come with the programs.
#pragma once

#include <optional>
#include <string>

namespace app {

/// `name` itself where such a file is, or where none of that name is installed either; else the installed one, $(pkgdatadir)/name.
std::string findShipped(const std::string& name);
/// The installed file of that name; nothing where none is installed.
std::optional<std::string> installedFile(const std::string& name);

}  // namespace app
