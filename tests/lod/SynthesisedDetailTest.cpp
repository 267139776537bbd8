#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "lod/BoxPyramid.h"
#include "lod/BruteForceMesh.h"
#include "lod/RayCast.h"
#include "lod/SynthesisedDetail.h"

#include "Maps.h"
#include "Views.h"

using namespace terrain;
using namespace terrain::test;

namespace {

std::vector<float> filled(const SynthesisedDetail& detail, const SampleGrid& grid, int level, const ClipRect& rect)
{
    std::vector<float> heights(std::size_t(rect.samples()));
    detail.fill(grid, level, rect, heights.data());
    return heights;
}

ClipRect whole(const SampleGrid& grid, int level)
{
    return {glm::ivec2(0), SynthesisedDetail::lastVertex(grid, level)};
}

bool sameBits(float a, float b)
{
    return std::memcmp(&a, &b, sizeof a) == 0 || (std::isnan(a) && std::isnan(b));
}

float largestStep(const SampleGrid& grid)
{
    float step = 0.0f;
    const auto include = [&](float a, float b) {
        if (std::isfinite(a - b)) step = std::max(step, std::fabs(a - b));
    };
    for (int y = 0; y < grid.rows(); ++y)
        for (int x = 0; x < grid.columns(); ++x) {
            if (x > 0) include(grid.height(x, y), grid.height(x - 1, y));
            if (y > 0) include(grid.height(x, y), grid.height(x, y - 1));
        }
    return step;
}

std::vector<Terrain> regularTerrains()
{
    std::vector<Terrain> terrains = smallTerrains();
    std::erase_if(terrains, [](const Terrain& t) { return !t.grid().isRegular(); });
    return terrains;
}

class DetailOf : public testing::TestWithParam<Terrain> {
protected:
    const SampleGrid grid = GetParam().grid();
    std::mt19937 random{17};
};

}  // namespace

TEST_P(DetailOf, KeepsTheVerticesOfTheLevelBefore)
{
    const SynthesisedDetail detail(grid, {4, 0.5f, 3});
    std::vector<float> before = filled(detail, grid, 0, whole(grid, 0));
    for (int y = 0; y < grid.rows(); ++y)
        for (int x = 0; x < grid.columns(); ++x)
            ASSERT_TRUE(grid.isHole(x, y) ? std::isnan(before[grid.index(x, y)]) : before[grid.index(x, y)] == grid.height(x, y));
    for (int level = 1; level <= 4; ++level) {
        const ClipRect all = whole(grid, level);
        const std::vector<float> heights = filled(detail, grid, level, all);
        const std::size_t columns = std::size_t(all.columns()), coarse = (columns + 1) / 2;
        for (std::size_t y = 0; y < std::size_t(all.rows()); y += 2)
            for (std::size_t x = 0; x < columns; x += 2)
                ASSERT_TRUE(sameBits(heights[y * columns + x], before[y / 2 * coarse + x / 2]));
        before = heights;
    }
}

TEST_P(DetailOf, IsTheSameHoweverItIsCut)
{
    const SynthesisedDetail detail(grid, {5, 0.0f, 9});
    for (int level = 0; level <= 5; ++level) {
        const ClipRect all = whole(grid, level);
        const std::vector<float> heights = filled(detail, grid, level, all);
        for (int i = 0; i < 60; ++i) {
            ClipRect part;
            for (int axis = 0; axis < 2; ++axis) {
                // Also beyond the grid, where the nearest vertex stands in.
                const int last = all.high[axis];
                part.low[axis] = uniformInt(random, -5, last + 3);
                part.high[axis] = part.low[axis] + uniformInt(random, 0, i % 3 ? 12 : 70);
            }
            const std::vector<float> cut = filled(detail, grid, level, part);
            std::size_t at = 0;
            for (int y = part.low.y; y <= part.high.y; ++y)
                for (int x = part.low.x; x <= part.high.x; ++x, ++at) {
                    const glm::ivec2 v = glm::clamp(glm::ivec2(x, y), glm::ivec2(0), all.high);
                    ASSERT_TRUE(sameBits(cut[at], heights[std::size_t(v.y) * std::size_t(all.columns()) + std::size_t(v.x)]))
                        << "level " << level << ", " << x << ", " << y;
                }
        }
    }
}

