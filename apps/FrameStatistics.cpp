#include "FrameStatistics.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace app {

namespace {

using Terrain = FrameFigures::Terrain;

Terrain meanTerrain(const std::vector<const FrameFigures*>& frames) {
    Terrain mean;
    double patches = 0.0;
    for (const FrameFigures* frame : frames) {
        const Terrain terrain = frame->terrain.value_or(Terrain{});
        mean.selectMs += terrain.selectMs / double(frames.size());
        mean.uploadMs += terrain.uploadMs / double(frames.size());
        mean.drawMs += terrain.drawMs / double(frames.size());
        patches += double(terrain.patches) / double(frames.size());
        mean.errorPixels = std::max(mean.errorPixels, terrain.errorPixels);
        mean.memoryBytes = std::max(mean.memoryBytes, terrain.memoryBytes);
        mean.bufferBytes = std::max(mean.bufferBytes, terrain.bufferBytes);
        mean.isComplete = mean.isComplete && terrain.isComplete;
    }
    mean.patches = std::uint64_t(std::llround(patches));
    return mean;
}

MeanFrame meanOf(const std::vector<const FrameFigures*>& frames) {
    MeanFrame result;
    result.leastMs = std::numeric_limits<double>::max();
    FrameFigures& mean = result.mean;
    double triangles = 0.0;
    for (const FrameFigures* frame : frames) {
        mean.frameMs += frame->frameMs / double(frames.size());
        mean.cpuMs += frame->cpuMs / double(frames.size());
        triangles += double(frame->triangles) / double(frames.size());
        result.leastMs = std::min(result.leastMs, frame->frameMs);
        result.mostMs = std::max(result.mostMs, frame->frameMs);
    }
    mean.frame = frames.front()->frame;
    mean.timeMs = frames.front()->timeMs;
    mean.triangles = std::uint64_t(std::llround(triangles));
    if (frames.front()->terrain) mean.terrain = meanTerrain(frames);
    return result;
}

}  // namespace

void FrameStatistics::add(const FrameFigures& figures) {
    if (flights_.empty()) beginRepetition();
    flights_.back().push_back(figures);
}

void FrameStatistics::setStart(double loadMs, double firstFrameMs) {
    loadMs_ = loadMs;
    firstFrameMs_ = firstFrameMs;
}

std::size_t FrameStatistics::frames() const {
    std::size_t shortest = flights_.empty() ? 0 : flights_.front().size();
    for (const auto& flight : flights_) shortest = std::min(shortest, flight.size());
    return shortest;
}

std::vector<MeanFrame> FrameStatistics::means() const {
    std::vector<MeanFrame> means;
    std::vector<const FrameFigures*> frames(flights_.size());
    for (std::size_t i = 0; i < this->frames(); ++i) {
        std::transform(flights_.begin(), flights_.end(), frames.begin(), [i](const auto& flight) { return &flight[i]; });
        means.push_back(meanOf(frames));
    }
    return means;
}

bool FrameStatistics::sameTriangles() const {
    const auto same = [](const FrameFigures& a, const FrameFigures& b) { return a.triangles == b.triangles; };
    return std::all_of(flights_.begin(), flights_.end(), [&](const auto& flight) {
        return std::equal(flight.begin(), flight.end(), flights_.front().begin(), flights_.front().end(), same);
    });
}

bool FrameStatistics::hasTerrain() const {
    return frames() > 0 && flights_.front().front().terrain.has_value();
}

Summary FrameStatistics::summary(Figure figure) const {
    Summary mean;
    for (const auto& flight : flights_) {
        std::vector<double> values(flight.size());
        std::transform(flight.begin(), flight.end(), values.begin(), figure);
        const Summary one = summarize(std::move(values));
        mean.mean += one.mean / double(flights_.size());
        mean.median += one.median / double(flights_.size());
        mean.p95 += one.p95 / double(flights_.size());
        mean.worst += one.worst / double(flights_.size());
    }
    return mean;
}

double FrameStatistics::framesPerSecond() const {
    const double mean = summary([](const FrameFigures& f) { return f.frameMs; }).mean;
    return mean > 0.0 ? 1000.0 / mean : 0.0;
}

std::optional<double> FrameStatistics::errorBound() const {
    std::optional<double> bound;
    for (const auto& flight : flights_)
        for (const FrameFigures& frame : flight) {
            // A tile that stands in for others and reaches behind the eye has none.
            if (!frame.terrain || !std::isfinite(frame.terrain->errorPixels)) continue;
            bound = std::max(bound.value_or(0.0), frame.terrain->errorPixels);
        }
    return bound;
}

std::uint64_t FrameStatistics::unfinished() const {
    const auto isUnfinished = [](const FrameFigures& frame) { return frame.terrain && !frame.terrain->isComplete; };
    std::uint64_t count = 0;
    for (const auto& flight : flights_) count += std::uint64_t(std::count_if(flight.begin(), flight.end(), isUnfinished));
    return count;
}

std::uint64_t FrameStatistics::most(std::uint64_t Terrain::*bytes) const {
    std::uint64_t most = 0;
    for (const auto& flight : flights_)
        for (const FrameFigures& frame : flight)
            if (frame.terrain) most = std::max(most, (*frame.terrain).*bytes);
    return most;
}

AnimationTime FrameStatistics::animation() const {
    AnimationTime mean;
    for (const AnimationTime& one : animations_) {
        mean.wantedMs = one.wantedMs;
        mean.lastedMs += one.lastedMs / double(animations_.size());
        mean.longestFrameMs = std::max(mean.longestFrameMs, one.longestFrameMs);
    }
    return mean;
}

std::string FrameStatistics::line() const {
    char text[200];
    const std::size_t drawn = frames();
    const Summary frame = summary([](const FrameFigures& f) { return f.frameMs; });
    const Summary triangles = summary([](const FrameFigures& f) { return double(f.triangles); });
    std::snprintf(text, sizeof text, "%zu %s, median %.2f ms, mean %.0f triangles", drawn, drawn == 1 ? "frame" : "frames",
                  frame.median, triangles.mean);
    std::string line = text;
    if (const auto bound = errorBound()) {
        std::snprintf(text, sizeof text, ", worst error bound %.2f px", *bound);
        line += text;
    }
    if (const auto count = unfinished(); count > 0) line += ", " + std::to_string(count) + " not complete";
    if (flights_.size() > 1) line += ", mean of " + std::to_string(flights_.size()) + " flights";
    return line;
}

}  // namespace app
