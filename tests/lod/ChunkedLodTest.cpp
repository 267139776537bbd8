// The tiles that Chunked LoD draws together: their surface, the walls between them, their promise, and what streaming does to it.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <thread>

#include <gtest/gtest.h>

#include "lod/ChunkedLod.h"

#include "Maps.h"
#include "MeshCheck.h"
#include "Views.h"

using namespace terrain;
using namespace terrain::test;

namespace {

/// What rounding positions to floats may add.
constexpr double kRounding = 0.03;

LodSettings completeSettings(float pixelError)
{
    LodSettings settings;
    settings.pixelError = pixelError;
    settings.geomorph = true;
    settings.complete = true;
    return settings;
}

/// The list's triangles but for the walls, which have no area seen from above.
std::vector<GridTriangle> groundOf(const SampleGrid& grid, const DrawList& list)
{
    std::vector<GridTriangle> triangles = trianglesOf(grid, list);
    std::erase_if(triangles, [](const GridTriangle& t) {
        const glm::ivec2 a = t.corner[1] - t.corner[0], b = t.corner[2] - t.corner[0];
        return a.x * b.y == a.y * b.x;
    });
    return triangles;
}

/// Edges that have no other side, though they lie neither on the border of the grid nor at a hole.
int openEdges(const SampleGrid& grid, const std::vector<GridTriangle>& triangles)
{
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    std::map<std::uint32_t, glm::ivec2> at;
    for (const GridTriangle& t : triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            ++edges[{t.vertex[i], t.vertex[(i + 1) % 3]}];
            at[t.vertex[i]] = t.corner[i];
        }
    const auto onBorder = [&grid](glm::ivec2 a, glm::ivec2 b) {
        return (a.x == b.x && (a.x == 0 || a.x == grid.columns() - 1)) || (a.y == b.y && (a.y == 0 || a.y == grid.rows() - 1));
    };
    int open = 0;
    for (const auto& [edge, count] : edges) {
        const glm::ivec2 a = at[edge.first], b = at[edge.second];
        // Upright edges of walls meet at a corner of tiles, where they all lie in one line.
        if (a == b || onBorder(a, b)) continue;
        const auto back = edges.find({edge.second, edge.first});
        if (back == edges.end() || back->second != count) ++open;
    }
    return open;
}

/// Where every sample in view is drawn, in pixels: those between two tiles by each of them.
using DrawnSamples = std::map<std::uint32_t, std::vector<glm::dvec2>>;

DrawnSamples drawnSamples(const SampleGrid& grid, const DrawList& list, const View& view)
{
    DrawnSamples drawn;
    for (const GridTriangle& t : groundOf(grid, list)) {
        const glm::ivec2 low = glm::min(glm::min(t.corner[0], t.corner[1]), t.corner[2]);
        const glm::ivec2 high = glm::max(glm::max(t.corner[0], t.corner[1]), t.corner[2]);
        const glm::dvec2 ab(t.corner[1] - t.corner[0]), ac(t.corner[2] - t.corner[0]);
        const double area = ab.x * ac.y - ab.y * ac.x;
        for (int row = low.y; row <= high.y; ++row)
            for (int column = low.x; column <= high.x; ++column) {
                const glm::dvec2 p = glm::dvec2(column, row) - glm::dvec2(t.corner[0]);
                const double u = (p.x * ac.y - p.y * ac.x) / area, v = (ab.x * p.y - ab.y * p.x) / area;
                if (u < -1e-9 || v < -1e-9 || u + v > 1.0 + 1e-9) continue;
                const glm::dvec3 a(list.positions[t.vertex[0]]), b(list.positions[t.vertex[1]]), c(list.positions[t.vertex[2]]);
                const Projected found = project(view, a + u * (b - a) + v * (c - a));
                if (found.inView) drawn[std::uint32_t(grid.index(column, row))].push_back(found.pixel);
            }
    }
    return drawn;
}

class ChunkedLodOver : public testing::TestWithParam<Terrain> {
protected:
    const SampleGrid grid = GetParam().grid();
    const Box box = GetParam().box();
    std::mt19937 random{77};

