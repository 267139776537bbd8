#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "lod/BruteForceMesh.h"
#include "lod/ClipmapErrors.h"
#include "lod/ClipmapSurface.h"

#include "Maps.h"
#include "Views.h"

using namespace terrain;
using namespace terrain::test;

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// The levels of a grid as their definition says, in double and cell by cell. Written apart from the classes under test.
class Reference {
public:
    explicit Reference(const SampleGrid& grid) : grid_(grid), last_(grid.columns() - 1, grid.rows() - 1) {}

    glm::ivec2 cells(int level) const
    {
        const int step = 1 << level;
        return {(last_.x + step - 1) / step, (last_.y + step - 1) / step};
    }
    glm::ivec2 place(int level, glm::ivec2 vertex) const { return glm::min(vertex * (1 << level), last_); }
    /// Of a regular grid heights alone differ.
    glm::dvec3 value(glm::ivec2 sample) const
    {
        const glm::dvec3 p(grid_.position(sample.x, sample.y));
        return grid_.isRegular() ? glm::dvec3(p[grid_.heightAxis()], 0.0, 0.0) : p;
    }
    bool isHole(glm::ivec2 sample) const { return grid_.isHole(sample.x, sample.y); }

    struct Corners {
        std::array<glm::ivec2, 4> vertex;
        std::array<double, 4> weight;
    };
    /// A sample in a cell of a level that covers it.
    Corners cornersAt(int level, glm::ivec2 cell, glm::ivec2 sample) const
    {
        const glm::ivec2 low = place(level, cell), high = place(level, cell + 1);
        const glm::dvec2 t = glm::dvec2(sample - low) / glm::dvec2(high - low);
        Corners corners{{cell, cell + glm::ivec2(1, 0), cell + glm::ivec2(0, 1), cell + 1}, {}};
        if (t.x + t.y <= 1.0)
            corners.weight = {1.0 - t.x - t.y, t.x, t.y, 0.0};
        else
            corners.weight = {0.0, 1.0 - t.y, 1.0 - t.x, t.x + t.y - 1.0};
        return corners;
    }
    glm::dvec3 surface(int level, glm::ivec2 cell, glm::ivec2 sample) const
    {
        const Corners corners = cornersAt(level, cell, sample);
        glm::dvec3 sum(0.0);
        for (std::size_t i = 0; i < 4; ++i)
            if (corners.weight[i] > 1e-12) sum += corners.weight[i] * value(place(level, corners.vertex[i]));
        return sum;
    }
    /// What a vertex may be drawn away from its own place.
    glm::dvec3 difference(int level, glm::ivec2 vertex) const
    {
        const glm::ivec2 sample = place(level, vertex), own = cells(level + 1);
        const glm::ivec2 cell = glm::min(vertex / 2, own - 1);
        const glm::dvec3 off = surface(level + 1, cell, sample) - value(sample);
        return std::isfinite(off.x + off.y + off.z) ? off : glm::dvec3(0.0);
    }
    bool isDrawn(int level, glm::ivec2 cell) const
    {
        for (int i = 0; i < 4; ++i)
            if (isHole(place(level, cell + glm::ivec2(i % 2, i / 2)))) return false;
        return true;
    }
    template <class Visit>
    void forSamples(int level, glm::ivec2 cell, const Visit& visit) const
    {
        const glm::ivec2 low = place(level, cell), high = place(level, cell + 1);
        for (int row = low.y; row <= high.y; ++row)
            for (int column = low.x; column <= high.x; ++column) visit(glm::ivec2(column, row));
    }

    double cellError(int level, bool blending, glm::ivec2 cell) const
    {
        const glm::ivec2 low = place(level, cell), high = place(level, cell + 1);
        bool missing = false, there = false;
        for (int row = low.y; row < high.y; ++row)
            for (int column = low.x; column < high.x; ++column) (isCellHole(grid_, column, row) ? missing : there) = true;
        const bool drawn = isDrawn(level, cell);
        if (level > 0 && (drawn ? missing : there)) return kNever;
        double largest = 0.0;
        if (drawn)
            forSamples(level, cell, [&](glm::ivec2 sample) {
                const Corners corners = cornersAt(level, cell, sample);
                const glm::dvec3 off = surface(level, cell, sample) - value(sample);
                double up = 0.0, down = 0.0, length = 0.0;
                for (std::size_t i = 0; i < 4 && blending; ++i) {
                    const glm::dvec3 difference = this->difference(level, corners.vertex[i]);
                    up += corners.weight[i] * std::max(0.0, difference.x);
                    down += corners.weight[i] * std::min(0.0, difference.x);
                    length += corners.weight[i] * glm::length(difference);
                }
                largest = std::max(largest, grid_.isRegular() ? std::max(std::fabs(off.x + up), std::fabs(off.x + down)) : glm::length(off) + length);
            });
        return largest;
    }

private:
    const SampleGrid& grid_;
    glm::ivec2 last_;
};