TEST_P(DetailOf, HasHolesJustWhereCellsOfSamplesHaveOne)
{
    const SynthesisedDetail detail(grid, {3, 1.0f, 1});
    for (int row = 0; row < grid.rows() - 1; ++row)
        for (int column = 0; column < grid.columns() - 1; ++column) {
            const bool hole = isCellHole(grid, column, row);
            for (const int level : {1, 3}) {
                const int cells = 1 << level;
                const ClipRect rect{glm::ivec2(column, row) * cells, glm::ivec2(column + 1, row + 1) * cells};
                const std::vector<float> heights = filled(detail, grid, level, rect);
                for (int y = 0; y < cells; ++y)
                    for (int x = 0; x < cells; ++x) {
                        const std::size_t at = std::size_t(y * (cells + 1) + x), up = at + std::size_t(cells) + 1;
                        ASSERT_EQ(std::isnan(heights[at] + heights[at + 1] + heights[up] + heights[up + 1]), hole);
                    }
            }
        }
}

TEST_P(DetailOf, StaysWithinItsBoundOfTheSurfaceOfTheSamples)
{
    const float step = largestStep(grid);
    const bool holes = BoxPyramid(grid).hasHoles();
    for (const float amplitude : {0.0f, 2.0f, -1.0f})
        for (const int levels : {1, 2, 5}) {
            const SynthesisedDetail detail(grid, {levels, amplitude, 77});
            const float bound = detail.largest(step, holes) + 1e-4f;
            const ClipRect all = whole(grid, levels);
            const std::vector<float> heights = filled(detail, grid, levels, all);
            std::size_t at = 0;
            for (int y = 0; y <= all.high.y; ++y)
                for (int x = 0; x <= all.high.x; ++x, ++at) {
                    const auto surface = surfaceAt(grid, {std::ldexp(x, -levels), std::ldexp(y, -levels)});
                    if (!surface || std::isnan(heights[at])) continue;
                    ASSERT_LE(std::fabs(heights[at] - surface->height), bound) << levels << " levels, " << x << ", " << y;
                }
        }
}

TEST_P(DetailOf, LeavesACellsHeightsByNoMoreThanItsOvershoot)
{
    const int levels = 4;
    for (const float amplitude : {0.0f, -1.0f}) {
        const SynthesisedDetail detail(grid, {levels, amplitude, 78});
        for (int level = 0; level < levels; ++level) {
            const ClipRect all = whole(grid, level);
            for (int i = 0; i < 200; ++i) {
                const glm::ivec2 cell(uniformInt(random, 0, all.high.x - 1), uniformInt(random, 0, all.high.y - 1));
                const ClipRect around = ClipRect{cell - 2, cell + 3}.cutTo(all);
                HeightMap map{around.columns(), around.rows(), filled(detail, grid, level, around), {}, {1.0, 1.0}, {}};
                const bool holes = std::any_of(map.heights.begin(), map.heights.end(), [](float h) { return std::isnan(h); });
                const float room = detail.overshoot(level, largestStep(SampleGrid(map)), holes) + 1e-4f;
                const std::vector<float> corners = filled(detail, grid, level, {cell, cell + 1});
                const auto [low, high] = std::minmax_element(corners.begin(), corners.end());
                if (std::isnan(corners[0] + corners[1] + corners[2] + corners[3])) continue;
                const int cells = 1 << (levels - level);
                for (const float height : filled(detail, grid, levels, {cell * cells, (cell + 1) * cells})) {
                    ASSERT_GE(height, *low - room);
                    ASSERT_LE(height, *high + room);
                }
            }
        }
    }
}

TEST_P(DetailOf, HasTheHeightsOfItsFinestTriangles)
{
    const SynthesisedDetail detail(grid, {2, 1.0f, 4});
    const ClipRect all = whole(grid, 2);
    const HeightMap map{all.columns(), all.rows(), filled(detail, grid, 2, all), {}, {1.0, 1.0}, {}};
    for (int i = 0; i < 500; ++i) {
        const glm::dvec2 p(uniform(random, -0.5, grid.columns() - 0.5), uniform(random, -0.5, grid.rows() - 0.5));
        const auto expected = surfaceAt(SampleGrid(map), p * 4.0);
        const float height = detail.height(grid, p.x, p.y);
        ASSERT_EQ(std::isnan(height), !expected.has_value()) << p.x << ", " << p.y;
        if (expected) {
            ASSERT_EQ(height, expected->height);
        }
    }
}

