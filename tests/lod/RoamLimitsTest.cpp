// What ROAM spends: triangles, operations, memory.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "lod/RoamMesh.h"

#include "Maps.h"
#include "MeshCheck.h"
#include "Views.h"

using namespace terrain;
using namespace terrain::test;

namespace {

class RoamLimitsOver : public testing::TestWithParam<Terrain> {
protected:
    const SampleGrid grid = GetParam().grid();
    const TerrainModel model = GetParam().model();
    const Box box = GetParam().box();
    std::mt19937 random{77};
};

}  // namespace

TEST_P(RoamLimitsOver, NeverExceedsTheTriangleBudget)
{
    RoamMesh mesh(model, grid);
    for (int i = 0; i < 40; ++i) {
        LodSettings settings;
        settings.pixelError = i % 4 ? 0.2f : 0.0f;
        settings.cull = i % 2;
        settings.geomorph = i % 5 < 2;
        settings.triangleBudget = std::uint32_t(i % 7 == 0 ? uniformInt(random, 2, 20) : uniformInt(random, 20, 3000));
        const DrawList list = mesh.select(grid, nextView(random, box, i), settings);
        ASSERT_LE(list.report.triangles, settings.triangleBudget) << "view " << i;
        ASSERT_LE(mesh.meshTriangles(), settings.triangleBudget) << "view " << i;
        ASSERT_EQ(list.indices.size(), 3 * list.report.triangles);
    }
}

TEST_P(RoamLimitsOver, KeepsTheTriangleBudgetUnderAnOperationLimitToo)
{
    RoamMesh mesh(model, grid);
    for (int i = 0; i < 40; ++i) {
        LodSettings settings;
        settings.pixelError = 0.2f;
        settings.triangleBudget = std::uint32_t(uniformInt(random, 2, 3000));
        settings.operationLimit = std::uint32_t(uniformInt(random, 1, 200));
        ASSERT_LE(mesh.select(grid, nextView(random, box, i), settings).report.triangles, settings.triangleBudget) << "view " << i;
    }
}

TEST_P(RoamLimitsOver, SpendsMostOfABudgetThatIsTooSmall)
{
    LodSettings settings;
    settings.pixelError = 0.0f;
    settings.cull = false;
    const View view = flightView(box, 3, 40);
    RoamMesh full(model, grid);
    full.select(grid, view, settings);
    settings.triangleBudget = full.meshTriangles() / 2;
    if (settings.triangleBudget < 100) return;  // one split is more than a tenth of it
    RoamMesh mesh(model, grid);
    mesh.select(grid, view, settings);
    EXPECT_GE(mesh.meshTriangles(), settings.triangleBudget - settings.triangleBudget / 10);
}

TEST_P(RoamLimitsOver, NeverExceedsTheOperationLimitAfterTheFirstSelection)
{
    RoamMesh mesh(model, grid);
    LodSettings settings;
    settings.pixelError = 0.5f;
    mesh.select(grid, nextView(random, box, 0), settings);
    for (int i = 1; i < 60; ++i) {
        // A single split may force two more on each level of the hierarchy.
        const int forced = 2 * model.errors->exponent() + 1;
        settings.operationLimit = std::uint32_t(uniformInt(random, forced, 200));
        settings.cull = i % 4 != 0;
        const SelectionReport report = mesh.select(grid, nextView(random, box, i), settings).report;
        ASSERT_LE(report.splits + report.merges, settings.operationLimit) << "view " << i;
    }
}

TEST_P(RoamLimitsOver, ReachesByStepsWhatOneSelectionGives)
{
    RoamMesh mesh(model, grid);
    LodSettings settings;
    settings.pixelError = 1.0f;
    settings.geomorph = false;
    mesh.select(grid, nextView(random, box, 0), settings);
    for (int i = 1; i < 8; ++i) {
        const View view = nextView(random, box, i);
        settings.operationLimit = 50;
        int steps = 0;
        while (!mesh.select(grid, view, settings).report.converged)
            ASSERT_LT(++steps, 6000) << "view " << i << " does not come to rest";
        const DrawList list = mesh.select(grid, view, settings);
        EXPECT_LE(list.report.errorPixels, settings.pixelError);
        RoamMesh fresh(model, grid);
        EXPECT_LE(list.report.triangles, fresh.select(grid, view, settings).report.triangles * 1.05 + 8.0);
    }
}

