// The mesh that Geo Mip-Mapping gives, whatever it is asked for: its shape, its promise, its levels.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

#include <gtest/gtest.h>

#include "lod/GeoMipmapMesh.h"

#include "Maps.h"
#include "MeshCheck.h"
#include "Views.h"

using namespace terrain;
using namespace terrain::test;

namespace {

/// What rounding positions to floats may add.
constexpr double kRounding = 0.03;

std::shared_ptr<GeoMipmapErrors> errorsOf(const SampleGrid& grid, int tileSize)
{
    return std::make_shared<GeoMipmapErrors>(grid, tileSize);
}

class GeoMipmapOver : public testing::TestWithParam<Terrain> {
protected:
    const SampleGrid grid = GetParam().grid();
    const Box box = GetParam().box();
    std::mt19937 random{2024};

    /// Enough views for a large map, and not too many.
    int viewCount() const { return grid.columns() * grid.rows() > 20000 ? 8 : 20; }
};

std::string described(const LodSettings& s, int i, int tileSize)
{
    return "tiles of " + std::to_string(tileSize) + ", view " + std::to_string(i) + ", pixelError " + std::to_string(s.pixelError) +
           (s.cull ? ", culled" : "") + (s.geomorph ? ", morphed" : "") + (s.clockwise ? ", clockwise" : "");
}

}  // namespace

TEST_P(GeoMipmapOver, HasNoCracksOverlapsOrGaps)
{
    for (const int tileSize : {2, 4, 8, 16, 64}) {
        GeoMipmapMesh mesh(errorsOf(grid, tileSize));
        for (int i = 0; i < viewCount(); ++i) {
            const LodSettings settings = randomSettings(random);
            const View view = nextView(random, box, i);
            const DrawList list = mesh.select(grid, view, settings);
            ASSERT_EQ("", meshProblem(grid, list, view, settings.clockwise, !settings.cull)) << described(settings, i, tileSize);
        }
    }
}

TEST_P(GeoMipmapOver, HasNoCracksOverlapsOrGapsFromStraightAbove)
{
    // An orthographic camera there sees no vertical error at all, but it does see holes and borders.
    const glm::vec3 low = box.lowest(), high = box.highest();
    const View above{glm::ortho(double(low.x), double(high.x), double(low.y), double(high.y), -high.z - 10.0, -low.z + 10.0), {300.0, 300.0}};
    for (const bool morph : {false, true})
        for (const bool cull : {false, true}) {
            GeoMipmapMesh mesh(errorsOf(grid, 8));
            LodSettings settings;
            settings.cull = cull;
            settings.geomorph = morph;
            const DrawList list = mesh.select(grid, above, settings);
            ASSERT_EQ("", meshProblem(grid, list, above, false, true)) << (cull ? "culled" : "not culled");
        }
}

TEST_P(GeoMipmapOver, DrawsEverySampleInViewWithinPixelError)
{
    for (const int tileSize : {2, 4, 8, 16, 64}) {
        GeoMipmapMesh mesh(errorsOf(grid, tileSize));
        for (int i = 0; i < viewCount(); ++i) {
            const LodSettings settings = randomSettings(random);
            const View view = nextView(random, box, i);
            const DrawList list = mesh.select(grid, view, settings);
            ASSERT_TRUE(list.report.converged);
            ASSERT_LE(list.report.errorPixels, settings.pixelError) << described(settings, i, tileSize);
            const double worst = worstScreenError(grid, list, trianglesOf(grid, list), view);
            ASSERT_LE(worst, list.report.errorPixels + kRounding) << described(settings, i, tileSize);
        }
    }
}

TEST_P(GeoMipmapOver, GivesFullDetailForAPixelErrorOfZero)
{
    GeoMipmapMesh mesh(errorsOf(grid, 8));
    LodSettings settings;
    settings.pixelError = 0.0f;
    for (int i = 0; i < 4; ++i) {
        settings.cull = i % 2;
        settings.geomorph = i / 2;
        const View view = nextView(random, box, i);
        const DrawList list = mesh.select(grid, view, settings);
        EXPECT_EQ(list.report.errorPixels, 0.0f);
        EXPECT_EQ("", meshProblem(grid, list, view, false, !settings.cull));
        EXPECT_LE(worstScreenError(grid, list, trianglesOf(grid, list), view), kRounding);
        for (const GridTriangle& t : trianglesOf(grid, list))
            for (std::size_t k = 0; k < 3; ++k)
                ASSERT_EQ(list.positions[t.vertex[k]], grid.position(t.corner[k].x, t.corner[k].y)) << "a vertex off its sample";
    }
}

