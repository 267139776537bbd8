// The window of SoTerrainTest.
#pragma once

#include <optional>

#include "Errand.h"
#include "Options.h"
#include "Scene.h"
#include "base/Result.h"

namespace app {

/// Connects to the display, once, before anything else of this header. Error: there is no display, or this build has no SoQt.
std::optional<terrain::Error> openDisplay(const char* program);
/// For the files of a window that is not there yet: behind a progress bar, unless the run is measured.
Errand windowErrand(const Options& options);
/// What the window was left with, for what the options leave open. Nothing where they want none of it.
void recallSettings(Options& options);
/// Shows the scene until the user or the options end it. As runOffscreen() otherwise.
std::optional<terrain::Error> runWindow(const Options& options, Scene& scene, double startedMs);

}  // namespace app
