// File names with a frame number in them.
#pragma once

#include <optional>
#include <string>

#include "base/Result.h"

namespace app {

/// Error: a `%` that is neither `%%` nor the only `%d` (with an optional width, `%4d` or `%04d`).
std::optional<terrain::Error> checkFrameName(const std::string& pattern);
bool hasFrameNumber(const std::string& pattern);
/// The pattern, which has been checked, with the number in place.
std::string frameName(const std::string& pattern, int frame);

}  // namespace app
