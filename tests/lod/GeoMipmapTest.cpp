// The mesh that Geo Mip-Mapping gives, whatever it is asked for: its shape, its promise, its levels.
#include <algorithm>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "lod/GeoMipmapMesh.h"

#include "Maps.h"
#include "MeshCheck.h"
#include "Views.h"

using namespace terrain;
using namespace terrain::test;

namespace {

/// What rounding positions to floats may add.
constexpr double kRounding = 0.03;

std::shared_ptr<const GeoMipmapErrors> errorsOf(const SampleGrid& grid, int tileSize)
{
    return std::make_shared<GeoMipmapErrors>(grid, tileSize);
}

class GeoMipmapOver : public testing::TestWithParam<Terrain> {
protected:
    const SampleGrid grid = GetParam().grid();
    const Box box = GetParam().box();
    std::mt19937 random{2024};

    LodSettings randomSettings()
    {
        constexpr float errors[] = {0.5f, 1.0f, 2.0f, 6.0f, 40.0f};
        LodSettings settings;
        settings.pixelError = errors[uniformInt(random, 0, 4)];
        settings.cull = uniformInt(random, 0, 1) != 0;
        settings.geomorph = uniformInt(random, 0, 1) != 0;
        settings.clockwise = uniformInt(random, 0, 3) == 0;
        return settings;
    }
    /// Now a jump, now a step of a flight.
    View nextView(int i) { return i % 3 == 0 ? randomView(random, box) : flightView(box, i, 40); }
    /// Enough views for a large map, and not too many.
    int viewCount() const { return grid.columns() * grid.rows() > 20000 ? 8 : 20; }
};

std::string described(const LodSettings& s, int i, int tileSize)
{
    return "tiles of " + std::to_string(tileSize) + ", view " + std::to_string(i) + ", pixelError " + std::to_string(s.pixelError) +
           (s.cull ? ", culled" : "") + (s.geomorph ? ", morphed" : "") + (s.clockwise ? ", clockwise" : "");
}

}  // namespace

TEST_P(GeoMipmapOver, HasNoCracksOverlapsOrGaps)
{
    for (const int tileSize : {2, 4, 8, 16, 64}) {
        GeoMipmapMesh mesh(errorsOf(grid, tileSize));
        for (int i = 0; i < viewCount(); ++i) {
            const LodSettings settings = randomSettings();
            const View view = nextView(i);
            const DrawList list = mesh.select(grid, view, settings);
            ASSERT_EQ("", meshProblem(grid, list, view, settings.clockwise, !settings.cull)) << described(settings, i, tileSize);
        }
    }
}

TEST_P(GeoMipmapOver, HasNoCracksOverlapsOrGapsFromStraightAbove)
{
    // An orthographic camera there sees no vertical error at all, but it does see holes and borders.
    const glm::vec3 low = box.lowest(), high = box.highest();
    const View above{glm::ortho(double(low.x), double(high.x), double(low.y), double(high.y), -high.z - 10.0, -low.z + 10.0), {300.0, 300.0}};
    for (const bool morph : {false, true})
        for (const bool cull : {false, true}) {
            GeoMipmapMesh mesh(errorsOf(grid, 8));
            LodSettings settings;
            settings.cull = cull;
            settings.geomorph = morph;
            const DrawList list = mesh.select(grid, above, settings);
            ASSERT_EQ("", meshProblem(grid, list, above, false, true)) << (cull ? "culled" : "not culled");
        }
}

TEST_P(GeoMipmapOver, DrawsEverySampleInViewWithinPixelError)
{
    for (const int tileSize : {2, 4, 8, 16, 64}) {
        GeoMipmapMesh mesh(errorsOf(grid, tileSize));
        for (int i = 0; i < viewCount(); ++i) {
            const LodSettings settings = randomSettings();
            const View view = nextView(i);
            const DrawList list = mesh.select(grid, view, settings);
            ASSERT_TRUE(list.report.converged);
            ASSERT_LE(list.report.errorPixels, settings.pixelError) << described(settings, i, tileSize);
            const double worst = worstScreenError(grid, list, trianglesOf(grid, list), view);
            ASSERT_LE(worst, list.report.errorPixels + kRounding) << described(settings, i, tileSize);
        }
    }
}