/// With points on a regular grid, heights along y.
Terrain pointsWithHeightsAlongY(int columns, int rows)
{
    const HeightMap map = fractalMap(columns, rows, 7);
    return curved("PointsWithHeightsAlongY", columns, rows,
                  [&map](int column, int row) { return glm::vec3(2.0f * float(column), map.at(column, row), -1.5f * float(row)); });
}

std::vector<Terrain> clipmapTerrains()
{
    std::vector<Terrain> all = smallTerrains();
    all.push_back(fractal(100, 37));
    all.push_back(fractal(65, 66));
    all.push_back(fractal(131, 18));
    all.push_back(pointsWithHeightsAlongY(45, 30));
    all.push_back({"CornerOfHoles", punched(fractalMap(70, 70, 8), [](int column, int row) { return column < 36 && row < 40; }), {}});
    return all;
}

class ClipmapErrorsOver : public testing::TestWithParam<Terrain> {
protected:
    static constexpr int kLevels = 6;
    const SampleGrid grid = GetParam().grid();
    const Reference reference{grid};
    const ClipmapErrors errors{grid, kLevels};
    const double rounding = 3e-6 * largestValue();

    double largestValue() const
    {
        const Box box = GetParam().box();
        const glm::vec3 reach = glm::abs(box.centre) + box.half;
        return grid.isRegular() ? reach[grid.heightAxis()] : glm::length(reach);
    }
};

}  // namespace

TEST_P(ClipmapErrorsOver, CoarserHeightsAreThoseOfTheCoarserSurface)
{
    for (int level = 0; level <= kLevels; ++level) {
        const glm::ivec2 last = reference.cells(level);
        for (int row = -2; row <= last.y + 2; ++row)
            for (int column = -2; column <= last.x + 2; ++column) {
                const glm::ivec2 nearest = glm::clamp(glm::ivec2(column, row), glm::ivec2(0), last), sample = reference.place(level, nearest);
                const glm::vec3 fine = levelPosition(grid, level, {column, row}), coarse = coarserPosition(grid, level, {column, row});
                const glm::vec3 own = grid.position(sample.x, sample.y);
                if (reference.isHole(sample)) {
                    EXPECT_FALSE(std::isfinite(fine.x + fine.y + fine.z));
                    continue;
                }
                ASSERT_EQ(fine, own);
                const glm::dvec3 difference = reference.difference(level, nearest);
                if (!grid.isRegular()) {
                    ASSERT_LE(glm::length(glm::dvec3(coarse - fine) - difference), rounding) << level << ": " << column << ", " << row;
                    continue;
                }
                ASSERT_EQ(levelHeight(grid, level, {column, row}), fine[grid.heightAxis()]);
                ASSERT_EQ(coarserHeight(grid, level, {column, row}), coarse[grid.heightAxis()]);
                ASSERT_NEAR(coarserHeight(grid, level, {column, row}) - own[grid.heightAxis()], difference.x, rounding)
                    << level << ": " << column << ", " << row;
            }
    }
}

