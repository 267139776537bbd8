// Whatever is known of a grid, after edits: what building it anew gives, and meshes that keep their promise.
#include <bit>
#include <cmath>

#include <gtest/gtest.h>

#include "height/MapSource.h"
#include "lod/ChunkedLod.h"
#include "lod/ClipmapErrors.h"
#include "lod/ClipmapMesh.h"
#include "lod/GeoMipmapMesh.h"
#include "lod/RoamMesh.h"

#include "Maps.h"
#include "MeshCheck.h"
#include "TestTiles.h"
#include "Views.h"

using namespace terrain;
using namespace terrain::test;

namespace {

/// A terrain that is edited at random, with all that is kept of it.
class Edited {
public:
    explicit Edited(Terrain terrain) : terrain_(std::move(terrain)), grid_(terrain_.grid()), log_(std::make_shared<EditLog>()),
        boxes_(std::make_shared<BoxPyramid>(grid_)), errors_(std::make_shared<ErrorHierarchy>(grid_)) {}

    const SampleGrid& grid() const { return grid_; }
    TerrainModel model() const { return {boxes_, errors_, nullptr, nullptr, log_}; }
    const EditLog& log() const { return *log_; }
    std::shared_ptr<const EditLog> sharedLog() const { return log_; }
    Box box() const { return terrain_.box(); }

    /// Raises, lowers, levels, punches or fills a rectangle, `holes` or not.
    GridEdits edit(std::mt19937& random, bool holes) {
        const glm::ivec2 size(grid_.columns(), grid_.rows());
        SampleRect rect;
        for (int axis = 0; axis < 2; ++axis) {
            rect.low[axis] = uniformInt(random, 0, size[axis] - 1);
            rect.high[axis] = std::min(size[axis] - 1, rect.low[axis] + uniformInt(random, 0, random() % 4 ? 7 : size[axis]));
        }
        const int how = uniformInt(random, 0, holes ? 3 : 1);
        const float by = float(uniform(random, -12.0, 12.0));
        GridEdits edits{{rect}, false};
        for (int row = rect.low.y; row <= rect.high.y; ++row)
            for (int column = rect.low.x; column <= rect.high.x; ++column) {
                const bool was = grid_.isHole(column, row);
                const auto bump = [&](float height) { return how == 0 ? height + by * float(uniform(random, 0.5, 1.0)) : by; };
                const bool isHole = how == 2 ? (column + row) % 5 != 0 : how == 3 ? false : was;
                change(column, row, isHole, was, bump);
                edits.holes = edits.holes || was != isHole;
            }
        for (const SampleRect& r : edits.rects) boxes_->update(grid_, r);
        for (const SampleRect& r : edits.rects) errors_->update(grid_, r, *boxes_);
        log_->add(edits);
        return edits;
    }

private:
    template <class Bump>
    void change(int column, int row, bool isHole, bool was, const Bump& bump) {
        const std::size_t sample = grid_.index(column, row);
        if (terrain_.points.empty()) {
            float& height = terrain_.map.heights[sample];
            height = isHole ? kHole : bump(was ? 0.0f : height);
            return;
        }
        float* point = &terrain_.points[3 * sample];
        if (was && !isHole) point[0] = float(column), point[1] = float(row), point[2] = 0.0f;
        point[2] = isHole ? kHole : bump(point[2]);
    }

    Terrain terrain_;
    SampleGrid grid_;
    std::shared_ptr<EditLog> log_;
    std::shared_ptr<BoxPyramid> boxes_;
    std::shared_ptr<ErrorHierarchy> errors_;
};

bool isSame(float a, float b) { return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b); }

bool isSame(const BoxPyramid::Bounds& a, const BoxPyramid::Bounds& b) {
    for (int axis = 0; axis < 3; ++axis)
        if (!isSame(a.low[axis], b.low[axis]) || !isSame(a.high[axis], b.high[axis])) return false;
    return true;
}

int differences(const BoxPyramid& a, const BoxPyramid& b) {
    int count = a.hasHoles() != b.hasHoles() || !isSame(a.all(), b.all());
    for (int level = 0; level < a.levelCount(); ++level)
        for (int row = 0; row < a.rows(level); ++row)
            for (int column = 0; column < a.columns(level); ++column)
                count += !isSame(a.block(level, column, row), b.block(level, column, row));
    return count;
}

