// The mesh of a clipmap on the CPU, whatever it is asked for: it covers the terrain once, has no cracks and keeps its promise.
#include "lod/ClipmapMesh.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "ClipmapScene.h"

namespace terrain {
namespace {

using namespace test;

struct Case {
    Terrain terrain;
    ClipmapShape shape;
};

std::string nameOf(const Case& c) {
    return c.terrain.name + "_" + std::to_string(c.shape.size) + "_" + std::to_string(c.shape.detailLevels);
}
std::ostream& operator<<(std::ostream& out, const Case& c) {
    return out << nameOf(c);
}

std::vector<Case> cases() {
    std::vector<Case> result;
    for (const Terrain& terrain : terrains())
        for (const int size : {15, 31, 63}) {
            if (size == 63 && terrain.map.columns < 200) continue;
            result.push_back({terrain, {size, 0, 0, 0}});
        }
    for (const Terrain& terrain :
         {fractal(33, 33), fractal(40, 23), spike(33), withDisc(40, 33), withSingleHole(33), fractal(2, 2)})
        for (const int detail : {1, 3}) result.push_back({terrain, {15, 0, detail, 0}});
    result.push_back({fractal(100, 77), {31, 0, 2, 9}});
    return result;
}

class ClipmapMeshOver : public testing::TestWithParam<Case> {
protected:
    const Box box = GetParam().terrain.box();
    std::mt19937 random{2025};

