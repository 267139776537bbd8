#include "RunLog.h"

#include <cstdio>

namespace app {

using terrain::Error;
using terrain::Result;

Result<RunLog> RunLog::open(const Options& options, Scene& scene) {
    RunLog log;
    if (!options.profile.empty()) {
        auto profile = ProfileWriter::open(options.profile);
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

void RunLog::frame(int frame, double timeMs, double frameMs, Scene& scene) {
    FrameFigures figures = scene.figures();
    figures.frame = frame;
    figures.timeMs = timeMs;
    figures.frameMs = frameMs;
    statistics_.add(figures);
    if (profile_) profile_->write(figures);
    if (flight_) flight_->write(timeMs, scene.pose());
}

std::optional<Error> RunLog::measure(const std::function<void()>& draw) {
    const auto measured = meter_->measure(draw);
    if (!measured) return measured.error();
    statistics_.add(measured.value());
    return std::nullopt;
}

std::optional<Error> RunLog::finish(const Options& options, const Scene& scene, const std::string& renderer) {
    meter_.reset();
    if (profile_ && !profile_->close()) return Error{options.profile, "a profile written to its end", "a write error"};
    if (flight_ && !flight_->close()) return Error{options.record, "a flight written to its end", "a write error"};
    const ErrorSample& errors = statistics_.errors();
    if (options.stats) {
        std::printf("%s\n", statistics_.json(scene.algorithm(), renderer).c_str());
    } else if (options.measureError) {
        std::printf("screen error of %llu samples in view: rms %.3f, p99.9 %.3f, max %.3f px; %llu not drawn\n",
                    static_cast<unsigned long long>(errors.samples()), errors.rms(), errors.quantile(0.999), errors.maximum(),
                    static_cast<unsigned long long>(errors.missing));
    } else if (options.offscreen && options.output.empty() && options.profile.empty()) {
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

}  // namespace app
