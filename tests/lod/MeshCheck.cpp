#include "MeshCheck.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <unordered_map>

#include <glm/geometric.hpp>

#include "lod/BruteForceMesh.h"
#include "Views.h"

namespace terrain::test {

namespace {

std::string text(glm::ivec2 p)
{
    return "(" + std::to_string(p.x) + ", " + std::to_string(p.y) + ")";
}

std::string text(const GridTriangle& t)
{
    return text(t.corner[0]) + text(t.corner[1]) + text(t.corner[2]);
}

std::int64_t cross(glm::ivec2 a, glm::ivec2 b)
{
    return std::int64_t(a.x) * b.y - std::int64_t(a.y) * b.x;
}

std::int64_t twiceArea(const GridTriangle& t)
{
    return cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]);
}

bool isValidCell(const SampleGrid& grid, int column, int row)
{
    return column >= 0 && row >= 0 && column < grid.columns() - 1 && row < grid.rows() - 1 && !isCellHole(grid, column, row);
}

/// Points in the middles of the quarters of a cell (bottom, right, top, left), in parts of a cell. Their number is prime and the points are a
/// little off, so that they lie on no line between samples.
constexpr int kParts = 65537;
constexpr glm::ivec2 kQuarter[4] = {{32771, 16411}, {49139, 32749}, {32717, 49193}, {16349, 32801}};

std::size_t quarterIndex(const SampleGrid& grid, int column, int row, int quarter)
{
    return grid.index(column, row) * 4 + std::size_t(quarter);
}

/// Number of triangles over each quarter, by quarterIndex().
std::vector<int> countCoverage(const SampleGrid& grid, const std::vector<GridTriangle>& triangles)
{
    std::vector<int> count(std::size_t(grid.columns()) * std::size_t(grid.rows()) * 4);
    for (const GridTriangle& t : triangles) {
        const auto [left, right] = std::minmax({t.corner[0].x, t.corner[1].x, t.corner[2].x});
        const auto [bottom, top] = std::minmax({t.corner[0].y, t.corner[1].y, t.corner[2].y});
        const bool turned = twiceArea(t) < 0;
        for (int row = bottom; row < top; ++row)
            for (int column = left; column < right; ++column)
                for (int quarter = 0; quarter < 4; ++quarter) {
                    const glm::ivec2 p = glm::ivec2(column, row) * kParts + kQuarter[quarter];
                    bool inside = true;
                    for (std::size_t i = 0; i < 3 && inside; ++i) {
                        const glm::ivec2 from = t.corner[i] * kParts, to = t.corner[(i + 1) % 3] * kParts;
                        inside = (cross(to - from, p - from) > 0) != turned;
                    }
                    if (inside) ++count[quarterIndex(grid, column, row, quarter)];
                }
    }
    return count;
}

struct EdgeUse {
    int forward = 0;
    int backward = 0;
};

std::uint64_t edgeKey(const SampleGrid& grid, glm::ivec2 a, glm::ivec2 b)
{
    return std::uint64_t(grid.index(a.x, a.y)) << 32 | std::uint64_t(grid.index(b.x, b.y));
}

bool isOrdered(glm::ivec2 a, glm::ivec2 b)
{
    return a.y < b.y || (a.y == b.y && a.x < b.x);
}

std::unordered_map<std::uint64_t, EdgeUse> countEdges(const SampleGrid& grid, const std::vector<GridTriangle>& triangles)
{
    std::unordered_map<std::uint64_t, EdgeUse> edges;
    edges.reserve(triangles.size() * 2);
    for (const GridTriangle& t : triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::ivec2 a = t.corner[i], b = t.corner[(i + 1) % 3];
            if (isOrdered(a, b))
                ++edges[edgeKey(grid, a, b)].forward;
            else
                ++edges[edgeKey(grid, b, a)].backward;
        }
    return edges;
}

/// The cell left of the unit step from a along `step`, which is not diagonal.
glm::ivec2 cellLeftOf(glm::ivec2 a, glm::ivec2 step)
{
    if (step.x > 0) return a;
    if (step.x < 0) return {a.x - 1, a.y - 1};
    return step.y > 0 ? glm::ivec2(a.x - 1, a.y) : glm::ivec2(a.x, a.y - 1);
}