TEST_P(DetailOf, WithoutLevelsIsTheSamplesSurface)
{
    const SynthesisedDetail none(grid, {0, 1.0f, 4});
    EXPECT_EQ(none.largest(100.0f), 0.0f);
    for (int i = 0; i < 300; ++i) {
        const glm::dvec2 p(uniform(random, 0.0, grid.columns() - 1), uniform(random, 0.0, grid.rows() - 1));
        const auto surface = surfaceAt(grid, p);
        const float height = none.height(grid, p.x, p.y);
        ASSERT_TRUE(surface ? sameBits(height, surface->height) : std::isnan(height));
    }
}

INSTANTIATE_TEST_SUITE_P(Terrains, DetailOf, testing::ValuesIn(regularTerrains()),
                         [](const testing::TestParamInfo<Terrain>& info) { return info.param.name; });

TEST(SynthesisedDetail, RowsGrowAndBendByNoMoreThanTheBoundsConstants)
{
    // Rows of up to nine samples have all ends that a cell can feel, on both sides.
    double gain = 0.0, bend = 0.0;
    constexpr int levels = 8, cells = 1 << levels;
    for (int samples = 2; samples <= 9; ++samples) {
        std::vector<std::vector<float>> weight;
        for (int i = 0; i < samples; ++i) {
            const HeightMap map = mapOf(samples, 2, [i](int column, int) { return column == i ? 1.0f : 0.0f; });
            const SampleGrid grid(map);
            const SynthesisedDetail detail(grid, {levels, -1.0f, 0});
            weight.push_back(filled(detail, grid, levels, {{0, 0}, {(samples - 1) * cells, 0}}));
        }
        for (int x = 0; x <= (samples - 1) * cells; ++x) {
            // Of sum (w_i - linear_i) f_i, by the differences of f.
            double sum = 0.0, partial = 0.0, differences = 0.0;
            for (int i = 0; i < samples; ++i) {
                const double w = double(weight[std::size_t(i)][std::size_t(x)]);
                sum += std::fabs(w);
                partial += w - std::max(0.0, 1.0 - std::fabs(double(x) / cells - i));
                differences += std::fabs(partial);
            }
            gain = std::max(gain, sum);
            bend = std::max(bend, differences);
        }
    }
    EXPECT_LE(gain, double(SynthesisedDetail::kGain));
    EXPECT_GE(gain, 0.999 * double(SynthesisedDetail::kGain));
    EXPECT_LE(bend, double(SynthesisedDetail::kBend));
    EXPECT_GE(bend, 0.999 * double(SynthesisedDetail::kBend));
}

TEST(SynthesisedDetail, BoundsAreNotMuchLargerThanNeeded)
{
    // A chessboard of hills is the worst that steps allow.
    const HeightMap map = mapOf(17, 17, [](int column, int row) { return float((column + row) % 2); });
    const SampleGrid grid(map);
    const SynthesisedDetail detail(grid, {3, -1.0f, 0});
    float deviation = 0.0f;
    for (int y = 0; y <= 128; ++y)
        for (int x = 0; x <= 128; ++x) {
            const float height = detail.height(grid, x / 8.0, y / 8.0);
            deviation = std::max(deviation, std::fabs(height - surfaceAt(grid, {x / 8.0, y / 8.0})->height));
        }
    EXPECT_LE(deviation, detail.largest(1.0f, false));
    EXPECT_GE(deviation, 0.5f * detail.largest(1.0f, false));
    EXPECT_LT(detail.largest(1.0f, false), detail.largest(1.0f));
}