TEST_P(ClipmapErrorsOver, RectanglesAreFilledAsVertexByVertex)
{
    std::mt19937 random(3);
    const auto same = [](float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); };
    for (int i = 0; i < 60; ++i) {
        const int level = uniformInt(random, 0, kLevels);
        const glm::ivec2 last = reference.cells(level), low(uniformInt(random, -4, last.x + 2), uniformInt(random, -4, last.y + 2));
        const ClipRect rect{low, low + glm::ivec2(uniformInt(random, -1, 40), uniformInt(random, 0, 40))};
        std::vector<float> pairs(2 * std::size_t(rect.samples()) + 1, -77.0f);
        std::vector<glm::vec3> positions(2 * std::size_t(rect.samples()) + 1, glm::vec3(-77.0f));
        if (grid.isRegular()) fillLevel(grid, level, rect, pairs.data());
        fillLevel(grid, level, rect, positions.data());
        ASSERT_EQ(pairs.back(), -77.0f);
        ASSERT_EQ(positions.back(), glm::vec3(-77.0f));
        std::size_t at = 0;
        for (int row = rect.low.y; row <= rect.high.y; ++row)
            for (int column = rect.low.x; column <= rect.high.x; ++column, at += 2) {
                for (int axis = 0; axis < 3; ++axis) {
                    ASSERT_TRUE(same(positions[at][axis], levelPosition(grid, level, {column, row})[axis]));
                    ASSERT_TRUE(same(positions[at + 1][axis], coarserPosition(grid, level, {column, row})[axis]));
                }
                if (!grid.isRegular()) continue;
                ASSERT_TRUE(same(pairs[at], levelHeight(grid, level, {column, row}))) << level << ": " << column << ", " << row;
                ASSERT_TRUE(same(pairs[at + 1], coarserHeight(grid, level, {column, row}))) << level << ": " << column << ", " << row;
            }
    }
}

TEST_P(ClipmapErrorsOver, BlocksHaveTheErrorsOfTheirCells)
{
    for (int level = 0; level < kLevels; ++level) {
        const glm::ivec2 cells = reference.cells(level), blocks = errors.blocks(level, 0);
        ASSERT_EQ(blocks, (cells + ClipmapErrors::kBlockCells - 1) / ClipmapErrors::kBlockCells);
        for (const bool blending : {false, true}) {
            std::vector<double> expected(std::size_t(blocks.x) * std::size_t(blocks.y), 0.0);
            for (int row = 0; row < cells.y; ++row)
                for (int column = 0; column < cells.x; ++column) {
                    const int block = row / ClipmapErrors::kBlockCells * blocks.x + column / ClipmapErrors::kBlockCells;
                    double& largest = expected[std::size_t(block)];
                    largest = std::max(largest, reference.cellError(level, blending && level + 1 < kLevels, {column, row}));
                }
            for (int row = 0; row < blocks.y; ++row)
                for (int column = 0; column < blocks.x; ++column) {
                    const double want = expected[std::size_t(row * blocks.x + column)], found = errors.error(level, blending, 0, {column, row});
                    ASSERT_TRUE(want == found || std::fabs(want - found) <= rounding)
                        << "level " << level << (blending ? " blending" : " plain") << ", block " << column << ", " << row << ": " << found
                        << ", not " << want;
                }
        }
    }
}

TEST_P(ClipmapErrorsOver, NoMixtureOfTwoLevelsIsFurtherOffThanTheBlendingError)
{
    std::mt19937 random(5);
    for (int level = 0; level + 1 < kLevels; ++level) {
        const glm::ivec2 cells = reference.cells(level);
        for (int i = 0; i < 200; ++i) {
            const glm::ivec2 cell(uniformInt(random, 0, cells.x - 1), uniformInt(random, 0, cells.y - 1));
            if (!reference.isDrawn(level, cell)) continue;
            const double bound = errors.error(level, true, 0, cell / ClipmapErrors::kBlockCells);
            std::array<double, 4> shares;
            for (double& share : shares) share = std::clamp(uniform(random, -0.5, 1.5), 0.0, 1.0);
            reference.forSamples(level, cell, [&](glm::ivec2 sample) {
                if (reference.isHole(sample)) return;
                const Reference::Corners corners = reference.cornersAt(level, cell, sample);
                glm::dvec3 off = reference.surface(level, cell, sample) - reference.value(sample);
                for (std::size_t k = 0; k < 4; ++k) off += shares[k] * corners.weight[k] * reference.difference(level, corners.vertex[k]);
                ASSERT_LE(glm::length(off), bound + rounding) << "level " << level << ", cell " << cell.x << ", " << cell.y;
            });
        }
    }
}