    LodSettings randomSettings() {
        LodSettings settings;
        settings.pixelError = float(std::pow(2.0, uniformInt(random, -1, 5)));
        settings.cull = false;
        settings.clockwise = uniformInt(random, 0, 3) == 0;
        return settings;
    }
    View nextView(int i) { return i % 3 == 0 ? randomView(random, box) : flightView(box, i, 40); }
};

TEST_P(ClipmapMeshOver, CoversTheTerrainOnceWithoutCracks) {
    for (const int active : {0, 100, 2}) {
        ClipmapSettings options;
        options.activeLevels = active;
        Scene scene(GetParam().terrain, GetParam().shape, options);
        for (int i = 0; i < 12; ++i) {
            const LodSettings settings = randomSettings();
            const DrawList list = scene.mesh.select(scene.grid, nextView(i), settings);
            ASSERT_EQ("", problemOf(scene, list, settings.clockwise)) << "view " << i;
        }
    }
}

TEST_P(ClipmapMeshOver, DrawsSamplesInViewWithinTheErrorThatItReports) {
    for (const std::int64_t budget : {0, 60}) {
        ClipmapSettings options;
        options.updateBudget = budget;
        options.activeLevels = budget ? 100 : 0;
        Scene scene(GetParam().terrain, GetParam().shape, options);
        int bounded = 0;
        for (int i = 0; i < 20; ++i) {
            LodSettings settings = randomSettings();
            settings.cull = i % 2;
            const View view = nextView(i);
            const DrawList list = scene.mesh.select(scene.grid, view, settings);
            bounded += std::isfinite(list.report.errorPixels);
            ASSERT_LE(worstError(scene, list, view), list.report.errorPixels + kRounding) << "view " << i << " budget " << budget;
        }
        if (!scene.boxes->hasHoles() && budget == 0) {
            EXPECT_GT(bounded, 3);
        }
    }
}

TEST_P(ClipmapMeshOver, HasNoCracksWhereUpdatesFellBehind) {
    ClipmapSettings options;
    options.activeLevels = 100;
    options.updateBudget = 70;
    Scene scene(GetParam().terrain, GetParam().shape, options);
    int cropped = 0;
    for (int i = 0; i < 60; ++i) {
        if (i % 15 == 0) options.updateBudget = 40 + 7 * i;
        const double t = 0.11 * i;
        const glm::dvec2 middle(scene.grid.columns() * 0.5, scene.grid.rows() * 0.5);
        const glm::dvec2 at = middle + middle * 0.7 * (i % 20 == 19 ? -1.0 : 1.0) * glm::dvec2(std::cos(t), std::sin(t));
        LodSettings settings;
        settings.cull = false;
        const DrawList list = scene.mesh.select(scene.grid, lookingDown(scene.grid, box, at, 1.0), settings);
        cropped += !list.report.converged;
        // Before the coarsest level is there again, nothing is to be drawn in its place.
        const int last = scene.layout.levels() - 1;
        if (!scene.mesh.clipmap().valid().back().contains(scene.layout.domain(last))) continue;
        ASSERT_EQ("", problemOf(scene, list, false)) << "frame " << i;
    }
    // Levels that hold all of the grid have nothing to follow.
    const ClipRect all = scene.layout.domain(0);
    if (scene.layout.levels() > 2 && std::max(all.columns(), all.rows()) > scene.layout.size()) {
        EXPECT_GT(cropped, 5);
    }
}

TEST_P(ClipmapMeshOver, LeavesOutNothingThatIsInView) {
    Scene whole(GetParam().terrain, GetParam().shape), culled(GetParam().terrain, GetParam().shape);
    for (int i = 0; i < 15; ++i) {
        LodSettings settings = randomSettings();
        const View view = nextView(i);
        const DrawList all = whole.mesh.select(whole.grid, view, settings);
        settings.cull = true;
        const DrawList list = culled.mesh.select(culled.grid, view, settings);
        EXPECT_LE(list.report.triangles, all.report.triangles);
        ASSERT_EQ("", missingProblem(culled, list, whole, all, view)) << "view " << i;
    }
}

TEST_P(ClipmapMeshOver, CanBeFollowedByWhatItSaysHasChanged) {
    ClipmapSettings options;
    options.updateBudget = 150;
    Scene scene(GetParam().terrain, GetParam().shape, options);
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> samples, indices;
    std::vector<glm::vec2> places;
    for (int i = 0; i < 40; ++i) {
        LodSettings settings = randomSettings();
        settings.cull = true;
        const DrawList list = scene.mesh.select(scene.grid, nextView(i / 2), settings);
        if (list.positionsChanged) positions.assign(list.positions.begin(), list.positions.end());
        if (list.indicesChanged) indices.assign(list.indices.begin(), list.indices.end());
        samples.resize(list.samples.size(), kNoVertex);
        places.resize(list.places.size(), glm::vec2(-1.0f));
        for (const std::uint32_t vertex : list.newVertices) {
            samples[vertex] = list.samples[vertex];
            if (!places.empty()) places[vertex] = list.places[vertex];
        }
        ASSERT_EQ(positions.size(), list.positions.size());
        ASSERT_EQ(indices.size(), 3 * list.report.triangles);
        for (const std::uint32_t vertex : indices) {
            ASSERT_TRUE(sameBits(positions[vertex], list.positions[vertex])) << i;
            ASSERT_EQ(samples[vertex], list.samples[vertex]) << i;
            if (!places.empty()) {
                ASSERT_EQ(places[vertex], list.places[vertex]) << i;
            }
        }
    }
}

TEST_P(ClipmapMeshOver, GivesWhatAFreshMeshWouldGive) {
    Scene travelled(GetParam().terrain, GetParam().shape);
    for (int i = 0; i < 10; ++i) {
        const LodSettings settings = randomSettings();
        const View view = nextView(i);
        Scene fresh(GetParam().terrain, GetParam().shape);
        DrawList a = travelled.mesh.select(travelled.grid, view, settings);
        for (int more = 0; more < 40 && !a.report.converged; ++more) a = travelled.mesh.select(travelled.grid, view, settings);
        const DrawList b = fresh.mesh.select(fresh.grid, view, settings);
        ASSERT_EQ(a.indices.size(), b.indices.size());
        for (std::size_t k = 0; k < a.indices.size(); ++k) {
            ASSERT_EQ(a.samples[a.indices[k]], b.samples[b.indices[k]]);
            ASSERT_TRUE(sameBits(a.positions[a.indices[k]], b.positions[b.indices[k]]));
        }
        ASSERT_EQ(std::memcmp(&a.report.errorPixels, &b.report.errorPixels, sizeof(float)), 0);
        const DrawList again = travelled.mesh.select(travelled.grid, view, settings);
        EXPECT_FALSE(again.positionsChanged);
        EXPECT_FALSE(again.indicesChanged);
        EXPECT_TRUE(again.newVertices.empty());
        EXPECT_EQ(again.report.triangles, b.report.triangles);
    }
}

INSTANTIATE_TEST_SUITE_P(Terrains, ClipmapMeshOver, testing::ValuesIn(cases()),
                         [](const testing::TestParamInfo<Case>& info) { return nameOf(info.param); });

/// Looks for cracks over one place after the other, with all levels.
std::string problemAlong(const Terrain& terrain, const ClipmapShape& shape, const std::vector<glm::dvec2>& samples) {
    ClipmapSettings options;
    options.activeLevels = 100;
    Scene scene(terrain, shape, options);
    const Box box = terrain.box();
    LodSettings settings;
    settings.cull = false;
    for (const glm::dvec2& sample : samples) {
        const DrawList list = scene.mesh.select(scene.grid, lookingDown(scene.grid, box, sample, 1.0), settings);
        const std::string problem = problemOf(scene, list, false);
        if (!problem.empty()) return problem + " from " + std::to_string(sample.x) + ", " + std::to_string(sample.y);
    }
    return {};
}

double periodOf(const Terrain& terrain, const ClipmapShape& shape) {
    const ClipmapLayout layout(terrain.map.columns, terrain.map.rows, shape);
    return 2.0 * layout.spacing(layout.levels() - 1);
}

TEST(ClipmapMesh, HasNoCracksAtAnyPlaceOfTwoPeriodsOfAllLevels) {
    for (const int detail : {0, 1}) {
        const Terrain terrain = detail ? fractal(36, 33) : fractal(49, 53);
        const ClipmapShape shape{15, 0, detail, 0};
        const double period = periodOf(terrain, shape), step = detail ? 0.47 : 0.93;
        std::vector<glm::dvec2> samples;
        for (double y = 0.0; y < 2.0 * period; y += step)
            for (double x = 0.0; x < 2.0 * period; x += step) samples.emplace_back(8.0 + x, 8.0 + y);
        EXPECT_EQ("", problemAlong(terrain, shape, samples));
    }
}

TEST(ClipmapMesh, HasNoCracksAlongTwoPeriodsOfLargerLevels) {
    for (const int size : {63, 255}) {
        const Terrain terrain = fractal(size == 63 ? 270 : 401, size == 63 ? 200 : 301);
        const ClipmapShape shape{size, 0, 0, 0};
        std::vector<glm::dvec2> samples;
        for (double way = 0.0; way < 2.0 * periodOf(terrain, shape); way += 0.9) {
            samples.emplace_back(100.0 + way, 90.0);
            samples.emplace_back(100.0, 90.0 + way);
        }
        EXPECT_EQ("", problemAlong(terrain, shape, samples));
    }
}

TEST(ClipmapMesh, DrawsEveryVertexWhereTheSelectionSays) {
    const Terrain terrain = fractal(129, 129);
    for (const int detail : {0, 2}) {
        Scene scene(terrain, {31, 0, detail, 0});
        LodSettings settings;
        int blending = 0;
        for (int i = 0; i < 12; ++i) {
            const DrawList list = scene.mesh.select(
                scene.grid, lookingDown(scene.grid, terrain.box(), {30.0 + 5.3 * i, 90.0 - 4.1 * i}, 2.0), settings);
            std::set<std::uint32_t> drawn(list.indices.begin(), list.indices.end());
            const Clipmap& clipmap = scene.mesh.clipmap();
            for (int level = scene.layout.detailLevels(); level < scene.layout.levels(); ++level) {
                const int source = scene.layout.sourceLevel(level);
                for (const std::uint32_t v : drawn) {
                    const std::uint32_t sample = list.samples[v];
                    const glm::ivec2 at(int(sample % 129), int(sample / 129)), vertex = at >> source;
                    if ((vertex << source) != at || !clipmap.frame().active[std::size_t(level)].contains(vertex)) continue;
                    if (level > 0 && !clipmap.frame().active[std::size_t(level) - 1].isEmpty() &&
                        coarserRect(clipmap.frame().active[std::size_t(level) - 1]).contains(vertex))
                        continue;
                    if (detail && glm::vec2(at) != list.places[v]) continue;
                    const float share = clipmap.blend(level, vertex);
                    blending += share > 0.0f && share < 1.0f;
                    const float own = levelHeight(scene.grid, source, vertex), coarser = coarserHeight(scene.grid, source, vertex);
                    EXPECT_NEAR(list.positions[v].z, own + (coarser - own) * share, 1e-4) << level;
                    EXPECT_EQ(list.positions[v].x, scene.grid.position(at.x, at.y).x);
                    EXPECT_EQ(list.positions[v].y, scene.grid.position(at.x, at.y).y);
                }
            }
        }
        EXPECT_GT(blending, 500);
    }
}

TEST(ClipmapMesh, GivesWhatAFreshMeshWouldGiveAfterJumpsInOneFrame) {
    const Terrain terrain = fractal(300, 300);
    ClipmapSettings options;
    options.activeLevels = 100;
    options.updateBudget = 1000000;
    Scene travelled(terrain, {63, 0, 0, 0}, options);
    std::mt19937 random(9);
    for (int i = 0; i < 12; ++i) {
        Scene fresh(terrain, {63, 0, 0, 0}, options);
        const View view = lookingDown(fresh.grid, terrain.box(), {uniform(random, 0.0, 300.0), uniform(random, 0.0, 300.0)}, 1.0);
        LodSettings settings;
        settings.cull = false;
        const DrawList a = travelled.mesh.select(travelled.grid, view, settings), b = fresh.mesh.select(fresh.grid, view, settings);
        ASSERT_TRUE(a.report.converged);
        ASSERT_EQ(a.indices.size(), b.indices.size());
        for (std::size_t k = 0; k < a.indices.size(); ++k)
            ASSERT_TRUE(sameBits(a.positions[a.indices[k]], b.positions[b.indices[k]])) << "jump " << i;
    }
}

}  // namespace
}  // namespace terrain
