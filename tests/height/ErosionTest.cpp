#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include "height/Erosion.h"
#include "height/FractalSource.h"

using namespace terrain;

namespace {

HeightMap fractal(double amplitude = 60.0) {
    FractalParameters parameters;
    parameters.columns = parameters.rows = 129;
    parameters.amplitude = amplitude;
    parameters.seed = 5;
    return makeFractalMap(parameters).value();
}

HeightMap flat(int columns, int rows, float height) {
    HeightMap map;
    map.columns = columns;
    map.rows = rows;
    map.heights.assign(std::size_t(columns) * std::size_t(rows), height);
    return map;
}

double volume(const HeightMap& map) {
    return std::accumulate(map.heights.begin(), map.heights.end(), 0.0);
}

double steepest(const HeightMap& map) {
    double result = 0.0;
    for (int row = 0; row < map.rows; ++row)
        for (int column = 1; column < map.columns; ++column)
            result = std::max(result, std::abs(double(map.at(column, row)) - map.at(column - 1, row)) / map.spacing.x);
    return result;
}

/// Inner samples without a lower neighbour: where water would stand.
int pits(const HeightMap& map) {
    int count = 0;
    for (int row = 1; row < map.rows - 1; ++row)
        for (int column = 1; column < map.columns - 1; ++column) {
            bool pit = true;
            for (int y = -1; y <= 1; ++y)
                for (int x = -1; x <= 1; ++x) pit = pit && map.at(column + x, row + y) >= map.at(column, row);
            count += pit;
        }
    return count;
}

bool allFinite(const HeightMap& map) {
    return std::all_of(map.heights.begin(), map.heights.end(), [](float height) { return std::isfinite(height); });
}

}  // namespace

TEST(Erosion, RiversLeadAlmostAllWaterToTheBorder) {
    HeightMap map = fractal();
    const int before = pits(map);
    RiverParameters parameters;
    parameters.creep = 0.5;
    const auto eroded = erodeByRivers(map, flat(129, 129, 1.0f), parameters);
    ASSERT_TRUE(eroded) << eroded.error().message();
    EXPECT_TRUE(allFinite(eroded.value()));
    EXPECT_LT(pits(eroded.value()), before / 10);
}

TEST(Erosion, RiversBalanceUpliftInALongValley) {
    // A strip one sample wide between two borders, steep banks aside, comes to rest: the slope law is U = K sqrt(A) S.
    RiverParameters parameters;
    parameters.steps = 3000;
    parameters.creep = 0.0;
    parameters.uplift = 0.01;
    parameters.erosion = 0.1;
    const HeightMap start = flat(33, 3, 0.0f);
    const auto once = erodeByRivers(start, flat(33, 3, 1.0f), parameters);
    parameters.steps = 3100;
    const auto later = erodeByRivers(start, flat(33, 3, 1.0f), parameters);
    ASSERT_TRUE(once && later);
    // Every sample lies beside the border and drains nothing but itself: S = U / K = 0.1, over a distance of 1 or of a diagonal.
    for (int column = 2; column < 31; ++column) {
        EXPECT_GE(later.value().at(column, 1), 0.0999f);
        EXPECT_LE(later.value().at(column, 1), 0.1415f);
    }
}

TEST(Erosion, TheBorderDoesNotRise) {
    const HeightMap map = fractal();
    const auto eroded = erodeByRivers(map, flat(129, 129, 1.0f), {});
    ASSERT_TRUE(eroded);
    for (int i = 0; i < 129; ++i) {
        EXPECT_LE(eroded.value().at(i, 0), map.at(i, 0));
        EXPECT_LE(eroded.value().at(128, i), map.at(128, i));
    }
}

TEST(Erosion, DropletsCarryMaterialDownhillAndLoseNoneInABasin) {
    HeightMap basin = flat(129, 129, 0.0f);
    const auto distance = [](std::size_t i) { return std::hypot(double(i % 129) - 64.0, double(i / 129) - 64.0); };
    for (std::size_t i = 0; i < basin.heights.size(); ++i) basin.heights[i] = float(0.01 * distance(i) * distance(i));
    DropletParameters parameters;
    parameters.droplets = 5000;
    parameters.lifetime = 200;
    const auto eroded = erodeByDroplets(basin, parameters);
    ASSERT_TRUE(eroded);
    EXPECT_TRUE(allFinite(eroded.value()));
    double flank = 0.0, bottom = 0.0;
    for (std::size_t i = 0; i < basin.heights.size(); ++i)
        (distance(i) > 30.0 ? flank : bottom) += double(eroded.value().heights[i]) - basin.heights[i];
    EXPECT_LT(flank, -100.0);
    EXPECT_GT(bottom, 100.0);
    EXPECT_NEAR(volume(eroded.value()), volume(basin), 0.01 * bottom);
}

