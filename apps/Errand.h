// Work that takes long.
#pragma once

#include <functional>
#include <string>

#include "height/HeightSource.h"

namespace app {

/// Runs `work` and returns when it is done: in this thread, or in another one while a window says what takes so long and stays
/// alive. The work touches nothing of Coin; it stops early when its progress is cancelled.
using Errand = std::function<void(const std::string& what, const std::function<void(terrain::ReadProgress&)>& work)>;

/// In this thread.
inline void runHere(const std::string&, const std::function<void(terrain::ReadProgress&)>& work) {
    terrain::ReadProgress progress;
    work(progress);
}

}  // namespace app
