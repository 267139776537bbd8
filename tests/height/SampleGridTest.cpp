// What SampleGrid finds out about points, and that every way of looking at the same samples gives the same positions.
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "../lod/Maps.h"
#include "../lod/Views.h"

using namespace terrain;
using namespace terrain::test;

namespace {

/// A regular grid whose columns, rows and heights run along the given axes, with the given steps.
Terrain along(int columnAxis, int rowAxis, float columnStep, float rowStep)
{
    const int heightAxis = 3 - columnAxis - rowAxis;
    return curved("Grid", 13, 9, [=](int column, int row) {
        glm::vec3 p(0.0f);
        p[columnAxis] = 100.0f + columnStep * float(column);
        p[rowAxis] = -30.0f + rowStep * float(row);
        p[heightAxis] = float((column * 7 + row * 5) % 11) + 0.25f * float(column * row);
        return p;
    });
}

void expectPositionsOf(const SampleGrid& grid, const std::vector<float>& points)
{
    for (int row = 0; row < grid.rows(); ++row)
        for (int column = 0; column < grid.columns(); ++column) {
            const float* p = points.data() + grid.index(column, row) * 3;
            const glm::vec3 position(p[0], p[1], p[2]);
            ASSERT_EQ(grid.position(column, row), position);
            const glm::dvec3 fromFrame(grid.localFromFrame() * glm::dvec4(glm::dvec3(grid.framePosition(column, row)), 1.0));
            ASSERT_LT(glm::distance(fromFrame, glm::dvec3(position)), 1e-4);
        }
}

}  // namespace

TEST(SampleGrid, FindsRegularGridsAlongAnyAxesAndEitherWay)
{
    for (int columnAxis = 0; columnAxis < 3; ++columnAxis)
        for (int rowAxis = 0; rowAxis < 3; ++rowAxis)
            for (const float columnStep : {0.3f, -2.0f})
                for (const float rowStep : {1.0f, -0.7f}) {
                    if (columnAxis == rowAxis) continue;
                    const Terrain terrain = along(columnAxis, rowAxis, columnStep, rowStep);
                    const SampleGrid grid = terrain.grid();
                    ASSERT_TRUE(grid.isRegular()) << columnAxis << ", " << rowAxis;
                    ASSERT_EQ(grid.heightAxis(), 3 - columnAxis - rowAxis);
                    expectPositionsOf(grid, terrain.points);
                    for (int row = 0; row < 9; ++row)
                        for (int column = 0; column < 13; ++column)
                            ASSERT_EQ(grid.height(column, row), grid.position(column, row)[grid.heightAxis()]);
                }
}

TEST(SampleGrid, TakesAFlatGridToHaveItsHeightsAlongTheAxisThatDoesNotVary)
{
    const Terrain terrain = curved("Floor", 5, 4, [](int column, int row) { return glm::vec3(float(column), 2.0f, float(row)); });
    const SampleGrid grid = terrain.grid();
    ASSERT_TRUE(grid.isRegular());
    EXPECT_EQ(grid.heightAxis(), 1);
}

TEST(SampleGrid, RefusesToCallCurvedGridsRegular)
{
    for (const Terrain& terrain : {hemisphere(20, 12), wavySheet(20, 12, false), wavySheet(33, 33, true)}) {
        const SampleGrid grid = terrain.grid();
        EXPECT_FALSE(grid.isRegular()) << terrain.name;
        EXPECT_EQ(grid.localFromFrame(), glm::dmat4(1.0));
        for (int row = 0; row < grid.rows(); ++row)
            for (int column = 0; column < grid.columns(); ++column)
                if (!grid.isHole(column, row)) {
                    ASSERT_EQ(grid.framePosition(column, row), grid.position(column, row));
                }
    }
}

TEST(SampleGrid, NoticesASinglePointThatIsOffTheGrid)
{
    Terrain terrain = along(0, 1, 1.0f, 1.0f);
    terrain.points[(4 * 13 + 6) * 3] += 0.05f;
    EXPECT_FALSE(terrain.grid().isRegular());
    EXPECT_EQ(terrain.grid().position(6, 4).x, 106.05f);
}

