// A rectangle of samples.
#pragma once

#include <cstdint>

#include <glm/common.hpp>
#include <glm/vec2.hpp>

namespace terrain {

/// Samples from `low` to `high`, both included, as (column, row); empty where high lies before low.
struct SampleRect {
    glm::ivec2 low{0};
    glm::ivec2 high{-1};

    bool isEmpty() const { return high.x < low.x || high.y < low.y; }
    int columns() const { return high.x - low.x + 1; }
    int rows() const { return high.y - low.y + 1; }
    std::int64_t samples() const { return isEmpty() ? 0 : std::int64_t(columns()) * rows(); }
    SampleRect cutTo(const SampleRect& other) const { return {glm::max(low, other.low), glm::min(high, other.high)}; }
    SampleRect widened(int by) const { return {low - by, high + by}; }
    /// The smallest that holds both, neither of which is empty.
    SampleRect united(const SampleRect& other) const { return {glm::min(low, other.low), glm::max(high, other.high)}; }
    bool touches(const SampleRect& other) const { return !cutTo(other).isEmpty(); }
    bool contains(glm::ivec2 p) const { return p.x >= low.x && p.y >= low.y && p.x <= high.x && p.y <= high.y; }

    bool operator==(const SampleRect&) const = default;
};

}  // namespace terrain
