// Which levels a clipmap draws for a view, and that these are the ones that it takes.
#include "lod/Clipmap.h"

#include <cmath>

#include <gtest/gtest.h>

#include "lod/SynthesisedDetail.h"

#include "Maps.h"
#include "Views.h"

namespace terrain {
namespace {

using namespace test;

struct Ground {
    Ground(Terrain given, const ClipmapShape& shape)
        : terrain(std::move(given)), grid(terrain.grid()), box(terrain.box()), boxes(grid), layout(grid.columns(), grid.rows(), shape),
          errors(grid, layout.levels() - layout.detailLevels()) {}

    /// What a clipmap without a past would choose.
    Clipmap::Frame fresh(const View& view, const ClipmapSettings& settings, bool withErrors = true) const {
        Clipmap clipmap(layout);
        return clipmap.select(grid, boxes, withErrors ? &errors : nullptr, view, settings);
    }

    Ground(const Ground&) = delete;

    Terrain terrain;
    SampleGrid grid;
    Box box;
    BoxPyramid boxes;
    ClipmapLayout layout;
    ClipmapErrors errors;
};

/// From `above` a place in local coordinates, straight down.
View lookingDown(const glm::dvec3& ground, double above) {
    const glm::dvec3 eye = ground + glm::dvec3(0.0, 0.0, above);
    const glm::dmat4 camera = glm::lookAt(eye, ground, glm::dvec3(0.0, 1.0, 0.0));
    return {glm::perspective(1.2, 4.0 / 3.0, 0.01 * above, 100.0 * above) * camera, {1024.0, 768.0}};
}

Terrain plain(int side) {
    Terrain terrain = flat(side);
    terrain.map.spacing = {1.0, 1.0};
    return terrain;
}

TEST(Clipmap, DrawsAsManyLevelsAsItIsTold) {
    const Ground ground(fractal(257, 129), {15, 0, 2, 0});
    const View view = flightView(ground.box, 3, 20);
    ClipmapSettings settings;
    const int levels = ground.layout.levels();
    for (int active = 1; active < levels + 3; ++active) {
        settings.activeLevels = active;
        const Clipmap::Frame frame = ground.fresh(view, settings);
        EXPECT_EQ(frame.finest, std::max(0, levels - active));
        for (int level = 0; level < levels; ++level)
            EXPECT_EQ(frame.active[std::size_t(level)].isEmpty(), level < frame.finest) << active << " active, level " << level;
        for (const auto& patches : frame.patches.by)
            for (const ClipmapPatch& patch : patches) EXPECT_GE(patch.level, frame.finest);
    }
}

TEST(Clipmap, WithoutErrorsDrawsLevelsThatAreTwoAndAHalfHeightsWide) {
    for (const int detail : {0, 2}) {
        const Ground ground(plain(257), {31, 0, detail, 0});
        for (double above = 0.3; above < 2000.0; above *= 1.3) {
            const Clipmap::Frame frame = ground.fresh(lookingDown({100.0, 90.0, 3.0}, above), {}, false);
            const auto width = [&](int level) { return 30.0 * ground.layout.spacing(level); };
            if (frame.finest + 1 < ground.layout.levels()) {
                EXPECT_GE(width(frame.finest), 2.5 * above * 0.999);
            }
            if (frame.finest > 0) {
                EXPECT_LT(width(frame.finest - 1), 2.5 * above * 1.001);
            }
            EXPECT_TRUE(std::isinf(frame.report.errorPixels));
        }
    }
}

TEST(Clipmap, IsHighAboveTheGroundWhereverThatLies) {
    // On a mountain, and beside the grid, where the distance to its border counts.
    Terrain mountain = plain(257);
    for (float& height : mountain.map.heights) height = 500.0f;
    const Ground ground(mountain, {15, 0, 0, 0});
    const Box box = ground.box;
    const double x = double(box.centre.x), y = double(box.centre.y);
    EXPECT_EQ(ground.fresh(lookingDown({x, y, 500.0}, 2.0), {}, false).finest, 0);
    EXPECT_GT(ground.fresh(lookingDown({x, y, 500.0}, 30.0), {}, false).finest, 1);
    const Clipmap::Frame beside = ground.fresh(lookingDown({double(box.lowest().x) - 40.0, y, 500.0}, 2.0), {}, false);
    EXPECT_GT(beside.finest, 1);
    EXPECT_EQ(beside.viewer.x, 0.0);
    EXPECT_EQ(ground.fresh(lookingDown({double(box.lowest().x) - 2.0, y, 500.0}, 2.0), {}, false).finest, 0);
}

TEST(Clipmap, DropsLevelsThatPixelErrorDoesNotNeedAndNoneThatItNeeds) {
    int dropped = 0, needed = 0;
    for (const Terrain& terrain : {flat(129), ramp(129), spike(129), fractal(257, 129), fractal(300, 300), wavySheet(70, 50, false)}) {
        const Ground ground(terrain, {31, 0, 0, 0});
        std::mt19937 random(11);
        for (int i = 0; i < 60; ++i) {
            const View view = i % 2 ? randomView(random, ground.box) : flightView(ground.box, i, 60);
            ClipmapSettings settings;
            settings.pixelError = float(std::pow(2.0, uniformInt(random, -2, 6)));
            const Clipmap::Frame chosen = ground.fresh(view, settings);
            const auto errorFrom = [&](int finest) {
                ClipmapSettings forced = settings;
                forced.activeLevels = ground.layout.levels() - finest;
                return ground.fresh(view, forced).report.errorPixels;
            };
            EXPECT_LE(chosen.report.errorPixels, std::max(settings.pixelError, errorFrom(chosen.finest))) << terrain.name << ' ' << i;
            // All levels would do no better, or those that were chosen are good enough.
            if (chosen.report.errorPixels > settings.pixelError) {
                EXPECT_LE(chosen.report.errorPixels, errorFrom(0)) << terrain.name << ' ' << i;
            }
            if (chosen.finest + 1 < ground.layout.levels()) {
                // A level may be let go somewhat later than it could be, so that it fades.
                EXPECT_GT(errorFrom(chosen.finest + 1), 0.79f * settings.pixelError) << terrain.name << ' ' << i;
                ++needed;
            }
            dropped += chosen.finest > 0;
        }
    }
    EXPECT_GT(dropped, 50);
    EXPECT_GT(needed, 50);
}

TEST(Clipmap, DrawsAPlainWithItsCoarsestLevelAlone) {
    for (const Terrain& terrain : {flat(257), ramp(257)}) {
        const Ground ground(terrain, {15, 0, 0, 0});
        const Clipmap::Frame frame = ground.fresh(flightView(ground.box, 1, 9), {});
        EXPECT_EQ(frame.finest, ground.layout.levels() - 1) << terrain.name;
        EXPECT_LE(frame.report.errorPixels, 0.01f);
    }
}

TEST(Clipmap, KeepsSynthesisedLevelsNearTheGround) {
    // No error of samples asks for them.
    const Ground ground(plain(65), {15, 0, 3, 0});
    EXPECT_EQ(ground.fresh(lookingDown({30.0, 30.0, 3.0}, 0.5), {}).finest, 0);
    EXPECT_EQ(ground.fresh(lookingDown({30.0, 30.0, 3.0}, 1.2), {}).finest, 1);
    EXPECT_GT(ground.fresh(lookingDown({30.0, 30.0, 3.0}, 40.0), {}).finest, 3);
}

TEST(Clipmap, BlendsAlongEveryBorderOfALevelBehindWhichThereIsMore) {
    const Ground ground(fractal(257, 257), {31, 0, 0, 0});
    Clipmap clipmap(ground.layout);
    ClipmapSettings settings;
    settings.activeLevels = 100;
    settings.updateBudget = 260;
    int cropped = 0;
    for (int i = 0; i < 120; ++i) {
        const double t = 0.05 * i;
        const glm::dvec3 at(glm::dvec3(ground.box.centre) + glm::dvec3(ground.box.half) * glm::dvec3(0.8 * std::cos(t), 0.8 * std::sin(t), 1.0));
        const Clipmap::Frame& frame = clipmap.select(ground.grid, ground.boxes, &ground.errors, lookingDown(at, 3.0), settings);
        for (int level = 0; level + 1 < ground.layout.levels(); ++level) {
            const ClipRect& active = frame.active[std::size_t(level)];
            if (active.isEmpty()) continue;
            const ClipRect domain = ground.layout.domain(level), drawn = active.cutTo(domain);
            cropped += active != ground.layout.place(level, frame.viewer);
            for (int axis = 0; axis < 2; ++axis)
                for (int other = drawn.low[1 - axis]; other <= drawn.high[1 - axis]; ++other) {
                    glm::ivec2 v(0);
                    v[1 - axis] = other;
                    v[axis] = active.low[axis];
                    if (active.low[axis] > domain.low[axis]) {
                        EXPECT_EQ(clipmap.blend(level, v), 1.0f);
                    }
                    v[axis] = active.high[axis];
                    if (active.high[axis] < domain.high[axis]) {
                        EXPECT_EQ(clipmap.blend(level, v), 1.0f);
                    }
                }
            if (frame.active[std::size_t(level) + 1].isEmpty()) continue;
            // The finer level's perimeter stands where this one is its own.
            if (level > 0 && !frame.active[std::size_t(level) - 1].isEmpty()) {
                const ClipRect hole = coarserRect(frame.active[std::size_t(level) - 1]).cutTo(domain);
                for (int axis = 0; axis < 2; ++axis)
                    for (int v = hole.low[axis]; v <= hole.high[axis]; ++v) EXPECT_EQ(clipmap.blend(level, axis, v), 0.0f) << i;
            }
        }
    }
    EXPECT_GT(cropped, 20);
}

TEST(Clipmap, SaysWhenALevelIsNotThereYetAndShowsNoError) {
    const Ground ground(fractal(257, 257), {31, 0, 0, 0});
    Clipmap clipmap(ground.layout);
    ClipmapSettings settings;
    settings.activeLevels = 100;
    settings.updateBudget = 300;
    const glm::dvec3 middle(ground.box.centre), half(ground.box.half);
    const View here = lookingDown(middle - half * 0.7, 10.0), there = lookingDown(middle + half * 0.7, 10.0);
    EXPECT_TRUE(clipmap.select(ground.grid, ground.boxes, &ground.errors, here, settings).report.converged);
    EXPECT_FALSE(clipmap.select(ground.grid, ground.boxes, &ground.errors, there, settings).report.converged);
    int frames = 0;
    while (!clipmap.select(ground.grid, ground.boxes, &ground.errors, there, settings).report.converged && frames < 200) ++frames;
    EXPECT_GT(frames, 3);
    const Clipmap::Frame fresh = ground.fresh(there, settings);
    EXPECT_EQ(clipmap.frame().active, fresh.active);
    EXPECT_EQ(clipmap.frame().report.errorPixels, fresh.report.errorPixels);
    EXPECT_TRUE(clipmap.select(ground.grid, ground.boxes, &ground.errors, there, settings).updates.empty());
}

TEST(Clipmap, OfNoGivenSizeIsTheSmallestThatKeepsPixelError) {
    const Ground ground(fractal(300, 300), {15, 0, 0, 0});
    std::mt19937 random(5);
    int smaller = 0;
    for (int i = 0; i < 30; ++i) {
        const View view = flightView(ground.box, i, 30);
        ClipmapSettings settings;
        settings.pixelError = float(std::pow(2.0, i % 8));
        const int size = smallestClipmap(ground.grid, ground.boxes, &ground.errors, view, {}, settings);
        const auto errorOf = [&](int n) {
            const ClipmapLayout layout(300, 300, {n, 0, 0, 0});
            return Clipmap(layout).errorOf(ground.grid, ground.boxes, ground.errors, view, settings);
        };
        EXPECT_EQ(size, ClipmapShape::validSize(size));
        EXPECT_TRUE(errorOf(size) <= settings.pixelError || size == ClipmapShape::kLargest);
        if (size > ClipmapShape::kSmallest) {
            EXPECT_GT(errorOf(size / 2), settings.pixelError);
        }
        smaller += size < ClipmapShape::kLargest;
    }
    EXPECT_GT(smaller, 10);
}

}  // namespace
}  // namespace terrain
