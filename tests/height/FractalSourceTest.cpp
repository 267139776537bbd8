#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "height/FractalSource.h"

using namespace terrain;

namespace {

HeightMap make(const FractalParameters& parameters) {
    auto map = makeFractalMap(parameters);
    EXPECT_TRUE(map) << map.error().message();
    return map ? std::move(map).value() : HeightMap{};
}

FractalParameters sized(int columns, int rows) {
    FractalParameters parameters;
    parameters.columns = columns;
    parameters.rows = rows;
    return parameters;
}

/// FNV-1a over the bits of the heights, lowest byte first.
std::uint64_t checksum(const HeightMap& map) {
    std::uint64_t hash = 14695981039346656037ull;
    for (const float height : map.heights) {
        std::uint32_t bits = 0;
        std::memcpy(&bits, &height, sizeof bits);
        for (int byte = 0; byte < 4; ++byte) hash = (hash ^ ((bits >> (8 * byte)) & 255)) * 1099511628211ull;
    }
    return hash;
}

/// Mean difference between neighbours.
double ruggedness(const HeightMap& map) {
    double sum = 0.0;
    for (int row = 0; row < map.rows; ++row)
        for (int column = 1; column < map.columns; ++column) sum += std::abs(map.at(column, row) - map.at(column - 1, row));
    return sum / (double(map.rows) * (map.columns - 1));
}

}  // namespace

TEST(FractalSource, SameParametersGiveSameHeightsBitForBit) {
    FractalParameters parameters = sized(257, 200);
    parameters.seed = 42;
    parameters.filterPasses = 2;
    parameters.amplitude = 1234.5;
    EXPECT_EQ(make(parameters).heights, make(parameters).heights);
}

TEST(FractalSource, SameHeightsOnEveryMachine) {
    FractalParameters parameters = sized(129, 129);
    parameters.seed = 7;
    parameters.roughness = 0.55;
    parameters.filterPasses = 1;
    parameters.filterCoefficient = 0.7;
    parameters.amplitude = 1000.0;
    EXPECT_EQ(checksum(make(parameters)), 11120428701160331095ull);
}

TEST(FractalSource, HeightsSpanZeroToAmplitude) {
    for (const auto& [columns, rows] : {std::pair{2, 2}, {3, 3}, {100, 7}, {257, 257}, {2, 300}}) {
        FractalParameters parameters = sized(columns, rows);
        parameters.amplitude = 250.0;
        const HeightMap map = make(parameters);
        ASSERT_EQ(map.heights.size(), std::size_t(columns * rows));
        const auto [low, high] = std::minmax_element(map.heights.begin(), map.heights.end());
        EXPECT_EQ(*low, 0.0f);
        EXPECT_EQ(*high, 250.0f);
    }
}

TEST(FractalSource, AnotherSeedGivesAnotherTerrain) {
    FractalParameters parameters = sized(65, 65);
    const HeightMap first = make(parameters);
    parameters.seed = 2;
    const HeightMap second = make(parameters);
    std::size_t equal = 0;
    for (std::size_t i = 0; i < first.heights.size(); ++i) equal += first.heights[i] == second.heights[i];
    EXPECT_LT(equal, first.heights.size() / 100);
}

TEST(FractalSource, RoughnessMakesRougher) {
    FractalParameters parameters = sized(257, 257);
    double previous = 0.0;
    for (double roughness : {0.3, 0.5, 0.7, 0.9}) {
        parameters.roughness = roughness;
        const double now = ruggedness(make(parameters));
        EXPECT_GT(now, 1.3 * previous) << roughness;
        previous = now;
    }
}

TEST(FractalSource, FilteringSmoothsTheMoreTheSmallerItsCoefficientAndTheMorePasses) {
    FractalParameters parameters = sized(257, 257);
    parameters.roughness = 0.7;
    const double none = ruggedness(make(parameters));
    parameters.filterPasses = 1;
    parameters.filterCoefficient = 0.9;
    const double weak = ruggedness(make(parameters));
    parameters.filterCoefficient = 0.6;
    const double strong = ruggedness(make(parameters));
    parameters.filterPasses = 3;
    const double stronger = ruggedness(make(parameters));
    EXPECT_LT(weak, none);
    EXPECT_LT(strong, weak);
    EXPECT_LT(stronger, strong);
    parameters.filterCoefficient = 1.0;
    EXPECT_EQ(ruggedness(make(parameters)), none);
}

TEST(FractalSource, FilterFollowsItsEquation) {
    FractalParameters parameters = sized(17, 17);
    parameters.seed = 3;
    HeightMap expected = make(parameters);
    const double k = 0.75;
    const auto run = [&](int column, int row, int dx, int dy) {
        for (int i = 1; i < 17; ++i) {
            const double neighbour = expected.at(column, row);
            column += dx;
            row += dy;
            float& height = expected.heights[std::size_t(row * 17 + column)];
            height = float(neighbour * (1 - k) + height * k);
        }
    };
    for (int row = 0; row < 17; ++row) run(0, row, 1, 0), run(16, row, -1, 0);
    for (int column = 0; column < 17; ++column) run(column, 0, 0, 1), run(column, 16, 0, -1);
    const auto [low, high] = std::minmax_element(expected.heights.begin(), expected.heights.end());
    const float lowest = *low, range = *high - *low;
    parameters.filterPasses = 1;
    parameters.filterCoefficient = k;
    const HeightMap filtered = make(parameters);
    for (std::size_t i = 0; i < filtered.heights.size(); ++i)
        EXPECT_NEAR(filtered.heights[i], (expected.heights[i] - lowest) / range, 1e-5);
}

TEST(FractalSource, ASourceHoldsTheMap) {
    const auto source = makeFractalSource(sized(33, 20));
    ASSERT_TRUE(source);
    EXPECT_EQ(source.value()->map()->heights, make(sized(33, 20)).heights);
}

TEST(FractalSource, BadParametersAreErrorsThatNameThem) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto problem = [](auto change) {
        FractalParameters parameters = sized(9, 9);
        change(parameters);
        const auto map = makeFractalMap(parameters);
        EXPECT_EQ(bool(map), bool(makeFractalSource(parameters)));
        return map ? std::string("no error") : map.error().message();
    };
    for (int size : {1, 0, -5, std::numeric_limits<int>::max()}) {
        EXPECT_NE(problem([&](auto& p) { p.columns = size; }).find("size"), std::string::npos) << size;
        EXPECT_NE(problem([&](auto& p) { p.rows = size; }).find("size"), std::string::npos) << size;
    }
    for (double value : {0.0, 1.0, -1.0, nan})
        EXPECT_NE(problem([&](auto& p) { p.roughness = value; }).find("roughness"), std::string::npos) << value;
    for (double value : {0.0, 1.1, -1.0, nan})
        EXPECT_NE(problem([&](auto& p) { p.filterCoefficient = value; }).find("filter coefficient"), std::string::npos) << value;
    for (double value : {0.0, -1.0, 1e39, nan})
        EXPECT_NE(problem([&](auto& p) { p.amplitude = value; }).find("amplitude"), std::string::npos) << value;
    EXPECT_NE(problem([](auto& p) { p.filterPasses = -1; }).find("filter passes"), std::string::npos);
}
