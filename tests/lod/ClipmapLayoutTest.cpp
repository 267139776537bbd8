// Levels of a clipmap nest wherever the viewer is, their patches cover the grid once, and updates bring what is new and nothing
// else.
#include "lod/ClipmapLayout.h"
#include "lod/ClipmapUpdates.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

namespace terrain {
namespace {

std::vector<ClipRect> wholeRegions(const ClipmapLayout& layout, int finest, glm::dvec2 viewer) {
    std::vector<ClipRect> valid;
    for (int level = 0; level < layout.levels(); ++level) valid.push_back(layout.domain(level));
    return activeRegions(layout, valid, finest, viewer);
}

ClipmapPatches patchesOf(const ClipmapLayout& layout, const std::vector<ClipRect>& active) {
    ClipmapPatches patches;
    for (int level = 0; level < layout.levels(); ++level) {
        const ClipRect hole = holeIn(active, level);
        coverLevel(layout, level, active[std::size_t(level)], hole, patches);
    }
    return patches;
}

/// How often each unit cell of the grid is covered by patches that have an area.
std::vector<int> coverage(const ClipmapLayout& layout, const ClipmapPatches& patches) {
    const glm::ivec2 last = layout.lastUnit();
    std::vector<int> times(std::size_t(last.x) * std::size_t(last.y));
    for (const Footprint footprint : {Footprint::Block, Footprint::Column, Footprint::Row})
        for (const ClipmapPatch& patch : patches[footprint]) {
            const glm::ivec2 low = layout.unitAt(patch.low, patch.level), high = layout.unitAt(patch.high, patch.level);
            for (int y = low.y; y < high.y; ++y)
                for (int x = low.x; x < high.x; ++x) ++times[std::size_t(y) * std::size_t(last.x) + std::size_t(x)];
        }
    return times;
}

bool isOnceEverywhere(const std::vector<int>& times) {
    return std::all_of(times.begin(), times.end(), [](int n) { return n == 1; });
}

struct Grid {
    int columns, rows;
    ClipmapShape shape;
};

class ClipmapLayouts : public testing::TestWithParam<Grid> {};

TEST_P(ClipmapLayouts, NestAtEveryPlaceOfTheViewer) {
    const Grid& g = GetParam();
    const ClipmapLayout layout(g.columns, g.rows, g.shape);
    const int m = layout.blockSize();
    for (int unit = -300; unit < 300; ++unit)
        for (const double part : {0.0, 0.5, 0.999}) {
            const glm::dvec2 viewer(unit + part, -unit - part);
            for (int level = 0; level + 1 < layout.levels(); ++level) {
                const ClipRect fine = layout.place(level, viewer), coarse = layout.place(level + 1, viewer);
                EXPECT_EQ(fine.low & 1, glm::ivec2(0));
                EXPECT_EQ(fine.high & 1, glm::ivec2(0));
                const glm::ivec2 behind = (fine.low >> 1) - coarse.low;
                EXPECT_TRUE(behind.x == m - 1 || behind.x == m) << unit;
                EXPECT_TRUE(behind.y == m - 1 || behind.y == m) << unit;
            }
        }
}

TEST_P(ClipmapLayouts, CoverEveryCellOnceWithWholeLevels) {
    const Grid& g = GetParam();
    const ClipmapLayout layout(g.columns, g.rows, g.shape);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> x(-20.0, layout.lastUnit().x + 20.0), y(-20.0, layout.lastUnit().y + 20.0);
    for (int i = 0; i < 60; ++i) {
        const glm::dvec2 viewer = layout.viewerUnits(glm::dvec2(x(random), y(random)) / double(layout.unitsPerSample()));
        for (int finest = 0; finest < layout.levels(); ++finest)
            EXPECT_TRUE(isOnceEverywhere(coverage(layout, patchesOf(layout, wholeRegions(layout, finest, viewer)))))
                << viewer.x << ' ' << viewer.y << " finest " << finest;
    }
}

TEST_P(ClipmapLayouts, CoverEveryCellOnceHoweverFarUpdatesFellBehind) {
    const Grid& g = GetParam();
    const ClipmapLayout layout(g.columns, g.rows, g.shape);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> x(0.0, layout.lastUnit().x), y(0.0, layout.lastUnit().y);
    ClipmapUpdates updates(layout);
    updates.follow({x(random), y(random)}, 0, 0);
    glm::dvec2 viewer(x(random), y(random));
    for (int i = 0; i < 120; ++i) {
        if (i % 20 == 0) viewer = {x(random), y(random)};
        viewer = glm::clamp(viewer + glm::dvec2(3.7, -2.1), glm::dvec2(0.0), glm::dvec2(layout.lastUnit()));
        updates.follow(viewer, 0, 40 + 13 * (i % 9));
        const auto active = activeRegions(layout, updates.valid(), 0, viewer);
        // The coarsest level fell behind as well: nothing is there to be drawn in its place.
        std::vector<int> times = coverage(layout, patchesOf(layout, active));
        EXPECT_TRUE(std::all_of(times.begin(), times.end(), [](int n) { return n <= 1; })) << i;
        if (updates.valid().back().contains(layout.domain(layout.levels() - 1))) {
            EXPECT_TRUE(isOnceEverywhere(times)) << i;
        }
        for (int level = 0; level < layout.levels(); ++level) {
            const ClipRect& region = active[std::size_t(level)];
            if (region.isEmpty()) continue;
            EXPECT_TRUE(updates.valid()[std::size_t(level)].contains(region.cutTo(layout.domain(level))));
            if (level + 1 < layout.levels()) {
                EXPECT_TRUE(active[std::size_t(level) + 1].shrunk(2).contains(coarserRect(region)));
            }
        }
    }
}

TEST_P(ClipmapLayouts, UpdatesBringWhatIsNewOnceAndWithinTheBudget) {
    const Grid& g = GetParam();
    const ClipmapLayout layout(g.columns, g.rows, g.shape);
    ClipmapUpdates updates(layout);
    std::vector<std::map<std::pair<int, int>, std::pair<int, int>>> store(std::size_t(layout.levels()));
    std::mt19937 random(3);
    std::uniform_real_distribution<double> x(0.0, layout.lastUnit().x), y(0.0, layout.lastUnit().y), step(-4.0, 4.0);
    glm::dvec2 viewer(x(random), y(random));
    for (int i = 0; i < 150; ++i) {
        viewer = i % 40 == 39
                     ? glm::dvec2(x(random), y(random))
                     : glm::clamp(viewer + glm::dvec2(step(random), step(random)), glm::dvec2(0.0), glm::dvec2(layout.lastUnit()));
        const std::int64_t budget = i % 3 == 0 ? 0 : 200 + 7 * i;
        const std::vector<ClipRect> before(updates.valid().begin(), updates.valid().end());
        std::int64_t brought = 0;
        int strips = 0, level = -1;
        for (const auto& update : updates.follow(viewer, i % 2, budget)) {
            strips = update.level == level ? strips + 1 : 1;
            level = update.level;
            EXPECT_LE(strips, 4);
            brought += update.rect.samples();
            auto& texels = store[std::size_t(level)];
            for (int v = update.rect.low.y; v <= update.rect.high.y; ++v)
                for (int u = update.rect.low.x; u <= update.rect.high.x; ++u) {
                    EXPECT_FALSE(before[std::size_t(level)].contains(glm::ivec2(u, v))) << "again: " << u << ' ' << v;
                    texels[{layout.texel(u), layout.texel(v)}] = {u, v};
                }
        }
        if (budget > 0) {
            EXPECT_LE(brought, budget);
        }
        for (int l = 0; l < layout.levels(); ++l) {
            const ClipRect& have = updates.valid()[std::size_t(l)];
            for (int v = have.low.y; v <= have.high.y; ++v)
                for (int u = have.low.x; u <= have.high.x; ++u)
                    ASSERT_EQ((store[std::size_t(l)][{layout.texel(u), layout.texel(v)}]), std::make_pair(u, v)) << "level " << l;
        }
        if (budget == 0) {
            EXPECT_TRUE(updates.isComplete());
        }
    }
}

TEST_P(ClipmapLayouts, BlendsIntoTheCoarserLevelOnThePerimeterAndNotInTheMiddle) {
    const Grid& g = GetParam();
    const ClipmapLayout layout(g.columns, g.rows, g.shape);
    for (double unit = 0.0; unit < 64.0; unit += 0.37) {
        const glm::dvec2 viewer(unit, 64.0 - unit);
        for (int level = 0; level + 1 < layout.levels(); ++level) {
            const ClipRect all = layout.place(level, viewer);
            for (int i = 0; i < layout.size(); ++i)
                for (const glm::ivec2 edge :
                     {glm::ivec2(i, 0), glm::ivec2(0, i), glm::ivec2(i, layout.size() - 1), glm::ivec2(layout.size() - 1, i)})
                    EXPECT_EQ(layout.blend(level, all.low + edge, viewer), 1.0f);
            EXPECT_EQ(layout.blend(level, glm::ivec2(glm::floor(layout.viewerAt(level, viewer))), viewer), 0.0f);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Grids, ClipmapLayouts,
                         testing::Values(Grid{65, 65, {15, 0, 0, 0}}, Grid{100, 37, {15, 0, 0, 0}}, Grid{2, 2, {15, 0, 0, 0}},
                                         Grid{130, 71, {31, 0, 0, 0}}, Grid{33, 21, {15, 0, 2, 0}}, Grid{257, 3, {15, 0, 0, 3}}));

TEST(ClipmapShape, TakesTheNearestSizeThatThereIs) {
    for (const auto& [wanted, size] : std::map<int, int>{{-5, 15},
                                                         {0, 15},
                                                         {15, 15},
                                                         {16, 15},
                                                         {30, 31},
                                                         {127, 127},
                                                         {128, 127},
                                                         {255, 255},
                                                         {400, 511},
                                                         {1023, 1023},
                                                         {99999, 1023}})
        EXPECT_EQ(ClipmapShape::validSize(wanted), size) << wanted;
}

TEST(ClipmapLayout, HasALevelOfSamplesHoweverMuchDetailCoversASmallGrid) {
    for (const int side : {2, 3, 17, 64, 65, 300})
        for (const int detail : {0, 1, 3, 8})
            for (const int levels : {0, 1, 5}) {
                const ClipmapLayout layout(side, side, {255, levels, detail, 0});
                EXPECT_GE(layout.sourceLevel(layout.levels() - 1), 0) << side << ", detail " << detail << ", levels " << levels;
            }
}

TEST(ClipmapLayout, DrawsInTheFootprintsOfThe2005Article) {
    // Sect. 3.1: twelve blocks, four strips and a trim of one L for each level; four blocks and a second L more in the middle.
    ClipmapShape shape;
    shape.size = 63;
    const ClipmapLayout layout(100001, 100001, shape);
    const auto active = wholeRegions(layout, 0, glm::dvec2(50001.5, 50003.25));
    ClipmapPatches all = patchesOf(layout, active);
    const auto within = [&](const std::vector<ClipmapPatch>& patches, int level) {
        return std::count_if(patches.begin(), patches.end(), [level](const ClipmapPatch& p) { return p.level == level; });
    };
    ASSERT_EQ(footprintCells(layout), layout.blockSize() - 1);
    EXPECT_EQ(within(all[Footprint::Block], 0), 16);
    EXPECT_EQ(within(all[Footprint::Block], 1), 12);
    EXPECT_EQ(within(all[Footprint::Column], 1), 3);
    EXPECT_EQ(within(all[Footprint::Row], 1), 3);
    EXPECT_EQ(within(all[Footprint::Column], 0), 4);
    EXPECT_EQ(within(all[Footprint::Seam], 1), 4);
}

TEST(ClipmapLayout, HasThirteenMillionTrianglesInEightLevelsOfTheLargestSize) {
    // Of the 2011 thesis: 13,056,036, where the trim leaves out the cell in its corner, on each of seven levels.
    ClipmapShape shape;
    shape.size = 1023;
    shape.levels = 8;
    const ClipmapLayout layout(300001, 300001, shape);
    const ClipmapPatches patches = patchesOf(layout, wholeRegions(layout, 0, glm::dvec2(150000.5, 150001.5)));
    std::int64_t triangles = 0;
    for (const Footprint footprint : {Footprint::Block, Footprint::Column, Footprint::Row})
        for (const ClipmapPatch& patch : patches[footprint])
            triangles += 2 * std::int64_t(patch.high.x - patch.low.x) * (patch.high.y - patch.low.y);
    EXPECT_EQ(triangles, 13056036 + 7 * 2);
}

}  // namespace
}  // namespace terrain
