// The mesh that ROAM gives, whatever it is asked for: its shape, its promise, its order.
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "lod/RoamMesh.h"

#include "Maps.h"
#include "MeshCheck.h"
#include "Views.h"

using namespace terrain;
using namespace terrain::test;

namespace {

/// What rounding positions to floats may add.
constexpr double kRounding = 0.03;

class RoamMeshOver : public testing::TestWithParam<Terrain> {
protected:
    const SampleGrid grid = GetParam().grid();
    const TerrainModel model = GetParam().model();
    const Box box = GetParam().box();
    std::mt19937 random{2024};

    /// Enough views for a large map, and not too many.
    int viewCount() const { return grid.columns() * grid.rows() > 20000 ? 15 : 30; }
};

std::string described(const LodSettings& s, int i)
{
    return "view " + std::to_string(i) + ", pixelError " + std::to_string(s.pixelError) + (s.cull ? ", culled" : "") +
           (s.geomorph ? ", morphed" : "") + (s.clockwise ? ", clockwise" : "");
}

}  // namespace

TEST_P(RoamMeshOver, HasNoCracksOverlapsOrGaps)
{
    RoamMesh mesh(model, grid);
    for (int i = 0; i < viewCount(); ++i) {
        const LodSettings settings = randomSettings(random);
        const View view = nextView(random, box, i);
        const DrawList list = mesh.select(grid, view, settings);
        ASSERT_EQ("", meshProblem(grid, list, view, settings.clockwise, !settings.cull)) << described(settings, i);
    }
}

TEST_P(RoamMeshOver, HasNoCracksOverlapsOrGapsFromStraightAbove)
{
    // An orthographic camera there sees no vertical error at all, but it does see holes and borders.
    const glm::vec3 low = box.lowest(), high = box.highest();
    const View above{glm::ortho(double(low.x), double(high.x), double(low.y), double(high.y), -high.z - 10.0, -low.z + 10.0), {300.0, 300.0}};
    RoamMesh mesh(model, grid);
    for (const bool cull : {false, true}) {
        LodSettings settings;
        settings.cull = cull;
        const DrawList list = mesh.select(grid, above, settings);
        ASSERT_EQ("", meshProblem(grid, list, above, false, true)) << (cull ? "culled" : "not culled");
    }
}

TEST_P(RoamMeshOver, DrawsEverySampleInViewWithinPixelError)
{
    RoamMesh mesh(model, grid);
    for (int i = 0; i < viewCount(); ++i) {
        const LodSettings settings = randomSettings(random);
        const View view = nextView(random, box, i);
        const DrawList list = mesh.select(grid, view, settings);
        ASSERT_TRUE(list.report.converged);
        ASSERT_LE(list.report.errorPixels, settings.pixelError) << described(settings, i);
        const double worst = worstScreenError(grid, list, trianglesOf(grid, list), view);
        ASSERT_LE(worst, list.report.errorPixels + kRounding) << described(settings, i);
    }
}

TEST_P(RoamMeshOver, KeepsItsBoundWhenLimitsStopIt)
{
    RoamMesh mesh(model, grid);
    for (int i = 0; i < 2 * viewCount(); ++i) {
        LodSettings settings = randomSettings(random);
        if (i % 2) settings.triangleBudget = std::uint32_t(uniformInt(random, 50, 2000));
        if (i % 3) settings.operationLimit = std::uint32_t(uniformInt(random, 1, 300));
        const View view = nextView(random, box, i);
        const DrawList list = mesh.select(grid, view, settings);
        if (!std::isfinite(list.report.errorPixels)) continue;
        const std::vector<GridTriangle> triangles = trianglesOf(grid, list);
        ASSERT_EQ("", visibilityProblem(grid, triangles, view)) << described(settings, i);
        const double worst = worstScreenError(grid, list, triangles, view);
        // Where nothing is missing, what is said to be exact is exact but for rounding.
        ASSERT_LE(worst, list.report.errorPixels + kRounding)
            << described(settings, i) << ", budget " << settings.triangleBudget << ", limit " << settings.operationLimit;
    }
}