glm::ivec2 unitStep(glm::ivec2 a, glm::ivec2 b)
{
    return (b - a) / std::gcd(std::abs(b.x - a.x), std::abs(b.y - a.y));
}

}  // namespace

std::vector<GridTriangle> trianglesOf(const SampleGrid& grid, const DrawList& list)
{
    std::vector<GridTriangle> triangles;
    for (std::size_t first = 0; first + 2 < list.indices.size(); first += 3) {
        GridTriangle t{};
        for (std::size_t i = 0; i < 3; ++i) {
            t.vertex[i] = list.indices[first + i];
            const std::size_t sample = list.wholeGrid ? t.vertex[i] : t.vertex[i] < list.samples.size() ? list.samples[t.vertex[i]] : kNoVertex;
            t.corner[i] = {int(sample % std::size_t(grid.columns())), int(sample / std::size_t(grid.columns()))};
        }
        triangles.push_back(t);
    }
    return triangles;
}

std::string conformityProblem(const SampleGrid& grid, const std::vector<GridTriangle>& triangles, bool clockwise)
{
    std::vector<bool> used(std::size_t(grid.columns()) * std::size_t(grid.rows()));
    for (const GridTriangle& t : triangles) {
        for (const glm::ivec2 corner : t.corner) {
            if (!grid.contains(corner.x, corner.y)) return "a corner outside of the grid: " + text(t);
            if (grid.isHole(corner.x, corner.y)) return "a corner in a hole: " + text(t);
            used[grid.index(corner.x, corner.y)] = true;
        }
        if (twiceArea(t) == 0) return "no area: " + text(t);
        if ((twiceArea(t) < 0) != clockwise) return "turns the wrong way: " + text(t);
    }
    for (const auto& [key, use] : countEdges(grid, triangles))
        if (use.forward > 1 || use.backward > 1) return "an edge with two triangles on one side";
    for (const GridTriangle& t : triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::ivec2 a = t.corner[i], b = t.corner[(i + 1) % 3], step = unitStep(a, b);
            for (glm::ivec2 p = a + step; p != b; p += step)
                if (used[grid.index(p.x, p.y)]) return "a vertex at " + text(p) + " within an edge of " + text(t);
        }
    return {};
}

std::string overlapProblem(const SampleGrid& grid, const std::vector<GridTriangle>& triangles)
{
    const std::vector<int> count = countCoverage(grid, triangles);
    for (int row = 0; row < grid.rows() - 1; ++row)
        for (int column = 0; column < grid.columns() - 1; ++column)
            for (int quarter = 0; quarter < 4; ++quarter) {
                const int times = count[quarterIndex(grid, column, row, quarter)];
                if (times > 1) return "cell " + text(glm::ivec2(column, row)) + " is covered " + std::to_string(times) + " times";
                if (times > 0 && isCellHole(grid, column, row)) return "the hole at " + text(glm::ivec2(column, row)) + " is covered";
            }
    return {};
}

std::string completenessProblem(const SampleGrid& grid, const std::vector<GridTriangle>& triangles)
{
    const std::vector<int> count = countCoverage(grid, triangles);
    for (int row = 0; row < grid.rows() - 1; ++row)
        for (int column = 0; column < grid.columns() - 1; ++column)
            for (int quarter = 0; quarter < 4; ++quarter)
                if (isValidCell(grid, column, row) && count[quarterIndex(grid, column, row, quarter)] == 0)
                    return "cell " + text(glm::ivec2(column, row)) + " is not covered";
    const auto edges = countEdges(grid, triangles);
    for (const GridTriangle& t : triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            glm::ivec2 a = t.corner[i], b = t.corner[(i + 1) % 3];
            const EdgeUse use = edges.at(isOrdered(a, b) ? edgeKey(grid, a, b) : edgeKey(grid, b, a));
            if (use.forward + use.backward == 2) continue;
            // The other side lies to the right of a triangle that turns counter-clockwise.
            if (twiceArea(t) > 0) std::swap(a, b);
            const glm::ivec2 step = unitStep(a, b);
            if (step.x != 0 && step.y != 0) return "a diagonal with one triangle only: " + text(t);
            for (glm::ivec2 p = a; p != b; p += step)
                if (const glm::ivec2 cell = cellLeftOf(p, step); isValidCell(grid, cell.x, cell.y))
                    return "no triangle beside " + text(t) + " in cell " + text(cell);
        }
    return {};
}

