#include "RunLog.h"

#include <cmath>
#include <cstdio>
#include <fstream>

namespace app {

using terrain::Error;
using terrain::Result;

FrameFigures figuresOf(Scene& scene, int frame, double timeMs, const Duration& took) {
    FrameFigures figures = scene.figures();
    figures.frame = frame;
    figures.timeMs = timeMs;
    figures.frameMs = took.wallMs;
    figures.cpuMs = took.processorMs;
    return figures;
}

RunInfo infoOf(const Scene& scene, const std::string& renderer, glm::ivec2 sizePixels) {
    return {scene.algorithm(), renderer, sizePixels, scene.settings()};
}

std::optional<Error> writeSummary(const std::string& path, const FrameStatistics& statistics, const RunInfo& info) {
    std::ofstream file(path, std::ios::trunc);
    if (!file) return Error{path, "a file that can be written", "no permission, or no such folder"};
    file << (path.ends_with(".json") ? statistics.json(info) + "\n" : statistics.csv(info));
    file.close();
    return file ? std::nullopt : std::optional(Error{path, "a summary written to its end", "a write error"});
}

Result<RunLog> RunLog::open(const Options& options, Scene& scene) {
    RunLog log;
    if (!options.profile.empty()) {
        log.writesMeans_ = options.repeat.has_value();
        auto profile =
            ProfileWriter::open(options.profile, log.writesMeans_ ? ProfileWriter::Rows::Means : ProfileWriter::Rows::Frames);
        if (!profile) return profile.error();
        log.profile_ = std::move(profile).value();
    }
    if (!options.record.empty()) {
        auto flight = FlightWriter::open(options.record);
        if (!flight) return flight.error();
        log.flight_ = std::move(flight).value();
    }
    if (options.measureError) {
        auto meter = scene.makeErrorMeter();
        if (!meter) return meter.error();
        log.meter_ = std::move(meter).value();
        log.every_ = *options.measureError;
    }
    return log;
}

void RunLog::frame(int frame, double timeMs, const Duration& took, Scene& scene) {
    const FrameFigures figures = figuresOf(scene, frame, timeMs, took);
    statistics_.add(figures);
    if (profile_ && !writesMeans_) profile_->write(figures);
    if (flight_) flight_->write(timeMs, scene.pose());
}

std::optional<Error> RunLog::measure(const std::function<void()>& draw) {
    const auto measured = meter_->measure(draw);
    if (!measured) return measured.error();
    statistics_.add(measured.value());
    return std::nullopt;
}

std::optional<Error> RunLog::closeFiles(const Options& options) {
    if (profile_ && writesMeans_)
        for (const MeanFrame& frame : statistics_.means()) profile_->write(frame);
    if (profile_ && !profile_->close()) return Error{options.profile, "a profile written to its end", "a write error"};
    if (flight_ && !flight_->close()) return Error{options.record, "a flight written to its end", "a write error"};
    return std::nullopt;
}

std::optional<Error> RunLog::finish(const Options& options, const Scene& scene, const std::string& renderer,
                                    glm::ivec2 sizePixels) {
    meter_.reset();
    if (auto problem = closeFiles(options)) return problem;
    const RunInfo info = infoOf(scene, renderer, sizePixels);
    if (!options.summary.empty()) {
        if (auto problem = writeSummary(options.summary, statistics_, info)) return problem;
    }
    if (!statistics_.sameTriangles())
        std::fprintf(
            stderr,
            "SoTerrainTest: expected the same triangles in every flight, found others: the means are of different meshes\n");
    const ErrorSample& errors = statistics_.errors();
    if (options.stats) {
        std::printf("%s\n", statistics_.json(info).c_str());
    } else if (options.measureError) {
        std::printf("screen error of %llu samples in view: rms %.3f, p99.9 %.3f, max %.3f px; %llu not drawn\n",
                    static_cast<unsigned long long>(errors.samples()), errors.rms(), errors.quantile(0.999), errors.maximum(),
                    static_cast<unsigned long long>(errors.missing));
    } else if (options.offscreen && options.output.empty() && options.profile.empty() && options.summary.empty()) {
        std::printf("%s\n", statistics_.line().c_str());
    }
    if (std::fflush(stdout) != 0) return Error{"standard output", "a place to write to", "a write error"};
    return std::nullopt;
}

Result<Animation> Animation::make(const Options& options, const Scene& scene) {
    std::optional<Flight> flight;
    if (options.flight.empty()) {
        flight = standardFlight(scene.flightArea(), options.animationTime.value_or(Options::defaultAnimationTime));
    } else {
        auto read = readFlightFile(options.flight);
        if (!read) return read.error();
        flight = std::move(read).value();
        if (options.animationTime) flight = flight->lasting(*options.animationTime);
    }
    return Animation{*flight, FrameSchedule::make(flight->duration(), options.frameTime, options.frames, options.synchronize)};
}

Pose Animation::pose(int frame) const {
    const double time = schedule.time(frame), length = flight.duration();
    return flight.at(time > length && length > 0.0 ? std::fmod(time, length) : time);
}

}  // namespace app
