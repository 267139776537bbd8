// The mesh of a clipmap on the CPU, whatever it is asked for: it covers the terrain once, has no cracks, keeps its promise, and
// nothing in it jumps.
#include "lod/ClipmapMesh.h"

#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <unordered_map>

#include <gtest/gtest.h>

#include "lod/ClipmapSurface.h"

#include "Maps.h"
#include "Views.h"

namespace terrain {
namespace {

using namespace test;

/// What rounding positions to floats may add, in pixels.
constexpr double kRounding = 0.03;

/// A drawn triangle in units of the finest level.
struct UnitTriangle {
    std::array<std::uint32_t, 3> vertex;
    std::array<glm::ivec2, 3> at;
    std::int64_t twiceArea;
};

std::int64_t cross(glm::ivec2 a, glm::ivec2 b) {
    return std::int64_t(a.x) * b.y - std::int64_t(a.y) * b.x;
}
std::string text(glm::ivec2 p) {
    return "(" + std::to_string(p.x) + ", " + std::to_string(p.y) + ")";
}
/// Units of the grids here fit into 16 bits.
std::uint32_t key(glm::ivec2 p) {
    return std::uint32_t(p.y) << 16 | std::uint32_t(p.x);
}
std::uint64_t edgeKey(std::uint32_t from, std::uint32_t to) {
    return std::uint64_t(from) << 32 | to;
}
bool sameBits(const glm::vec3& a, const glm::vec3& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

/// A mesh with all that it needs.
struct Scene {
    Scene(const Terrain& terrain, const ClipmapShape& wanted, ClipmapSettings options = {}, float amplitude = 0.0f)
        : grid(terrain.grid()), boxes(std::make_shared<BoxPyramid>(grid)), layout(grid.columns(), grid.rows(), wanted),
          errors(std::make_shared<ClipmapErrors>(grid, layout.levels() - layout.detailLevels())),
          detail(std::make_shared<SynthesisedDetail>(grid, DetailShape{layout.detailLevels(), amplitude, 7})),
          mesh(
              layout, options, boxes, [this] { return errors; }, detail) {}
    Scene(const Scene&) = delete;

    std::vector<UnitTriangle> triangles(const DrawList& list) const {
        std::vector<UnitTriangle> result;
        for (std::size_t first = 0; first + 2 < list.indices.size(); first += 3) {
            UnitTriangle t{};
            for (std::size_t i = 0; i < 3; ++i) {
                t.vertex[i] = list.indices[first + i];
                const std::uint32_t sample = list.samples[t.vertex[i]];
                const glm::ivec2 nearest(int(sample) % grid.columns(), int(sample) / grid.columns());
                t.at[i] = list.places.empty()
                              ? nearest
                              : glm::ivec2(glm::round(glm::dvec2(list.places[t.vertex[i]]) * double(layout.unitsPerSample())));
            }
            t.twiceArea = cross(t.at[1] - t.at[0], t.at[2] - t.at[0]);
            result.push_back(t);
        }
        return result;
    }

    SampleGrid grid;
    std::shared_ptr<const BoxPyramid> boxes;
    ClipmapLayout layout;
    std::shared_ptr<const ClipmapErrors> errors;
    std::shared_ptr<const SynthesisedDetail> detail;
    ClipmapMesh mesh;
};

/// One point in each quarter of a cell (bottom, right, top, left), in parts of it, which lies on no line between vertices.
constexpr int kParts = 65537;
constexpr glm::ivec2 kQuarter[4] = {{32771, 16411}, {49139, 32749}, {32717, 49193}, {16349, 32801}};

/// Number of triangles over each quarter of each unit's cell.
std::vector<int> coverage(const Scene& scene, const std::vector<UnitTriangle>& triangles) {
    const glm::ivec2 last = scene.layout.lastUnit();
    std::vector<int> count(std::size_t(last.x) * std::size_t(last.y) * 4);
    for (const UnitTriangle& t : triangles) {
        if (t.twiceArea == 0) continue;
        const glm::ivec2 low = glm::min(t.at[0], glm::min(t.at[1], t.at[2])), high = glm::max(t.at[0], glm::max(t.at[1], t.at[2]));
        for (int row = low.y; row < high.y; ++row)
            for (int column = low.x; column < high.x; ++column)
                for (std::size_t quarter = 0; quarter < 4; ++quarter) {
                    const glm::dvec2 p = glm::dvec2(column, row) + glm::dvec2(kQuarter[quarter]) / double(kParts);
                    bool inside = true;
                    for (std::size_t i = 0; i < 3 && inside; ++i) {
                        const glm::dvec2 from(t.at[i]), along = glm::dvec2(t.at[(i + 1) % 3]) - from;
                        inside = (along.x * (p.y - from.y) - along.y * (p.x - from.x) > 0.0) == (t.twiceArea > 0);
                    }
                    if (inside) ++count[(std::size_t(row) * std::size_t(last.x) + std::size_t(column)) * 4 + quarter];
                }
    }
    return count;
}

/// Whether the level that a unit's cell is drawn at has no hole at a corner of its own cell there.
bool isSolid(const Scene& scene, glm::ivec2 unit) {
    const auto& active = scene.mesh.clipmap().frame().active;
    for (int level = 0; level < scene.layout.levels(); ++level) {
        const glm::ivec2 cell = unit >> level;
        const ClipRect& region = active[std::size_t(level)];
        if (region.isEmpty() || !region.contains(cell) || !region.contains(cell + 1)) continue;
        const int samples = std::max(level, scene.layout.detailLevels());
        for (int i = 0; i < 4; ++i) {
            const glm::ivec2 corner =
                scene.layout.unitAt((unit >> samples) + glm::ivec2(i % 2, i / 2), samples) >> scene.layout.detailLevels();
            if (scene.grid.isHole(corner.x, corner.y)) return false;
        }
        return true;
    }
    return false;
}

/// Every cell is covered once, and those with a hole not at all. Of a mesh that was not culled.
std::string coverageProblem(const Scene& scene, const std::vector<UnitTriangle>& triangles, bool clockwise) {
    for (const UnitTriangle& t : triangles) {
        if (t.twiceArea != 0 && (t.twiceArea < 0) != clockwise) return "turns the wrong way at " + text(t.at[0]);
    }
    const std::vector<int> count = coverage(scene, triangles);
    const glm::ivec2 last = scene.layout.lastUnit();
    const bool holes = scene.boxes->hasHoles();
    for (std::size_t i = 0; i < count.size(); ++i) {
        const glm::ivec2 unit(int(i / 4) % last.x, int(i / 4) / last.x);
        const int wanted = !holes || isSolid(scene, unit) ? 1 : 0;
        if (count[i] != wanted) return "cell " + text(unit) + " is covered " + std::to_string(count[i]) + " times";
    }
    return {};
}

/// Vertices in one place have one position. Each edge has a triangle on its other side, or two whose common vertex stands on it
/// and a triangle without area between, or nothing because the terrain ends there. Without holes and culling.
std::string crackProblem(const Scene& scene, const DrawList& list, const std::vector<UnitTriangle>& triangles) {
    std::unordered_map<std::uint32_t, std::uint32_t> vertexAt;
    std::unordered_map<std::uint64_t, int> edges;
    std::set<std::array<std::uint32_t, 3>> seams;
    edges.reserve(4 * triangles.size());
    const Box all = boxOf(scene.boxes->all());
    const double size = glm::length(glm::dvec3(all.half)) + glm::length(glm::dvec3(all.centre));
    for (const UnitTriangle& t : triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const auto [known, isNew] = vertexAt.emplace(key(t.at[i]), t.vertex[i]);
            if (!isNew && list.positions[known->second] != list.positions[t.vertex[i]]) return "two positions at " + text(t.at[i]);
            if (t.twiceArea != 0 && ++edges[edgeKey(key(t.at[i]), key(t.at[(i + 1) % 3]))] > 1)
                return "two triangles on one side at " + text(t.at[i]);
        }
        if (t.twiceArea != 0) continue;
        const glm::dvec3 a(list.positions[t.vertex[0]]), m(list.positions[t.vertex[1]]), b(list.positions[t.vertex[2]]);
        const double part = glm::length(glm::dvec2(t.at[1] - t.at[0])) / glm::length(glm::dvec2(t.at[2] - t.at[0]));
        if (glm::length(a + (b - a) * part - m) > 1e-6 * size + 1e-6 * glm::length(b - a))
            return "off the coarser edge: " + text(t.at[1]);
        seams.insert({key(t.at[0]), key(t.at[1]), key(t.at[2])});
    }
    if (scene.boxes->hasHoles()) return {};
    std::map<std::uint32_t, std::vector<std::uint32_t>> open;
    for (const auto& [edge, times] : edges) {
        const std::uint32_t from = std::uint32_t(edge >> 32), to = std::uint32_t(edge);
        if (!edges.contains(edgeKey(to, from))) open[from].push_back(to);
    }
    const auto place = [](std::uint32_t k) { return glm::ivec2(int(k & 0xffff), int(k >> 16)); };
    std::set<std::uint64_t> closed;
    for (const auto& [a, ends] : open)
        for (const std::uint32_t b : ends)
            for (const std::uint32_t m : open.contains(b) ? open.at(b) : std::vector<std::uint32_t>{}) {
                const glm::ivec2 whole = place(b) - place(a), half = place(m) - place(a);
                const int along = half.x * whole.x + half.y * whole.y;
                const bool isBetween = cross(whole, half) == 0 && along > 0 && along < whole.x * whole.x + whole.y * whole.y;
                if (!isBetween || !edges.contains(edgeKey(m, a))) continue;
                if (!seams.contains({a, m, b}) && !seams.contains({b, m, a})) return "no seam at " + text(place(m));
                closed.insert({edgeKey(a, b), edgeKey(b, m), edgeKey(m, a)});
            }
    const glm::ivec2 last = scene.layout.lastUnit();
    for (const auto& [a, ends] : open)
        for (const std::uint32_t b : ends) {
            const glm::ivec2 p = place(a), q = place(b);
            const bool isBorder = (p.x == q.x && (p.x == 0 || p.x == last.x)) || (p.y == q.y && (p.y == 0 || p.y == last.y));
            if (!isBorder && !closed.contains(edgeKey(a, b))) return "an open edge from " + text(p) + " to " + text(q);
        }
    return {};
}

std::string problemOf(const Scene& scene, const DrawList& list, bool clockwise) {
    for (const std::uint32_t vertex : list.indices)
        if (vertex >= list.positions.size()) return "a vertex that is not in the pool";
    if (list.indices.size() != 3 * list.report.triangles) return "a report of another number of triangles";
    const auto triangles = scene.triangles(list);
    const std::string problem = coverageProblem(scene, triangles, clockwise);
    return problem.empty() ? crackProblem(scene, list, triangles) : problem;
}

/// The drawn surface at each sample, by the sample's index: calls found(column, row, drawn point).
template <class Found>
void forSamples(const Scene& scene, const DrawList& list, const Found& found) {
    const int step = scene.layout.unitsPerSample();
    for (const UnitTriangle& t : scene.triangles(list)) {
        if (t.twiceArea == 0) continue;
        const glm::ivec2 low = glm::min(t.at[0], glm::min(t.at[1], t.at[2])), high = glm::max(t.at[0], glm::max(t.at[1], t.at[2]));
        for (int row = (low.y + step - 1) / step; row * step <= high.y; ++row)
            for (int column = (low.x + step - 1) / step; column * step <= high.x; ++column) {
                const glm::ivec2 p = glm::ivec2(column, row) * step;
                glm::dvec3 drawn(0.0);
                bool inside = true;
                for (std::size_t i = 0; i < 3; ++i) {
                    const double weight = double(cross(t.at[(i + 1) % 3] - p, t.at[(i + 2) % 3] - p)) / double(t.twiceArea);
                    inside = inside && weight >= 0.0;
                    drawn += glm::dvec3(list.positions[t.vertex[i]]) * weight;
                }
                if (inside && !scene.grid.isHole(column, row)) found(column, row, drawn);
            }
    }
}

double worstError(const Scene& scene, const DrawList& list, const View& view) {
    double worst = 0.0;
    forSamples(scene, list, [&](int column, int row, const glm::dvec3& drawn) {
        const Projected sample = project(view, scene.grid.position(column, row));
        if (!sample.inView) return;
        const Projected shown = project(view, drawn);
        worst = std::max(worst, shown.w > 0.0 ? glm::distance(sample.pixel, shown.pixel) : std::numeric_limits<double>::infinity());
    });
    return worst;
}

/// What is in view of `all` and not in `drawn`.
std::string missingProblem(const Scene& scene, const DrawList& drawn, const Scene& whole, const DrawList& all, const View& view) {
    std::set<std::array<std::uint32_t, 3>> there;
    for (const UnitTriangle& t : scene.triangles(drawn)) there.insert({key(t.at[0]), key(t.at[1]), key(t.at[2])});
    for (const UnitTriangle& t : whole.triangles(all)) {
        if (there.contains({key(t.at[0]), key(t.at[1]), key(t.at[2])})) continue;
        const glm::dvec3 a(all.positions[t.vertex[0]]), b(all.positions[t.vertex[1]]), c(all.positions[t.vertex[2]]);
        for (const glm::dvec3& p : {a, b, c, (a + b + c) / 3.0})
            if (project(view, p).inView) return "not drawn: " + text(t.at[0]) + text(t.at[1]) + text(t.at[2]);
    }
    return {};
}

/// From `above` the ground over a place in samples, straight down.
View lookingDown(const SampleGrid& grid, const Box& box, glm::dvec2 sample, double above) {
    glm::dvec3 eye(grid.localFromFrame() * glm::dvec4(sample, double(box.highest().z) + above, 1.0));
    const glm::dmat4 camera = glm::lookAt(eye, eye - glm::dvec3(0.0, 0.0, 1.0), glm::dvec3(0.0, 1.0, 0.0));
    return {glm::perspective(1.2, 4.0 / 3.0, 0.01, 10000.0) * camera, {1024.0, 768.0}};
}

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
        for (std::size_t i = 0; i < before.size(); ++i) {
            if (std::isnan(now[i]) || std::isnan(before[i]) || now[i] == before[i]) continue;
            glm::dvec3 p(
                scene.grid.position(int(i % std::size_t(scene.grid.columns())), int(i / std::size_t(scene.grid.columns()))));
            if (!project(view, p).inView) continue;
            p.z = now[i];
            const glm::dvec2 there = project(view, p).pixel;
            p.z = before[i];
            largest = std::max(largest, glm::distance(there, project(view, p).pixel));
        }
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
        300, 300, {0, 0, 0, 0}, {}, boxes, [&] { return errors; }, nullptr);
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
            300, 300, {size, 0, 0, 0}, {}, boxes, [&] { return errors; }, nullptr);
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
        layout, {}, std::make_shared<BoxPyramid>(grid), [&] { return errors; }, nullptr);
    ClipmapMesh without(layout, {}, std::make_shared<BoxPyramid>(grid), {}, nullptr);
    const View view = flightView(terrain.box(), 1, 10);
    EXPECT_TRUE(std::isinf(mesh.select(grid, view, {}).report.errorPixels));
    EXPECT_TRUE(std::isinf(without.select(grid, view, {}).report.errorPixels));
    errors = std::make_shared<ClipmapErrors>(grid, layout.levels());
    EXPECT_TRUE(std::isfinite(mesh.select(grid, view, {}).report.errorPixels));
}

}  // namespace
}  // namespace terrain