TEST(SampleGrid, ToleratesTheRoundingOfCoordinatesFarFromTheOrigin)
{
    const Terrain terrain = curved("Far", 40, 30, [](int column, int row) {
        return glm::vec3(float(4.5e6 + 0.7 * column), float(5.1e5 + 0.7 * row), float(column % 3));
    });
    const SampleGrid grid = terrain.grid();
    EXPECT_TRUE(grid.isRegular());
    EXPECT_EQ(grid.position(39, 29), glm::vec3(float(4.5e6 + 0.7 * 39), float(5.1e5 + 0.7 * 29), 0.0f));
}

TEST(SampleGrid, RegularGridsMayHaveHoles)
{
    Terrain terrain = along(0, 2, 1.0f, 1.0f);
    const std::size_t sample = 4 * 13 + 6;
    terrain.points[sample * 3 + 1] = kHole;
    const SampleGrid grid = terrain.grid();
    ASSERT_TRUE(grid.isRegular());
    for (int row = 0; row < 9; ++row)
        for (int column = 0; column < 13; ++column) EXPECT_EQ(grid.isHole(column, row), grid.index(column, row) == sample);
}

TEST(SampleGrid, InfiniteHeightsAreHolesToo)
{
    HeightMap map = fractalMap(5, 5);
    map.heights[7] = std::numeric_limits<float>::infinity();
    EXPECT_TRUE(SampleGrid(map).isHole(2, 1));
    EXPECT_FALSE(SampleGrid(map).isHole(1, 1));
}

TEST(SampleGrid, OverAMapStandsWhereTheMapSays)
{
    const HeightMap map = fractalMap(17, 9);
    const SampleGrid grid(map);
    ASSERT_TRUE(grid.isRegular());
    for (int row = 0; row < 9; ++row)
        for (int column = 0; column < 17; ++column) {
            EXPECT_EQ(grid.position(column, row), glm::vec3(float(3.0 + 1.25 * column), float(-20.0 + 0.75 * row), map.at(column, row)));
            EXPECT_EQ(grid.framePosition(column, row), glm::vec3(float(column), float(row), map.at(column, row)));
        }
    EXPECT_TRUE(grid.contains(16, 8));
    EXPECT_FALSE(grid.contains(17, 8));
    EXPECT_FALSE(grid.contains(0, -1));
}

TEST(SampleGrid, APartOfAMapIsWhereThatPartIs)
{
    const HeightMap map = punched(fractalMap(17, 9), [](int column, int row) { return column == 5 && row == 3; });
    const SampleGrid whole(map), part(map, 4, 2, 7, 5);
    ASSERT_EQ(part.columns(), 7);
    ASSERT_EQ(part.rows(), 5);
    for (int row = 0; row < 5; ++row)
        for (int column = 0; column < 7; ++column) {
            EXPECT_EQ(part.isHole(column, row), whole.isHole(column + 4, row + 2));
            if (!part.isHole(column, row)) {
                EXPECT_EQ(part.position(column, row), whole.position(column + 4, row + 2));
            }
        }
}

TEST(SampleGrid, MovesWithItsSamples)
{
    for (const Terrain& terrain : {along(2, 0, 1.5f, -1.0f), wavySheet(13, 9, false)}) {
        const SampleGrid grid = terrain.grid();
        std::vector<float> elsewhere = terrain.points;
        elsewhere[3 * 20 + std::size_t(grid.heightAxis())] += 4.0f;
        const SampleGrid moved = grid.movedTo(elsewhere.data());
        EXPECT_EQ(moved.isRegular(), grid.isRegular());
        const int column = 20 % grid.columns(), row = 20 / grid.columns();
        EXPECT_EQ(moved.position(column, row)[grid.heightAxis()], terrain.points[3 * 20 + std::size_t(grid.heightAxis())] + 4.0f);
        expectPositionsOf(moved, elsewhere);
    }
}

TEST(SampleGrid, RefusesSizesThatAreNoGrid)
{
    const float points[12] = {};
    for (const auto& [columns, rows] : {std::pair(1, 4), std::pair(4, 1), std::pair(0, 0), std::pair(-2, -2), std::pair(65536, 65536)}) {
        const Result<SampleGrid> grid = SampleGrid::overPoints(points, columns, rows);
        ASSERT_FALSE(grid) << columns << " x " << rows;
        EXPECT_NE(grid.error().message().find(std::to_string(columns) + " x " + std::to_string(rows)), std::string::npos);
    }
}
