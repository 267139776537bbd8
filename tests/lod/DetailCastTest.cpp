// Rays against all triangles of the finest level, by another method than the one under test.
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "lod/BruteForceMesh.h"
#include "lod/DetailCast.h"

#include "Maps.h"
#include "Views.h"

using namespace terrain;
using namespace terrain::test;

namespace {

constexpr int kLevels = 3;

class DetailCastOver : public testing::TestWithParam<Terrain> {
protected:
    const SampleGrid grid = GetParam().grid();
    const BoxPyramid boxes{grid};
    const SynthesisedDetail detail{grid, {kLevels, 0.4f, 11}};
    /// All of the finest level as samples.
    HeightMap fine = [this] {
        const glm::ivec2 last = SynthesisedDetail::lastVertex(grid, kLevels);
        HeightMap map{last.x + 1, last.y + 1, {}, {}, {1.0, 1.0}, {}};
        map.heights.resize(std::size_t(map.columns) * std::size_t(map.rows));
        detail.fill(grid, kLevels, {glm::ivec2(0), last}, map.heights.data());
        return map;
    }();
    const SampleGrid fineGrid{fine};
    std::mt19937 random{31};

    struct NaiveHit {
        double distance;
        glm::ivec2 sample;
        double inside;  ///< the smallest weight: how far from the triangle's border
    };
    std::vector<NaiveHit> naive(const glm::dvec3& origin, const glm::dvec3& direction, double first, double last) const
    {
        const double scale = 1.0 / (1 << kLevels);
        const glm::dvec3 toFrame(scale, scale, 1.0);
        std::vector<NaiveHit> hits;
        for (int row = 0; row < fineGrid.rows() - 1; ++row)
            for (int column = 0; column < fineGrid.columns() - 1; ++column) {
                if (isCellHole(fineGrid, column, row)) continue;
                for (const auto& triangle : kCellTriangles) {
                    glm::dvec3 corner[3];
                    for (int i = 0; i < 3; ++i)
                        corner[i] = glm::dvec3(fineGrid.framePosition(column + triangle[i][0], row + triangle[i][1])) * toFrame;
                    const glm::dmat3 system(-direction, corner[1] - corner[0], corner[2] - corner[0]);
                    if (std::fabs(glm::determinant(system)) < 1e-9) continue;
                    const glm::dvec3 tuv = glm::inverse(system) * (origin - corner[0]);
                    const double inside = std::min({tuv.y, tuv.z, 1.0 - tuv.y - tuv.z});
                    if (inside >= -1e-6 && tuv.x >= first && tuv.x <= last)
                        hits.push_back({tuv.x, glm::ivec2(column, row) >> kLevels, inside});
                }
            }
        return hits;
    }
};

std::vector<Terrain> mapsForDetail()
{
    return {flat(9),        ramp(12),        spike(17),        fractal(17, 17),      fractal(2, 2),       fractal(3, 40),
            fractal(25, 14), withDisc(20, 17), withCheckerboard(13), withBorderStrip(17), allHoles(9)};
}

}  // namespace

TEST_P(DetailCastOver, HitsExactlyTheFinestTriangles)
{
    const BoxPyramid::Bounds all = boxes.all().isEmpty() ? BoxPyramid::Bounds{glm::vec3(0.0f), glm::vec3(1.0f)} : boxes.all();
    const glm::dvec3 low = glm::dvec3(all.low) - 2.0, high = glm::dvec3(all.high) + 2.0;
    int total = 0;
    for (int i = 0; i < 60; ++i) {
        const glm::dvec3 origin = uniformIn(random, low, high), direction = uniformIn(random, low, high) - origin;
        const double first = i % 2 ? 0.0 : -3.0, last = i % 3 ? 1.0 : 5.0;
        const std::vector<RayHit> hits = castRay(grid, boxes, detail, origin, direction, first, last);
        const std::vector<NaiveHit> expected = naive(origin, direction, first, last);
        const auto same = [](const RayHit& h, const NaiveHit& e) {
            return std::fabs(h.distance - e.distance) < 1e-6 && h.column == e.sample.x && h.row == e.sample.y;
        };
        for (const NaiveHit& e : expected) {
            if (e.inside < 1e-6 || std::min(e.distance - first, last - e.distance) < 1e-6) continue;
            ++total;
            ASSERT_TRUE(std::any_of(hits.begin(), hits.end(), [&](const RayHit& h) { return same(h, e); }))
                << "ray " << i << " misses a triangle in cell " << e.sample.x << ", " << e.sample.y << " at " << e.distance;
        }
        for (const RayHit& h : hits)
            ASSERT_TRUE(std::any_of(expected.begin(), expected.end(), [&](const NaiveHit& e) { return same(h, e); }))
                << "ray " << i << " hits cell " << h.column << ", " << h.row << ", which is not on its way";
        const auto nearer = [](const RayHit& a, const RayHit& b) { return a.distance < b.distance; };
        ASSERT_TRUE(std::is_sorted(hits.begin(), hits.end(), nearer));
    }
    EXPECT_TRUE(total > 0 || boxes.all().isEmpty());
}

