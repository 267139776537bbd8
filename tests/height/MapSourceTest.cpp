#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "height/HeightSource.h"

using namespace terrain;

namespace {

/// Heights that differ everywhere: column + 1000 * row.
HeightMap numbered(int columns, int rows) {
    HeightMap map;
    map.columns = columns;
    map.rows = rows;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) map.heights.push_back(float(column + 1000 * row));
    return map;
}

std::shared_ptr<const HeightSource> sourceOf(HeightMap map) {
    auto source = makeMapSource(std::move(map));
    EXPECT_TRUE(source) << source.error().message();
    return source.value();
}

/// Checks one tile, sample by sample and in its extremes, against the map.
void expectTileOfMap(const HeightSource& source, const TileKey& key) {
    const auto loaded = source.load(key);
    ASSERT_TRUE(loaded) << loaded.error().message();
    const HeightTile& tile = loaded.value();
    const HeightMap& map = *source.map();
    const int stride = 1 << key.level;
    const int firstColumn = key.column * key.cells * stride, firstRow = key.row * key.cells * stride;
    const int lastColumn = std::min(firstColumn + key.cells * stride, map.columns - 1);
    const int lastRow = std::min(firstRow + key.cells * stride, map.rows - 1);
    ASSERT_EQ(tile.heights.size(), std::size_t(tile.columns) * std::size_t(tile.rows));
    EXPECT_EQ(tile.key, key);
    for (int row = 0; row < tile.rows; ++row)
        for (int column = 0; column < tile.columns; ++column)
            EXPECT_EQ(tile.heights[std::size_t(row * tile.columns + column)],
                      map.at(std::min(firstColumn + column * stride, lastColumn), std::min(firstRow + row * stride, lastRow)));
    EXPECT_EQ(tile.heights.back(), map.at(lastColumn, lastRow));
    EXPECT_EQ(tile.minimum, map.at(firstColumn, firstRow));
    EXPECT_EQ(tile.maximum, map.at(lastColumn, lastRow));
}

}  // namespace

TEST(MapSource, EveryTileOfEveryLevelHoldsTheMapsSamples) {
    for (const auto& [columns, rows] : {std::pair{2, 2}, {9, 9}, {300, 7}, {13, 130}, {65, 65}}) {
        const auto source = sourceOf(numbered(columns, rows));
        for (int cells : {1, 3, 4, 64})
            for (int level = 0; level < source->levelCount(); ++level)
                for (int row = 0; row * (cells << level) < rows - 1; ++row)
                    for (int column = 0; column * (cells << level) < columns - 1; ++column)
                        expectTileOfMap(*source, {level, column, row, cells});
    }
}

TEST(MapSource, NeighbouringTilesShareTheirBorder) {
    const auto source = sourceOf(numbered(33, 33));
    const HeightTile west = source->load({1, 0, 0, 4}).value();
    const HeightTile east = source->load({1, 1, 0, 4}).value();
    ASSERT_EQ(west.rows, east.rows);
    for (int row = 0; row < west.rows; ++row)
        EXPECT_EQ(west.heights[std::size_t(row * west.columns + west.columns - 1)], east.heights[std::size_t(row * east.columns)]);
}

TEST(MapSource, LevelsGrowByOneForEveryDoublingOfTheLongerSide) {
    EXPECT_EQ(sourceOf(numbered(2, 2))->levelCount(), 1);
    EXPECT_EQ(sourceOf(numbered(3, 2))->levelCount(), 2);
    EXPECT_EQ(sourceOf(numbered(2, 5))->levelCount(), 3);
    EXPECT_EQ(sourceOf(numbered(6, 6))->levelCount(), 4);
    EXPECT_EQ(sourceOf(numbered(129, 65))->levelCount(), 8);
}

TEST(MapSource, ACoarseTileKnowsThePeakBetweenItsSamples) {
    HeightMap map = numbered(9, 9);
    map.heights[std::size_t(5 * 9 + 3)] = 1e6f;
    map.heights[std::size_t(3 * 9 + 5)] = -1e6f;
    const HeightTile tile = sourceOf(std::move(map))->load({3, 0, 0, 1}).value();
    EXPECT_EQ(tile.heights.size(), 4u);
    EXPECT_EQ(tile.maximum, 1e6f);
    EXPECT_EQ(tile.minimum, -1e6f);
}

TEST(MapSource, HolesCountNeitherAsMinimumNorAsMaximum) {
    constexpr float hole = std::numeric_limits<float>::quiet_NaN();
    HeightMap map = numbered(3, 2);
    map.heights = {hole, 5.0f, hole, 7.0f, hole, hole};
    const auto source = sourceOf(std::move(map));
    const HeightTile some = source->load({0, 0, 0, 2}).value();
    EXPECT_EQ(some.minimum, 5.0f);
    EXPECT_EQ(some.maximum, 7.0f);
    HeightMap empty = numbered(2, 2);
    empty.heights.assign(4, hole);
    const HeightTile none = sourceOf(std::move(empty))->load({0, 0, 0, 1}).value();
    EXPECT_TRUE(std::isnan(none.minimum));
    EXPECT_TRUE(std::isnan(none.maximum));
}

TEST(MapSource, KeysOutsideThePyramidAreErrors) {
    constexpr int huge = std::numeric_limits<int>::max();
    const auto source = sourceOf(numbered(9, 5));
    for (const TileKey& key :
         {TileKey{-1, 0, 0, 4}, TileKey{4, 0, 0, 4}, TileKey{0, 2, 0, 4}, TileKey{0, 0, 1, 4}, TileKey{0, -1, 0, 4},
          TileKey{0, 0, 0, 0}, TileKey{0, 0, 0, -5}, TileKey{3, huge, huge, huge}, TileKey{huge, 0, 0, 4}})
        EXPECT_FALSE(source->load(key)) << key.level << " " << key.column << " " << key.row << " " << key.cells;
    EXPECT_TRUE(source->load({3, 0, 0, huge}));
}

TEST(MapSource, SizesThatDoNotFitTheSamplesAreErrors) {
    EXPECT_FALSE(makeMapSource(HeightMap{}));
    EXPECT_FALSE(makeMapSource(numbered(1, 5)));
    HeightMap map = numbered(4, 4);
    map.rows = 5;
    const auto result = makeMapSource(map);
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().message().find("20"), std::string::npos) << result.error().message();
    EXPECT_NE(result.error().message().find("16"), std::string::npos) << result.error().message();
    map.columns = map.rows = -4;
    EXPECT_FALSE(makeMapSource(map));
}

TEST(MapSource, ExtentAndBytesAreThoseOfTheMap) {
    HeightMap map = numbered(5, 4);
    map.origin = {100.0, 200.0};
    map.spacing = {10.0, 20.0};
    const auto source = sourceOf(std::move(map));
    EXPECT_EQ(source->extent().columns, 5);
    EXPECT_EQ(source->extent().rows, 4);
    EXPECT_EQ(source->extent().origin, glm::dvec2(100.0, 200.0));
    EXPECT_EQ(source->extent().spacing, glm::dvec2(10.0, 20.0));
    EXPECT_GE(source->bytes(), 5 * 4 * sizeof(float));
    EXPECT_LT(source->bytes(), 5 * 4 * sizeof(float) + 1024);
}
