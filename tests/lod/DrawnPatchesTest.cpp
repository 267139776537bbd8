// What algorithms tell of the mesh that they have drawn, and what colours it gets.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "Maps.h"
#include "MeshCheck.h"
#include "Views.h"
#include "base/TaskRunner.h"
#include "lod/BruteForceMesh.h"
#include "lod/ChunkedLod.h"
#include "lod/ClipmapMesh.h"
#include "lod/DebugColours.h"
#include "lod/GeoMipmapMesh.h"
#include "lod/RoamMesh.h"
#include "lod/TriangleErrors.h"

namespace terrain::test {

namespace {

enum class Kind { BruteForce, Roam, GeoMipmap, ChunkedLod, Clipmap };
constexpr Kind kKinds[] = {Kind::BruteForce, Kind::Roam, Kind::GeoMipmap, Kind::ChunkedLod, Kind::Clipmap};
constexpr const char* kNames[] = {"BruteForce", "Roam", "GeoMipmap", "ChunkedLod", "Clipmap"};

std::unique_ptr<LodAlgorithm> algorithmOf(Kind kind, const Terrain& terrain) {
    const SampleGrid grid = terrain.grid();
    const TerrainModel model = terrain.model();
    switch (kind) {
    case Kind::Roam:
        return std::make_unique<RoamMesh>(model, grid);
    case Kind::GeoMipmap:
        return std::make_unique<GeoMipmapMesh>(std::make_shared<GeoMipmapErrors>(grid, 8));
    case Kind::ChunkedLod:
        return std::make_unique<ChunkedLod>(model, grid, 16, nullptr);
    case Kind::Clipmap: {
        ClipmapShape shape;
        shape.size = 15;
        const auto errors = std::make_shared<const ClipmapErrors>(grid, 8);
        return std::make_unique<ClipmapMesh>(
            grid.columns(), grid.rows(), shape, ClipmapSettings{}, model.boxes, [errors](const SampleGrid&) { return errors; },
            nullptr);
    }
    default:
        return std::make_unique<BruteForceMesh>();
    }
}

using Corners = std::array<std::uint32_t, 3>;

/// The triangles of a list, each beginning with its smallest index: which comes first is nothing that matters.
std::vector<Corners> trianglesIn(std::span<const std::uint32_t> indices) {
    std::vector<Corners> triangles;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        Corners corners{indices[i], indices[i + 1], indices[i + 2]};
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        triangles.push_back(corners);
    }
    return triangles;
}

LodSettings settingsFor(int frame) {
    LodSettings settings;
    settings.pixelError = frame % 2 ? 2.0f : 8.0f;
    settings.geomorph = frame % 3 == 0;
    settings.clockwise = frame % 4 == 3;
    settings.complete = true;
    return settings;
}

class DrawnPatches : public testing::TestWithParam<Kind> {};

}  // namespace

TEST_P(DrawnPatches, AreTheTrianglesThatWereListed) {
    for (const Terrain& terrain : smallTerrains()) {
        SCOPED_TRACE(terrain.name);
        const auto mesh = algorithmOf(GetParam(), terrain);
        std::mt19937 random(5);
        std::vector<std::uint32_t> indices;
        for (int frame = 0; frame < 12; ++frame) {
            const View view = nextView(random, terrain.box(), frame);
            const DrawList list = mesh->select(terrain.grid(), view, settingsFor(frame));
            if (list.indicesChanged) indices.assign(list.indices.begin(), list.indices.end());
            std::vector<Corners> listed = trianglesIn(indices), told;
            mesh->eachPatch(terrain.grid(), [&](const DrawnPatch& patch) {
                const auto some = trianglesIn(patch.indices);
                told.insert(told.end(), some.begin(), some.end());
                ASSERT_EQ(patch.wholeGrid, list.wholeGrid);
                ASSERT_EQ(patch.positions.data(), list.positions.data());
                ASSERT_EQ(patch.samples.data(), list.samples.data());
            });
            std::sort(listed.begin(), listed.end());
            std::sort(told.begin(), told.end());
            ASSERT_EQ(listed, told) << "frame " << frame;
        }
    }
}

TEST_P(DrawnPatches, NextToEachOtherHaveOtherColours) {
    for (const Terrain& terrain : smallTerrains()) {
        SCOPED_TRACE(terrain.name);
        const SampleGrid grid = terrain.grid();
        const auto mesh = algorithmOf(GetParam(), terrain);
        std::mt19937 random(6);
        for (int frame = 0; frame < 8; ++frame) {
            mesh->select(grid, nextView(random, terrain.box(), frame), settingsFor(frame));
            // For each cell, the part that has a point of it.
            std::vector<std::tuple<int, int, int>> part(std::size_t(grid.columns()) * std::size_t(grid.rows()), {-1, -1, -100});
            std::vector<Colour> colour(part.size());
            mesh->eachPatch(grid, [&](const DrawnPatch& patch) {
                if (patch.closesGaps) return;
                for (std::size_t i = 0; i + 2 < patch.indices.size(); i += 3) {
                    glm::dvec2 at[3];
                    for (std::size_t j = 0; j < 3; ++j) {
                        const std::uint32_t sample = patch.wholeGrid ? patch.indices[i + j] : patch.samples[patch.indices[i + j]];
                        at[j] = {int(sample) % grid.columns(), int(sample) / grid.columns()};
                    }
                    const glm::dvec2 ab = at[1] - at[0], ac = at[2] - at[0];
                    const double area = ab.x * ac.y - ab.y * ac.x;
                    const glm::ivec2 low(glm::min(glm::min(at[0], at[1]), at[2])), high(glm::max(glm::max(at[0], at[1]), at[2]));
                    for (int row = low.y; row < high.y; ++row)
                        for (int column = low.x; column < high.x; ++column) {
                            const glm::dvec2 p = glm::dvec2(column + 0.31, row + 0.43) - at[0];
                            const double v = (p.x * ac.y - p.y * ac.x) / area, w = (ab.x * p.y - ab.y * p.x) / area;
                            if (v < 0.0 || w < 0.0 || v + w > 1.0) continue;
                            part[grid.index(column, row)] = {patch.place.x, patch.place.y, patch.size};
                            colour[grid.index(column, row)] = patchColour(patch);
                        }
                }
            });
            const auto isClear = [&](std::size_t a, std::size_t b) {
                if (part[a] == part[b] || std::get<0>(part[a]) < 0 || std::get<0>(part[b]) < 0) return true;
                const Colour off = glm::abs(colour[a] - colour[b]);
                return std::max({off.r, off.g, off.b}) > 0.1f;
            };
            for (int row = 0; row + 2 < grid.rows(); ++row)
                for (int column = 0; column + 2 < grid.columns(); ++column) {
                    const std::size_t here = grid.index(column, row);
                    ASSERT_TRUE(isClear(here, grid.index(column + 1, row))) << column << ' ' << row << " frame " << frame;
                    ASSERT_TRUE(isClear(here, grid.index(column, row + 1))) << column << ' ' << row << " frame " << frame;
                }
        }
    }
}

