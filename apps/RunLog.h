// Everything that a run writes down: profile, recorded flight, statistics, measured errors.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "Clock.h"
#include "Flight.h"
#include "FrameSchedule.h"
#include "FrameStatistics.h"
#include "MeasureError.h"
#include "Options.h"
#include "Profile.h"
#include "Scene.h"

namespace app {

/// The figures of a frame that has been drawn.
FrameFigures figuresOf(Scene& scene, int frame, double timeMs, const Duration& took);
/// What statistics are of.
RunInfo infoOf(const Scene& scene, const std::string& renderer, glm::ivec2 sizePixels);
/// Writes statistics to a file: JSON where its name ends in .json, else CSV.
std::optional<terrain::Error> writeSummary(const std::string& path, const FrameStatistics& statistics, const RunInfo& info);

class RunLog {
public:
    /// Opens the files that the options name. Error: one can't be written, or nothing can be measured.
    static terrain::Result<RunLog> open(const Options& options, Scene& scene);

    /// Milliseconds from the start of the program's work to the scene, and of its first frame.
    void setStart(double loadMs, double firstFrameMs) { statistics_.setStart(loadMs, firstFrameMs); }
    /// Frames that follow are of another flight along the same path.
    void beginRepetition() { statistics_.beginRepetition(); }
    /// Notes a frame that has been drawn.
    void frame(int frame, double timeMs, const Duration& took, Scene& scene);
    /// Notes how long the animation was.
    void animation(const AnimationTime& time) { statistics_.add(time); }
    /// Whether this frame's error is to be measured after it.
    bool measures(int frame) const { return meter_ && frame % every_ == 0; }
    /// Measures; draw as ErrorMeter says.
    std::optional<terrain::Error> measure(const std::function<void()>& draw);
    /// Closes the files and prints the statistics. Returns what went wrong, if anything did.
    std::optional<terrain::Error> finish(const Options& options, const Scene& scene, const std::string& renderer,
                                         glm::ivec2 sizePixels);

private:
    std::optional<terrain::Error> closeFiles(const Options& options);

    std::optional<ProfileWriter> profile_;
    bool writesMeans_ = false;  ///< the profile is written at the end
    std::optional<FlightWriter> flight_;
    FrameStatistics statistics_;
    std::unique_ptr<ErrorMeter> meter_;
    int every_ = 1;
};

/// The animation that the options ask for, over this scene, and its schedule. Error: an unreadable flight.
struct Animation {
    Flight flight;
    FrameSchedule schedule;
    static terrain::Result<Animation> make(const Options& options, const Scene& scene);
    /// Where the camera is in a frame. More frames than the flight has fly round again.
    Pose pose(int frame) const;
};

}  // namespace app
