// Rays against all triangles of the full-resolution surface, by another method than the one under test.
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "lod/BruteForceMesh.h"
#include "lod/RayCast.h"

#include "Maps.h"
#include "Views.h"

using namespace terrain;
using namespace terrain::test;

namespace {

struct NaiveHit {
    double distance;
    int column, row, triangle;
    double inside;  ///< the smallest weight: how far from the triangle's border
};

class RayCastOver : public testing::TestWithParam<Terrain> {
protected:
    const SampleGrid grid = GetParam().grid();
    const BoxPyramid boxes{grid};
    std::mt19937 random{31};

    /// Bounds of the samples in the frame.
    Box frameBox() const { return boxes.all().isEmpty() ? Box{glm::vec3(0.0f), glm::vec3(1.0f)} : boxOf(boxes.all()); }

    std::vector<NaiveHit> naive(const glm::dvec3& origin, const glm::dvec3& direction, double first, double last) const
    {
        std::vector<NaiveHit> hits;
        for (int row = 0; row < grid.rows() - 1; ++row)
            for (int column = 0; column < grid.columns() - 1; ++column) {
                if (isCellHole(grid, column, row)) continue;
                for (int triangle = 0; triangle < 2; ++triangle) {
                    glm::dvec3 corner[3];
                    for (int i = 0; i < 3; ++i)
                        corner[i] = grid.framePosition(column + kCellTriangles[triangle][i][0], row + kCellTriangles[triangle][i][1]);
                    // origin + t direction = corner0 + u edge1 + v edge2
                    const glm::dmat3 system(-direction, corner[1] - corner[0], corner[2] - corner[0]);
                    if (std::fabs(glm::determinant(system)) < 1e-9) continue;
                    const glm::dvec3 tuv = glm::inverse(system) * (origin - corner[0]);
                    const double inside = std::min({tuv.y, tuv.z, 1.0 - tuv.y - tuv.z});
                    if (inside >= -1e-6 && tuv.x >= first && tuv.x <= last) hits.push_back({tuv.x, column, row, triangle, inside});
                }
            }
        return hits;
    }
};

}  // namespace

TEST_P(RayCastOver, HitsExactlyTheTrianglesThatAreThere)
{
    const Box box = frameBox();
    const glm::dvec3 low = glm::dvec3(box.lowest()) - 2.0, high = glm::dvec3(box.highest()) + 2.0;
    int total = 0;
    for (int i = 0; i < 150; ++i) {
        const glm::dvec3 origin = uniformIn(random, low, high), direction = uniformIn(random, low, high) - origin;
        const double first = i % 2 ? 0.0 : -3.0, last = i % 3 ? 1.0 : 5.0;
        const std::vector<RayHit> hits = castRay(grid, boxes, origin, direction, first, last);
        const std::vector<NaiveHit> expected = naive(origin, direction, first, last);
        for (const NaiveHit& e : expected) {
            if (e.inside < 1e-6 || std::min(e.distance - first, last - e.distance) < 1e-6) continue;
            ++total;
            const auto found = std::find_if(hits.begin(), hits.end(), [&e](const RayHit& h) {
                return h.column == e.column && h.row == e.row && h.triangle == e.triangle;
            });
            ASSERT_NE(found, hits.end()) << "ray " << i << " misses cell " << e.column << ", " << e.row;
            ASSERT_NEAR(found->distance, e.distance, 1e-6);
        }
        for (const RayHit& h : hits)
            ASSERT_TRUE(std::any_of(expected.begin(), expected.end(), [&h](const NaiveHit& e) {
                return h.column == e.column && h.row == e.row && h.triangle == e.triangle;
            })) << "ray " << i << " hits cell " << h.column << ", " << h.row << ", which is not on its way";
    }
    EXPECT_TRUE(total > 0 || boxes.all().isEmpty());
}