int differences(const SampleGrid& grid, const ErrorHierarchy& a, const ErrorHierarchy& b) {
    int count = a.hasHoles() != b.hasHoles() || a.isWhole() != b.isWhole();
    for (int row = 0; row <= a.side(); ++row)
        for (int column = 0; column <= a.side(); ++column) {
            if ((column % a.side() == 0 && row % a.side() == 0)) continue;
            const DiamondShape shape(glm::ivec2(column, row));
            count += !isSame(a.error(grid, shape), b.error(grid, shape));
        }
    return count;
}

int differences(const GeoMipmapErrors& a, const GeoMipmapErrors& b) {
    int count = 0;
    const BlockLayout& layout = a.layout();
    for (std::size_t block = 0; block < layout.blockCount(); ++block) {
        count += a.hasHoles(block) != b.hasHoles(block) || a.hasOtherDiagonal(block) != b.hasOtherDiagonal(block);
        for (int level = 1; level <= layout.exponent; ++level) count += !isSame(a.level(block, level), b.level(block, level));
        for (int level = 0; level < layout.exponent; ++level)
            for (int border = level + 1; border <= layout.exponent; ++border)
                for (int side = 0; side < 4; ++side) count += !isSame(a.side(block, side, level, border), b.side(block, side, level, border));
    }
    for (int level = 0; level < a.boundsLevels(); ++level)
        for (int row = 0; row < a.boundsRows(level); ++row)
            for (int column = 0; column < a.boundsColumns(level); ++column) count += !isSame(a.bounds(level, column, row), b.bounds(level, column, row));
    return count;
}

int differences(const ClipmapErrors& a, const ClipmapErrors& b) {
    int count = 0;
    for (int level = 0; level < a.levels(); ++level)
        for (int layer = 0; layer < a.layers(level); ++layer)
            for (int row = 0; row < a.blocks(level, layer).y; ++row)
                for (int column = 0; column < a.blocks(level, layer).x; ++column)
                    for (const bool blending : {false, true})
                        count += !isSame(a.error(level, blending, layer, {column, row}), b.error(level, blending, layer, {column, row}));
    return count;
}

class Editing : public testing::TestWithParam<Terrain> {
protected:
    Edited edited{GetParam()};
    std::mt19937 random{7};
};

/// Draws, edits and draws on, and checks each list.
template <class Algorithm>
void expectPromise(Edited& edited, std::mt19937& random, Algorithm& mesh, bool culls, int edits) {
    std::unique_ptr<LodAlgorithm> again;
    View view = nextView(random, edited.box(), 0);
    for (int i = 0; i < edits; ++i) {
        if (i % 3 == 2) view = nextView(random, edited.box(), i);
        LodSettings settings;
        settings.pixelError = 3.0f;
        settings.cull = culls;
        settings.geomorph = i % 2 == 1;
        settings.complete = true;
        mesh.select(edited.grid(), view, settings);
        const GridEdits change = edited.edit(random, false);
        ASSERT_TRUE(mesh.update(edited.grid(), change));
        const DrawList list = mesh.select(edited.grid(), view, settings);
        const auto triangles = trianglesOf(edited.grid(), list);
        ASSERT_LE(list.report.errorPixels, settings.pixelError) << "edit " << i;
        ASSERT_LE(worstScreenError(edited.grid(), list, triangles, view), settings.pixelError + 0.05) << "edit " << i;
        // A vertex stands where its sample is, or between others.
        if (!settings.geomorph) {
            ASSERT_EQ("", visibilityProblem(edited.grid(), triangles, view)) << "edit " << i;
            for (const std::uint32_t vertex : list.indices) {
                const int sample = int(list.samples[vertex]);
                const glm::vec3 p = edited.grid().position(sample % edited.grid().columns(), sample / edited.grid().columns());
                ASSERT_EQ(p, list.positions[vertex]) << "edit " << i;
            }
        }
    }
}

}  // namespace

TEST_P(Editing, GivesTheBoundsAndErrorsOfARebuildBitForBit)
{
    for (int i = 0; i < 60; ++i) {
        edited.edit(random, true);
        ASSERT_EQ(differences(*edited.model().boxes, BoxPyramid(edited.grid())), 0) << "edit " << i;
        ASSERT_EQ(differences(edited.grid(), *edited.model().errors, ErrorHierarchy(edited.grid())), 0) << "edit " << i;
    }
}