TEST(SynthesisedDetail, WithoutNoiseIsTheFourPointSubdivision)
{
    // Which reproduces cubics, away from the border.
    const HeightMap map = mapOf(24, 20, [](int column, int row) {
        const double x = column / 8.0 - 1.0, y = row / 8.0 - 1.0;
        return float((x * x * x - x + 2.0) * (2.0 * y * y * y + y * y - 1.0));
    });
    const SampleGrid grid(map);
    const SynthesisedDetail detail(grid, {1, -1.0f, 0});
    for (int y = 3; y < 36; ++y)
        for (int x = 3; x < 44; ++x) {
            const double u = x / 16.0 - 1.0, v = y / 16.0 - 1.0;
            float height;
            detail.fill(grid, 1, {{x, y}, {x, y}}, &height);
            ASSERT_NEAR(height, (u * u * u - u + 2.0) * (2.0 * v * v * v + v * v - 1.0), 1e-5) << x << ", " << y;
        }
}

TEST(SynthesisedDetail, IsTheSameWithTheSameSeedAndOtherWithAnother)
{
    const Terrain terrain = fractal(40, 23);
    const SampleGrid grid = terrain.grid();
    const ClipRect all = whole(grid, 3);
    const std::vector<float> first = filled(SynthesisedDetail(grid, {3, 1.0f, 6}), grid, 3, all);
    EXPECT_EQ(first, filled(SynthesisedDetail(grid, {3, 1.0f, 6}), grid, 3, all));
    const std::vector<float> other = filled(SynthesisedDetail(grid, {3, 1.0f, 7}), grid, 3, all);
    std::size_t same = 0;
    for (std::size_t i = 0; i < first.size(); ++i) same += first[i] == other[i];
    // The samples, and a few whose noise happens to be the same.
    EXPECT_LT(same, std::size_t(grid.columns() * grid.rows()) + first.size() / 50);
}

TEST(SynthesisedDetail, KeepsCoarserLevelsWhenFinerOnesAreAdded)
{
    const Terrain terrain = fractal(40, 23);
    const SampleGrid grid = terrain.grid();
    EXPECT_EQ(filled(SynthesisedDetail(grid, {2, 0.0f, 6}), grid, 2, whole(grid, 2)),
              filled(SynthesisedDetail(grid, {6, 0.0f, 6}), grid, 2, whole(grid, 2)));
}

TEST(SynthesisedDetail, NoiseIsGaussianAndWithoutPattern)
{
    const Terrain terrain = flat(33);
    const float amplitude = 3.0f;
    const SynthesisedDetail detail(terrain.grid(), {8, amplitude, 12345});
    for (const int level : {1, 2, 8}) {
        constexpr int side = 400;
        std::vector<double> noise;
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) noise.push_back(std::ldexp(double(detail.noise({x, y}, level)), level - 1) / amplitude);
        const double count = double(noise.size());
        double mean = 0.0, variance = 0.0, skewness = 0.0, kurtosis = 0.0, within = 0.0;
        for (const double n : noise) mean += n / count;
        for (const double n : noise) {
            const double d = n - mean;
            variance += d * d / count;
            skewness += d * d * d / count;
            kurtosis += d * d * d * d / count;
            within += std::fabs(d) < 1.0 ? 1.0 / count : 0.0;
        }
        // Four standard errors, and what the table lacks of the distribution's tails.
        EXPECT_NEAR(mean, 0.0, 4.0 / std::sqrt(count));
        EXPECT_NEAR(variance, 1.0, 4.0 * std::sqrt(2.0 / count));
        EXPECT_NEAR(skewness, 0.0, 4.0 * std::sqrt(6.0 / count));
        EXPECT_NEAR(kurtosis, 3.0, 4.0 * std::sqrt(24.0 / count) + 0.05);
        EXPECT_NEAR(within, 0.6827, 0.006);
        // Neighbours near and far, along both axes and across levels, know nothing of each other.
        constexpr int steps[][2] = {{1, 0}, {0, 1}, {1, 1}, {2, 0}, {0, 2}, {64, 0}, {0, 128}};
        for (const auto& [right, up] : steps) {
            double product = 0.0, pairs = 0.0;
            for (int y = 0; y + up < side; ++y)
                for (int x = 0; x + right < side; ++x, ++pairs)
                    product += noise[std::size_t(y * side + x)] * noise[std::size_t((y + up) * side + x + right)];
            EXPECT_NEAR(product / pairs, 0.0, 4.5 / std::sqrt(pairs)) << "level " << level << ", step " << right << ", " << up;
        }
    }
    double product = 0.0;
    for (int i = 0; i < 100000; ++i) {
        const glm::ivec2 vertex(i % 317, i / 317);
        product += double(detail.noise(vertex, 1)) * double(detail.noise(vertex, 2));
    }
    EXPECT_NEAR(product / 100000 / (amplitude * amplitude * 0.5), 0.0, 4.5 / std::sqrt(1e5));
}

