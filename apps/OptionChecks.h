// What options of one command line say together.
#pragma once

#include <optional>

#include "Options.h"
#include "base/Result.h"

namespace app {

/// The first contradiction, or what is missing.
std::optional<terrain::Error> checkCombination(const Options& options);

}  // namespace app
