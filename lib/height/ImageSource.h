// Heights from images, through OpenImageIO.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/Result.h"
#include "height/HeightMap.h"
#include "height/HeightSource.h"

namespace terrain {

/// Whether this build has OpenImageIO. Without it the functions below only report that.
bool hasImageReader();

/// Nothing when OpenImageIO recognises the file, else its reason.
std::optional<std::string> whyNotAnImage(const std::string& path);

/// Whether a file of OpenImageIO's format of that name goes on to its end, as far as it has one that can be looked for: some decoders
/// fill in what is missing, or leak memory.
bool imageEnds(const std::string& path, std::string_view format);

/// What is wrong with the sizes that the file states for its images and their levels, in words; nothing when they can be. OpenImageIO's cache
/// ends the program over some that can't.
std::optional<std::string> whyNotSized(const std::string& path);

/// Reads one channel of an image: `options.channel`, or the first one of a grey image with or without alpha.
///
/// Samples keep their values: 255 of 8 bits is 255, 65535 of 16 bits is 65535, floats are as they are, alpha is not multiplied in.
/// (Only depths that OpenImageIO widens itself, as 1, 2, 4 or 12 bits, span the next wider type.) Of several subimages the first
/// counts. Error: unreadable or truncated file with OpenImageIO's reason; three or more channels and none chosen; volume or deep
/// images.
Result<HeightMap> readImage(const std::string& path, const HeightFileOptions& options);

}  // namespace terrain