std::string visibilityProblem(const SampleGrid& grid, const std::vector<GridTriangle>& triangles, const View& view)
{
    const std::vector<int> count = countCoverage(grid, triangles);
    std::vector<bool> inView(std::size_t(grid.columns()) * std::size_t(grid.rows()));
    for (int row = 0; row < grid.rows(); ++row)
        for (int column = 0; column < grid.columns(); ++column)
            inView[grid.index(column, row)] = !grid.isHole(column, row) && project(view, grid.position(column, row)).inView;
    constexpr glm::ivec2 kCorner[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (int row = 0; row < grid.rows() - 1; ++row)
        for (int column = 0; column < grid.columns() - 1; ++column) {
            if (!isValidCell(grid, column, row)) continue;
            for (int quarter = 0; quarter < 4; ++quarter) {
                if (count[quarterIndex(grid, column, row, quarter)] > 0) continue;
                const glm::ivec2 a = glm::ivec2(column, row) + kCorner[quarter], b = glm::ivec2(column, row) + kCorner[(quarter + 1) % 4];
                const glm::ivec2 c = glm::ivec2(column, row) + kCorner[(quarter + 2) % 4];
                const auto position = [&grid](glm::ivec2 p) { return glm::dvec3(grid.position(p.x, p.y)); };
                const glm::dvec3 middle = position(a) * 0.5 + position(b) * 0.25 + position(c) * 0.25;
                if (inView[grid.index(a.x, a.y)] || inView[grid.index(b.x, b.y)] || project(view, middle).inView)
                    return "cell " + text(glm::ivec2(column, row)) + " is in view and not drawn";
            }
        }
    return {};
}

double worstScreenError(const SampleGrid& grid, const DrawList& list, const std::vector<GridTriangle>& triangles, const View& view)
{
    double worst = 0.0;
    for (const GridTriangle& t : triangles) {
        const auto [left, right] = std::minmax({t.corner[0].x, t.corner[1].x, t.corner[2].x});
        const auto [bottom, top] = std::minmax({t.corner[0].y, t.corner[1].y, t.corner[2].y});
        const double area = double(twiceArea(t));
        for (int row = bottom; row <= top; ++row)
            for (int column = left; column <= right; ++column) {
                const glm::ivec2 p(column, row);
                glm::dvec3 drawn(0.0);
                bool inside = true;
                for (std::size_t i = 0; i < 3; ++i) {
                    const double weight = double(cross(t.corner[(i + 1) % 3] - p, t.corner[(i + 2) % 3] - p)) / area;
                    inside = inside && weight >= 0.0;
                    drawn += glm::dvec3(list.positions[t.vertex[i]]) * weight;
                }
                if (!inside || grid.isHole(column, row)) continue;
                const Projected sample = project(view, grid.position(column, row));
                if (!sample.inView) continue;
                const Projected shown = project(view, drawn);
                worst = std::max(worst, shown.w > 0.0 ? glm::distance(sample.pixel, shown.pixel) : std::numeric_limits<double>::infinity());
            }
    }
    return worst;
}

std::string meshProblem(const SampleGrid& grid, const DrawList& list, const View& view, bool clockwise, bool complete)
{
    if (list.indices.size() % 3 != 0) return "indices that are not in threes";
    for (const std::uint32_t vertex : list.indices)
        if (vertex >= list.positions.size()) return "a vertex that is not in the pool";
    const std::vector<GridTriangle> triangles = trianglesOf(grid, list);
    if (triangles.size() != list.report.triangles) return "a report of another number of triangles";
    std::string problem = conformityProblem(grid, triangles, clockwise);
    if (problem.empty()) problem = overlapProblem(grid, triangles);
    if (problem.empty()) problem = complete ? completenessProblem(grid, triangles) : visibilityProblem(grid, triangles, view);
    return problem;
}

}  // namespace terrain::test
