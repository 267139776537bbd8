// Draped lines lie on the full-resolution surface; views leave out what does not show.
#include "lod/DrapedLines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

#include "lod/DrapeView.h"

using namespace terrain;

namespace {

HeightMap roughMap(int columns, int rows) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> height(0.0f, 5.0f);
    HeightMap map;
    map.columns = columns;
    map.rows = rows;
    for (int i = 0; i < columns * rows; ++i) map.heights.push_back(height(random));
    return map;
}

/// The higher of the surfaces of the two diagonals, by barycentric weights of its own.
double higherSurface(const SampleGrid& grid, double x, double y) {
    const int c = std::clamp(int(std::floor(x)), 0, grid.columns() - 2), r = std::clamp(int(std::floor(y)), 0, grid.rows() - 2);
    const double u = x - c, v = y - r;
    const double z00 = grid.height(c, r), z10 = grid.height(c + 1, r), z01 = grid.height(c, r + 1), z11 = grid.height(c + 1, r + 1);
    const double falling =
        u + v <= 1.0 ? (1.0 - u - v) * z00 + u * z10 + v * z01 : (u + v - 1.0) * z11 + (1.0 - u) * z01 + (1.0 - v) * z10;
    const double rising = u >= v ? (1.0 - u) * z00 + (u - v) * z10 + v * z11 : (1.0 - v) * z00 + (v - u) * z01 + u * z11;
    return std::max(falling, rising);
}

DrapeInput polyline(std::vector<glm::dvec2> places) {
    DrapeInput input;
    input.counts = {int(places.size())};
    input.places = std::move(places);
    return input;
}

}  // namespace

TEST(DrapedLines, LieOnTheHigherSurfaceEverywhere) {
    const HeightMap map = roughMap(23, 17);
    const SampleGrid grid(map);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> x(0.0, 22.0), y(0.0, 16.0), unit(0.0, 1.0);
    for (int round = 0; round < 200; ++round) {
        std::vector<glm::dvec2> places{{x(random), y(random)}, {x(random), y(random)}, {x(random), y(random)}};
        // Along rows, columns, diagonals and between samples, too.
        if (round % 3 == 1)
            for (auto& place : places) place = {std::round(place.x), std::round(place.y)};
        if (round % 7 == 2) places[1] = {places[0].x, 16.0 - places[0].y};
        const DrapedLines lines(grid, polyline(places));
        double covered = 0.0;
        for (const auto& run : lines.runs())
            for (std::uint32_t i = run.first; i + 1 < run.first + run.count; ++i) {
                const auto &a = lines.vertices()[i], &b = lines.vertices()[i + 1];
                const float t = float(unit(random));
                const glm::vec3 at = glm::mix(a.position, b.position, t);
                EXPECT_NEAR(at.z, higherSurface(grid, at.x, at.y), 1e-4) << at.x << ", " << at.y;
                covered += glm::length(glm::dvec2(b.position) - glm::dvec2(a.position));
            }
        EXPECT_NEAR(covered, glm::length(places[1] - places[0]) + glm::length(places[2] - places[1]), 1e-4);
    }
}

TEST(DrapedLines, EndAtHolesAndAtTheBorder) {
    HeightMap map = roughMap(21, 11);
    map.heights[5 * 21 + 10] = std::numeric_limits<float>::quiet_NaN();
    const SampleGrid grid(map);
    const DrapedLines lines(grid, polyline({{-5.0, 5.25}, {30.0, 5.25}}));
    ASSERT_EQ(lines.runs().size(), 2u);
    const auto ends = [&](int run) {
        const auto& r = lines.runs()[std::size_t(run)];
        return glm::vec2(lines.vertices()[r.first].position.x, lines.vertices()[r.first + r.count - 1].position.x);
    };
    EXPECT_NEAR(ends(0).x, 0.0f, 1e-5f);
    EXPECT_NEAR(ends(0).y, 9.0f, 1e-5f);
    EXPECT_NEAR(ends(1).x, 11.0f, 1e-5f);
    EXPECT_NEAR(ends(1).y, 20.0f, 1e-5f);
    for (const auto& vertex : lines.vertices()) EXPECT_TRUE(std::isfinite(vertex.position.z));
    EXPECT_TRUE(DrapedLines(grid, polyline({{-5.0, -1.0}, {30.0, -1.0}})).runs().empty());
    EXPECT_TRUE(DrapedLines(grid, polyline({{3.0, 3.0}, {std::nan(""), 4.0}})).runs().empty());
    // On the border of a hole the neighbour's side is there.
    EXPECT_EQ(DrapedLines(grid, polyline({{9.0, 0.0}, {9.0, 10.0}})).runs().size(), 1u);
    DrapeInput points = polyline({{10.0, 5.0}, {-1.0, 3.0}, {20.0, 10.0}, {0.0, 0.0}});
    points.lines = false;
    EXPECT_EQ(DrapedLines(grid, points).runs().size(), 2u);
}

