// What every frame cost: a row of CSV each, and a summary in JSON.
#pragma once

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "MeasureError.h"
#include "base/Result.h"

namespace app {

/// One frame as -p writes it. Values that the shape does not tell are empty there.
struct FrameFigures {
    int frame = 0;
    double timeMs = 0.0;   ///< time in the animation
    double frameMs = 0.0;  ///< wall clock, until GL has finished
    std::uint64_t triangles = 0;
    struct Terrain {  ///< known for this project's own nodes only
        double selectMs = 0.0;
        double uploadMs = 0.0;
        double drawMs = 0.0;
        std::uint64_t patches = 0;
        double errorPixels = 0.0;
        std::uint64_t memoryBytes = 0;
        std::uint64_t bufferBytes = 0;
        bool isComplete = true;  ///< not waiting for tiles, nor stopped by a limit on work per frame
    };
    std::optional<Terrain> terrain;
};

/// Writes -p's file.
class ProfileWriter {
public:
    /// Error: the file can't be written.
    static terrain::Result<ProfileWriter> open(const std::string& path);
    void write(const FrameFigures& figures);
    /// False when something could not be written.
    bool close();

private:
    std::ofstream file_;
};

/// Collects frames for --stats.
class FrameStatistics {
public:
    void add(const FrameFigures& figures);
    void add(const ErrorSample& error) { errors_.merge(error); }
    void setStart(double loadMs, double firstFrameMs);
    /// The JSON object, indented.
    std::string json(const std::string& algorithm, const std::string& renderer) const;
    /// Frames, their median time, mean triangles and, where the shape tells it, the greatest error bound and how many frames were
    /// not complete, in one line.
    std::string line() const;
    const ErrorSample& errors() const { return errors_; }

private:
    std::vector<double> frame_, select_, upload_, draw_, triangles_;
    std::optional<double> errorBound_;  ///< greatest of the frames that have one
    std::uint64_t unfinished_ = 0;
    std::uint64_t memoryBytes_ = 0;
    std::uint64_t bufferBytes_ = 0;
    double loadMs_ = 0.0;
    double firstFrameMs_ = 0.0;
    ErrorSample errors_;
};

}  // namespace app
