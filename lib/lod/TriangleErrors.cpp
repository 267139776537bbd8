#include "lod/TriangleErrors.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace terrain {

float TriangleErrors::pixelsOf(glm::ivec2 sample, const glm::dvec3& drawn) const {
    const glm::dvec4 there = view_.clipFromLocal * glm::dvec4(grid_.position(sample.x, sample.y), 1.0);
    if (std::max({std::fabs(there.x), std::fabs(there.y), std::fabs(there.z)}) > there.w) return 0.0f;
    const glm::dvec4 here = view_.clipFromLocal * glm::dvec4(drawn, 1.0);
    if (here.w <= 0.0) return std::numeric_limits<float>::infinity();
    return float(glm::length((glm::dvec2(here) / here.w - glm::dvec2(there) / there.w) * 0.5 * view_.viewportPixels));
}

float TriangleErrors::pixels(const std::array<DrawnVertex, 3>& triangle) const {
    const auto& [a, b, c] = triangle;
    const glm::dvec2 ab(b.place - a.place), ac(c.place - a.place);
    const double area = ab.x * ac.y - ab.y * ac.x;
    const glm::ivec2 last(grid_.columns() - 1, grid_.rows() - 1);
    float largest = 0.0f;
    if (area == 0.0) {
        for (const DrawnVertex& corner : triangle) {
            const glm::ivec2 at = glm::min(glm::ivec2(corner.place), last);
            if (glm::vec2(at) == corner.place && !grid_.isHole(at.x, at.y))
                largest = std::max(largest, pixelsOf(at, glm::dvec3(corner.position)));
        }
        return largest;
    }
    const glm::ivec2 low(glm::ceil(glm::min(glm::min(a.place, b.place), c.place)));
    const glm::ivec2 high = glm::min(glm::ivec2(glm::floor(glm::max(glm::max(a.place, b.place), c.place))), last);
    const int step = std::max(1, int(std::ceil(std::sqrt(0.5 * std::fabs(area) / kMostSamples))));
    constexpr double kAtRim = -1e-6;
    for (int row = low.y; row <= high.y; row += step)
        for (int column = low.x; column <= high.x; column += step) {
            const glm::dvec2 at = glm::dvec2(column, row) - glm::dvec2(a.place);
            const double v = (at.x * ac.y - at.y * ac.x) / area, w = (ab.x * at.y - ab.y * at.x) / area;
            if (v < kAtRim || w < kAtRim || v + w > 1.0 - kAtRim || grid_.isHole(column, row)) continue;
            const glm::dvec3 drawn =
                glm::dvec3(a.position) + v * glm::dvec3(b.position - a.position) + w * glm::dvec3(c.position - a.position);
            largest = std::max(largest, pixelsOf({column, row}, drawn));
        }
    return largest;
}

}  // namespace terrain