TEST_P(GeoMipmapOver, GivesFullDetailForAPixelErrorOfZero)
{
    GeoMipmapMesh mesh(errorsOf(grid, 8));
    LodSettings settings;
    settings.pixelError = 0.0f;
    for (int i = 0; i < 4; ++i) {
        settings.cull = i % 2;
        settings.geomorph = i / 2;
        const View view = nextView(i);
        const DrawList list = mesh.select(grid, view, settings);
        EXPECT_EQ(list.report.errorPixels, 0.0f);
        EXPECT_EQ("", meshProblem(grid, list, view, false, !settings.cull));
        EXPECT_LE(worstScreenError(grid, list, trianglesOf(grid, list), view), kRounding);
        for (const GridTriangle& t : trianglesOf(grid, list))
            for (std::size_t k = 0; k < 3; ++k)
                ASSERT_EQ(list.positions[t.vertex[k]], grid.position(t.corner[k].x, t.corner[k].y)) << "a vertex off its sample";
    }
}

TEST_P(GeoMipmapOver, RestsWhenNothingChanges)
{
    GeoMipmapMesh mesh(errorsOf(grid, 8));
    LodSettings settings;
    for (int i = 0; i < 6; ++i) {
        settings.geomorph = i % 2;
        const View view = nextView(i);
        const std::uint32_t triangles = mesh.select(grid, view, settings).report.triangles;
        const DrawList again = mesh.select(grid, view, settings);
        EXPECT_FALSE(again.positionsChanged);
        EXPECT_FALSE(again.indicesChanged);
        EXPECT_TRUE(again.newVertices.empty());
        EXPECT_EQ(again.report.triangles, triangles);
    }
}

TEST_P(GeoMipmapOver, CanBeFollowedByWhatItSaysHasChanged)
{
    GeoMipmapMesh mesh(errorsOf(grid, 8));
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> samples, indices;
    for (int i = 0; i < 2 * viewCount(); ++i) {
        const DrawList list = mesh.select(grid, nextView(i / 2), randomSettings());
        if (list.positionsChanged) positions.assign(list.positions.begin(), list.positions.end());
        if (list.indicesChanged) indices.assign(list.indices.begin(), list.indices.end());
        samples.resize(list.samples.size(), kNoVertex);
        for (const std::uint32_t vertex : list.newVertices) samples[vertex] = list.samples[vertex];
        ASSERT_EQ(positions.size(), list.positions.size());
        ASSERT_EQ(indices.size(), 3 * list.report.triangles);
        for (const std::uint32_t vertex : indices) {
            ASSERT_EQ(positions[vertex], list.positions[vertex]) << i;
            ASSERT_EQ(samples[vertex], list.samples[vertex]) << i;
        }
    }
}

TEST_P(GeoMipmapOver, GivesWhatAFreshMeshWouldGive)
{
    // Selections do not depend on those before: neither their triangles nor, sample by sample, where their vertices stand.
    const auto errors = errorsOf(grid, 8);
    GeoMipmapMesh travelled(errors);
    for (int i = 0; i < viewCount(); ++i) {
        const LodSettings settings = randomSettings();
        const View view = nextView(i);
        GeoMipmapMesh fresh(errors);
        const DrawList a = travelled.select(grid, view, settings), b = fresh.select(grid, view, settings);
        ASSERT_EQ(a.indices.size(), b.indices.size());
        for (std::size_t k = 0; k < a.indices.size(); ++k) {
            ASSERT_EQ(a.samples[a.indices[k]], b.samples[b.indices[k]]);
            const glm::vec3 p = a.positions[a.indices[k]], q = b.positions[b.indices[k]];
            ASSERT_EQ(std::memcmp(&p, &q, sizeof(p)), 0);
        }
        ASSERT_EQ(std::memcmp(&a.report.errorPixels, &b.report.errorPixels, sizeof(float)), 0);
    }
}

INSTANTIATE_TEST_SUITE_P(Terrains, GeoMipmapOver, testing::ValuesIn(terrains()),
                         [](const testing::TestParamInfo<Terrain>& info) { return info.param.name; });
