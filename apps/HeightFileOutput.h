// Height maps as 16-bit files.
#pragma once

#include <string>

#include "EnlargedMap.h"

namespace app {

/// Writes the heights, stretched to 0..65535, some rows at a time: an image with one channel, in tiles of tile x tile samples
/// unless `tile` is 0. Without OpenImageIO a headerless file of little-endian samples. What went wrong, or nothing.
std::string writeHeights(const EnlargedMap& map, const std::string& path, int tile);

}  // namespace app