TEST_P(ClipmapErrorsOver, LayersHoldTheMaximaOfThoseBelow)
{
    for (int level = 0; level < kLevels; ++level) {
        ASSERT_EQ(errors.blocks(level, errors.layers(level) - 1), glm::ivec2(1));
        for (int layer = 1; layer < errors.layers(level); ++layer) {
            const glm::ivec2 fine = errors.blocks(level, layer - 1), coarse = errors.blocks(level, layer);
            ASSERT_EQ(coarse, (fine + 1) / 2);
            for (const bool blending : {false, true})
                for (int row = 0; row < coarse.y; ++row)
                    for (int column = 0; column < coarse.x; ++column) {
                        float largest = 0.0f;
                        for (int y = 2 * row; y < std::min(2 * row + 2, fine.y); ++y)
                            for (int x = 2 * column; x < std::min(2 * column + 2, fine.x); ++x)
                                largest = std::max(largest, errors.error(level, blending, layer - 1, {x, y}));
                        ASSERT_EQ(errors.error(level, blending, layer, {column, row}), largest);
                    }
        }
    }
}

namespace {

/// A part of a level as it may be drawn, seen from somewhere.
struct Shot {
    View view;
    int level;
    bool blending;
    ClipRect region, hole;
};

Shot randomShot(std::mt19937& random, const Reference& reference, const Box& box, int levels)
{
    Shot shot{randomView(random, box), uniformInt(random, 0, levels - 1), uniformInt(random, 0, 1) == 1, {}, {}};
    const glm::ivec2 last = reference.cells(shot.level);
    const auto rectangle = [&] {
        const glm::ivec2 low(uniformInt(random, -3, last.x - 1), uniformInt(random, -3, last.y - 1));
        return ClipRect{low, low + glm::ivec2(uniformInt(random, 1, last.x + 3), uniformInt(random, 1, last.y + 3))};
    };
    shot.region = rectangle();
    if (uniformInt(random, 0, 2) > 0) shot.hole = rectangle();
    return shot;
}

/// Largest distance on the screen of a sample from where it may be drawn, each vertex having a random share of the coarser level.
double worstDistance(const SampleGrid& grid, const Reference& reference, const Shot& shot, std::mt19937& random)
{
    const glm::ivec2 cells = reference.cells(shot.level);
    std::vector<double> shares;
    for (int i = 0; i < (cells.x + 1) * (cells.y + 1); ++i) shares.push_back(shot.blending ? std::clamp(uniform(random, -0.5, 1.5), 0.0, 1.0) : 0.0);
    double worst = 0.0;
    const auto look = [&](glm::ivec2 cell, bool drawn, glm::ivec2 sample) {
        if (reference.isHole(sample)) return;
        const glm::dvec3 place(grid.position(sample.x, sample.y));
        const Projected wanted = project(shot.view, place);
        if (!wanted.inView) return;
        const Reference::Corners corners = reference.cornersAt(shot.level, cell, sample);
        glm::dvec3 off = reference.surface(shot.level, cell, sample) - reference.value(sample);
        for (std::size_t k = 0; k < 4 && shot.blending; ++k)
            off += shares[std::size_t(corners.vertex[k].y * (cells.x + 1) + corners.vertex[k].x)] * corners.weight[k] *
                   reference.difference(shot.level, corners.vertex[k]);
        glm::dvec3 axis(0.0);
        axis[grid.heightAxis()] = off.x;
        const Projected found = project(shot.view, place + (grid.isRegular() ? axis : off));
        worst = std::max(worst, drawn && found.w > 0.0 ? glm::length(found.pixel - wanted.pixel) : kNever);
    };
    for (int row = std::max(shot.region.low.y, 0); row < std::min(shot.region.high.y, cells.y); ++row)
        for (int column = std::max(shot.region.low.x, 0); column < std::min(shot.region.high.x, cells.x); ++column) {
            const glm::ivec2 cell(column, row);
            if (shot.hole.contains(ClipRect{cell, cell + 1})) continue;
            const bool drawn = reference.isDrawn(shot.level, cell);
            // Level 0 leaves out what is not there.
            if (!drawn && (shot.level == 0 || std::isfinite(reference.cellError(shot.level, false, cell)))) continue;
            reference.forSamples(shot.level, cell, [&](glm::ivec2 sample) { look(cell, drawn, sample); });
        }
    return worst;
}

}  // namespace

