// A clipmap's mesh on the CPU with all that it needs, and what is wrong with what it draws.
#pragma once

#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "lod/ClipmapMesh.h"
#include "lod/ClipmapSurface.h"

#include "Maps.h"
#include "Views.h"

namespace terrain::test {

/// What rounding positions to floats may add, in pixels.
inline constexpr double kRounding = 0.03;

/// A drawn triangle in units of the finest level.
struct UnitTriangle {
    std::array<std::uint32_t, 3> vertex;
    std::array<glm::ivec2, 3> at;
    std::int64_t twiceArea;
};

inline std::int64_t cross(glm::ivec2 a, glm::ivec2 b) {
    return std::int64_t(a.x) * b.y - std::int64_t(a.y) * b.x;
}
inline std::string text(glm::ivec2 p) {
    return "(" + std::to_string(p.x) + ", " + std::to_string(p.y) + ")";
}
/// Units of the grids here fit into 16 bits.
inline std::uint32_t key(glm::ivec2 p) {
    return std::uint32_t(p.y) << 16 | std::uint32_t(p.x);
}
inline std::uint64_t edgeKey(std::uint32_t from, std::uint32_t to) {
    return std::uint64_t(from) << 32 | to;
}
inline bool sameBits(const glm::vec3& a, const glm::vec3& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

/// A mesh with all that it needs.
struct Scene {
    Scene(const Terrain& terrain, const ClipmapShape& wanted, ClipmapSettings options = {}, float amplitude = 0.0f)
        : grid(terrain.grid()), boxes(std::make_shared<BoxPyramid>(grid)), layout(grid.columns(), grid.rows(), wanted),
          errors(std::make_shared<ClipmapErrors>(grid, layout.levels() - layout.detailLevels())),
          detail(std::make_shared<SynthesisedDetail>(grid, DetailShape{layout.detailLevels(), amplitude, 7})),
          mesh(
              layout, options, boxes, [this](const SampleGrid&) { return errors; }, detail) {}
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
inline std::vector<int> coverage(const Scene& scene, const std::vector<UnitTriangle>& triangles) {
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
inline bool isSolid(const Scene& scene, glm::ivec2 unit) {
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
inline std::string coverageProblem(const Scene& scene, const std::vector<UnitTriangle>& triangles, bool clockwise) {
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
inline std::string crackProblem(const Scene& scene, const DrawList& list, const std::vector<UnitTriangle>& triangles) {
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

inline std::string problemOf(const Scene& scene, const DrawList& list, bool clockwise) {
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

inline double worstError(const Scene& scene, const DrawList& list, const View& view) {
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
inline std::string missingProblem(const Scene& scene, const DrawList& drawn, const Scene& whole, const DrawList& all, const View& view) {
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
inline View lookingDown(const SampleGrid& grid, const Box& box, glm::dvec2 sample, double above) {
    glm::dvec3 eye(grid.localFromFrame() * glm::dvec4(sample, double(box.highest().z) + above, 1.0));
    const glm::dmat4 camera = glm::lookAt(eye, eye - glm::dvec3(0.0, 0.0, 1.0), glm::dvec3(0.0, 1.0, 0.0));
    return {glm::perspective(1.2, 4.0 / 3.0, 0.01, 10000.0) * camera, {1024.0, 768.0}};
}

}  // namespace terrain::test
