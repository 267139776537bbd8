// How far samples are from triangles that stand on some of them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>

#include <glm/vec2.hpp>

namespace terrain {

inline std::int64_t crossProduct(glm::ivec2 a, glm::ivec2 b) {
    return std::int64_t(a.x) * b.y - std::int64_t(a.y) * b.x;
}

/// A surface over one triangle of samples.
template <class Value>
struct Plane {
    glm::ivec2 origin{0};
    Value value{}, alongColumns{}, alongRows{};
    Value at(glm::ivec2 p) const { return value + alongColumns * float(p.x - origin.x) + alongRows * float(p.y - origin.y); }
};

/// The corners must not lie on a line.
template <class Samples>
auto planeThrough(const Samples& samples, glm::ivec2 a, glm::ivec2 b, glm::ivec2 c) {
    using Value = typename Samples::Value;
    const glm::ivec2 ab = b - a, ac = c - a;
    const float scale = 1.0f / (float(ab.x) * float(ac.y) - float(ab.y) * float(ac.x));
    const Value va = samples.at(a), vb = samples.at(b) - va, vc = samples.at(c) - va;
    return Plane<Value>{a, va, (vb * float(ac.y) - vc * float(ab.y)) * scale, (vc * float(ab.x) - vb * float(ac.x)) * scale};
}

/// Where an edge crosses rows.
struct Edge {
    glm::ivec2 from;
    int across, rows;  ///< columns that it goes while it goes so many rows, which are 1 where that is exact
    Edge(glm::ivec2 p, glm::ivec2 q) : from(p), across(q.x - p.x), rows(q.y - p.y) {
        if (rows > 0 && across % rows == 0) {
            across /= rows;
            rows = 1;
        }
    }
    /// The first column not left of the edge.
    int after(int row) const {
        const int way = across * (row - from.y);
        return rows == 1 ? from.x + way : from.x + (way >= 0 ? (way + rows - 1) / rows : way / rows);
    }
    /// The last one not right of it.
    int before(int row) const {
        const int way = across * (row - from.y);
        return rows == 1 ? from.x + way : from.x + (way >= 0 ? way / rows : (way - rows + 1) / rows);
    }
};

/// Largest deviation of the samples in a triangle from the plane through its corners; where it exceeds `enough`, any value that
/// does.
template <class Samples>
float triangleDeviation(const Samples& samples, glm::ivec2 a, glm::ivec2 b, glm::ivec2 c, float enough) {
    if (crossProduct(b - a, c - a) == 0) return 0.0f;
    const auto plane = planeThrough(samples, a, b, c);
    if (b.y < a.y) std::swap(a, b);
    if (c.y < a.y) std::swap(a, c);
    if (c.y < b.y) std::swap(b, c);
    const Edge whole(a, c), lower(a, b), upper(b, c);
    const bool bendsRight = crossProduct(c - a, b - a) < 0;
    float deviation = 0.0f;
    for (int row = a.y; row <= c.y && deviation <= enough; ++row) {
        const Edge& other = row < b.y || upper.rows == 0 ? lower : upper;
        // Along a level edge at the bottom or the top all of it counts.
        int first = bendsRight ? whole.after(row) : (other.rows == 0 ? b.x : other.after(row));
        int last = bendsRight ? (other.rows == 0 ? b.x : other.before(row)) : whole.before(row);
        if (row == b.y) (bendsRight ? last : first) = b.x;
        if (first <= last)
            deviation = std::max(deviation, samples.rowDeviation(row, first, last, plane.at({first, row}), plane.alongColumns));
    }
    return deviation;
}

}  // namespace terrain
