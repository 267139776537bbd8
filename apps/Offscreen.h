// Runs an animation without a window.
#pragma once

#include <optional>

#include "Options.h"
#include "Scene.h"
#include "base/Result.h"

namespace app {

/// Draws what the options ask for through EGL and writes pictures, profile and statistics. `startedMs`: nowMs() when the scene was
/// begun. Returns what went wrong, if anything did.
std::optional<terrain::Error> runOffscreen(const Options& options, Scene& scene, double startedMs);

}  // namespace app
