// Which frame of an animation comes next, and when.
#pragma once

#include <optional>

namespace app {

/// Frames of an animation: frame i shows the time i * step.
struct FrameSchedule {
    int frames = 1;  ///< of one run of the animation
    double stepMs = 40.0;
    double durationMs = 40.0;   ///< a synchronised run ends at this time
    bool synchronized = false;  ///< frames follow the clock: late ones are skipped

    /// The schedule of the options -A (or the flight's own length), -F, --frames and -s. Without a frame time, a number of frames
    /// is spread over the whole duration.
    static FrameSchedule make(double durationMs, std::optional<double> frameTimeMs, std::optional<int> frames, bool synchronized);

    double time(int frame) const { return frame * stepMs; }

    struct Next {
        int frame;      ///< to draw
        double waitMs;  ///< from now until it is due; 0 when not synchronised
    };
    /// The frame after `last` (-1: none yet), `elapsedMs` after the start; nothing at the end.
    std::optional<Next> next(int last, double elapsedMs) const;
};

}  // namespace app
