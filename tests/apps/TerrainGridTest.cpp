// Where height maps stand in the scene.
#include "TerrainGrid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <Inventor/SoDB.h>
#include <Inventor/nodes/SoIndexedFaceSet.h>

namespace {

using app::TerrainGrid;
using terrain::HeightMap;

terrain::Result<TerrainGrid> place(HeightMap map, std::optional<glm::dvec2> spacing = {}, std::optional<double> scale = {})
{
    auto source = terrain::makeMapSource(std::move(map));
    if (!source) return source.error();
    return app::placeGrid(std::move(source).value(), spacing, scale);
}

HeightMap bytes()
{
    return {3, 2, {0, 10, 20, 30, 40, 255}, {0, 0}, {1, 1}, ""};
}

TEST(TerrainGrid, BytesSpanTheUnitSquareAndTheStandardHeight)
{
    const auto grid = place(bytes());
    ASSERT_TRUE(grid);
    EXPECT_TRUE(grid.value().point(2, 1, 255.0f).equals(SbVec3f(2.0f / 3.0f, 0.5f, 255.0f * 0.0002f), 1e-12f));
}

TEST(TerrainGrid, SixteenBitsReachTheSameHeight)
{
    HeightMap map = bytes();
    map.heights.back() = 65535;
    const auto grid = place(map);
    ASSERT_TRUE(grid);
    EXPECT_NEAR(grid.value().point(0, 0, 65535.0f)[2], 255.0f * 0.0002f, 1e-7f);
}

TEST(TerrainGrid, FractionsAreScaledFromLowestToHighest)
{
    const auto grid = place({2, 2, {-1.5f, 0.0f, 0.25f, 2.5f}, {0, 0}, {1, 1}, ""});
    ASSERT_TRUE(grid);
    EXPECT_NEAR(grid.value().minimum, 0.0, 1e-9);
    EXPECT_NEAR(grid.value().maximum, app::standardHeight, 1e-9);
}

TEST(TerrainGrid, OwnSpacingKeepsRealUnits)
{
    HeightMap map = bytes();
    map.spacing = {30.0, 25.0};
    const auto grid = place(map);
    ASSERT_TRUE(grid);
    EXPECT_TRUE(grid.value().point(2, 1, 7.0f).equals(SbVec3f(60.0f, 25.0f, 7.0f), 1e-9f));
}

TEST(TerrainGrid, DegreesBecomeMetres)
{
    HeightMap map = bytes();
    map.spacing = {0.001, 0.001};
    map.origin = {10.0, 60.0};
    map.projection = "GEOGCS[\"WGS 84\"]";
    const auto grid = place(map);
    ASSERT_TRUE(grid);
    EXPECT_NEAR(grid.value().spacing.y, 111.3, 0.1);
    EXPECT_NEAR(grid.value().spacing.x, 111.3 * 0.5, 0.2);
}

TEST(TerrainGrid, GivenSpacingAndScaleWin)
{
    const auto grid = place(bytes(), glm::dvec2(2.0, 3.0), 0.5);
    ASSERT_TRUE(grid);
    EXPECT_TRUE(grid.value().point(1, 1, 10.0f).equals(SbVec3f(2.0f, 3.0f, 5.0f), 1e-12f));
}

TEST(TerrainGrid, HolesOnlyAreRefused)
{
    const float hole = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(place({2, 2, {hole, hole, hole, hole}, {0, 0}, {1, 1}, ""}));
}

TEST(TerrainGrid, HeightAtIsThatOfTheTriangles)
{
    const auto grid = place({2, 2, {0, 0, 0, 4}, {0, 0}, {1, 1}, ""}, glm::dvec2(1.0, 1.0), 1.0);
    ASSERT_TRUE(grid);
    EXPECT_FLOAT_EQ(grid.value().heightAt(0.25f, 0.25f).value(), 0.0f);
    EXPECT_FLOAT_EQ(grid.value().heightAt(0.75f, 0.75f).value(), 2.0f);
    EXPECT_FLOAT_EQ(grid.value().heightAt(1.0f, 1.0f).value(), 4.0f);
    EXPECT_FALSE(grid.value().heightAt(-0.1f, 0.5f));
    EXPECT_FALSE(grid.value().heightAt(0.5f, 1.1f));
}

TEST(TerrainGrid, FaceSetLeavesHolesOut)
{
    SoDB::init();
    HeightMap map{3, 3, std::vector<float>(9, 1.0f), {0, 0}, {1, 1}, ""};
    map.heights[0] = std::numeric_limits<float>::quiet_NaN();
    const auto grid = place(map);
    ASSERT_TRUE(grid);
    SoIndexedFaceSet* faces = app::makeFaceSet(grid.value());
    faces->ref();
    EXPECT_EQ(faces->coordIndex.getNum(), 7 * 4) << "eight triangles but the one with the hole";
    for (int i = 0; i < faces->coordIndex.getNum(); ++i) EXPECT_NE(faces->coordIndex[i], 0);
    faces->unref();
}

}  // namespace
