#include <gtest/gtest.h>

#include "lod/BruteForceMesh.h"

#include "Maps.h"
#include "MeshCheck.h"
#include "Views.h"

using namespace terrain;
using namespace terrain::test;

class BruteForceMeshOver : public testing::TestWithParam<Terrain> {
protected:
    const SampleGrid grid = GetParam().grid();
};

TEST_P(BruteForceMeshOver, DrawsEveryValidCellOnceAndNothingElse)
{
    for (const bool clockwise : {false, true}) {
        BruteForceMesh mesh;
        LodSettings settings;
        settings.clockwise = clockwise;
        const DrawList list = mesh.select(grid, View{}, settings);
        EXPECT_TRUE(list.wholeGrid);
        EXPECT_TRUE(list.indicesChanged);
        EXPECT_EQ(list.report.errorPixels, 0.0f);
        const std::vector<GridTriangle> triangles = trianglesOf(grid, list);
        EXPECT_EQ("", conformityProblem(grid, triangles, clockwise));
        EXPECT_EQ("", overlapProblem(grid, triangles));
        EXPECT_EQ("", completenessProblem(grid, triangles));
        std::uint32_t cells = 0;
        for (int row = 0; row < grid.rows() - 1; ++row)
            for (int column = 0; column < grid.columns() - 1; ++column) cells += !isCellHole(grid, column, row);
        EXPECT_EQ(list.report.triangles, 2 * cells);
        EXPECT_EQ(triangles.size(), 2 * cells);
    }
}

TEST_P(BruteForceMeshOver, CutsEveryCellAlongTheDiagonalThatPickingUses)
{
    BruteForceMesh mesh;
    for (const GridTriangle& t : trianglesOf(grid, mesh.select(grid, View{}, LodSettings{}))) {
        const glm::ivec2 low = glm::min(glm::min(t.corner[0], t.corner[1]), t.corner[2]);
        int onDiagonal = 0;
        for (const glm::ivec2 corner : t.corner) onDiagonal += corner.x - low.x + corner.y - low.y == 1;
        ASSERT_EQ(onDiagonal, 2);
    }
}

TEST_P(BruteForceMeshOver, SendsItsIndicesOnlyWhenTheyChange)
{
    BruteForceMesh mesh;
    LodSettings settings;
    const std::uint32_t triangles = mesh.select(grid, View{}, settings).report.triangles;
    for (int i = 0; i < 3; ++i) {
        const DrawList again = mesh.select(grid, View{}, settings);
        EXPECT_FALSE(again.indicesChanged);
        EXPECT_FALSE(again.positionsChanged);
        EXPECT_EQ(again.report.triangles, triangles);
    }
    EXPECT_EQ(mesh.bytes(), 0u) << "whoever draws has the indices";
    settings.clockwise = true;
    const DrawList turned = mesh.select(grid, View{}, settings);
    EXPECT_TRUE(turned.indicesChanged);
    EXPECT_EQ(turned.indices.size(), 3 * triangles);
}

INSTANTIATE_TEST_SUITE_P(Terrains, BruteForceMeshOver, testing::ValuesIn(smallTerrains()),
                         [](const testing::TestParamInfo<Terrain>& info) { return info.param.name; });
