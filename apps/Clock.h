// The clock of all measurements.
#pragma once

#include <chrono>

namespace app {

/// Milliseconds of a clock that only goes forward.
inline double nowMs() {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double, std::milli>(now).count();
}

}  // namespace app