TEST_P(DrawnPatches, HaveTheErrorsThatAreMeasured) {
    double most = 0.0;
    for (const Terrain& terrain : smallTerrains()) {
        SCOPED_TRACE(terrain.name);
        const SampleGrid grid = terrain.grid();
        const auto mesh = algorithmOf(GetParam(), terrain);
        std::mt19937 random(7);
        std::vector<std::uint32_t> indices;
        for (int frame = 0; frame < 6; ++frame) {
            const View view = nextView(random, terrain.box(), frame);
            LodSettings settings = settingsFor(frame);
            settings.geomorph = false;
            DrawList list = mesh->select(grid, view, settings);
            if (list.indicesChanged) indices.assign(list.indices.begin(), list.indices.end());
            list.indices = indices;
            const TriangleErrors errors(grid, view);
            double found = 0.0;
            mesh->eachPatch(grid, [&](const DrawnPatch& patch) {
                if (patch.closesGaps) return;
                for (std::size_t i = 0; i + 2 < patch.indices.size(); i += 3) {
                    std::array<DrawnVertex, 3> corner;
                    for (std::size_t j = 0; j < 3; ++j) {
                        const std::uint32_t index = patch.indices[i + j], sample = patch.wholeGrid ? index : patch.samples[index];
                        const glm::ivec2 at(int(sample) % grid.columns(), int(sample) / grid.columns());
                        corner[j] = {patch.wholeGrid ? grid.position(at.x, at.y) : patch.positions[index], glm::vec2(at)};
                    }
                    found = std::max(found, double(errors.pixels(corner)));
                }
            });
            const double measured = list.wholeGrid ? 0.0 : worstScreenError(grid, list, trianglesOf(grid, list), view);
            if (std::isfinite(measured)) {
                EXPECT_NEAR(found, measured, 0.01 + 1e-3 * measured) << "frame " << frame;
                most = std::max(most, found);
            } else {
                EXPECT_EQ(found, measured) << "frame " << frame;
            }
        }
    }
    if (GetParam() != Kind::BruteForce) {
        EXPECT_GT(most, 0.5);
    }
}

INSTANTIATE_TEST_SUITE_P(Algorithms, DrawnPatches, testing::ValuesIn(kKinds), [](const auto& info) {
    return kNames[std::size_t(info.param)];
});

TEST(DebugColours, LevelIsTheSizeOfTheCell) {
    for (int level = -8; level <= 14; ++level) {
        const float size = std::ldexp(1.0f, level);
        const glm::vec2 o(300.0f, 200.0f), x(size, 0.0f), y(0.0f, size);
        EXPECT_EQ(levelOf(o, o + x, o + y), level);
        EXPECT_EQ(levelOf(o + x, o + y, o + x + y), level);
        EXPECT_EQ(levelOf(o - x, o + x, o + y), level) << "of twice the area, as bisection makes them";
        EXPECT_EQ(levelOf(o, o + x, o + 0.5f * x), level) << "without area";
    }
}

TEST(DebugColours, OfLevelsGetDarkerAndAreToldApart) {
    const auto lightness = [](const Colour& c) { return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b; };
    for (int level = kFinestLevel; level < kCoarsestLevel; ++level) {
        const Colour here = levelColour(level), next = levelColour(level + 1);
        EXPECT_LT(lightness(next), lightness(here)) << level;
        EXPECT_GT(glm::length(next - here), 0.08f) << level;
    }
    EXPECT_EQ(levelColour(30), levelColour(kCoarsestLevel));
    EXPECT_EQ(levelColour(-30), levelColour(kFinestLevel));
}

TEST(DebugColours, OfErrorsAreMagentaOnlyBeyondTheLimit) {
    EXPECT_EQ(errorColour(0.0f), errorRamp().front());
    EXPECT_EQ(errorColour(1.0f), errorRamp().back());
    EXPECT_EQ(errorColour(0.25f), errorRamp()[1]);
    for (const float broken : {1.01f, 2.0f, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()})
        EXPECT_EQ(errorColour(broken), kBrokenColour) << broken;
    for (float part = 0.0f; part <= 1.0f; part += 0.01f) EXPECT_GT(glm::length(errorColour(part) - kBrokenColour), 0.5f) << part;
}

}  // namespace terrain::test