    TerrainModel model() const { return {std::make_shared<BoxPyramid>(grid), nullptr, nullptr}; }
    std::unique_ptr<ChunkedLod> tiles(int tileCells) const { return std::make_unique<ChunkedLod>(model(), grid, tileCells, nullptr); }
    int viewCount() const { return grid.columns() * grid.rows() > 20000 ? 8 : 20; }
    float nextError(int i) const { return std::array{0.5f, 1.0f, 2.0f, 6.0f, 40.0f}[std::size_t(i % 5)]; }
};

}  // namespace

TEST_P(ChunkedLodOver, CoversWhatIsInViewOnceAndKeepsThePromise)
{
    for (const int tileCells : {8, 16, 64}) {
        const auto mesh = tiles(tileCells);
        for (int i = 0; i < viewCount(); ++i) {
            const View view = nextView(random, box, i);
            const LodSettings settings = completeSettings(nextError(i));
            const DrawList list = mesh->select(grid, view, settings);
            const auto ground = groundOf(grid, list);
            ASSERT_EQ(overlapProblem(grid, ground), "") << GetParam() << ", tiles of " << tileCells << ", view " << i;
            ASSERT_EQ(visibilityProblem(grid, ground, view), "") << GetParam() << ", tiles of " << tileCells << ", view " << i;
            ASSERT_TRUE(list.report.converged);
            ASSERT_LE(list.report.errorPixels, settings.pixelError * 1.0001f) << GetParam() << ", tiles of " << tileCells << ", view " << i;
            ASSERT_LE(worstScreenError(grid, list, ground, view), list.report.errorPixels + kRounding)
                << GetParam() << ", tiles of " << tileCells << ", view " << i << ", pixelError " << settings.pixelError;
        }
    }
}

TEST_P(ChunkedLodOver, LeavesNoEdgeOpenBetweenTiles)
{
    if (BoxPyramid(grid).hasHoles()) return;  // those are open all around
    for (const bool clockwise : {false, true}) {
        const auto mesh = tiles(8);
        for (int i = 0; i < viewCount(); ++i) {
            LodSettings settings = completeSettings(nextError(i));
            settings.cull = false;
            settings.clockwise = clockwise;
            const DrawList list = mesh->select(grid, nextView(random, box, i), settings);
            ASSERT_EQ(openEdges(grid, trianglesOf(grid, list)), 0) << GetParam() << ", view " << i << ", " << mesh->drawnTiles() << " tiles";
        }
    }
}

TEST_P(ChunkedLodOver, GivesFullDetailForAPixelErrorOfZero)
{
    const auto mesh = tiles(16);
    const View view = flightView(box, 3, 40);
    LodSettings settings = completeSettings(0.0f);
    const DrawList list = mesh->select(grid, view, settings);
    EXPECT_LE(worstScreenError(grid, list, groundOf(grid, list), view), kRounding);
    EXPECT_EQ(list.report.errorPixels, 0.0f);
    // Built in the background, and sent piece by piece.
    const std::uint32_t triangles = list.report.triangles;
    settings.complete = false;
    settings.uploadBudget = std::size_t(64) << 10;
    const auto runner = std::make_shared<ManualRunner>();
    ChunkedLod streaming(model(), grid, 16, nullptr, runner);
    SelectionReport report;
    for (int frame = 0; frame == 0 || !report.converged; ++frame) {
        ASSERT_LT(frame, 5000) << "never complete";
        report = streaming.select(grid, view, settings).report;
        runner->runAll();
    }
    EXPECT_EQ(report.errorPixels, 0.0f);
    EXPECT_EQ(report.triangles, triangles);
    // Wherever the camera looks, when nothing is to be left out.
    settings = completeSettings(0.0f);
    settings.cull = false;
    const auto away = tiles(16);
    const std::uint32_t everywhere = mesh->select(grid, view, settings).report.triangles;
    EXPECT_EQ(away->select(grid, randomView(random, box), settings).report.triangles, everywhere);
}