TEST_P(RoamMeshOver, GivesFullDetailForAPixelErrorOfZero)
{
    RoamMesh mesh(model, grid);
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

TEST_P(RoamMeshOver, SettlesAfterASelectionWithoutLimits)
{
    RoamMesh mesh(model, grid);
    LodSettings settings;
    for (int i = 0; i < 6; ++i) {
        settings.geomorph = i % 2;
        const View view = nextView(random, box, i);
        mesh.select(grid, view, settings);
        const std::uint32_t triangles = mesh.meshTriangles();
        const DrawList again = mesh.select(grid, view, settings);
        EXPECT_TRUE(again.report.converged);
        EXPECT_EQ(again.report.splits + again.report.merges, 0u);
        EXPECT_FALSE(again.positionsChanged);
        EXPECT_FALSE(again.indicesChanged);
        EXPECT_TRUE(again.newVertices.empty());
        EXPECT_EQ(mesh.meshTriangles(), triangles);
    }
}

TEST_P(RoamMeshOver, CanBeFollowedByWhatItSaysHasChanged)
{
    RoamMesh mesh(model, grid);
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> samples, indices;
    for (int i = 0; i < 2 * viewCount(); ++i) {
        LodSettings settings = randomSettings(random);
        settings.operationLimit = std::uint32_t(uniformInt(random, 0, 1) * 100);
        const DrawList list = mesh.select(grid, nextView(random, box, i / 2), settings);
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

TEST_P(RoamMeshOver, GivesTheSameForTheSameCallsBitForBit)
{
    RoamMesh first(model, grid), second(model, grid);
    for (int i = 0; i < viewCount(); ++i) {
        LodSettings settings = randomSettings(random);
        settings.operationLimit = std::uint32_t(uniformInt(random, 0, 1) * 200);
        settings.triangleBudget = std::uint32_t(uniformInt(random, 0, 1) * 1000);
        const View view = nextView(random, box, i);
        const DrawList a = first.select(grid, view, settings), b = second.select(grid, view, settings);
        ASSERT_TRUE(std::equal(a.indices.begin(), a.indices.end(), b.indices.begin(), b.indices.end()));
        ASSERT_TRUE(std::equal(a.samples.begin(), a.samples.end(), b.samples.begin(), b.samples.end()));
        ASSERT_EQ(a.positions.size(), b.positions.size());
        ASSERT_TRUE(a.positions.empty() || std::memcmp(a.positions.data(), b.positions.data(), a.positions.size_bytes()) == 0);
        ASSERT_EQ(std::memcmp(&a.report.errorPixels, &b.report.errorPixels, sizeof(float)), 0);
        ASSERT_EQ(a.report.splits, b.report.splits);
        ASSERT_EQ(a.report.merges, b.report.merges);
    }
}

TEST_P(RoamMeshOver, IsNoLargerAfterAFlightThanAFreshOne)
{
    RoamMesh travelled(model, grid);
    LodSettings settings;
    settings.geomorph = false;
    std::uint64_t trianglesTravelled = 0, trianglesFresh = 0;
    for (int i = 0; i < viewCount(); ++i) {
        const View view = nextView(random, box, i);
        const DrawList list = travelled.select(grid, view, settings);
        RoamMesh fresh(model, grid);
        const DrawList other = fresh.select(grid, view, settings);
        EXPECT_LE(list.report.triangles, other.report.triangles * 1.05 + 8.0) << "view " << i;
        trianglesTravelled += travelled.meshTriangles();
        trianglesFresh += fresh.meshTriangles();
    }
    EXPECT_LE(double(trianglesTravelled), double(trianglesFresh) * 1.05 + 8.0);
}

INSTANTIATE_TEST_SUITE_P(Terrains, RoamMeshOver, testing::ValuesIn(terrains()),
                         [](const testing::TestParamInfo<Terrain>& info) { return info.param.name; });