TEST_P(GeoMipmapOver, RestsWhenNothingChanges)
{
    GeoMipmapMesh mesh(errorsOf(grid, 8));
    LodSettings settings;
    for (int i = 0; i < 6; ++i) {
        settings.geomorph = i % 2;
        const View view = nextView(random, box, i);
        const std::uint32_t triangles = mesh.select(grid, view, settings).report.triangles;
        const DrawList again = mesh.select(grid, view, settings);
        EXPECT_FALSE(again.positionsChanged);
        EXPECT_FALSE(again.indicesChanged);
        EXPECT_TRUE(again.newVertices.empty());
        EXPECT_EQ(again.report.triangles, triangles);
    }
}

TEST_P(GeoMipmapOver, CanBeFollowedByWhatItSaysHasChanged)
{
    GeoMipmapMesh mesh(errorsOf(grid, 8));
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> samples, indices;
    for (int i = 0; i < 2 * viewCount(); ++i) {
        const DrawList list = mesh.select(grid, nextView(random, box, i / 2), randomSettings(random));
        if (list.positionsChanged) positions.assign(list.positions.begin(), list.positions.end());
        if (list.indicesChanged) indices.assign(list.indices.begin(), list.indices.end());
        samples.resize(list.samples.size(), kNoVertex);
        for (const std::uint32_t vertex : list.newVertices) samples[vertex] = list.samples[vertex];
        ASSERT_EQ(positions.size(), list.positions.size());
        ASSERT_EQ(indices.size(), 3 * list.report.triangles);
        for (const std::uint32_t vertex : indices) {
            ASSERT_EQ(positions[vertex], list.positions[vertex]) << i;
            ASSERT_EQ(samples[vertex], list.samples[vertex]) << i;
        }
    }
}

TEST_P(GeoMipmapOver, GivesWhatAFreshMeshWouldGive)
{
    // Selections do not depend on those before: neither their triangles nor, sample by sample, where their vertices stand.
    const auto errors = errorsOf(grid, 8);
    GeoMipmapMesh travelled(errors);
    for (int i = 0; i < viewCount(); ++i) {
        const LodSettings settings = randomSettings(random);
        const View view = nextView(random, box, i);
        GeoMipmapMesh fresh(errors);
        const DrawList a = travelled.select(grid, view, settings), b = fresh.select(grid, view, settings);
        ASSERT_EQ(a.indices.size(), b.indices.size());
        for (std::size_t k = 0; k < a.indices.size(); ++k) {
            ASSERT_EQ(a.samples[a.indices[k]], b.samples[b.indices[k]]);
            const glm::vec3 p = a.positions[a.indices[k]], q = b.positions[b.indices[k]];
            ASSERT_EQ(std::memcmp(&p, &q, sizeof(p)), 0);
        }
        ASSERT_EQ(std::memcmp(&a.report.errorPixels, &b.report.errorPixels, sizeof(float)), 0);
    }
}

namespace {

/// Largest distance of the samples that the triangles cover from them, in double.
double deviation(const SampleGrid& grid, const GeoMipmapShape& shape, glm::ivec2 from, std::span<const GeoMipmapShape::Triangle> triangles)
{
    double largest = 0.0;
    const auto position = [&](glm::ivec2 p) { return glm::dvec3(grid.framePosition(from.x + p.x, from.y + p.y)); };
    for (const GeoMipmapShape::Triangle& triangle : triangles) {
        const glm::ivec2 a = shape.at(triangle[0]), b = shape.at(triangle[1]), c = shape.at(triangle[2]);
        const glm::dvec2 u(b - a), v(c - a);
        for (int row = 0; row <= shape.height(); ++row)
            for (int column = 0; column <= shape.width(); ++column) {
                const glm::dvec2 p = glm::dvec2(column, row) - glm::dvec2(a);
                const double area = u.x * v.y - u.y * v.x, s = (p.x * v.y - p.y * v.x) / area, t = (u.x * p.y - u.y * p.x) / area;
                if (s < -1e-9 || t < -1e-9 || s + t > 1.0 + 1e-9) continue;
                const glm::dvec3 drawn = position(a) * (1.0 - s - t) + position(b) * s + position(c) * t;
                largest = std::max(largest, glm::distance(drawn, position({column, row})));
            }
    }
    return largest;
}

/// What encoding in 16 bits and computing with floats may change.
void expectMeasured(float stored, double measured, double size)
{
    EXPECT_GE(stored, measured - 1e-6 * size);
    EXPECT_LE(stored, measured * 1.005 + 1e-6 * size);
}

}  // namespace

