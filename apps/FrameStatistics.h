// What the frames of a run come to: a line, JSON and CSV.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>

#include "MeasureError.h"
#include "Profile.h"
#include "Statistics.h"

namespace app {

/// What was measured, and where.
struct RunInfo {
    std::string algorithm;
    std::string renderer;
    glm::ivec2 sizePixels{0, 0};
    std::vector<std::pair<std::string, std::string>> settings;  ///< of the terrain node: names of fields and their values
};

/// How long an animation was to last and did.
struct AnimationTime {
    double wantedMs = 0.0;
    double lastedMs = 0.0;        ///< from its first frame to its end
    double longestFrameMs = 0.0;  ///< of its frames, with all that is done for one
};

/// Collects frames, of one flight or of several along the same path. Of several, figures of a flight are averaged over the flights,
/// as those of each frame are.
class FrameStatistics {
public:
    /// Frames that follow belong to another flight along the same path.
    void beginRepetition() { flights_.emplace_back(); }
    void add(const FrameFigures& figures);
    void add(const ErrorSample& error) { errors_.merge(error); }
    void add(const AnimationTime& time) { animations_.push_back(time); }
    void setStart(double loadMs, double firstFrameMs);

    /// Every frame, averaged over the flights: as many as the shortest of them has.
    std::vector<MeanFrame> means() const;
    /// Whether each frame had as many triangles in every flight.
    bool sameTriangles() const;
    /// Frames, their median time, mean triangles and, where the shape tells it, the greatest error bound and how many frames were
    /// not complete, in one line.
    std::string line() const;
    /// A JSON object, indented.
    std::string json(const RunInfo& info) const;
    /// A line of names and a line of figures.
    std::string csv(const RunInfo& info) const;
    const ErrorSample& errors() const { return errors_; }

private:
    using Figure = double (*)(const FrameFigures&);

    std::size_t frames() const;
    bool hasTerrain() const;
    /// Mean over the flights of what summarizes each of them.
    Summary summary(Figure figure) const;
    double framesPerSecond() const;
    std::optional<double> errorBound() const;
    std::uint64_t unfinished() const;
    std::uint64_t most(std::uint64_t FrameFigures::Terrain::*bytes) const;
    AnimationTime animation() const;

    std::vector<std::vector<FrameFigures>> flights_;
    std::vector<AnimationTime> animations_;
    double loadMs_ = 0.0;
    double firstFrameMs_ = 0.0;
    ErrorSample errors_;
};

}  // namespace app