TEST(DrapedLines, ClosedPolylinesComeBackToTheirFirstPlace) {
    const HeightMap map = roughMap(21, 21);
    DrapeInput input = polyline({{2.0, 2.0}, {12.5, 3.0}, {9.0, 15.0}, {4.0, 4.0}, {5.0, 6.0}});
    input.counts = {3, 2};
    input.closed = true;
    const DrapedLines lines(SampleGrid(map), input);
    ASSERT_EQ(lines.runs().size(), 4u);
    EXPECT_TRUE(lines.runs()[2].continues);
    EXPECT_EQ(lines.runs()[2].nextPlace, 0);
    EXPECT_EQ(lines.runs()[3].polyline, 1);
    EXPECT_FALSE(lines.runs()[3].continues);
}

TEST(DrapeView, LeavesOutOnlyWhatDoesNotShow) {
    const HeightMap map = roughMap(513, 513);
    const SampleGrid grid(map);
    const DrapedLines lines(grid, polyline({{3.0, 5.0}, {500.0, 490.0}, {20.0, 400.0}}));
    std::size_t last = lines.vertices().size();
    for (const double height : {20.0, 200.0, 3000.0, 40000.0}) {
        View view;
        view.viewportPixels = {800.0, 600.0};
        view.clipFromLocal =
            glm::perspective(0.8, 800.0 / 600.0, 1.0, 1e5) *
            glm::lookAt(glm::dvec3(256.0, 256.0 - height, height), glm::dvec3(256.0, 256.0, 0.0), glm::dvec3(0.0, 0.0, 1.0));
        DrapeSettings settings;
        settings.top = 5.0f;
        const DrapeView drape(lines, view, grid.localFromFrame(), settings);
        const DrapeSelection selection = drape.select();
        EXPECT_EQ(selection.firsts.size(), 1u);
        // From near by, little of the lines is in view.
        if (height > 100.0) {
            EXPECT_LE(selection.positions.size(), last);
            last = selection.positions.size();
        }
        const auto onScreen = [&](const glm::dvec3& p) {
            const glm::dvec4 clip = view.clipFromLocal * glm::dvec4(p, 1.0);
            return glm::dvec3(glm::dvec2(clip) / clip.w * view.viewportPixels * 0.5, clip.w);
        };
        // Every vertex, raised, is near the part of the strip that stands for it.
        std::size_t at = 0;
        for (std::uint32_t i = 0; i < lines.vertices().size(); ++i) {
            while (at + 2 < selection.vertices.size() && selection.vertices[at + 1].vertex < i) ++at;
            glm::dvec3 place(lines.vertices()[i].position);
            place.z += drape.raise(place);
            const glm::dvec3 p = onScreen(place), a = onScreen(glm::dvec3(selection.positions[at])),
                             b = onScreen(glm::dvec3(selection.positions[at + 1]));
            if (!(p.z > 0.0 && a.z > 0.0 && b.z > 0.0)) continue;
            if (std::fabs(p.x) > view.viewportPixels.x * 0.5 || std::fabs(p.y) > view.viewportPixels.y * 0.5) continue;
            const glm::dvec2 along(b - a), to(p - a);
            const double t = std::clamp(glm::dot(to, along) / std::max(1e-12, glm::dot(along, along)), 0.0, 1.0);
            EXPECT_LE(glm::length(to - along * t), 0.3) << "vertex " << i << " from a height of " << height;
        }
    }
    EXPECT_LT(last, 20u);
}