TEST_P(GeoMipmapOver, HasExactErrorsOfLevelsAndSides)
{
    for (const int tileSize : {2, 8, 16}) {
        const GeoMipmapErrors errors(grid, tileSize);
        const double size = glm::length(glm::dvec3(box.half)) + glm::length(glm::dvec3(box.centre));
        const int last = errors.layout().exponent;
        for (int row = 0; row < errors.layout().blockRows; ++row)
            for (int column = 0; column < errors.layout().blockColumns; ++column) {
                const std::size_t block = errors.layout().block(column, row);
                const GeoMipmapShape& shape = errors.shape(column, row);
                const glm::ivec2 from = glm::ivec2(column, row) * tileSize;
                double finer = 0.0;
                for (int level = 1; level <= last; ++level) {
                    if (errors.hasHoles(block) || !shape.hasLevel(level)) {
                        EXPECT_TRUE(std::isinf(errors.level(block, level)));
                        continue;
                    }
                    double measured = level == last ? deviation(grid, shape, from, shape.flat(errors.hasOtherDiagonal(block)))
                                                    : deviation(grid, shape, from, shape.inner(level));
                    for (int side = 0; side < 4; ++side)
                        measured = std::max(measured, deviation(grid, shape, from, shape.side(side, level, level)));
                    if (level == last) {
                        EXPECT_LE(measured, deviation(grid, shape, from, shape.flat(!errors.hasOtherDiagonal(block))) + 1e-6 * size);
                    }
                    finer = std::max(finer, measured);
                    expectMeasured(errors.level(block, level), finer, size);
                }
                for (int level = 0; level < last && !errors.hasHoles(block); ++level)
                    for (int border = level + 1; border <= last; ++border)
                        for (int side = 0; side < 4; ++side) {
                            const auto triangles = shape.side(side, level, border);
                            const float stored = errors.side(block, side, level, border);
                            if (triangles.empty()) {
                                EXPECT_TRUE(std::isinf(stored));
                            } else {
                                expectMeasured(stored, deviation(grid, shape, from, triangles), size);
                            }
                        }
            }
    }
}

INSTANTIATE_TEST_SUITE_P(Terrains, GeoMipmapOver, testing::ValuesIn(terrains()),
                         [](const testing::TestParamInfo<Terrain>& info) { return info.param.name; });

namespace {

/// Rough ground that ends at a straight line in a plain.
Terrain cliff(int side)
{
    const HeightMap rough = fractalMap(side, side, 6);
    return {"Cliff", mapOf(side, side, [&](int column, int row) {
                return column < side / 2 - 3 ? rough.heights[std::size_t(row) * std::size_t(side) + std::size_t(column)] : 0.0f;
            }), {}};
}

/// Over the middle, looking along rows and a little down.
View lookingAlong(const Box& box, double along, double aboveGround)
{
    const glm::dvec3 eye(double(box.centre.x) - 0.6 * double(box.half.x) + along, double(box.centre.y), double(box.highest().z) + aboveGround);
    const glm::dmat4 camera = glm::lookAt(eye, eye + glm::dvec3(1.0, 0.02, -0.35), glm::dvec3(0.0, 0.0, 1.0));
    return {glm::perspective(0.8, 4.0 / 3.0, 0.5, 1000.0) * camera, {1024.0, 768.0}};
}

int largestDifference(const GeoMipmapMesh& mesh, const BlockLayout& layout)
{
    int largest = 0;
    for (int row = 0; row < layout.blockRows; ++row)
        for (int column = 0; column < layout.blockColumns; ++column)
            for (const glm::ivec2 step : {glm::ivec2(1, 0), glm::ivec2(0, 1)}) {
                if (column + step.x >= layout.blockColumns || row + step.y >= layout.blockRows) continue;
                const int level = mesh.level(column, row), beyond = mesh.level(column + step.x, row + step.y);
                if (level >= 0 && beyond >= 0) largest = std::max(largest, std::abs(level - beyond));
            }
    return largest;
}

/// The drawn surface at each sample; none where nothing is drawn.
std::vector<double> drawnHeights(const SampleGrid& grid, const DrawList& list)
{
    std::vector<double> heights(std::size_t(grid.columns()) * std::size_t(grid.rows()), std::nan(""));
    for (const GridTriangle& t : trianglesOf(grid, list)) {
        const glm::dvec2 a(t.corner[0]), u = glm::dvec2(t.corner[1]) - a, v = glm::dvec2(t.corner[2]) - a;
        const auto [left, right] = std::minmax({t.corner[0].x, t.corner[1].x, t.corner[2].x});
        const auto [bottom, top] = std::minmax({t.corner[0].y, t.corner[1].y, t.corner[2].y});
        for (int row = bottom; row <= top; ++row)
            for (int column = left; column <= right; ++column) {
                const glm::dvec2 p = glm::dvec2(column, row) - a;
                const double area = u.x * v.y - u.y * v.x, s = (p.x * v.y - p.y * v.x) / area, r = (u.x * p.y - u.y * p.x) / area;
                if (s < -1e-9 || r < -1e-9 || s + r > 1.0 + 1e-9) continue;
                heights[grid.index(column, row)] = double(list.positions[t.vertex[0]].z) * (1.0 - s - r) +
                                                   double(list.positions[t.vertex[1]].z) * s + double(list.positions[t.vertex[2]].z) * r;
            }
    }
    return heights;
}

/// Largest way on screen that any sample in view goes from one frame of a slow flight to the next, beyond what the camera does.
double largestJump(const SampleGrid& grid, const Box& box, const LodSettings& settings, int tileSize)
{
    GeoMipmapMesh mesh(errorsOf(grid, tileSize));
    std::vector<double> before;
    double largest = 0.0;
    for (int frame = 0; frame < 80; ++frame) {
        const View view = lookingAlong(box, 0.1 * frame, 12.0);
        const std::vector<double> now = drawnHeights(grid, mesh.select(grid, view, settings));
        largest = std::max(largest, largestMove(grid, view, before, now));
        before = now;
    }
    return largest;
}

}  // namespace