TEST(SynthesisedDetail, HalvesItsNoiseFromLevelToLevel)
{
    const Terrain terrain = flat(65);
    const SampleGrid grid = terrain.grid();
    const SynthesisedDetail detail(grid, {3, 1.0f, 5});
    for (int level = 1; level <= 3; ++level) {
        const SynthesisedDetail without(grid, {3, -1.0f, 5});
        const ClipRect all = whole(grid, level);
        const ClipRect coarser = whole(grid, level - 1);
        const std::vector<float> before = filled(detail, grid, level - 1, coarser);
        std::vector<float> plain(std::size_t(all.samples()));
        without.refine(grid, level, all, coarser, before.data(), plain.data());
        const std::vector<float> heights = filled(detail, grid, level, all);
        double squares = 0.0, count = 0.0;
        for (int y = 0; y <= all.high.y; ++y)
            for (int x = 0; x <= all.high.x; ++x)
                if (x % 2 || y % 2) {
                    const std::size_t at = std::size_t(y) * std::size_t(all.columns()) + std::size_t(x);
                    squares += double(heights[at] - plain[at]) * double(heights[at] - plain[at]);
                    ++count;
                }
        EXPECT_NEAR(std::sqrt(squares / count), std::ldexp(1.0, 1 - level), 0.03 * std::ldexp(1.0, 1 - level)) << "level " << level;
    }
}

TEST(SynthesisedDetail, TakesItsAmplitudeFromTheRoughnessOfTheData)
{
    // Of a ramp nothing is left; of a level of its own detail twice what the next one has.
    EXPECT_NEAR(detailAmplitudeOf(ramp(33).grid()), 0.0f, 1e-6f);
    const Terrain smooth = ramp(257);
    const SynthesisedDetail known(smooth.grid(), {1, 0.8f, 3});
    const ClipRect all = whole(smooth.grid(), 1);
    const HeightMap map{all.columns(), all.rows(), filled(known, smooth.grid(), 1, all), {}, {1.0, 1.0}, {}};
    EXPECT_NEAR(detailAmplitudeOf(SampleGrid(map)), 0.4f, 0.01f);
    EXPECT_EQ(SynthesisedDetail(SampleGrid(map), {1, 0.0f, 3}).amplitude(), detailAmplitudeOf(SampleGrid(map)));
    EXPECT_EQ(SynthesisedDetail(SampleGrid(map), {1, 0.3f, 3}).amplitude(), 0.3f);
    EXPECT_EQ(SynthesisedDetail(SampleGrid(map), {1, -0.3f, 3}).amplitude(), 0.0f);
    EXPECT_EQ(SynthesisedDetail(SampleGrid(map), {1, kHole, 3}).amplitude(), detailAmplitudeOf(SampleGrid(map)));
}

TEST(SynthesisedDetail, TakesAsManyLevelsAsThereCanBe)
{
    const Terrain terrain = flat(33), sheet = wavySheet(33, 33, true);
    EXPECT_EQ(SynthesisedDetail(terrain.grid(), {100, 1.0f, 0}).levels(), ClipmapShape::kMostDetail);
    EXPECT_EQ(SynthesisedDetail(terrain.grid(), {-3, 1.0f, 0}).levels(), 0);
    EXPECT_EQ(SynthesisedDetail(sheet.grid(), {3, 1.0f, 0}).levels(), 0);
    // As ClipmapLayout: units are ints.
    const HeightMap longOne = mapOf(1 << 23, 2, [](int, int) { return 0.0f; });
    ClipmapShape shape;
    shape.detailLevels = 8;
    EXPECT_EQ(SynthesisedDetail(SampleGrid(longOne), {8, 1.0f, 0}).levels(), ClipmapLayout(1 << 23, 2, shape).detailLevels());
}