TEST_P(ChunkedLodOver, TellsWhatIsToComeAndWhatItTook)
{
    const View view = flightView(box, 3, 40);
    LodSettings settings = completeSettings(0.0f);
    settings.complete = false;
    const auto runner = std::make_shared<ManualRunner>();
    ChunkedLod streaming(model(), grid, 16, nullptr, runner);
    SelectionReport report = streaming.select(grid, view, settings).report;
    EXPECT_GT(report.buildMilliseconds, 0.0) << "the root, which is always built at once";
    EXPECT_EQ(streaming.select(grid, view, settings).report.buildMilliseconds, 0.0) << "nothing was built since";
    const bool streams = !report.converged;
    double milliseconds = 0.0;
    for (int frame = 0; !report.converged; ++frame) {
        ASSERT_LT(frame, 5000) << "never complete";
        EXPECT_GT(report.pending, 0u);
        runner->runAll();
        report = streaming.select(grid, view, settings).report;
        milliseconds += report.buildMilliseconds;
    }
    EXPECT_EQ(milliseconds > 0.0, streams);
    EXPECT_EQ(report.pending, 0u);
}

TEST_P(ChunkedLodOver, GivesTheSameForTheSameAndRests)
{
    const auto mesh = tiles(16), other = tiles(16);
    for (int i = 0; i < 6; ++i) {
        const View view = nextView(random, box, i);
        const LodSettings settings = completeSettings(nextError(i));
        const DrawList a = mesh->select(grid, view, settings);
        const std::vector<std::uint32_t> indices(a.indices.begin(), a.indices.end());
        const std::vector<glm::vec3> positions(a.positions.begin(), a.positions.end());
        const DrawList b = other->select(grid, view, settings);
        ASSERT_TRUE(std::equal(indices.begin(), indices.end(), b.indices.begin(), b.indices.end()));
        for (const std::uint32_t vertex : indices) ASSERT_EQ(positions[vertex], b.positions[vertex]);
        const DrawList again = mesh->select(grid, view, settings);
        ASSERT_FALSE(again.indicesChanged || again.positionsChanged || !again.newVertices.empty());
    }
}

TEST_P(ChunkedLodOver, CanBeFollowedByWhatItSaysHasChanged)
{
    const auto mesh = tiles(16);
    std::vector<std::uint32_t> samples;
    for (int i = 0; i < viewCount(); ++i) {
        const DrawList list = mesh->select(grid, nextView(random, box, i), completeSettings(nextError(i)));
        samples.resize(list.samples.size(), 0xffffffffu);
        for (const std::uint32_t vertex : list.newVertices) samples[vertex] = list.samples[vertex];
        for (const std::uint32_t vertex : list.indices) ASSERT_EQ(samples[vertex], list.samples[vertex]) << "view " << i;
    }
}

INSTANTIATE_TEST_SUITE_P(Terrains, ChunkedLodOver, testing::ValuesIn(terrains()), testing::PrintToStringParamName());

namespace {

struct Slow {
    Terrain terrain = fractal(257, 257);
    SampleGrid grid = terrain.grid();
    TerrainModel model{std::make_shared<BoxPyramid>(grid), nullptr, nullptr};
    Box box = terrain.box();

    /// A straight flight of a tenth of a cell a frame.
    View view(int frame) const
    {
        const glm::dvec3 eye = glm::dvec3(box.centre) + glm::dvec3(-60.0 + 0.1 * frame * 1.25, 10.0, box.half.z + 25.0);
        return {glm::perspective(0.8, 4.0 / 3.0, 1.0, 2000.0) * glm::lookAt(eye, eye + glm::dvec3(10.0, 1.0, -4.0), glm::dvec3(0.0, 0.0, 1.0)),
                {1024.0, 768.0}};
    }