TEST(Erosion, DropletsAreTheSameForTheSameSeed) {
    DropletParameters parameters;
    parameters.droplets = 500;
    const auto first = erodeByDroplets(fractal(), parameters);
    EXPECT_EQ(first.value().heights, erodeByDroplets(fractal(), parameters).value().heights);
    parameters.seed = 2;
    EXPECT_NE(first.value().heights, erodeByDroplets(fractal(), parameters).value().heights);
}

TEST(Erosion, SlidingBringsSlopesDownToTheTalusAndKeepsTheVolume) {
    HeightMap map = flat(65, 65, 0.0f);
    map.heights[32 * 65 + 32] = 100.0f;
    ThermalParameters parameters;
    parameters.iterations = 2000;
    const auto slid = erodeThermally(map, parameters);
    ASSERT_TRUE(slid);
    EXPECT_NEAR(volume(slid.value()), 100.0, 0.01);
    EXPECT_GT(steepest(map), 50.0);
    EXPECT_LT(steepest(slid.value()), 0.85);
}

TEST(Erosion, GentleSlopesDoNotSlide) {
    HeightMap map = flat(20, 20, 0.0f);
    for (std::size_t i = 0; i < map.heights.size(); ++i) map.heights[i] = 0.5f * float(i % 20);
    EXPECT_EQ(erodeThermally(map, {}).value().heights, map.heights);
}

TEST(Erosion, HolesStayAndDoNotSpread) {
    HeightMap map = fractal();
    constexpr float hole = std::numeric_limits<float>::quiet_NaN();
    for (int i : {0, 64 * 129 + 64, 64 * 129 + 65, 30 * 129 + 5}) map.heights[std::size_t(i)] = hole;
    const auto holes = [](const Result<HeightMap>& result) {
        return std::count_if(result.value().heights.begin(), result.value().heights.end(), [](float h) { return std::isnan(h); });
    };
    DropletParameters droplets;
    droplets.droplets = 5000;
    EXPECT_EQ(holes(erodeByRivers(map, flat(129, 129, 1.0f), {})), 4);
    EXPECT_EQ(holes(erodeByDroplets(map, droplets)), 4);
    EXPECT_EQ(holes(erodeThermally(map, {})), 4);
}

TEST(Erosion, SmallestMapsAreFine) {
    for (const auto& [columns, rows] : {std::pair{2, 2}, {2, 9}, {3, 3}}) {
        const HeightMap map = flat(columns, rows, 1.0f);
        EXPECT_TRUE(erodeByRivers(map, map, {}));
        EXPECT_TRUE(erodeByDroplets(map, {.droplets = 10}));
        EXPECT_TRUE(erodeThermally(map, {}));
    }
}

TEST(Erosion, BadParametersAndSizesAreErrors) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const HeightMap map = flat(4, 4, 1.0f);
    EXPECT_FALSE(erodeByRivers(map, flat(4, 5, 1.0f), {}));
    EXPECT_FALSE(erodeByRivers(map, map, {.steps = -1}));
    EXPECT_FALSE(erodeByRivers(map, map, {.erosion = nan}));
    EXPECT_FALSE(erodeByRivers(map, map, {.creep = -1.0}));
    EXPECT_FALSE(erodeByDroplets(map, {.droplets = -1}));
    EXPECT_FALSE(erodeByDroplets(map, {.radius = 1000}));
    EXPECT_FALSE(erodeThermally(map, {.rate = 2.0}));
    EXPECT_FALSE(erodeThermally(flat(1, 4, 0.0f), {}));
    HeightMap wrong = map;
    wrong.heights.pop_back();
    EXPECT_FALSE(erodeThermally(wrong, {}));
    EXPECT_FALSE(erodeByDroplets(HeightMap{}, {}));
}
