// Headerless files of heights: samples only, rows from north to south.
#pragma once

#include <string>

#include "base/Result.h"
#include "height/HeightMap.h"
#include "height/HeightSource.h"

namespace terrain {

/// Reads `options.rawSize` samples of `options.rawType`. A size of (0, 0) means a square whose side follows from the file's length.
/// Error: unreadable file, a length that is not exactly that of the size, or that is no square when the size is to be guessed.
Result<HeightMap> readRaw(const std::string& path, const HeightFileOptions& options);

}  // namespace terrain