TEST(GeoMipmapLevels, OfNeighboursDifferBySeveralStepsAndMeetWithoutCracks)
{
    const Terrain terrain = cliff(129);
    const SampleGrid grid = terrain.grid();
    for (const int tileSize : {8, 16, 32}) {
        const auto errors = errorsOf(grid, tileSize);
        GeoMipmapMesh mesh(errors);
        LodSettings settings;
        settings.pixelError = 1.0f;
        int largest = 0;
        for (const double above : {1.0, 10.0, 60.0})
            for (const double along : {0.0, 20.0, 60.0}) {
                const View view = lookingAlong(terrain.box(), along, above);
                settings.cull = along > 0.0;
                const DrawList list = mesh.select(grid, view, settings);
                ASSERT_EQ("", meshProblem(grid, list, view, false, !settings.cull));
                ASSERT_LE(worstScreenError(grid, list, trianglesOf(grid, list), view), list.report.errorPixels + kRounding);
                largest = std::max(largest, largestDifference(mesh, errors->layout()));
                settings.geomorph = true;
                const DrawList morphed = mesh.select(grid, view, settings);
                ASSERT_EQ("", meshProblem(grid, morphed, view, false, !settings.cull));
                EXPECT_LE(largestDifference(mesh, errors->layout()), 1);
                settings.geomorph = false;
            }
        EXPECT_GE(largest, errors->layout().exponent) << "tiles of " << tileSize;
    }
}

TEST(GeoMipmapMorph, SlidesFromLevelToLevelWithoutAJump)
{
    const Terrain terrain = fractal(257, 257);
    const SampleGrid grid = terrain.grid();
    for (const int tileSize : {8, 16})
        for (const float pixelError : {1.0f, 2.0f, 4.0f, 6.0f}) {
            LodSettings settings;
            settings.pixelError = pixelError;
            const double popped = largestJump(grid, terrain.box(), settings, tileSize);
            settings.geomorph = true;
            const double morphed = largestJump(grid, terrain.box(), settings, tileSize);
            std::printf("tiles of %d, pixelError %g: largest jump %.3f px, %.3f px without morphing\n", tileSize, double(pixelError), morphed, popped);
            // Few blocks change level in so short a flight where much error is allowed.
            if (pixelError <= 2.0f) {
                EXPECT_GT(popped, 0.4 * double(pixelError)) << "or there is nothing to see";
            }
            EXPECT_LE(morphed, 0.25) << "tiles of " << tileSize << ", pixelError " << pixelError;
        }
}

TEST(GeoMipmapMorph, KeepsThePromiseAllTheWay)
{
    const Terrain terrain = fractal(257, 257);
    const SampleGrid grid = terrain.grid();
    GeoMipmapMesh mesh(errorsOf(grid, 8));
    LodSettings settings;
    settings.geomorph = true;
    int moving = 0;
    for (int frame = 0; frame < 40; ++frame) {
        const View view = lookingAlong(terrain.box(), 0.7 * frame, 12.0);
        const DrawList list = mesh.select(grid, view, settings);
        ASSERT_LE(list.report.errorPixels, 2.0f);
        ASSERT_EQ("", meshProblem(grid, list, view, false, false));
        ASSERT_LE(worstScreenError(grid, list, trianglesOf(grid, list), view), list.report.errorPixels + kRounding);
        for (const std::uint32_t vertex : list.indices) {
            const std::uint32_t sample = list.samples[vertex];
            moving += list.positions[vertex] != grid.position(int(sample % 257), int(sample / 257));
        }
    }
    EXPECT_GT(moving, 1000);
}

TEST(GeoMipmapErrors, TakeAboutAByteASample)
{
    const Terrain terrain = fractal(513, 513);
    const SampleGrid grid = terrain.grid();
    EXPECT_LE(double(GeoMipmapErrors(grid, 8).bytes()), 1.2 * 513 * 513);
    EXPECT_LE(double(GeoMipmapErrors(grid, 16).bytes()), 0.6 * 513 * 513);
}
