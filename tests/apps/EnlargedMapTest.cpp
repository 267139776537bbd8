#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <unistd.h>

#include <gtest/gtest.h>

#include "EnlargedMap.h"
#include "HeightFileOutput.h"
#include "height/FractalSource.h"
#include "height/ImageSource.h"

using namespace app;
using terrain::HeightMap;

namespace {

HeightMap fractal(int columns, int rows) {
    terrain::FractalParameters parameters;
    parameters.columns = columns;
    parameters.rows = rows;
    parameters.amplitude = 100.0;
    auto map = makeFractalMap(parameters);
    EXPECT_TRUE(map) << map.error().message();
    return std::move(map).value();
}

/// All heights, row after row.
std::vector<double> all(const EnlargedMap& map) {
    std::vector<double> heights(std::size_t(map.columns()) * std::size_t(map.rows()));
    for (int row = 0; row < map.rows(); ++row) map.makeRow(row, &heights[std::size_t(row) * std::size_t(map.columns())]);
    return heights;
}

}  // namespace

TEST(EnlargedMap, AFactorOfOneIsTheMapItself) {
    const HeightMap map = fractal(33, 20);
    const auto heights = all(EnlargedMap(map, 1, 5.0, 0.5, 1));
    ASSERT_EQ(heights.size(), map.heights.size());
    for (std::size_t i = 0; i < heights.size(); ++i) ASSERT_EQ(heights[i], double(map.heights[i]));
}

TEST(EnlargedMap, WithoutReliefItGoesThroughTheSamplesAndIsSmoothBetweenThem) {
    const HeightMap map = fractal(33, 20);
    const EnlargedMap large(map, 8, 0.0, 0.5, 1);
    ASSERT_EQ(large.columns(), 257);
    ASSERT_EQ(large.rows(), 153);
    const auto heights = all(large);
    const auto at = [&](int column, int row) { return heights[std::size_t(row) * 257 + std::size_t(column)]; };
    double bend = 0.0, bendOfMap = 0.0;
    for (int row = 0; row < 20; ++row)
        for (int column = 0; column < 33; ++column) {
            EXPECT_NEAR(at(column * 8, row * 8), map.at(column, row), 1e-4);
            if (column == 0 || column == 32) continue;
            bend =
                std::max(bend, std::fabs(at(column * 8 - 1, row * 8) - 2 * at(column * 8, row * 8) + at(column * 8 + 1, row * 8)));
            bendOfMap = std::max(bendOfMap,
                                 std::fabs(double(map.at(column - 1, row)) - 2.0 * map.at(column, row) + map.at(column + 1, row)));
        }
    // Straight lines between the samples would bend by an eighth at them.
    EXPECT_LT(bend, 0.05 * bendOfMap);
}

TEST(EnlargedMap, ReliefStaysWithinWhatItWasGivenAndIsThere) {
    const HeightMap map = fractal(33, 33);
    const auto smooth = all(EnlargedMap(map, 8, 0.0, 0.5, 1));
    const EnlargedMap rough(map, 8, 2.0, 0.5, 1);
    const auto heights = all(rough);
    double largest = 0.0;
    for (std::size_t i = 0; i < heights.size(); ++i) largest = std::max(largest, std::fabs(heights[i] - smooth[i]));
    EXPECT_LE(largest, 2.0 + 1.0 + 0.5 + 1e-9);
    EXPECT_GT(largest, 1.0);
    EXPECT_LE(rough.lowest(), *std::min_element(heights.begin(), heights.end()));
    EXPECT_GE(rough.highest(), *std::max_element(heights.begin(), heights.end()));
    EXPECT_EQ(heights, all(rough));
    EXPECT_NE(heights, all(EnlargedMap(map, 8, 2.0, 0.5, 2)));
}

TEST(HeightFileOutput, LinesAndTilesHoldTheSameHeightsFromNorthToSouth) {
    if (!terrain::hasImageReader()) GTEST_SKIP() << "built without OpenImageIO";
    const auto folder = std::filesystem::temp_directory_path() / ("soterrain-enlarged-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    const HeightMap map = fractal(33, 20);
    const EnlargedMap large(map, 4, 1.0, 0.5, 1);
    const auto heights = all(large);
    for (const auto& [name, tile] : {std::pair{"lines.png", 0}, {"tiles.tif", 32}}) {
        SCOPED_TRACE(name);
        ASSERT_EQ(writeHeights(large, (folder / name).string(), tile), "");
        const auto source = terrain::openHeightFile((folder / name).string(), {});
        ASSERT_TRUE(source) << source.error().message();
        const HeightMap& found = *source.value()->map();
        ASSERT_EQ(found.heights.size(), heights.size());
        const double scale = 65535.0 / (large.highest() - large.lowest());
        for (std::size_t i = 0; i < heights.size(); ++i) ASSERT_NEAR(found.heights[i], (heights[i] - large.lowest()) * scale, 0.52);
    }
    EXPECT_NE(writeHeights(large, (folder / "tiles.png").string(), 32).find("tiles"), std::string::npos);
    std::filesystem::remove_all(folder);
}
