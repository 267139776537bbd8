// Where a clipmap's levels blend, and what is drawn there: nothing is missing, nothing jumps.
#include "lod/ClipmapMesh.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "ClipmapScene.h"

namespace terrain {
namespace {

using namespace test;

TEST(ClipmapMesh, DrawsSynthesisedHeightsAroundTheViewer) {
    const Terrain terrain = fractal(80, 70);
    ClipmapSettings options;
    options.activeLevels = 100;
    Scene scene(terrain, {31, 0, 2, 0}, options);
    const DrawList list = scene.mesh.select(scene.grid, lookingDown(scene.grid, terrain.box(), {40.0, 36.0}, 0.5), {});
    // The surfaces of the samples and of each level of detail by itself.
    std::vector<SynthesisedDetail> surfaces;
    for (int levels = 0; levels < 3; ++levels) surfaces.emplace_back(scene.grid, DetailShape{levels, scene.detail->amplitude(), 7});
    const auto& active = scene.mesh.clipmap().frame().active;
    int own = 0, between = 0;
    for (const std::uint32_t v : std::set<std::uint32_t>(list.indices.begin(), list.indices.end())) {
        const glm::dvec2 place(list.places[v]);
        const glm::ivec2 unit(glm::round(place * 4.0));
        const int level = active[0].contains(unit) ? 0 : 1;
        // Where two levels meet both have a vertex.
        if (!active[std::size_t(level)].shrunk(1).contains(unit >> level) ||
            (level == 1 && coarserRect(active[0]).shrunk(-1).contains(unit >> 1)))
            continue;
        const float share = scene.mesh.clipmap().blend(level, unit >> level);
        const double fine = surfaces[std::size_t(2 - level)].height(scene.grid, place.x, place.y);
        const double coarse = surfaces[std::size_t(1 - level)].height(scene.grid, place.x, place.y);
        if (share == 0.0f) {
            EXPECT_EQ(list.positions[v].z, fine);
        } else {
            EXPECT_NEAR(list.positions[v].z, fine + (coarse - fine) * double(share), 1e-4);
        }
        ++(share > 0.0f && share < 1.0f && std::fabs(fine - coarse) > 1e-3 ? between : own);
    }
    EXPECT_GT(own, 300);
    EXPECT_GT(between, 100);
}

/// Looks along the ground and a little up, so that only what stands out of it is in view.
void expectAllThatStandsOut(const Terrain& terrain, const ClipmapShape& shape, float amplitude, double height) {
    ClipmapSettings options;
    options.activeLevels = 100;
    Scene whole(terrain, shape, options, amplitude), culled(terrain, shape, options, amplitude);
    std::mt19937 random(3);
    std::uint32_t left = 0;
    for (int i = 0; i < 60; ++i) {
        const glm::dvec3 middle(terrain.box().centre), half(terrain.box().half);
        const glm::dvec3 eye = middle + half * glm::dvec3(uniform(random, -0.7, 0.7), uniform(random, -0.7, 0.7), 0.0);
        const double turn = uniform(random, 0.0, 6.3), pitch = uniform(random, 0.02, 0.15);
        const glm::dvec3 at(eye.x, eye.y, double(terrain.box().lowest().z) + height);
        const glm::dmat4 camera =
            glm::lookAt(at, at + glm::dvec3(std::cos(turn), std::sin(turn), pitch), glm::dvec3(0.0, 0.0, 1.0));
        const View view{glm::perspective(0.1, 4.0 / 3.0, 0.1, 1000.0) * camera, {1024.0, 768.0}};
        LodSettings settings;
        settings.cull = false;
        const DrawList all = whole.mesh.select(whole.grid, view, settings);
        settings.cull = true;
        const DrawList list = culled.mesh.select(culled.grid, view, settings);
        left += all.report.triangles - list.report.triangles;
        ASSERT_EQ("", missingProblem(culled, list, whole, all, view)) << "view " << i;
    }
    EXPECT_GT(left, 1000u);
}

TEST(ClipmapMesh, DrawsWhatRisesInATransitionOnly) {
    Terrain spikes{
        "Spikes", mapOf(385, 385, [](int column, int row) { return column % 16 == 0 && row % 16 == 0 ? 30.0f : 0.0f; }), {}};
    expectAllThatStandsOut(spikes, {15, 0, 0, 0}, 0.0f, 1.0);
}

TEST(ClipmapMesh, DrawsSynthesisedHeightsThatRiseOverAllSamples) {
    expectAllThatStandsOut(flat(65), {31, 0, 2, 0}, 3.0f, 1.0);
}

/// Largest way on screen, beyond what the camera does, of the drawn surface at any sample in view from one frame of a slow flight
/// to the next.
double largestJump(const Terrain& terrain, const ClipmapShape& shape, double cellsAFrame, double cells) {
    ClipmapSettings options;
    options.activeLevels = 100;
    Scene scene(terrain, shape, options);
    const Box box = terrain.box();
    std::vector<double> before, now;
    double largest = 0.0;
    for (double flown = 0.0; flown < cells; flown += cellsAFrame) {
        const glm::dvec3 eye(double(box.centre.x) - 0.3 * double(box.half.x) + 1.25 * flown, double(box.centre.y),
                             double(box.highest().z) + 5.0);
        const glm::dmat4 camera = glm::lookAt(eye, eye + glm::dvec3(1.0, 0.02, -0.35), glm::dvec3(0.0, 0.0, 1.0));
        const View view{glm::perspective(0.8, 4.0 / 3.0, 0.5, 1000.0) * camera, {1024.0, 768.0}};
        const DrawList list = scene.mesh.select(scene.grid, view, {});
        now.assign(std::size_t(scene.grid.columns()) * std::size_t(scene.grid.rows()), std::nan(""));
        forSamples(scene, list, [&](int column, int row, const glm::dvec3& p) { now[scene.grid.index(column, row)] = p.z; });
        largest = std::max(largest, largestMove(scene.grid, view, before, now));
        before = now;
    }
    return largest;
}

TEST(ClipmapMesh, SlidesFromLevelToLevelWithoutAJump) {
    const Terrain terrain = fractal(257, 257);
    for (const int size : {31, 63}) {
        // Two cells of the finest level at once pass its whole transition where that is one cell wide.
        const double atOnce = largestJump(terrain, {size, 0, 0, 1}, 2.0, 40.0),
                     smooth = largestJump(terrain, {size, 0, 0, 0}, 0.1, 20.0);
        const int width = ClipmapLayout(257, 257, {size, 0, 0, 0}).transitionWidth();
        EXPECT_GT(atOnce, 1.0) << "or there is nothing to see";
        EXPECT_LE(smooth, 1.5 * 0.1 / width * atOnce) << size;
    }
}

TEST(ClipmapMesh, OfNoGivenSizeTakesTheOneThatEachViewNeeds) {
    const Terrain terrain = fractal(300, 300);
    const SampleGrid grid = terrain.grid();
    const auto boxes = std::make_shared<BoxPyramid>(grid);
    const auto errors = std::make_shared<const ClipmapErrors>(grid, ClipmapLayout(300, 300, {15, 0, 0, 0}).levels());
    ClipmapMesh any(
        300, 300, {0, 0, 0, 0}, {}, boxes, [&](const SampleGrid&) { return errors; }, nullptr);
    std::set<int> sizes;
    std::vector<std::uint32_t> samples;
    for (int i = 0; i < 12; ++i) {
        LodSettings settings;
        settings.pixelError = float(std::pow(2.0, (5 * i) % 9));
        const View view = flightView(terrain.box(), i, 12);
        const DrawList list = any.select(grid, view, settings);
        const int size = any.clipmap().layout().size();
        EXPECT_TRUE(list.report.errorPixels <= settings.pixelError || size == ClipmapShape::kLargest);
        sizes.insert(size);
        ClipmapMesh fixed(
            300, 300, {size, 0, 0, 0}, {}, boxes, [&](const SampleGrid&) { return errors; }, nullptr);
        const DrawList same = fixed.select(grid, view, settings);
        ASSERT_EQ(list.indices.size(), same.indices.size());
        samples.resize(list.samples.size(), kNoVertex);
        for (const std::uint32_t vertex : list.newVertices) samples[vertex] = list.samples[vertex];
        for (std::size_t k = 0; k < list.indices.size(); ++k) {
            ASSERT_TRUE(sameBits(list.positions[list.indices[k]], same.positions[same.indices[k]]));
            ASSERT_EQ(samples[list.indices[k]], same.samples[same.indices[k]]);
        }
    }
    EXPECT_GT(sizes.size(), 2u);
}

TEST(ClipmapMesh, TakesErrorsWhenTheyAreThere) {
    const Terrain terrain = fractal(129, 129);
    const SampleGrid grid = terrain.grid();
    const ClipmapLayout layout(129, 129, {31, 0, 0, 0});
    std::shared_ptr<const ClipmapErrors> errors;
    ClipmapMesh mesh(
        layout, {}, std::make_shared<BoxPyramid>(grid), [&](const SampleGrid&) { return errors; }, nullptr);
    ClipmapMesh without(layout, {}, std::make_shared<BoxPyramid>(grid), {}, nullptr);
    const View view = flightView(terrain.box(), 1, 10);
    EXPECT_TRUE(std::isinf(mesh.select(grid, view, {}).report.errorPixels));
    EXPECT_TRUE(std::isinf(without.select(grid, view, {}).report.errorPixels));
    errors = std::make_shared<ClipmapErrors>(grid, layout.levels());
    EXPECT_TRUE(std::isfinite(mesh.select(grid, view, {}).report.errorPixels));
}

}  // namespace
}  // namespace terrain
