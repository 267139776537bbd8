#include "Flight.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

#include <Inventor/SbMatrix.h>

namespace app {

using terrain::Error;
using terrain::Result;

namespace {

constexpr std::string_view header = "time_ms,x,y,z,qx,qy,qz,qw";

Error lineError(const std::string& name, int line, const std::string& expected, std::string_view found) {
    return {name + ":" + std::to_string(line), expected, "\"" + std::string(found) + "\""};
}

std::optional<std::array<double, 8>> readRow(std::string_view line) {
    std::array<double, 8> row{};
    for (std::size_t i = 0; i < row.size(); ++i) {
        while (line.starts_with(' ')) line.remove_prefix(1);
        const auto [stop, problem] = std::from_chars(line.data(), line.data() + line.size(), row[i]);
        if (problem != std::errc() || !std::isfinite(row[i])) return std::nullopt;
        line.remove_prefix(std::size_t(stop - line.data()));
        while (line.starts_with(' ')) line.remove_prefix(1);
        const bool last = i + 1 == row.size();
        if (last ? !line.empty() : !line.starts_with(',')) return std::nullopt;
        if (!last) line.remove_prefix(1);
    }
    return row;
}

}  // namespace

Pose Flight::at(double timeMs) const {
    return pose_(std::clamp(timeMs, 0.0, duration_));
}

Flight Flight::lasting(double durationMs) const {
    if (duration_ <= 0.0) return *this;
    const double speed = duration_ / durationMs;
    return Flight(durationMs, [path = pose_, speed, end = duration_](double t) { return path(std::min(t * speed, end)); });
}

Pose lookAlong(const SbVec3f& position, const SbVec3f& direction) {
    SbVec3f back = -direction;
    back.normalize();
    SbVec3f right = SbVec3f(0.0f, 0.0f, 1.0f).cross(back);
    if (right.normalize() == 0.0f) right.setValue(1.0f, 0.0f, 0.0f);
    const SbVec3f up = back.cross(right);
    const SbMatrix axes(right[0], right[1], right[2], 0.0f, up[0], up[1], up[2], 0.0f, back[0], back[1], back[2], 0.0f, 0.0f, 0.0f,
                        0.0f, 1.0f);
    return {position, SbRotation(axes)};
}

Flight standardFlight(const FlightArea& area, double durationMs) {
    const double pitch = 15.0 * std::numbers::pi / 180.0;
    return Flight(durationMs, [area, pitch, durationMs](double timeMs) {
        const double t = 2.0 * std::numbers::pi * timeMs / durationMs;
        const SbVec3f position(area.corner[0] + area.width * float(0.5 + 0.3 * std::cos(t)),
                               area.corner[1] + area.depth * float(0.5 + 0.3 * std::sin(t)), area.altitude);
        const double dx = -std::sin(t) * area.width, dy = std::cos(t) * area.depth;
        const double level = std::cos(pitch) / std::hypot(dx, dy);
        return lookAlong(position, SbVec3f(float(dx * level), float(dy * level), float(-std::sin(pitch))));
    });
}

Flight keyFrameFlight(std::vector<TimedPose> poses) {
    const double start = poses.empty() ? 0.0 : poses.front().timeMs;
    for (TimedPose& pose : poses) pose.timeMs -= start;
    const double duration = poses.empty() ? 0.0 : poses.back().timeMs;
    return Flight(duration, [poses = std::move(poses)](double timeMs) {
        const auto later = [](double time, const TimedPose& pose) { return time < pose.timeMs; };
        const auto next = std::upper_bound(poses.begin(), poses.end(), timeMs, later);
        if (poses.empty()) return Pose();
        if (next == poses.begin()) return next->pose;
        const TimedPose& before = *std::prev(next);
        if (next == poses.end()) return before.pose;
        const float f = float((timeMs - before.timeMs) / (next->timeMs - before.timeMs));
        return Pose{before.pose.position * (1.0f - f) + next->pose.position * f,
                    SbRotation::slerp(before.pose.orientation, next->pose.orientation, f)};
    });
}

Result<Flight> readFlight(std::istream& stream, const std::string& name) {
    std::vector<TimedPose> poses;
    std::string text;
    for (int line = 1; std::getline(stream, text); ++line) {
        while (!text.empty() && (text.back() == '\r' || text.back() == ' ')) text.pop_back();
        if (line == 1) {
            if (text != header) return lineError(name, line, "\"" + std::string(header) + "\"", text.substr(0, 80));
            continue;
        }
        if (text.empty()) continue;
        const auto row = readRow(text);
        if (!row) return lineError(name, line, "8 finite numbers between commas", text.substr(0, 80));
        const auto& [time, x, y, z, qx, qy, qz, qw] = *row;
        if (!poses.empty() && time <= poses.back().timeMs)
            return lineError(name, line, "a time after that of the line before", text);
        const double length = std::sqrt(qx * qx + qy * qy + qz * qz + qw * qw);
        if (!(length > 1e-6) || !std::isfinite(length)) return lineError(name, line, "a quaternion other than zero", text);
        const SbRotation turn(float(qx / length), float(qy / length), float(qz / length), float(qw / length));
        poses.push_back({time, {SbVec3f(float(x), float(y), float(z)), turn}});
    }
    if (poses.empty()) return Error{name, "a line \"" + std::string(header) + "\" and at least one line of numbers", "none"};
    return keyFrameFlight(std::move(poses));
}

Result<Flight> readFlightFile(const std::string& path) {
    std::ifstream file(path);
    if (!file) return Error{path, "a readable flight in CSV", "no such file, or no permission"};
    return readFlight(file, path);
}

Result<FlightWriter> FlightWriter::open(const std::string& path) {
    FlightWriter writer;
    writer.file_.open(path, std::ios::trunc);
    if (!writer.file_) return Error{path, "a file that can be written", "no permission, or no such folder"};
    writer.file_.imbue(std::locale::classic());
    writer.file_.precision(9);
    writer.file_ << header << '\n';
    return writer;
}

void FlightWriter::write(double timeMs, const Pose& pose) {
    float q[4];
    pose.orientation.getValue(q[0], q[1], q[2], q[3]);
    file_ << timeMs;
    for (int i = 0; i < 3; ++i) file_ << ',' << pose.position[i];
    for (const float value : q) file_ << ',' << value;
    file_ << '\n';
}

bool FlightWriter::close() {
    file_.close();
    return !file_.fail();
}

}  // namespace app
