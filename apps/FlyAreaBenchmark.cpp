// Recording and replaying in the render area.
#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#ifdef HAVE_SOQT

#include <algorithm>
#include <cstdio>

#include "FlyArea.h"
#include "NumberedFile.h"

namespace app {

namespace {

const char* const flightStem = "soterrain-flight";
const char* const replayStem = "soterrain-replay";
const char* const benchmarkStem = "soterrain-benchmark";
const char* const rowsEnding = ".csv";
const char* const summaryEnding = "-summary.csv";
const char* const jsonEnding = ".json";

}  // namespace

void FlyArea::toggleRecord() {
    if (isReplaying()) takeOver();
    const double time = nowMs() - startMs_;
    if (!recording_) {
        recording_.emplace({TimedPose{time, scene_.pose()}});
        message_.clear();
        return;
    }
    if (time > recording_->back().timeMs) recording_->push_back({time, scene_.pose()});
    const std::string name = freeStem(flightStem, {rowsEnding}) + rowsEnding;
    auto file = FlightWriter::open(name);
    bool written = bool(file);
    if (written) {
        for (const TimedPose& pose : *recording_) file.value().write(pose.timeMs, pose.pose);
        written = file.value().close();
    }
    recording_.reset();
    if (written) recorded_ = name;
    message_ = (written ? "recorded " : "cannot write ") + name;
}

// The latest record of this window; else the flight of the command line; else the latest record in this folder. It is always read
// from its file, whose rounded numbers every later replay has too.
std::optional<std::string> FlyArea::flightToReplay() const {
    if (!recorded_.empty()) return recorded_;
    if (!options_.flight.empty()) return options_.flight;
    return latestFile(flightStem, rowsEnding);
}

void FlyArea::replay(int flights) {
    if (ends_) return;
    if (isReplaying()) return takeOver();
    if (recording_) toggleRecord();
    const auto name = flightToReplay();
    auto flight = name ? readFlightFile(*name) : terrain::Result<Flight>(terrain::Error{"replay", "a record", "nothing recorded"});
    if (!flight) {
        message_ = name ? flight.error().message() : "nothing recorded";
        return;
    }
    message_.clear();
    const Flight path = std::move(flight).value();
    replayed_ = {};
    startReplay({path, FrameSchedule::make(path.duration(), options_.frameTime, std::nullopt, false)}, flights, flights > 1);
}

void FlyArea::startReplay(Animation animation, int flights, bool warmsUp) {
    play_.reset();
    due_ = false;
    replay_ = std::make_unique<Replay>(scene_, std::move(animation), flights, warmsUp);
    wake();
}

// A benchmark draws frame after frame; a single replay is there to be seen, too, and is no faster than the flight was.
void FlyArea::advanceReplay(double now) {
    const bool isPaced = replay_->flights() == 1 && !ends_ && replay_->isMeasured() && !replay_->ends();
    if (isPaced && now - lastDueMs_ < replay_->animation().schedule.stepMs - 0.5) return;
    if (!replay_->next()) return endOfAnimation();
    freezeInTime(scene_, options_, replay_->timeMs());
    due_ = true;
    lastDueMs_ = now;
    scheduleRedraw();
}

void FlyArea::logReplay(const Duration& took) {
    if (replay_->isMeasured() && ends_) {
        if (replay_->begins()) log_.beginRepetition();
        logScene(replay_->frame(), replay_->timeMs(), took);
    } else if (replay_->isMeasured()) {
        if (replay_->begins()) replayed_.beginRepetition();
        replayed_.add(figuresOf(scene_, replay_->frame(), replay_->timeMs(), took));
    }
    replay_->drawn();
}

void FlyArea::endReplay(bool isWhole) {
    if (!replay_) return;
    const int flights = replay_->flights();
    if (!replay_->startsComplete()) std::fprintf(stderr, "SoTerrainTest: %s\n", Replay::incompleteStart);
    replay_.reset();
    due_ = false;
    scene_.holdMeshes(false);
    if (ends_) return;
    scene_.waitForTiles(false);
    if (flights > 1 && !isWhole)
        message_ = "benchmark stopped, nothing written";
    else
        writeReplay(flights > 1, isWhole);
    std::fprintf(stderr, "SoTerrainTest: %s\n", message_.c_str());
}

void FlyArea::writeReplay(bool isBenchmark, bool isWhole) {
    const std::string stem =
        isBenchmark ? freeStem(benchmarkStem, {rowsEnding, summaryEnding, jsonEnding}) : freeStem(replayStem, {rowsEnding});
    auto profile = ProfileWriter::open(stem + rowsEnding, isBenchmark ? ProfileWriter::Rows::Means : ProfileWriter::Rows::Frames);
    bool written = bool(profile);
    if (written) {
        for (const MeanFrame& frame : replayed_.means())
            isBenchmark ? profile.value().write(frame) : profile.value().write(frame.mean);
        written = profile.value().close();
    }
    if (isBenchmark) {
        const RunInfo info = infoOf(scene_, renderer_, sizePixels());
        for (const char* ending : {summaryEnding, jsonEnding}) written = written && !writeSummary(stem + ending, replayed_, info);
    }
    const std::string figures = replayed_.line() + (replayed_.sameTriangles() ? "" : ", which differ between flights");
    if (!written)
        message_ = "cannot write " + stem + rowsEnding;
    else if (isBenchmark)
        message_ = figures + ": " + stem + rowsEnding + ", " + stem + summaryEnding + ", " + stem + jsonEnding;
    else
        message_ = std::string(isWhole ? "played" : "stopped") + ", profile in " + stem + rowsEnding;
}

}  // namespace app

#endif