TEST_P(RoamLimitsOver, ComesToRestWithABudgetAndALimit)
{
    RoamMesh mesh(model, grid);
    LodSettings settings;
    settings.pixelError = 0.3f;
    settings.triangleBudget = 600;
    settings.operationLimit = 40;
    for (int i = 0; i < 8; ++i) {
        const View view = nextView(random, box, i);
        int steps = 0;
        while (!mesh.select(grid, view, settings).report.converged)
            ASSERT_LT(++steps, 2000) << "view " << i << " does not come to rest";
        const SelectionReport rest = mesh.select(grid, view, settings).report;
        EXPECT_EQ(rest.splits + rest.merges, 0u);
    }
}

TEST_P(RoamLimitsOver, HoldsNoMoreMemoryThanFullDetailNeedsHoweverLongItFlies)
{
    LodSettings settings;
    settings.pixelError = 0.0f;
    settings.cull = false;
    RoamMesh full(model, grid);
    full.select(grid, flightView(box, 0, 40), settings);
    settings.pixelError = 0.5f;
    settings.cull = true;
    RoamMesh mesh(model, grid);
    std::size_t highest = 0;
    for (int i = 0; i < 500; ++i) {
        if (grid.columns() * grid.rows() > 5000 && i % 4) continue;
        settings.geomorph = i % 2;
        mesh.select(grid, randomView(random, box), settings);
        highest = std::max(highest, mesh.bytes());
    }
    EXPECT_LE(highest, full.bytes() + full.bytes() / 2);
}

TEST(RoamMesh, MemoryIsNotLostFromJumpToJump)
{
    const Terrain terrain = fractal(129, 129);
    const SampleGrid grid = terrain.grid();
    RoamMesh mesh(terrain.model(), grid);
    std::size_t afterTwoRounds = 0;
    for (int round = 0; round < 20; ++round) {
        std::mt19937 random(5);
        for (int i = 0; i < 25; ++i) mesh.select(grid, randomView(random, terrain.box()), LodSettings{});
        if (round == 1) afterTwoRounds = mesh.bytes();
    }
    EXPECT_LE(mesh.bytes(), afterTwoRounds + afterTwoRounds / 50);
}

TEST(RoamMesh, CullingSavesTriangles)
{
    const Terrain terrain = fractal(129, 129);
    const SampleGrid grid = terrain.grid();
    LodSettings settings;
    settings.pixelError = 1.0f;
    RoamMesh culled(terrain.model(), grid), whole(terrain.model(), grid);
    const View view = flightView(terrain.box(), 7, 40);
    const std::uint32_t few = culled.select(grid, view, settings).report.triangles;
    settings.cull = false;
    EXPECT_LT(few, whole.select(grid, view, settings).report.triangles / 2);
}

TEST(RoamMesh, LargerErrorsTakeFewerTriangles)
{
    const Terrain terrain = fractal(129, 129);
    const SampleGrid grid = terrain.grid();
    const View view = flightView(terrain.box(), 7, 40);
    std::uint32_t before = 2 * 128 * 128 + 1;
    for (const float pixelError : {0.5f, 1.0f, 2.0f, 4.0f, 8.0f, 16.0f}) {
        LodSettings settings;
        settings.pixelError = pixelError;
        settings.cull = false;
        RoamMesh mesh(terrain.model(), grid);
        const std::uint32_t triangles = mesh.select(grid, view, settings).report.triangles;
        EXPECT_LT(triangles, before) << pixelError;
        before = triangles;
    }
}

TEST(RoamMesh, FlatGroundTakesTwoTriangles)
{
    for (const Terrain& terrain : {flat(65), ramp(65)}) {
        const SampleGrid grid = terrain.grid();
        RoamMesh mesh(terrain.model(), grid);
        LodSettings settings;
        settings.pixelError = 0.0f;
        settings.cull = false;
        EXPECT_EQ(mesh.select(grid, flightView(terrain.box(), 0, 40), settings).report.triangles, 2u) << terrain.name;
    }
}

TEST(RoamMesh, GeomorphKeepsVerticesOffTheirSamplesOnTheirWay)
{
    const Terrain terrain = fractal(129, 129);
    const SampleGrid grid = terrain.grid();
    LodSettings settings;
    settings.pixelError = 4.0f;
    settings.geomorph = true;
    RoamMesh mesh(terrain.model(), grid);
    int morphing = 0;
    for (int i = 0; i < 20; ++i) {
        const DrawList list = mesh.select(grid, flightView(terrain.box(), i, 400), settings);
        for (const GridTriangle& t : trianglesOf(grid, list))
            for (std::size_t k = 0; k < 3; ++k) morphing += list.positions[t.vertex[k]] != grid.position(t.corner[k].x, t.corner[k].y);
    }
    EXPECT_GT(morphing, 0);
}

INSTANTIATE_TEST_SUITE_P(Terrains, RoamLimitsOver, testing::ValuesIn(terrains()),
                         [](const testing::TestParamInfo<Terrain>& info) { return info.param.name; });