    /// Largest jump, beyond that of the sample itself, of any drawn sample from frame to frame where tiles change.
    double largestJump(bool morphing, int& changes) const
    {
        ChunkedLod mesh(model, grid, 32, nullptr);
        LodSettings settings = completeSettings(2.0f);
        settings.geomorph = morphing;
        DrawnSamples before;
        double largest = 0.0;
        for (int frame = 0; frame < 200; ++frame) {
            const DrawList list = mesh.select(grid, view(frame), settings);
            const auto drawn = drawnSamples(grid, list, view(frame));
            if (frame > 0 && list.indicesChanged) {
                ++changes;
                for (const auto& [sample, pixels] : drawn) {
                    const auto was = before.find(sample);
                    if (was == before.end()) continue;
                    const glm::dvec3 place(grid.position(int(sample) % grid.columns(), int(sample) / grid.columns()));
                    const glm::dvec2 own = project(view(frame), place).pixel - project(view(frame - 1), place).pixel;
                    for (const glm::dvec2& pixel : pixels) {
                        double jump = 1e9;
                        for (const glm::dvec2& old : was->second) jump = std::min(jump, glm::length(pixel - old - own));
                        largest = std::max(largest, jump);
                    }
                }
            }
            before = drawn;
        }
        return largest;
    }
};

}  // namespace

TEST(ChunkedLod, DoesNotPopWhenItMorphs)
{
    const Slow flight;
    int changes = 0;
    const double morphed = flight.largestJump(true, changes), popped = flight.largestJump(false, changes);
    std::printf("largest jump %.3f px with morphing, %.3f px without\n", morphed, popped);
    EXPECT_GT(changes, 10);
    EXPECT_LE(morphed, 0.25);
    EXPECT_GT(popped, 0.5);
}

TEST(ChunkedLod, DrawsAncestorsUntilTilesAreThere)
{
    const Slow scene;
    const auto runner = std::make_shared<ManualRunner>();
    ChunkedLod mesh(scene.model, scene.grid, 32, nullptr, runner);
    LodSettings settings = completeSettings(1.0f);
    settings.complete = false;
    std::size_t before = 0;
    for (int frame = 0;; ++frame) {
        ASSERT_LT(frame, 1000) << "never complete";
        const DrawList list = mesh.select(scene.grid, scene.view(0), settings);
        const auto ground = groundOf(scene.grid, list);
        ASSERT_EQ(visibilityProblem(scene.grid, ground, scene.view(0)), "") << "frame " << frame;
        if (list.report.converged) {
            EXPECT_LE(worstScreenError(scene.grid, list, ground, scene.view(0)), 1.0 + kRounding);
            break;
        }
        before = mesh.drawnTiles();
        runner->runOne();
    }
    EXPECT_GT(before, 10u);
}

TEST(ChunkedLod, KeepsTheUploadBudgetInEveryFrame)
{
    const Slow scene;
    LodSettings settings = completeSettings(1.0f);
    ChunkedLod whole(scene.model, scene.grid, 16, nullptr);
    whole.select(scene.grid, scene.view(0), settings);
    const std::size_t all = whole.placedBytes();
    settings.complete = false;
    settings.uploadBudget = all / 10;
    const auto runner = std::make_shared<ManualRunner>();
    ChunkedLod mesh(scene.model, scene.grid, 16, nullptr, runner);
    int frames = 0;
    for (bool first = true;; first = false) {
        ASSERT_LT(frames, 1000) << "never complete";
        const DrawList list = mesh.select(scene.grid, scene.view(0), settings);
        // Something has to be drawn in the first.
        ASSERT_TRUE(first || mesh.placedBytes() <= settings.uploadBudget);
        ASSERT_EQ(visibilityProblem(scene.grid, groundOf(scene.grid, list), scene.view(0)), "");
        if (list.report.converged) break;
        runner->runAll();
        ++frames;
    }
    EXPECT_GT(frames, 8) << "the budget can't have been kept";
    EXPECT_EQ(mesh.drawnTiles(), whole.drawnTiles());
}