TEST_P(DetailCastOver, DescribesItsHitsByTheSamplesTriangles)
{
    const BoxPyramid::Bounds all = boxes.all();
    for (int i = 0; i < 100; ++i) {
        const glm::dvec3 origin = uniformIn(random, all.low, all.high), direction = uniformIn(random, all.low, all.high) - origin;
        if (all.isEmpty()) break;
        for (const RayHit& h : castRay(grid, boxes, detail, origin, direction, -10.0, 10.0)) {
            glm::dvec2 place(0.0);
            for (int k = 0; k < 3; ++k) {
                ASSERT_GE(h.barycentric[k], -1e-6);
                const auto& offset = kCellTriangles[h.triangle][k];
                place += h.barycentric[k] * glm::dvec2(h.column + offset[0], h.row + offset[1]);
            }
            ASSERT_NEAR(place.x, h.point.x, 1e-6);
            ASSERT_NEAR(place.y, h.point.y, 1e-6);
            ASSERT_NEAR(h.barycentric[0] + h.barycentric[1] + h.barycentric[2], 1.0, 1e-9);
            const glm::dvec2 last(grid.columns() - 1, grid.rows() - 1);
            const glm::dvec2 inside = glm::clamp(glm::dvec2(h.point), glm::dvec2(0.0), last);
            const float height = detail.height(grid, inside.x, inside.y);
            // Of a hit on the border of a hole the place may be in the hole.
            if (!std::isnan(height)) {
                ASSERT_NEAR(height, h.point.z, 1e-4 * (1.0 + std::fabs(h.point.z)));
            }
        }
    }
}

TEST_P(DetailCastOver, FindsFromAboveTheHeightOfTheSurface)
{
    for (int i = 0; i < 300; ++i) {
        const glm::dvec2 p(uniform(random, -1.0, grid.columns()), uniform(random, -1.0, grid.rows()));
        const std::optional<SurfacePoint> surface = surfaceAt(grid, detail, p);
        const std::vector<RayHit> hits = castRay(grid, boxes, detail, {p.x, p.y, 1000.0}, {0.0, 0.0, -1.0}, 0.0, 1e4);
        ASSERT_EQ(surface.has_value(), !hits.empty()) << p.x << ", " << p.y;
        if (!surface) continue;
        ASSERT_NEAR(surface->height, hits[0].point.z, 1e-5);
        ASSERT_EQ(surface->column, hits[0].column);
        ASSERT_EQ(surface->row, hits[0].row);
        ASSERT_EQ(surface->triangle, hits[0].triangle);
        // The plane of the finest triangle goes through the point.
        const auto corner = finestTriangle(grid, detail, p);
        const glm::dvec3 normal = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
        ASSERT_GT(normal.z, 0.0);
        ASSERT_NEAR(glm::dot(normal / normal.z, glm::dvec3(p, surface->height) - corner[0]), 0.0, 1e-4);
    }
}

TEST_P(DetailCastOver, ComesThroughNeitherAtVerticesNorAtEdges)
{
    const double scale = 1.0 / (1 << kLevels);
    for (int i = 0; i < 2000; ++i) {
        // Vertices and middles of edges and diagonals of the finest level.
        const glm::ivec2 half(uniformInt(random, 0, 2 * (fine.columns - 1)), uniformInt(random, 0, 2 * (fine.rows - 1)));
        const glm::dvec2 p = glm::dvec2(half) * (0.5 * scale);
        if (!surfaceAt(grid, p)) continue;
        const std::vector<RayHit> hits = castRay(grid, boxes, detail, {p.x, p.y, 1000.0}, {0.0, 0.0, -1.0}, 0.0, 1e4);
        ASSERT_FALSE(hits.empty()) << p.x << ", " << p.y;
    }
}

TEST_P(DetailCastOver, BoundsHoldTheFinestVertices)
{
    const BoxPyramid::Bounds bounds = detailBounds(boxes, detail);
    ASSERT_EQ(bounds.isEmpty(), boxes.all().isEmpty());
    if (bounds.isEmpty()) return;
    float low = boxes.all().high.z, high = boxes.all().low.z;
    for (const float height : fine.heights)
        if (!std::isnan(height)) {
            low = std::min(low, height);
            high = std::max(high, height);
        }
    EXPECT_GE(low, bounds.low.z);
    EXPECT_LE(high, bounds.high.z);
    EXPECT_EQ(glm::vec2(bounds.low), glm::vec2(boxes.all().low));
    EXPECT_EQ(glm::vec2(bounds.high), glm::vec2(boxes.all().high));
}

TEST_P(DetailCastOver, WithoutLevelsIsAsWithoutDetail)
{
    const SynthesisedDetail none(grid, {0, 1.0f, 3});
    const BoxPyramid::Bounds all = boxes.all();
    for (int i = 0; i < 50 && !all.isEmpty(); ++i) {
        const glm::dvec3 origin = uniformIn(random, all.low, all.high), direction = uniformIn(random, all.low, all.high) - origin;
        const std::vector<RayHit> hits = castRay(grid, boxes, none, origin, direction, -9.0, 9.0);
        const std::vector<RayHit> expected = castRay(grid, boxes, origin, direction, -9.0, 9.0);
        ASSERT_EQ(hits.size(), expected.size());
        for (std::size_t k = 0; k < hits.size(); ++k) {
            ASSERT_EQ(hits[k].distance, expected[k].distance);
            ASSERT_EQ(hits[k].barycentric, expected[k].barycentric);
            ASSERT_EQ(hits[k].point, expected[k].point);
        }
        const auto surface = surfaceAt(grid, none, glm::dvec2(origin)), without = surfaceAt(grid, glm::dvec2(origin));
        ASSERT_EQ(surface.has_value(), without.has_value());
        if (surface) {
            ASSERT_EQ(surface->height, without->height);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Terrains, DetailCastOver, testing::ValuesIn(mapsForDetail()),
                         [](const testing::TestParamInfo<Terrain>& info) { return info.param.name; });