TEST_P(RayCastOver, DescribesItsHitsConsistentlyAndNearestFirst)
{
    const Box box = frameBox();
    const glm::dvec3 low(box.lowest()), high(box.highest());
    for (int i = 0; i < 100; ++i) {
        const glm::dvec3 origin = uniformIn(random, low, high), direction = uniformIn(random, low, high) - origin;
        double before = -10.0;
        for (const RayHit& h : castRay(grid, boxes, origin, direction, -10.0, 10.0)) {
            ASSERT_GE(h.distance, before);
            before = h.distance;
            glm::dvec3 point(0.0);
            for (int k = 0; k < 3; ++k)
                point += h.barycentric[k] * glm::dvec3(grid.framePosition(h.column + kCellTriangles[h.triangle][k][0],
                                                                         h.row + kCellTriangles[h.triangle][k][1]));
            ASSERT_LT(glm::distance(point, h.point), 1e-4);
            ASSERT_LT(glm::distance(origin + h.distance * direction, h.point), 1e-9 * (1.0 + glm::length(h.point)));
        }
    }
}

TEST_P(RayCastOver, ComesThroughNeitherAtVerticesNorAtEdges)
{
    if (!grid.isRegular()) return;  // of a curved one the ray to a vertex is not exact
    for (int row = 0; row < grid.rows(); ++row)
        for (int column = 0; column < grid.columns(); ++column)
            for (const glm::dvec2 step : {glm::dvec2(0.0, 0.0), glm::dvec2(0.5, 0.0), glm::dvec2(0.0, 0.5), glm::dvec2(0.5, 0.5)}) {
                const glm::dvec2 p = glm::dvec2(column, row) + step;
                // Every cell that has the point.
                bool solid = false;
                for (const int y : {int(std::ceil(p.y)) - 1, int(p.y)})
                    for (const int x : {int(std::ceil(p.x)) - 1, int(p.x)})
                        solid |= x >= 0 && y >= 0 && x < grid.columns() - 1 && y < grid.rows() - 1 && !isCellHole(grid, x, y);
                const std::vector<RayHit> hits = castRay(grid, boxes, {p.x, p.y, 100.0}, {0.0, 0.0, -1.0}, 0.0, 1000.0);
                ASSERT_EQ(hits.empty(), !solid) << p.x << ", " << p.y;
                if (step == glm::dvec2(0.0) && solid) {
                    ASSERT_NEAR(hits[0].point.z, grid.height(column, row), 1e-5);
                }
            }
}

TEST_P(RayCastOver, FindsFromAboveTheHeightOfTheSurface)
{
    for (int i = 0; i < 500; ++i) {
        const glm::dvec2 p(uniform(random, -1.0, grid.columns()), uniform(random, -1.0, grid.rows()));
        const std::optional<SurfacePoint> surface = surfaceAt(grid, p);
        if (!grid.isRegular()) {
            ASSERT_FALSE(surface.has_value());
            continue;
        }
        const std::vector<RayHit> hits = castRay(grid, boxes, {p.x, p.y, 100.0}, {0.0, 0.0, -1.0}, 0.0, 1000.0);
        ASSERT_EQ(surface.has_value(), !hits.empty()) << p.x << ", " << p.y;
        if (!surface) continue;
        ASSERT_NEAR(surface->height, hits[0].point.z, 1e-5);
        ASSERT_EQ(surface->column, hits[0].column);
        ASSERT_EQ(surface->row, hits[0].row);
        ASSERT_EQ(surface->triangle, hits[0].triangle);
    }
}

TEST_P(RayCastOver, KnowsTheSurfaceAtEverySample)
{
    if (!grid.isRegular()) return;
    for (int row = 0; row < grid.rows(); ++row)
        for (int column = 0; column < grid.columns(); ++column)
            if (const std::optional<SurfacePoint> surface = surfaceAt(grid, {column, row})) {
                ASSERT_EQ(surface->height, grid.height(column, row));
            }
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(surfaceAt(grid, {-1e-9, 0.0}));
    EXPECT_FALSE(surfaceAt(grid, {0.0, grid.rows() - 1 + 1e-9}));
    EXPECT_FALSE(surfaceAt(grid, {std::nan(""), 0.0}));
    EXPECT_FALSE(surfaceAt(grid, {infinity, 0.0}));
}

INSTANTIATE_TEST_SUITE_P(Terrains, RayCastOver, testing::ValuesIn(smallTerrains()),
                         [](const testing::TestParamInfo<Terrain>& info) { return info.param.name; });
