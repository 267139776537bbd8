#include "HeightTools.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace app {

namespace {

constexpr double degrees = 180.0 / std::numbers::pi;
constexpr int piecesWithoutLattice = 4096;
// Corners of a profile nearer to each other than this part of a cell are one.
constexpr double nearest = 1e-6;

// Adds the shares of the way from a to b at which value runs through whole numbers.
void addCrossings(double a, double b, std::vector<double>& shares) {
    if (a == b) return;
    const double low = std::min(a, b), high = std::max(a, b);
    for (double line = std::ceil(low); line <= high; line += 1.0) shares.push_back((line - a) / (b - a));
}

// Shares of a leg, from 0 to 1, where the ground below may have an edge.
std::vector<double> cuts(const Ground::Lattice& lattice, glm::dvec2 from, glm::dvec2 to) {
    std::vector<double> shares{0.0, 1.0};
    if (lattice.columns < 2) {
        for (int i = 1; i < piecesWithoutLattice; ++i) shares.push_back(double(i) / piecesWithoutLattice);
        std::sort(shares.begin(), shares.end());
        return shares;
    }
    const glm::dvec2 a = (from - lattice.origin) / lattice.spacing, b = (to - lattice.origin) / lattice.spacing;
    // Beyond the map there is nothing to be cut.
    const glm::dvec2 last(lattice.columns - 1, lattice.rows - 1);
    double enter = 0.0, leave = 1.0;
    for (int axis = 0; axis < 2; ++axis) {
        const double step = b[axis] - a[axis];
        if (step == 0.0) continue;
        const double first = (0.0 - a[axis]) / step, second = (last[axis] - a[axis]) / step;
        enter = std::max(enter, std::min(first, second));
        leave = std::min(leave, std::max(first, second));
    }
    if (enter < leave) {
        const glm::dvec2 p = a + enter * (b - a), q = a + leave * (b - a);
        std::vector<double> inside{0.0, 1.0};
        addCrossings(p.x, q.x, inside);
        addCrossings(p.y, q.y, inside);
        addCrossings(p.x + p.y, q.x + q.y, inside);
        addCrossings(p.x - p.y, q.x - q.y, inside);
        for (const double share : inside) shares.push_back(std::clamp(enter + share * (leave - enter), 0.0, 1.0));
    }
    std::sort(shares.begin(), shares.end());
    const double least = nearest / std::max(glm::length(b - a), nearest);
    const auto isSame = [least](double first, double second) { return second - first < least; };
    shares.erase(std::unique(shares.begin(), shares.end(), isSame), shares.end());
    shares.back() = 1.0;
    return shares;
}

class LineMeter {
public:
    LineMeter(const Ground& ground, MeasuredLine& line) : ground_(ground), line_(line) {}

    void leg(glm::dvec2 from, glm::dvec2 to) {
        const double length = glm::length(to - from);
        if (!(length > 0.0)) return;
        const std::vector<double> shares = cuts(ground_.lattice(), from, to);
        const glm::dvec2 along = (to - from) / length;
        for (std::size_t i = 1; i < shares.size(); ++i)
            piece(from + shares[i - 1] * (to - from), from + shares[i] * (to - from), (shares[i] - shares[i - 1]) * length, along);
    }

private:
    // The triangle under its middle tells everything about a piece: at its ends another one may answer, or none.
    void piece(glm::dvec2 from, glm::dvec2 to, double length, glm::dvec2 along) {
        const auto middle = ground_.at(0.5 * (from + to));
        const bool hasGround = middle && middle->normal.z > 0.0;
        double rise = 0.0;
        std::optional<double> start, end;
        if (hasGround) {
            const double slope = -glm::dot(glm::dvec2(middle->normal), along) / middle->normal.z;
            rise = slope * length;
            start = middle->height - 0.5 * rise;
            end = middle->height + 0.5 * rise;
            line_.ground += std::hypot(length, rise);
            (rise > 0.0 ? line_.climb : line_.descent) += std::fabs(rise);
            line_.steepestDegrees = std::max(line_.steepestDegrees, std::atan(std::fabs(slope)) * degrees);
            line_.lowest = std::min({line_.lowest.value_or(*start), *start, *end});
            line_.highest = std::max({line_.highest.value_or(*start), *start, *end});
        } else {
            line_.withoutGround += length;
        }
        // Where ground begins or ends there are two points.
        if (line_.points.empty() || line_.points.back().height.has_value() != hasGround)
            line_.points.push_back({line_.horizontal, from, start});
        line_.horizontal += length;
        line_.points.push_back({line_.horizontal, to, end});
    }

    const Ground& ground_;
    MeasuredLine& line_;
};

}  // namespace

std::optional<Spot> spotAt(const Ground& ground, glm::dvec2 place) {
    const auto surface = ground.at(place);
    if (!surface) return std::nullopt;
    Spot spot;
    spot.at = glm::dvec3(place, surface->height);
    const glm::dvec2 downhill(surface->normal);
    spot.slopeDegrees = std::atan2(glm::length(downhill), surface->normal.z) * degrees;
    // Single precision has no level ground: what it calls level is within its rounding.
    constexpr double level = 1e-6;
    if (glm::length(downhill) > level) {
        const double aspect = std::atan2(downhill.x, downhill.y) * degrees;
        spot.aspectDegrees = aspect < 0.0 ? aspect + 360.0 : aspect;
    }
    return spot;
}

MeasuredLine measureLine(const Ground& ground, std::vector<glm::dvec2> corners) {
    MeasuredLine line;
    line.corners = std::move(corners);
    LineMeter meter(ground, line);
    for (std::size_t i = 1; i < line.corners.size(); ++i) meter.leg(line.corners[i - 1], line.corners[i]);
    return line;
}

glm::dvec2 MeasuredLine::placeAt(double distance) const {
    if (points.empty()) return corners.empty() ? glm::dvec2(0.0) : corners.front();
    const auto before = [](const ProfilePoint& point, double value) { return point.distance < value; };
    const auto next = std::lower_bound(points.begin(), points.end(), distance, before);
    if (next == points.begin()) return points.front().at;
    if (next == points.end()) return points.back().at;
    const ProfilePoint &a = *std::prev(next), &b = *next;
    return glm::mix(a.at, b.at, b.distance > a.distance ? (distance - a.distance) / (b.distance - a.distance) : 0.0);
}

std::optional<double> MeasuredLine::heightAt(double distance) const {
    const auto before = [](const ProfilePoint& point, double value) { return point.distance < value; };
    const auto next = std::lower_bound(points.begin(), points.end(), distance, before);
    if (next == points.end()) return points.empty() ? std::nullopt : points.back().height;
    if (next == points.begin()) return next->height;
    const ProfilePoint &a = *std::prev(next), &b = *next;
    if (!a.height || !b.height) return b.height;
    return glm::mix(*a.height, *b.height, b.distance > a.distance ? (distance - a.distance) / (b.distance - a.distance) : 1.0);
}

}  // namespace app
