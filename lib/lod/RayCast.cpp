#include "lod/RayCast.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "lod/BruteForceMesh.h"

namespace terrain {

namespace {

class Caster {
public:
    Caster(const SampleGrid& grid, const BoxPyramid& boxes, const glm::dvec3& origin, const glm::dvec3& direction, double first,
           double last)
        : grid_(grid), boxes_(boxes), origin_(origin), direction_(direction), first_(first), last_(last) {
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
    bool meets(const glm::dvec3& low, const glm::dvec3& high) const {
        double enter = first_, leave = last_;
        for (int axis = 0; axis < 3; ++axis) {
            if (direction_[axis] == 0.0) {
                if (origin_[axis] < low[axis] - slack_ || origin_[axis] > high[axis] + slack_) return false;
                continue;
            }
            const double a = (low[axis] - slack_ - origin_[axis]) / direction_[axis];
            const double b = (high[axis] + slack_ - origin_[axis]) / direction_[axis];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        return enter <= leave;
    }

    void descend(int level, int column, int row) {
        const BoxPyramid::Bounds bounds = boxes_.block(level, column, row);
        if (bounds.isEmpty() || !meets(bounds.low, bounds.high)) return;
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
        if (bounds.isEmpty() || !meets(bounds.low, bounds.high) || isCellHole(grid_, column, row)) return;
        for (int triangle = 0; triangle < 2; ++triangle) {
            glm::dvec3 corner[3];
            for (int i = 0; i < 3; ++i)
                corner[i] = grid_.framePosition(column + kCellTriangles[triangle][i][0], row + kCellTriangles[triangle][i][1]);
            testTriangle(corner, column, row, triangle);
        }
    }

    /// Moeller and Trumbore, "Fast, Minimum Storage Ray-Triangle Intersection", 1997. Borders belong to both neighbours, so that no
    /// ray slips through between them.
    void testTriangle(const glm::dvec3 (&corner)[3], int column, int row, int triangle) {
        constexpr double kBorder = 1e-9;
        const glm::dvec3 edge1 = corner[1] - corner[0], edge2 = corner[2] - corner[0];
        const glm::dvec3 p = glm::cross(direction_, edge2);
        const double determinant = glm::dot(edge1, p);
        if (determinant == 0.0) return;
        const glm::dvec3 toOrigin = origin_ - corner[0];
        const double u = glm::dot(toOrigin, p) / determinant;
        if (u < -kBorder || u > 1.0 + kBorder) return;
        const glm::dvec3 q = glm::cross(toOrigin, edge1);
        const double v = glm::dot(direction_, q) / determinant;
        if (v < -kBorder || u + v > 1.0 + kBorder) return;
        const double t = glm::dot(edge2, q) / determinant;
        if (t < first_ || t > last_) return;
        hits_.push_back({t, column, row, triangle, {1.0 - u - v, u, v}, origin_ + direction_ * t});
    }

    const SampleGrid& grid_;
    const BoxPyramid& boxes_;
    glm::dvec3 origin_, direction_;
    double first_, last_;
    double slack_ = 0.0;
    std::vector<RayHit> hits_;
};

}  // namespace

std::vector<RayHit> castRay(const SampleGrid& grid, const BoxPyramid& boxes, const glm::dvec3& origin, const glm::dvec3& direction,
                            double first, double last) {
    return Caster(grid, boxes, origin, direction, first, last).cast();
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
