#include "lod/DetailCast.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "lod/BruteForceMesh.h"
#include "lod/LineTests.h"

namespace terrain {

namespace {

/// What rounding on all levels may add to heights as large as these.
float roundingOf(const BoxPyramid::Bounds& bounds, const SynthesisedDetail& detail) {
    const float largest = std::max(std::fabs(bounds.low.z), std::fabs(bounds.high.z));
    return 4.0f * float(detail.levels()) * std::numeric_limits<float>::epsilon() * largest;
}

/// A block of the pyramid, with room for the detail in it. Neighbouring samples differ by no more than the heights of a block that
/// has both.
BoxPyramid::Bounds withDetail(const BoxPyramid& boxes, const SynthesisedDetail& detail, int level, int column, int row) {
    constexpr int kReach = 2;
    BoxPyramid::Bounds block = boxes.block(level, column, row);
    if (block.isEmpty()) return block;
    const int cells = BoxPyramid::kBlockCells << level;
    const BoxPyramid::Bounds around =
        boxes.bounds(column * cells - kReach, row * cells - kReach, (column + 1) * cells + kReach, (row + 1) * cells + kReach);
    const float over = detail.overshoot(0, around.high.z - around.low.z, boxes.hasHoles()) + roundingOf(around, detail);
    block.low.z -= over;
    block.high.z += over;
    return block;
}

/// Vertices around a cell of a level, or around the four that another one is cut into.
struct Patch {
    static constexpr int kMost = 7;
    ClipRect rect;
    std::array<float, kMost * kMost> heights;
    float step = 0.0f;  ///< largest difference of neighbours
    bool holes = false;

    float at(glm::ivec2 v) const { return heights[std::size_t((v.y - rect.low.y) * rect.columns() + v.x - rect.low.x)]; }
    void describe() {
        // Comparisons with holes are false.
        const int columns = rect.columns(), count = int(rect.samples());
        const auto include = [this](int a, int b) {
            if (const float d = std::fabs(heights[std::size_t(a)] - heights[std::size_t(b)]); d > step) step = d;
        };
        for (int i = 0; i < count; ++i) {
            holes = holes || std::isnan(heights[std::size_t(i)]);
            if (i % columns > 0) include(i, i - 1);
            if (i >= columns) include(i, i - columns);
        }
    }
};

class DetailCaster {
public:
    DetailCaster(const SampleGrid& grid, const BoxPyramid& boxes, const SynthesisedDetail& detail, const Line& line)
        : grid_(grid), boxes_(boxes), detail_(detail), line_(line) {
        const BoxPyramid::Bounds all = boxes.all();
        if (all.isEmpty()) return;
        // As without detail.
        slack_ = 1e-6 * (1.0 + glm::length(glm::dvec3(all.high) - glm::dvec3(all.low)));
        rounding_ = roundingOf(all, detail);
    }

    std::vector<RayHit> cast() {
        descend(boxes_.levelCount() - 1, 0, 0);
        std::sort(hits_.begin(), hits_.end(), [](const RayHit& a, const RayHit& b) { return a.distance < b.distance; });
        return std::move(hits_);
    }

private:
    void descend(int level, int column, int row) {
        const BoxPyramid::Bounds bounds = withDetail(boxes_, detail_, level, column, row);
        if (bounds.isEmpty() || !line_.meets(bounds.low, bounds.high, slack_)) return;
        if (level > 0) {
            for (int y = 2 * row; y < std::min(2 * row + 2, boxes_.rows(level - 1)); ++y)
                for (int x = 2 * column; x < std::min(2 * column + 2, boxes_.columns(level - 1)); ++x) descend(level - 1, x, y);
            return;
        }
        constexpr int cells = BoxPyramid::kBlockCells;
        for (int y = row * cells; y < std::min((row + 1) * cells, grid_.rows() - 1); ++y)
            for (int x = column * cells; x < std::min((column + 1) * cells, grid_.columns() - 1); ++x) {
                const glm::dvec3 low(x, y, bounds.low.z), high(x + 1, y + 1, bounds.high.z);
                if (isCellHole(grid_, x, y) || !line_.meets(low, high, slack_)) continue;
                Patch patch;
                patch.rect = within(0, {glm::ivec2(x, y) - 2, glm::ivec2(x, y) + 3});
                detail_.fill(grid_, 0, patch.rect, patch.heights.data());
                patch.describe();
                testCell(0, {x, y}, patch);
            }
    }

    ClipRect within(int level, const ClipRect& rect) const {
        return rect.cutTo({glm::ivec2(0), SynthesisedDetail::lastVertex(grid_, level)});
    }

    void testCell(int level, glm::ivec2 cell, const Patch& patch) {
        const float z[4] = {patch.at(cell), patch.at(cell + glm::ivec2(1, 0)), patch.at(cell + glm::ivec2(0, 1)),
                            patch.at(cell + 1)};
        const double spacing = 1.0 / double(1 << level);
        const double room = double(detail_.overshoot(level, patch.step, patch.holes)) + double(rounding_);
        const glm::dvec2 low = glm::dvec2(cell) * spacing;
        if (!line_.meets({low, double(*std::min_element(z, z + 4)) - room},
                         {low + spacing, double(*std::max_element(z, z + 4)) + room}, slack_))
            return;
        if (level == detail_.levels()) return testTriangles(cell, z);
        Patch finer;
        finer.rect = within(level + 1, {2 * cell - 2, 2 * cell + 4});
        detail_.refine(grid_, level + 1, finer.rect, patch.rect, patch.heights.data(), finer.heights.data());
        finer.describe();
        for (int i = 0; i < 4; ++i) testCell(level + 1, 2 * cell + glm::ivec2(i & 1, i >> 1), finer);
    }

