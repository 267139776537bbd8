// What every frame cost: a row of CSV each.
#pragma once

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>

#include "base/Result.h"

namespace app {

/// One frame as -p writes it. Values that the shape does not tell are empty there.
struct FrameFigures {
    int frame = 0;
    double timeMs = 0.0;   ///< time in the animation
    double frameMs = 0.0;  ///< wall clock, until GL has finished
    double cpuMs = 0.0;    ///< processor time of all threads meanwhile; not written by -p for a single flight
    std::uint64_t triangles = 0;
    struct Terrain {  ///< known for this project's own nodes only
        double selectMs = 0.0;
        double uploadMs = 0.0;
        double drawMs = 0.0;
        std::uint64_t patches = 0;
        double errorPixels = 0.0;
        std::uint64_t memoryBytes = 0;
        std::uint64_t bufferBytes = 0;
        std::uint64_t pending = 0;  ///< tiles that other threads build, or will
        bool isComplete = true;     ///< not waiting for tiles, nor stopped by a limit on work per frame
    };
    std::optional<Terrain> terrain;
};

/// One frame of a flight that was flown several times.
struct MeanFrame {
    FrameFigures mean;     ///< of everything; the worst where it is a bound or a number of bytes
    double leastMs = 0.0;  ///< of frameMs
    double mostMs = 0.0;
};

/// Writes -p's file: of one flight as it goes, or of several at their end.
class ProfileWriter {
public:
    enum class Rows { Frames, Means };  ///< rows of means have three columns more: frame_ms_min, frame_ms_max, cpu_ms

    /// Error: the file can't be written.
    static terrain::Result<ProfileWriter> open(const std::string& path, Rows rows = Rows::Frames);
    void write(const FrameFigures& figures);
    void write(const MeanFrame& frame);
    /// False when something could not be written.
    bool close();

private:
    void writeCells(const FrameFigures& figures);

    std::ofstream file_;
};

}  // namespace app
