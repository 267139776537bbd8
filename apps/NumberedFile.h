// File names that do not take the place of what is there.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace app {

/// STEM, STEM-2, STEM-3 ...: the first of which no file with any of these endings exists.
std::string freeStem(const std::string& stem, const std::vector<std::string>& endings);
/// The file that was written last among STEM + ending, STEM-2 + ending and so on.
std::optional<std::string> latestFile(const std::string& stem, const std::string& ending);

}  // namespace app
