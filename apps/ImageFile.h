// Pictures from and to files.
#pragma once

#include <optional>
#include <string>

#include "base/Result.h"
#include "gl/HeadlessContext.h"

namespace app {

/// Reads a picture of 1 to 4 channels, 8 bits each afterwards, rows from top to bottom. Without OpenImageIO only binary PPM and
/// PGM.
terrain::Result<terrain::Image> readImage(const std::string& path);
/// Channels of a picture; 0 when it can't be read.
int channelCount(const std::string& path);
/// Whether this build writes more than ".ppm".
bool picturesAreCompressed();
/// Writes a picture in the format that the name ends in. Without OpenImageIO only ".ppm". `quality`, 1 to 100, is
/// for formats that leave something out, such as JPEG; 0: the format's own. Returns what went wrong, if anything did.
std::optional<terrain::Error> writeImage(const std::string& path, const terrain::Image& image, int quality = 0);

}  // namespace app
