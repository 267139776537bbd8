// Camera flights: the standard circle, and flights in CSV files.
#pragma once

#include <fstream>
#include <functional>
#include <istream>
#include <string>
#include <vector>

#include <Inventor/SbRotation.h>
#include <Inventor/SbVec3f.h>

#include "base/Result.h"

namespace app {

/// Place and orientation of a camera, in the coordinates of the scene. At no rotation it looks along -z with y up.
struct Pose {
    SbVec3f position{0.0f, 0.0f, 0.0f};
    SbRotation orientation = SbRotation::identity();
};

/// A pose at every time from 0 to the duration; before and after, the nearest of the two.
class Flight {
public:
    Flight(double durationMs, std::function<Pose(double timeMs)> pose) : duration_(durationMs), pose_(std::move(pose)) {}

    double duration() const { return duration_; }  ///< milliseconds, at least 0
    Pose at(double timeMs) const;
    /// The same path in another time; a flight without any duration stays as it is.
    Flight lasting(double durationMs) const;

private:
    double duration_;
    std::function<Pose(double)> pose_;
};

/// Where the standard flight takes place: the ground spans (0, 0) to (width, depth), the camera stays at this altitude.
struct FlightArea {
    SbVec3f corner{0.0f, 0.0f, 0.0f};
    float width = 1.0f;
    float depth = 1.0f;
    float altitude = 0.07f;
};

/// The pose that looks from a position along a direction, z up.
Pose lookAlong(const SbVec3f& position, const SbVec3f& direction);
/// The standard flight: once round the middle of the area in the given time, counter-clockwise from the east, with radii of 0.3 of
/// its width and depth, looking along the tangent pitched 15 degrees down.
Flight standardFlight(const FlightArea& area, double durationMs);

/// A recorded pose.
struct TimedPose {
    double timeMs = 0.0;
    Pose pose;
};

/// The flight through these poses, whose times increase: linear between positions, spherical between orientations.
Flight keyFrameFlight(std::vector<TimedPose> poses);

/// Reads `time_ms,x,y,z,qx,qy,qz,qw` with that header. Times increase; they are taken relative to the first. Errors name the line.
terrain::Result<Flight> readFlight(std::istream& stream, const std::string& name);
terrain::Result<Flight> readFlightFile(const std::string& path);

/// Writes what readFlight() reads, with enough digits to get the same numbers back.
class FlightWriter {
public:
    /// Error: the file can't be written.
    static terrain::Result<FlightWriter> open(const std::string& path);
    void write(double timeMs, const Pose& pose);
    /// False when something could not be written.
    bool close();

private:
    std::ofstream file_;
};

}  // namespace app