TEST_P(Editing, GivesTheTablesOfARebuild)
{
    for (const int tile : {2, 8, 32}) {
        GeoMipmapErrors errors(edited.grid(), tile, edited.sharedLog());
        for (int i = 0; i < 15; ++i) {
            edited.edit(random, true);
            if (i % 3 == 0) continue;
            errors.follow(edited.grid());
            ASSERT_EQ(differences(errors, GeoMipmapErrors(edited.grid(), tile)), 0) << "tiles of " << tile << ", edit " << i;
        }
    }
    ClipmapErrors errors(edited.grid(), 5);
    for (int i = 0; i < 30; ++i) {
        errors.update(edited.grid(), edited.edit(random, true));
        ASSERT_EQ(differences(errors, ClipmapErrors(edited.grid(), 5)), 0) << "edit " << i;
    }
}

INSTANTIATE_TEST_SUITE_P(Grids, Editing, testing::ValuesIn(smallTerrains()), [](const auto& info) { return std::to_string(info.index) + info.param.name; });

TEST(EditedMesh, OfRoamKeepsThePromise)
{
    for (const bool culls : {true, false}) {
        for (const Terrain& terrain : {fractal(129, 129), fractal(100, 71), flat(65), hemisphere(65, 65)}) {
            SCOPED_TRACE(terrain.name);
            Edited edited(terrain);
            std::mt19937 random(3);
            RoamMesh mesh(edited.model(), edited.grid());
            expectPromise(edited, random, mesh, culls, 40);
        }
    }
}

TEST(EditedMesh, OfGeoMipMappingKeepsThePromise)
{
    for (const Terrain& terrain : {fractal(129, 129), fractal(100, 71), flat(65), hemisphere(65, 65)}) {
        SCOPED_TRACE(terrain.name);
        Edited edited(terrain);
        std::mt19937 random(3);
        GeoMipmapMesh mesh(std::make_shared<GeoMipmapErrors>(edited.grid(), 8, edited.sharedLog()));
        expectPromise(edited, random, mesh, true, 40);
    }
}

TEST(EditedMesh, OfTilesKeepsThePromise)
{
    for (const Terrain& terrain : {fractal(129, 129), fractal(100, 71), flat(65), hemisphere(65, 65)}) {
        SCOPED_TRACE(terrain.name);
        Edited edited(terrain);
        std::mt19937 random(3);
        ChunkedLod mesh(edited.model(), edited.grid(), 16, nullptr);
        expectPromise(edited, random, mesh, true, 40);
    }
}

TEST(EditedTile, ThatKeepsItsVerticesKnowsABoundOfItsError)
{
    Edited edited(fractal(129, 129));
    std::mt19937 random(5);
    TileSamples samples(edited.grid(), *edited.model().boxes, nullptr);
    const TileTree tree{129, 129, 16};
    std::shared_ptr<const TileMesh> tile = buildTile(samples, tree, {tree.rootLevel(), 0, 0}, nullptr);
    for (int i = 0; i < 30; ++i) {
        const GridEdits edits = edited.edit(random, false);
        samples.update(edited.grid(), *edited.model().boxes, edits);
        tile = changedTile(samples, *tile, edits);
        float worst = 0.0f;
        for (std::size_t t = 0; t + 2 < tile->indices.size(); t += 3) {
            const glm::ivec2 a = tile->at[tile->indices[t]], b = tile->at[tile->indices[t + 1]], c = tile->at[tile->indices[t + 2]];
            const double area = double(b.x - a.x) * (c.y - a.y) - double(b.y - a.y) * (c.x - a.x);
            for (int row = std::min({a.y, b.y, c.y}); row <= std::max({a.y, b.y, c.y}); ++row)
                for (int column = std::min({a.x, b.x, c.x}); column <= std::max({a.x, b.x, c.x}); ++column) {
                    const double u = (double(b.x - column) * (c.y - row) - double(b.y - row) * (c.x - column)) / area;
                    const double v = (double(c.x - column) * (a.y - row) - double(c.y - row) * (a.x - column)) / area;
                    if (u < 0.0 || v < 0.0 || u + v > 1.0) continue;
                    const double surface = u * samples.heightRow(a.y)[a.x] + v * samples.heightRow(b.y)[b.x] + (1.0 - u - v) * samples.heightRow(c.y)[c.x];
                    worst = std::max(worst, float(std::fabs(surface - samples.heightRow(row)[column])));
                }
        }
        ASSERT_LE(worst, tile->error * 1.0001f + 1e-4f) << "edit " << i;
    }
}