    void testTriangles(glm::ivec2 cell, const float (&z)[4]) {
        const int levels = detail_.levels();
        const glm::ivec2 sample = cell >> levels, inside = cell - (sample << levels);
        for (int t = 0; t < 2; ++t) {
            glm::dvec3 corner[3];
            for (int i = 0; i < 3; ++i) {
                const int x = kCellTriangles[t][i][0], y = kCellTriangles[t][i][1];
                corner[i] = {(cell.x + x) / double(1 << levels), (cell.y + y) / double(1 << levels), z[2 * y + x]};
            }
            const auto hit = line_.meets(corner);
            if (!hit) continue;
            // All of a finest triangle is in one of the samples'.
            const int triangle = inside.x + inside.y + t < (1 << levels) ? 0 : 1;
            const glm::dvec3& w = hit->barycentric;
            const double x = w[0] * corner[0].x + w[1] * corner[1].x + w[2] * corner[2].x - sample.x;
            const double y = w[0] * corner[0].y + w[1] * corner[1].y + w[2] * corner[2].y - sample.y;
            const glm::dvec3 weights = triangle == 0 ? glm::dvec3(1.0 - x - y, x, y) : glm::dvec3(1.0 - y, x + y - 1.0, 1.0 - x);
            hits_.push_back({hit->distance, sample.x, sample.y, triangle, weights, line_.origin + line_.direction * hit->distance});
        }
    }

    const SampleGrid& grid_;
    const BoxPyramid& boxes_;
    const SynthesisedDetail& detail_;
    Line line_;
    double slack_ = 0.0;
    float rounding_ = 0.0f;
    std::vector<RayHit> hits_;
};

/// Widens `bounds` to the detail of a block. Parts that cannot widen them are not looked at.
void include(BoxPyramid::Bounds& bounds, const BoxPyramid& boxes, const SynthesisedDetail& detail, int level, int column, int row) {
    const BoxPyramid::Bounds block = withDetail(boxes, detail, level, column, row);
    if (block.isEmpty() || (block.low.z >= bounds.low.z && block.high.z <= bounds.high.z)) return;
    if (level == 0) {
        bounds.low.z = std::min(bounds.low.z, block.low.z);
        bounds.high.z = std::max(bounds.high.z, block.high.z);
        return;
    }
    for (int y = 2 * row; y < std::min(2 * row + 2, boxes.rows(level - 1)); ++y)
        for (int x = 2 * column; x < std::min(2 * column + 2, boxes.columns(level - 1)); ++x)
            include(bounds, boxes, detail, level - 1, x, y);
}

}  // namespace

std::vector<RayHit> castRay(const SampleGrid& grid, const BoxPyramid& boxes, const SynthesisedDetail& detail,
                            const glm::dvec3& origin, const glm::dvec3& direction, double first, double last) {
    if (detail.levels() == 0) return castRay(grid, boxes, origin, direction, first, last);
    return DetailCaster(grid, boxes, detail, {origin, direction, first, last}).cast();
}

std::optional<SurfacePoint> surfaceAt(const SampleGrid& grid, const SynthesisedDetail& detail, const glm::dvec2& position) {
    std::optional<SurfacePoint> surface = surfaceAt(grid, position);
    if (surface && detail.levels() > 0) surface->height = detail.height(grid, position.x, position.y);
    return surface;
}

std::array<glm::dvec3, 3> finestTriangle(const SampleGrid& grid, const SynthesisedDetail& detail, const glm::dvec2& position) {
    const int levels = detail.levels();
    const double scale = double(1 << levels);
    const glm::ivec2 last = SynthesisedDetail::lastVertex(grid, levels);
    const glm::dvec2 at = glm::clamp(position * scale, glm::dvec2(0.0), glm::dvec2(last));
    const glm::ivec2 cell = glm::min(glm::ivec2(at), last - 1);
    float z[4];
    detail.fill(grid, levels, {cell, cell + 1}, z);
    const int triangle = at.x - cell.x + at.y - cell.y <= 1.0 ? 0 : 1;
    std::array<glm::dvec3, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
        const int x = kCellTriangles[triangle][i][0], y = kCellTriangles[triangle][i][1];
        corners[i] = {(cell.x + x) / scale, (cell.y + y) / scale, z[2 * y + x]};
    }
    return corners;
}

BoxPyramid::Bounds detailBounds(const BoxPyramid& boxes, const SynthesisedDetail& detail) {
    BoxPyramid::Bounds bounds = boxes.all();
    if (!bounds.isEmpty() && detail.levels() > 0) include(bounds, boxes, detail, boxes.levelCount() - 1, 0, 0);
    return bounds;
}

}  // namespace terrain
