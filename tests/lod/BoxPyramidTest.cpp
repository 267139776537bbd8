#include <random>

#include <gtest/gtest.h>

#include "lod/BoxPyramid.h"

#include "Maps.h"
#include "Views.h"

using namespace terrain;
using namespace terrain::test;

namespace {

class BoxPyramidOver : public testing::TestWithParam<Terrain> {
protected:
    const SampleGrid grid = GetParam().grid();
    const BoxPyramid boxes{grid};

    /// Bounds sample by sample, for a regular grid of the heights only. Written apart from the class under test.
    BoxPyramid::Bounds naive(int column0, int row0, int column1, int row1) const
    {
        constexpr float infinity = std::numeric_limits<float>::infinity();
        BoxPyramid::Bounds bounds{glm::vec3(infinity), glm::vec3(-infinity)};
        for (int row = std::max(row0, 0); row <= std::min(row1, grid.rows() - 1); ++row)
            for (int column = std::max(column0, 0); column <= std::min(column1, grid.columns() - 1); ++column) {
                if (grid.isHole(column, row)) continue;
                bounds.low = glm::min(bounds.low, grid.framePosition(column, row));
                bounds.high = glm::max(bounds.high, grid.framePosition(column, row));
            }
        return bounds;
    }
    static bool contains(const BoxPyramid::Bounds& outer, const BoxPyramid::Bounds& inner)
    {
        return inner.isEmpty() || (glm::all(glm::lessThanEqual(outer.low, inner.low)) && glm::all(glm::greaterThanEqual(outer.high, inner.high)));
    }
};

}  // namespace

TEST_P(BoxPyramidOver, BoundsContainAllSamplesOfAnyRectangle)
{
    std::mt19937 random(4);
    for (int i = 0; i < 400; ++i) {
        const int extent = 1 << uniformInt(random, 0, 8);
        const int column = uniformInt(random, -5, grid.columns() + 3), row = uniformInt(random, -5, grid.rows() + 3);
        const int column1 = column + uniformInt(random, 0, extent), row1 = row + uniformInt(random, 0, extent);
        const BoxPyramid::Bounds bounds = boxes.bounds(column, row, column1, row1);
        ASSERT_TRUE(contains(bounds, naive(column, row, column1, row1))) << column << ", " << row << " to " << column1 << ", " << row1;
        // Not more than the blocks that it touches, either.
        const int slack = std::max(BoxPyramid::kBlockCells, std::max(column1 - column, row1 - row));
        const BoxPyramid::Bounds wide = naive(column - slack, row - slack, column1 + slack, row1 + slack);
        if (bounds.isEmpty() || wide.isEmpty()) {
            ASSERT_TRUE(bounds.isEmpty());
            continue;
        }
        ASSERT_GE(bounds.low.z, wide.low.z);
        ASSERT_LE(bounds.high.z, wide.high.z);
    }
}

TEST_P(BoxPyramidOver, ExactBoundsOfARectangleAreThoseOfItsHeights)
{
    std::mt19937 random(5);
    for (int i = 0; i < 200; ++i) {
        const int column = uniformInt(random, 0, grid.columns() - 1), row = uniformInt(random, 0, grid.rows() - 1);
        const int column1 = column + uniformInt(random, 0, 6), row1 = row + uniformInt(random, 0, 6);
        const BoxPyramid::Bounds exact = BoxPyramid::exactBounds(grid, column, row, column1, row1), expected = naive(column, row, column1, row1);
        ASSERT_EQ(exact.isEmpty(), expected.isEmpty());
        if (exact.isEmpty()) continue;
        ASSERT_EQ(exact.low.z, expected.low.z);
        ASSERT_EQ(exact.high.z, expected.high.z);
        ASSERT_TRUE(contains(exact, expected));
    }
}

TEST_P(BoxPyramidOver, AllIsExact)
{
    const BoxPyramid::Bounds expected = naive(0, 0, grid.columns() - 1, grid.rows() - 1);
    ASSERT_EQ(boxes.all().isEmpty(), expected.isEmpty());
    if (expected.isEmpty()) return;
    EXPECT_EQ(boxes.all().low, expected.low);
    EXPECT_EQ(boxes.all().high, expected.high);
}

TEST_P(BoxPyramidOver, BlocksContainTheirSamplesAndTheTopOneAll)
{
    for (int level = 0; level < boxes.levelCount(); ++level) {
        const int cells = BoxPyramid::kBlockCells << level;
        ASSERT_GE(boxes.columns(level) * cells, grid.columns() - 1);
        ASSERT_GE(boxes.rows(level) * cells, grid.rows() - 1);
        for (int row = 0; row < boxes.rows(level); ++row)
            for (int column = 0; column < boxes.columns(level); ++column) {
                const BoxPyramid::Bounds expected = naive(column * cells, row * cells, (column + 1) * cells, (row + 1) * cells);
                ASSERT_EQ(boxes.block(level, column, row).isEmpty(), expected.isEmpty());
                ASSERT_TRUE(contains(boxes.block(level, column, row), expected));
            }
    }
    EXPECT_EQ(boxes.columns(boxes.levelCount() - 1) * boxes.rows(boxes.levelCount() - 1), 1);
}

TEST(BoxPyramid, TakesAFractionOfABytePerSample)
{
    const Terrain terrain = fractal(513, 513);
    EXPECT_LT(double(BoxPyramid(terrain.grid()).bytes()) / (513.0 * 513.0), 0.2);
}

INSTANTIATE_TEST_SUITE_P(Terrains, BoxPyramidOver, testing::ValuesIn(terrains()),
                         [](const testing::TestParamInfo<Terrain>& info) { return info.param.name; });