TEST(EditLog, TellsWhatHasChangedSince)
{
    EditLog log;
    EXPECT_TRUE(log.since(0)->isEmpty());
    log.add({{{{1, 1}, {3, 3}}}, false});
    log.add({{{{50, 50}, {52, 52}}}, true});
    EXPECT_EQ(log.since(0)->rects.size(), 2u);
    EXPECT_FALSE(log.since(2)->holes);
    EXPECT_TRUE(log.since(1)->holes);
    EXPECT_TRUE(log.since(1)->contains({51, 50}));
    EXPECT_FALSE(log.since(1)->contains({2, 2}));
    EXPECT_FALSE(log.since(3)) << "of another log";
    for (int i = 0; i < 1000; ++i) log.add({{{{i % 7 * 10, i % 11 * 10}, {i % 7 * 10 + 3, i % 11 * 10 + 3}}}, false});
    EXPECT_FALSE(log.since(2)) << "too long ago";
    EXPECT_LE(log.since(800)->rects.size(), 33u);
    EXPECT_TRUE(log.since(1001)->contains({999 % 7 * 10, 999 % 11 * 10}));
}

TEST(MapInScratchSpace, KeepsEditsWhenItsPagesAreReleased)
{
    constexpr int kSide = 600;
    auto writer = ScratchWriter::create("test", std::uint64_t(kSide) * kSide);
    ASSERT_TRUE(writer) << writer.error().message();
    const std::vector<float> row(kSide, 1.0f);
    for (int i = 0; i < kSide; ++i) ASSERT_FALSE(writer.value().write(std::uint64_t(i) * kSide, row.data(), kSide));
    auto heights = std::move(writer).value().finish();
    ASSERT_TRUE(heights) << heights.error().message();
    MapSource source(HeightMap{kSide, kSide, std::move(heights).value(), {}, {1.0, 1.0}, {}});
    const std::vector<float> hill(33 * 33, 7.0f);
    source.setHeights({{100, 200}, {132, 232}}, hill.data());
    EXPECT_EQ(source.map()->heights.memoryBytes(), 0u) << "all came into memory";
    source.map()->releaseRows(0, kSide);
    const auto copy = source.copy();
    ASSERT_TRUE(copy) << copy.error().message();
    source.setHeights({{100, 200}, {100, 200}}, row.data());
    for (const MapSource* map : {const_cast<const MapSource*>(&source), const_cast<const MapSource*>(copy.value().get())}) {
        EXPECT_TRUE(map->map()->heights.isMapped());
        EXPECT_EQ(map->map()->at(132, 232), 7.0f);
        EXPECT_EQ(map->map()->at(133, 232), 1.0f);
        EXPECT_EQ(map->map()->at(100, 200), map == &source ? 1.0f : 7.0f);
    }
    EXPECT_EQ(source.edits().version(), 2u);
    EXPECT_EQ(copy.value()->edits().version(), 0u);
}

TEST(Edits, DoNotRaceWithTilesThatAreBeingBuilt)
{
    HeightMap map = fractalMap(257, 257);
    auto source = std::make_shared<MapSource>(map);
    const std::shared_ptr<SampleGate> gate(source, &source->gate());
    auto boxes = std::make_shared<BoxPyramid>(SampleGrid(*source->map()));
    auto log = std::make_shared<EditLog>();
    ChunkedLod mesh({boxes, nullptr, source, gate, log}, SampleGrid(*source->map()), 16, source);
    std::mt19937 random(9);
    LodSettings settings;
    settings.pixelError = 1.0f;
    const Box box = Terrain{"", map, {}}.box();
    for (int i = 0; i < 60; ++i) {
        const View view = nextView(random, box, i);
        mesh.select(SampleGrid(*source->map()), view, settings);
        std::vector<float> heights(20 * 20, float(i % 9));
        const glm::ivec2 low(uniformInt(random, 0, 237), uniformInt(random, 0, 237));
        const SampleRect rect{low, low + 19};
        source->setHeights(rect, heights.data());
        const SampleGrid grid(*source->map());
        boxes->update(grid, rect);
        ASSERT_TRUE(mesh.update(grid, {{rect}, false}));
        settings.complete = i % 10 == 9;
        const DrawList list = mesh.select(grid, view, settings);
        if (settings.complete) {
            ASSERT_LE(worstScreenError(grid, list, trianglesOf(grid, list), view), 1.05) << "edit " << i;
        }
    }
}
