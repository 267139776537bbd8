// The largest deviation of heights from a triangle, without looking where there is none.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <utility>

#include <glm/vec2.hpp>

#include "height/SampleGrid.h"
#include "lod/BoxPyramid.h"
#include "lod/DiamondTopology.h"

namespace terrain {

/// The plane through the corners of one triangle of a diamond: value at the apex, and what a column and a row add.
template <class Value>
struct TrianglePlane {
    glm::ivec2 apex;
    Value atApex, gradientX, gradientY;

    Value at(int column, int row) const { return atApex + gradientX * float(column - apex.x) + gradientY * float(row - apex.y); }
};

/// First and last column of the samples of a row in triangle `half` (0: at corner 1, 1: at corner 3) of a diamond, whose rows it
/// must be one of.
inline std::pair<int, int> columnsOfRow(const DiamondShape& d, int half, int row) {
    const glm::ivec2 apex = d.corner[half ? 3 : 1];
    const int toCentre = d.centre.x > apex.x ? 1 : -1, away = std::abs(row - apex.y);
    if (!d.isSquare && apex.x == d.centre.x) return {apex.x - away, apex.x + away};
    const int from = d.isSquare ? apex.x : apex.x + toCentre * away,
              to = d.isSquare ? apex.x + toCentre * (2 * d.size - away) : d.centre.x;
    return {std::min(from, to), std::max(from, to)};
}

/// Branch and bound over the blocks of a BoxPyramid: a block whose heights can't be further from the plane than what was found is
/// left out. Deviations are computed as samples of whole rows are (`Samples::partDeviation`), so that the result has the same bits.
template <class Samples>
class TriangleSearch {
public:
    TriangleSearch(const Samples& samples, const BoxPyramid& boxes, const DiamondShape& d, int half,
                   const TrianglePlane<float>& plane)
        : samples_(samples), boxes_(boxes), d_(d), half_(half),
          plane_(plane), corners_{d.corner[half ? 3 : 1], d.corner[0], d.corner[2]} {
        for (const glm::ivec2& corner : corners_) {
            low_ = {std::min(low_.x, corner.x), std::min(low_.y, corner.y)};
            high_ = {std::max(high_.x, corner.x), std::max(high_.y, corner.y)};
        }
        // Of what single precision makes of heights of the plane.
        const double largest =
            std::abs(double(plane.atApex)) + 2.0 * d.size * (std::abs(double(plane.gradientX)) + std::abs(double(plane.gradientY)));
        slack_ =
            16.0 * std::numeric_limits<float>::epsilon() * (largest + std::abs(boxes.all().low.z) + std::abs(boxes.all().high.z));
    }

    /// The largest deviation, or `known` where none is larger.
    float above(float known) {
        deviation_ = known;
        search(boxes_.levelCount() - 1, {0, 0});
        return deviation_;
    }

private:
    void search(int level, glm::ivec2 block) {
        const BoxPyramid::Bounds bounds = boxes_.block(level, block.x, block.y);
        if (bounds.isEmpty() || bound(bounds) <= double(deviation_)) return;
        if (level == 0) return scan(bounds);
        for (int child = 0; child < 4; ++child) {
            const glm::ivec2 finer(2 * block.x + (child & 1), 2 * block.y + (child >> 1));
            if (finer.x < boxes_.columns(level - 1) && finer.y < boxes_.rows(level - 1)) search(level - 1, finer);
        }
    }

    /// On the deviation of samples that lie in both, or -1 where none does.
    double bound(const BoxPyramid::Bounds& block) const {
        const double left = std::max(block.low.x, float(low_.x)), right = std::min(block.high.x, float(high_.x));
        const double bottom = std::max(block.low.y, float(low_.y)), top = std::min(block.high.y, float(high_.y));
        if (left > right || bottom > top || isBeyondASide(left, right, bottom, top)) return -1.0;
        const double alongLeft = (left - plane_.apex.x) * plane_.gradientX, alongRight = (right - plane_.apex.x) * plane_.gradientX;
        const double alongBottom = (bottom - plane_.apex.y) * plane_.gradientY, alongTop = (top - plane_.apex.y) * plane_.gradientY;
        const double lowest = plane_.atApex + std::min(alongLeft, alongRight) + std::min(alongBottom, alongTop);
        const double highest = plane_.atApex + std::max(alongLeft, alongRight) + std::max(alongBottom, alongTop);
        return std::max(block.high.z - lowest, highest - block.low.z) + slack_;
    }

    bool isBeyondASide(double left, double right, double bottom, double top) const {
        const auto side = [](glm::ivec2 a, glm::ivec2 b, double x, double y) {
            return double(b.x - a.x) * (y - a.y) - double(b.y - a.y) * (x - a.x);
        };
        for (int i = 0; i < 3; ++i) {
            const glm::ivec2 a = corners_[std::size_t(i)], b = corners_[std::size_t((i + 1) % 3)],
                             c = corners_[std::size_t((i + 2) % 3)];
            const double inside = side(a, b, c.x, c.y) > 0.0 ? 1.0 : -1.0;
            if (std::max(std::max(inside * side(a, b, left, bottom), inside * side(a, b, left, top)),
                         std::max(inside * side(a, b, right, bottom), inside * side(a, b, right, top))) < 0.0)
                return true;
        }
        return false;
    }

    void scan(const BoxPyramid::Bounds& block) {
        const int bottom = std::max(int(block.low.y), low_.y), top = std::min(int(block.high.y), high_.y);
        for (int row = bottom; row <= top; ++row) {
            const auto [first, last] = columnsOfRow(d_, half_, row);
            const int from = std::max(first, int(block.low.x)), to = std::min(last, int(block.high.x));
            if (from > to) continue;
            deviation_ =
                std::max(deviation_, samples_.partDeviation(row, {from, to}, first, plane_.at(first, row), plane_.gradientX));
        }
    }

    const Samples& samples_;
    const BoxPyramid& boxes_;
    const DiamondShape& d_;
    int half_;
    TrianglePlane<float> plane_;
    std::array<glm::ivec2, 3> corners_;
    glm::ivec2 low_{std::numeric_limits<int>::max()}, high_{std::numeric_limits<int>::min()};
    double slack_ = 0.0;
    float deviation_ = 0.0f;
};

}  // namespace terrain
