#include "lod/RayCast.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "lod/BruteForceMesh.h"
#include "lod/LineTests.h"

namespace terrain {

namespace {

class Caster {
public:
    Caster(const SampleGrid& grid, const BoxPyramid& boxes, const Line& line) : grid_(grid), boxes_(boxes), line_(line) {
        // A little slack keeps what lies exactly on the border of a flat box.
        const BoxPyramid::Bounds all = boxes.all();
        if (!all.isEmpty()) slack_ = 1e-6 * (1.0 + glm::length(glm::dvec3(all.high) - glm::dvec3(all.low)));
    }

    std::vector<RayHit> cast() {
        descend(boxes_.levelCount() - 1, 0, 0);
        std::sort(hits_.begin(), hits_.end(), [](const RayHit& a, const RayHit& b) { return a.distance < b.distance; });
        return std::move(hits_);
    }

private:
    void descend(int level, int column, int row) {
        const BoxPyramid::Bounds bounds = boxes_.block(level, column, row);
        if (bounds.isEmpty() || !line_.meets(bounds.low, bounds.high, slack_)) return;
        if (level == 0) {
            constexpr int cells = BoxPyramid::kBlockCells;
            for (int y = row * cells; y < std::min((row + 1) * cells, grid_.rows() - 1); ++y)
                for (int x = column * cells; x < std::min((column + 1) * cells, grid_.columns() - 1); ++x) testCell(x, y);
            return;
        }
        for (int y = 2 * row; y < std::min(2 * row + 2, boxes_.rows(level - 1)); ++y)
            for (int x = 2 * column; x < std::min(2 * column + 2, boxes_.columns(level - 1)); ++x) descend(level - 1, x, y);
    }

    void testCell(int column, int row) {
        const BoxPyramid::Bounds bounds = BoxPyramid::exactBounds(grid_, column, row, column + 1, row + 1);
        if (bounds.isEmpty() || !line_.meets(bounds.low, bounds.high, slack_) || isCellHole(grid_, column, row)) return;
        for (int triangle = 0; triangle < 2; ++triangle) {
            glm::dvec3 corner[3];
            for (int i = 0; i < 3; ++i)
                corner[i] = grid_.framePosition(column + kCellTriangles[triangle][i][0], row + kCellTriangles[triangle][i][1]);
            if (const auto hit = line_.meets(corner))
                hits_.push_back(
                    {hit->distance, column, row, triangle, hit->barycentric, line_.origin + line_.direction * hit->distance});
        }
    }

    const SampleGrid& grid_;
    const BoxPyramid& boxes_;
    Line line_;
    double slack_ = 0.0;
    std::vector<RayHit> hits_;
};

}  // namespace

std::vector<RayHit> castRay(const SampleGrid& grid, const BoxPyramid& boxes, const glm::dvec3& origin, const glm::dvec3& direction,
                            double first, double last) {
    return Caster(grid, boxes, {origin, direction, first, last}).cast();
}

std::optional<SurfacePoint> surfaceAt(const SampleGrid& grid, const glm::dvec2& position) {
    if (!grid.isRegular() ||
        !(position.x >= 0.0 && position.x <= grid.columns() - 1 && position.y >= 0.0 && position.y <= grid.rows() - 1))
        return std::nullopt;
    const int column = std::min(int(position.x), grid.columns() - 2), row = std::min(int(position.y), grid.rows() - 2);
    if (isCellHole(grid, column, row)) return std::nullopt;
    const double x = position.x - column, y = position.y - row;
    const double z00 = grid.height(column, row), z10 = grid.height(column + 1, row);
    const double z01 = grid.height(column, row + 1), z11 = grid.height(column + 1, row + 1);
    if (x + y <= 1.0) return SurfacePoint{float(z00 + x * (z10 - z00) + y * (z01 - z00)), column, row, 0};
    return SurfacePoint{float(z11 + (1.0 - x) * (z01 - z11) + (1.0 - y) * (z10 - z11)), column, row, 1};
}

}  // namespace terrain