TEST(ChunkedLod, ComesToTheWholePictureHoweverSmallTheUploadBudget)
{
    const Slow scene;
    LodSettings settings = completeSettings(1.0f);
    ChunkedLod whole(scene.model, scene.grid, 16, nullptr);
    whole.select(scene.grid, scene.view(0), settings);
    settings.complete = false;
    // Smaller than a vertex, than most tiles, than some groups of four.
    for (const std::size_t budget : {std::size_t(1), std::size_t(1000), std::size_t(8000)}) {
        settings.uploadBudget = budget;
        const auto runner = std::make_shared<ManualRunner>();
        ChunkedLod mesh(scene.model, scene.grid, 16, nullptr, runner);
        const std::size_t largestGroup = 4 * 17 * 17 * settings.vertexBytes;
        std::uint32_t exceeded = 0;
        for (int frame = 0;; ++frame) {
            ASSERT_LT(frame, 3000) << "never complete";
            const DrawList list = mesh.select(scene.grid, scene.view(0), settings);
            ASSERT_LE(mesh.placedBytes(), std::max(budget, largestGroup));
            ASSERT_EQ(mesh.placedBytes(), list.newVertices.size() * settings.vertexBytes);
            exceeded += mesh.placedBytes() > budget;
            if (list.report.converged) break;
            runner->runAll();
        }
        EXPECT_EQ(mesh.drawnTiles(), whole.drawnTiles()) << "budget " << budget;
        if (budget <= 1000) {
            EXPECT_GT(exceeded, 0u) << "budget " << budget;
        }
    }
}

namespace {

/// Each job is done before submit() returns: whatever is asked for within a selection is there before it ends.
class PromptRunner final : public TaskRunner {
public:
    void submit(Job job) override
    {
        manual.submit(std::move(job));
        manual.runAll();
    }
    unsigned workers() const override { return 1; }

private:
    ManualRunner manual;
};

}  // namespace

TEST(ChunkedLod, GoesOnWhenItsBudgetIsRaised)
{
    const Slow scene;
    for (const bool complete : {false, true})
        for (const bool prompt : {true, false}) {
            // Where a selection waits for its tiles, somebody has to build them.
            if (complete && !prompt) continue;
            const auto manual = std::make_shared<ManualRunner>();
            const auto runner = prompt ? std::shared_ptr<TaskRunner>(std::make_shared<PromptRunner>()) : manual;
            ChunkedLod mesh(scene.model, scene.grid, 16, nullptr, runner);
            LodSettings settings = completeSettings(1.0f);
            settings.complete = complete;
            settings.memoryBudget = 0;
            for (int frame = 0; frame < 5; ++frame) {
                mesh.select(scene.grid, scene.view(0), settings);
                manual->runAll();
            }
            const SelectionReport coarse = mesh.select(scene.grid, scene.view(0), settings).report;
            EXPECT_TRUE(coarse.converged) << "it would be redrawn for ever";
            EXPECT_GT(coarse.errorPixels, 1.0f);
            settings.memoryBudget = std::size_t(64) << 20;
            SelectionReport report;
            for (int frame = 0; !report.converged || frame == 0; ++frame) {
                ASSERT_LT(frame, 1000) << "never complete";
                report = mesh.select(scene.grid, scene.view(0), settings).report;
                manual->runAll();
            }
            EXPECT_LE(report.errorPixels, 1.0f) << "complete " << complete << ", prompt " << prompt;
        }
}

TEST(ChunkedLod, KeepsTheMemoryBudgetOverRandomJumps)
{
    const Slow scene;
    std::mt19937 random(5);
    ChunkedLod mesh(scene.model, scene.grid, 16, nullptr);
    LodSettings settings = completeSettings(1.0f);
    settings.complete = false;
    settings.memoryBudget = std::size_t(1) << 20;
    std::size_t built = 0;
    for (int jump = 0; jump < 100; ++jump) {
        const View view = randomView(random, scene.box);
        for (int frame = 0; frame < 3; ++frame) {
            const DrawList list = mesh.select(scene.grid, view, settings);
            ASSERT_EQ(visibilityProblem(scene.grid, groundOf(scene.grid, list), view), "") << "jump " << jump;
            ASSERT_LE(mesh.cache().residentBytes(), settings.memoryBudget) << "jump " << jump;
            if (frame == 1) std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        built = mesh.cache().built();
    }
    EXPECT_GT(built, 100u);
}

TEST(ChunkedLod, MayEndWithJobsInFlight)
{
    const Slow scene;
    std::mt19937 random(6);
    LodSettings settings = completeSettings(0.5f);
    settings.complete = false;
    for (int i = 0; i < 1000; ++i) {
        ChunkedLod mesh(scene.model, scene.grid, 8 << i % 4, nullptr);
        mesh.select(scene.grid, randomView(random, scene.box), settings);
        mesh.select(scene.grid, randomView(random, scene.box), settings);
    }
}
