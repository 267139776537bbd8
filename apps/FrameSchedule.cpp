#include "FrameSchedule.h"

#include <algorithm>
#include <cmath>

#include "Options.h"

namespace app {

FrameSchedule FrameSchedule::make(double durationMs, std::optional<double> frameTimeMs, std::optional<int> frames,
                                  bool synchronized) {
    FrameSchedule schedule;
    schedule.synchronized = synchronized;
    schedule.durationMs = durationMs;
    schedule.stepMs = frameTimeMs ? *frameTimeMs : frames ? durationMs / *frames : Options::defaultFrameTime;
    // A flight of a single pose has no duration, but a frame.
    const double count = durationMs > 0.0 ? std::ceil(durationMs / schedule.stepMs - 1e-9) : 1.0;
    schedule.frames = frames ? *frames : int(std::clamp(count, 1.0, 1e9));
    if (frames && frameTimeMs) schedule.durationMs = *frames * *frameTimeMs;
    return schedule;
}

std::optional<FrameSchedule::Next> FrameSchedule::next(int last, double elapsedMs) const {
    if (!synchronized) return last + 1 < frames ? std::optional(Next{last + 1, 0.0}) : std::nullopt;
    const int due = int(std::min(elapsedMs / stepMs, 2e9));
    const int frame = std::max(due, last + 1);
    if (frame >= frames) return std::nullopt;
    return Next{frame, std::max(0.0, time(frame) - elapsedMs)};
}

}  // namespace app