TEST_P(ClipmapErrorsOver, ScreenErrorBoundsWhateverIsDrawn)
{
    std::mt19937 random(6);
    const BoxPyramid boxes(grid);
    const Box box = GetParam().box();
    for (int i = 0; i < 150; ++i) {
        const Shot shot = randomShot(random, reference, box, kLevels - 1);
        const ScreenSpace screen(shot.view, grid.localFromFrame(), grid.isRegular() ? ErrorDirection::Vertical : ErrorDirection::Any);
        const auto bound = [&](float enough) {
            return errors.screenError(screen, grid, boxes, shot.level, shot.blending, shot.region, shot.hole, enough);
        };
        const double worst = worstDistance(grid, reference, shot, random);
        const float best = bound(0.0f);
        ASSERT_GE(best * 1.001 + 1e-3, worst) << "level " << shot.level << (shot.blending ? " blending " : " plain ") << shot.region.low.x << ", "
                                             << shot.region.low.y << " to " << shot.region.high.x << ", " << shot.region.high.y;
        const float enough = float(uniform(random, 0.0, 2.0)) * (std::isfinite(best) ? best : 100.0f), loose = bound(enough);
        ASSERT_GE(loose, best * 0.999f);
        if (best > enough)
            ASSERT_EQ(loose, best);
        else
            ASSERT_LE(loose, enough);
    }
}

INSTANTIATE_TEST_SUITE_P(All, ClipmapErrorsOver, testing::ValuesIn(clipmapTerrains()),
                         [](const auto& info) { return info.param.name + "_" + std::to_string(info.index); });

TEST(ClipmapErrors, ScreenErrorIsThatOfTheWorstSampleSeenFromTheSide)
{
    // In an orthographic view a spike's height is the same wherever it stands.
    const Terrain terrain = spike(129);
    const SampleGrid grid = terrain.grid();
    const ClipmapErrors errors(grid, 4);
    const BoxPyramid boxes(grid);
    const Box box = terrain.box();
    const double size = 200.0;
    const glm::dmat4 camera = glm::lookAt(glm::dvec3(box.centre) - glm::dvec3(0.0, 300.0, 0.0), glm::dvec3(box.centre), glm::dvec3(0.0, 0.0, 1.0));
    const View view{glm::ortho(-size, size, -size, size, 1.0, 1000.0) * camera, {400.0, 400.0}};
    const ScreenSpace screen(view, grid.localFromFrame(), ErrorDirection::Vertical);
    const ClipRect all{{0, 0}, {64, 64}};
    EXPECT_NEAR(errors.screenError(screen, grid, boxes, 1, false, all, {}, 0.0f), 30.0f, 0.01f);
    // Sample (43, 64) lies between vertices 21 and 22.
    EXPECT_NEAR(errors.screenError(screen, grid, boxes, 1, false, all, {{16, 24}, {32, 40}}, 0.0f), 0.0f, 0.01f);
    EXPECT_EQ(errors.screenError(screen, grid, boxes, 1, false, {{40, 0}, {64, 64}}, {}, 0.0f), 0.0f);
    EXPECT_EQ(errors.screenError(screen, grid, boxes, 1, false, all, {{-10, -10}, {64, 64}}, 0.0f), 0.0f);
    EXPECT_EQ(errors.screenError(screen, grid, boxes, 0, false, all, {}, 0.0f), 0.0f);
    EXPECT_EQ(errors.screenError(screen, grid, boxes, -1, true, all, {}, 0.0f), 0.0f);
    EXPECT_EQ(errors.screenError(screen, grid, boxes, 4, false, all, {}, 0.0f), std::numeric_limits<float>::infinity());
}

TEST(ClipmapErrors, OnlyThePartOfABlockThatIsDrawnCounts)
{
    const Terrain terrain = spike(17);
    const SampleGrid grid = terrain.grid();
    const ClipmapErrors errors(grid, 3);
    const BoxPyramid boxes(grid);
    const glm::dvec3 target(terrain.box().centre), eye = target - glm::dvec3(0.0, 40.0, 0.0);
    const View view{glm::perspective(1.5, 1.0, 0.5, 500.0) * glm::lookAt(eye, target, glm::dvec3(0.0, 0.0, 1.0)), {512.0, 512.0}};
    const ScreenSpace screen(view, grid.localFromFrame(), ErrorDirection::Vertical);
    const auto bound = [&](const ClipRect& region, const ClipRect& hole) {
        return errors.screenError(screen, grid, boxes, 1, false, region, hole, 0.0f);
    };
    const ClipRect all{{0, 0}, {8, 8}}, nearHalf{{0, 0}, {8, 4}}, farHalf{{0, 4}, {8, 8}};
    ASSERT_GT(bound(farHalf, {}), 0.0f);
    EXPECT_LT(bound(farHalf, {}), 0.9f * bound(all, {}));
    EXPECT_EQ(bound(all, nearHalf), bound(farHalf, {}));
    EXPECT_EQ(bound(all, farHalf), bound(nearHalf, {}));
    EXPECT_EQ(bound(nearHalf, {}), bound(all, {}));
}

