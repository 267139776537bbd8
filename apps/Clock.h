// The clocks of all measurements.
#pragma once

#include <time.h>

#include <chrono>

namespace app {

/// Milliseconds of a clock that only goes forward.
inline double nowMs() {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double, std::milli>(now).count();
}

/// Processor milliseconds of this process, all threads together.
inline double processorMs() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return double(now.tv_sec) * 1e3 + double(now.tv_nsec) * 1e-6;
}

/// What something took.
struct Duration {
    double wallMs = 0.0;
    double processorMs = 0.0;
};

/// Measures from its construction on.
class Stopwatch {
public:
    Duration elapsed() const { return {nowMs() - wall_, app::processorMs() - processor_}; }

private:
    double wall_ = nowMs();
    double processor_ = app::processorMs();
};

}  // namespace app