TEST(ClipmapErrors, VerticesMayRiseTowardsHeightsOutsideOfTheRegion)
{
    // A slope along the border lifts vertex 1 of level 3 where that blends, from a region that begins there. Seen from above, it then
    // is much nearer than all samples of the region.
    const Terrain terrain{"Slope", mapOf(65, 65, [](int column, int) { return std::max(0.0f, 500.0f - 62.5f * float(column)); }), {}};
    const SampleGrid grid = terrain.grid();
    const Reference reference(grid);
    const ClipmapErrors errors(grid, 6);
    const BoxPyramid boxes(grid);
    const glm::dvec3 target(grid.position(32, 32)), eye = target + glm::dvec3(0.0, 0.0, 600.0);
    const View view{glm::perspective(1.0, 1.0, 0.5, 2000.0) * glm::lookAt(eye, target, glm::dvec3(0.0, 1.0, 0.0)), {512.0, 512.0}};
    const ScreenSpace screen(view, grid.localFromFrame(), ErrorDirection::Vertical);
    const Shot shot{view, 3, true, {{1, 3}, {2, 4}}, {}};
    std::mt19937 random(9);
    double worst = 0.0;
    for (int i = 0; i < 50; ++i) worst = std::max(worst, worstDistance(grid, reference, shot, random));
    ASSERT_GT(worst, 1.0);
    EXPECT_GE(errors.screenError(screen, grid, boxes, shot.level, true, shot.region, {}, 0.0f), worst);
}

TEST(ClipmapErrors, BelowTheEyeBlocksAreCutUntilTheyHaveABound)
{
    // The eye stands lower than the top of the block that it is over.
    const Terrain terrain{"Step", mapOf(129, 129, [](int column, int) { return (column % 16 == 7 ? 0.5f : 0.0f) + (column > 70 ? 20.0f : 0.0f); }), {}};
    const SampleGrid grid = terrain.grid();
    const ClipmapErrors errors(grid, 4);
    const BoxPyramid boxes(grid);
    const glm::dvec3 eye(grid.position(66, 64) + glm::vec3(0.0f, 0.0f, 8.0f));
    const View view{glm::perspective(0.9, 4.0 / 3.0, 0.5, 500.0) * glm::lookAt(eye, eye + glm::dvec3(-1.0, 0.0, -0.5), glm::dvec3(0.0, 0.0, 1.0)),
                    {1024.0, 768.0}};
    const ScreenSpace screen(view, grid.localFromFrame(), ErrorDirection::Vertical);
    EXPECT_TRUE(std::isfinite(errors.screenError(screen, grid, boxes, 1, false, {{0, 0}, {64, 64}}, {}, 0.0f)));
}

TEST(ClipmapErrors, FlatGroundHasNone)
{
    const Terrain terrain = flat(70);
    const ClipmapErrors errors(terrain.grid(), 5);
    for (int level = 0; level < 5; ++level)
        for (const bool blending : {false, true}) EXPECT_EQ(errors.error(level, blending, errors.layers(level) - 1, {0, 0}), 0.0f);
}

TEST(ClipmapErrors, MoreLevelsThanTheGridHasAreOneCell)
{
    const Terrain terrain = fractal(40, 23);
    const SampleGrid grid = terrain.grid();
    const ClipmapErrors errors(grid, 28);
    const Reference reference(grid);
    for (int level = 6; level < 28; ++level) {
        ASSERT_EQ(errors.blocks(level, 0), glm::ivec2(1));
        ASSERT_NEAR(errors.error(level, true, 0, {0, 0}), reference.cellError(6, false, {0, 0}), 1e-4);
    }
}

TEST(ClipmapErrors, TakeLessThanASixthOfAByteASample)
{
    const Terrain terrain = fractal(513, 700);
    EXPECT_LE(double(ClipmapErrors(terrain.grid(), 8).bytes()), 513.0 * 700.0 / 6.0);
}
