// Chunked LoD as a node: what is on screen while tiles are built, budgets, and nodes that go before their tiles come.
#include <epoxy/gl.h>

#include "Scenes.h"

#include <gtest/gtest.h>

#include <chrono>
#include <climits>
#include <cstdio>
#include <future>
#include <numeric>
#include <thread>
#include <utility>
#include <vector>

#include <Inventor/SoDB.h>
#include <Inventor/actions/SoSearchAction.h>
#include <Inventor/nodes/SoCoordinate3.h>
#include <Inventor/sensors/SoNodeSensor.h>
#include <Inventor/sensors/SoSensorManager.h>

#include <SoTerrain/SoChunkedLoDTerrain.h>

#include "base/TaskRunner.h"

using namespace test;
using terrain::Image;

namespace {

Surface ground() { return surfaceOf(fractalMap(513, 513, 60.0)); }

Ref<SoSeparator> tilesOver(const Surface& surface, bool background) {
    Ref<SoSeparator> root = sceneOf(Kind::ChunkedLod, surface, {.pixelError = 1.0f}, unlitTexture);
    static_cast<SoChunkedLoDTerrain*>(terrainIn(root.get()))->background = background;
    return root;
}

/// For the tiles that were asked for, however slow the machine is: until what was submitted before has begun, and a moment to end.
void waitForJobs() {
    std::promise<void> reached;
    terrain::TaskRunner::shared()->submit([&reached] { reached.set_value(); });
    reached.get_future().wait();
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
}

}  // namespace

TEST(Tiles, CoverTheGroundFromTheFirstFrameOnAndComeToRest) {
    const Surface surface = ground();
    Stage stage;
    const Image complete = stage.render(tilesOver(surface, false).get());
    const auto root = tilesOver(surface, true);
    const Image first = stage.render(root.get());
    const Difference coarse = compare(complete, first, 8);
    EXPECT_EQ(coarse.onlyFirst, 0) << "background shows in the first frame";
    EXPECT_FALSE(terrainIn(root.get())->getStatistics().converged);
    Image last = first;
    int frames = 1;
    for (; !terrainIn(root.get())->getStatistics().converged; ++frames) {
        ASSERT_LT(frames, 5000) << "never complete";
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        last = stage.render(root.get());
    }
    EXPECT_EQ(last.pixels, complete.pixels) << "after " << frames << " frames";
    EXPECT_LE(terrainIn(root.get())->getStatistics().errorPixels, 1.0);
    EXPECT_GT(terrainIn(root.get())->getStatistics().patches, 10u);
    savePicture("tiles_streaming", {first, last, complete});
    stage.render(root.get());
    EXPECT_EQ(terrainIn(root.get())->getStatistics().uploadedBytes, 0u) << "at rest";
}

TEST(Tiles, AskForFramesUntilTheyAreComplete) {
    const auto root = tilesOver(ground(), true);
    Stage stage;
    stage.render(root.get());
    // What a viewer does: it redraws when the scene says that it has changed.
    bool touched = false;
    SoNodeSensor sensor([](void* flag, SoSensor*) { *static_cast<bool*>(flag) = true; }, &touched);
    sensor.setPriority(0);
    sensor.attach(root.get());
    int frames = 0;
    for (; !terrainIn(root.get())->getStatistics().converged; ++frames) {
        ASSERT_LT(frames, 5000) << "never complete";
        touched = false;
        SoDB::getSensorManager()->processDelayQueue(TRUE);
        ASSERT_TRUE(touched) << "frame " << frames;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        stage.render(root.get());
    }
    SoDB::getSensorManager()->processDelayQueue(TRUE);
    touched = false;
    stage.render(root.get());
    SoDB::getSensorManager()->processDelayQueue(TRUE);
    EXPECT_FALSE(touched) << "it does not come to rest";
}

TEST(Tiles, KeepSmallBudgetsAndStillShowTheGround) {
    const Surface surface = ground();
    Stage stage;
    const Image complete = stage.render(tilesOver(surface, false).get());
    const auto root = tilesOver(surface, true);
    auto* node = static_cast<SoChunkedLoDTerrain*>(terrainIn(root.get()));
    node->memoryBudget = 0;
    node->uploadBudget = 1;
    for (int frame = 0; frame < 50; ++frame) {
        const Image picture = stage.render(root.get());
        ASSERT_EQ(compare(complete, picture, 8).onlyFirst, 0) << "frame " << frame;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_LT(node->getStatistics().patches, 10u) << "the budgets can't have been kept";
    EXPECT_TRUE(node->getStatistics().converged) << "it would be redrawn for ever";
    EXPECT_GT(node->getStatistics().errorPixels, 1.0);
    node->memoryBudget = 64;
    node->uploadBudget = 0;
    stage.render(root.get());
    EXPECT_FALSE(node->getStatistics().converged) << "it goes on when it may";
    for (int frame = 0; !node->getStatistics().converged; ++frame) {
        ASSERT_LT(frame, 5000) << "never complete";
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        stage.render(root.get());
    }
    EXPECT_LE(node->getStatistics().errorPixels, 1.0);
}

namespace {

/// What goes to GL buffers, by call, for as long as one lives. Buffers must have been filled before: the first call finds the function.
class SentToBuffers {
public:
    SentToBuffers() {
        formerSubData = std::exchange(epoxy_glBufferSubData, subData);
        formerData = std::exchange(epoxy_glBufferData, data);
        arrays.clear();
        indices.clear();
    }
    ~SentToBuffers() {
        epoxy_glBufferSubData = formerSubData;
        epoxy_glBufferData = formerData;
    }
    SentToBuffers(const SentToBuffers&) = delete;
    SentToBuffers& operator=(const SentToBuffers&) = delete;

    static std::size_t sum(const std::vector<std::size_t>& bytes, std::size_t from = 0) {
        return bytes.size() <= from ? 0 : std::accumulate(bytes.begin() + std::ptrdiff_t(from), bytes.end(), std::size_t(0));
    }
    static inline std::vector<std::size_t> arrays, indices;  ///< bytes of each call

private:
    static void count(GLenum target, GLsizeiptr bytes) { (target == GL_ARRAY_BUFFER ? arrays : indices).push_back(std::size_t(bytes)); }
    static void subData(GLenum target, GLintptr offset, GLsizeiptr bytes, const void* values) {
        count(target, bytes);
        formerSubData(target, offset, bytes, values);
    }
    static void data(GLenum target, GLsizeiptr bytes, const void* values, GLenum usage) {
        if (values) count(target, bytes);
        formerData(target, bytes, values, usage);
    }
    static inline PFNGLBUFFERSUBDATAPROC formerSubData;
    static inline PFNGLBUFFERDATAPROC formerData;
};

}  // namespace

TEST(Tiles, NewOnScreenSendNoMoreThanTheUploadBudget) {
    const Surface surface = ground();
    // Four tiles of 16 cells, at full detail, with 32 bytes a vertex, may have to come together: 36 KB.
    for (const int budget : {40, 64, 256}) {
        const auto root = tilesOver(surface, true);
        auto* node = static_cast<SoChunkedLoDTerrain*>(terrainIn(root.get()));
        node->tileSize = 16;
        node->pixelError = 0.5f;
        node->uploadBudget = budget;
        Stage stage;
        stage.render(tilesOver(surface, false).get());
        std::size_t stride = 0, largest = 0, total = 0;
        for (int frame = 0; frame < 60; ++frame) {
            // It looks back now and then: what was seen before is there and could come all at once.
            const float way = 2.0f * float(frame), ahead = (frame / 10) % 2 ? -150.0f : 150.0f;
            const SbVec3f eye(150.0f + way, 160.0f + way, 90.0f);
            root->replaceChild(0, cameraAt(eye, eye + SbVec3f(ahead, 0.7f * ahead, -70.0f), 1.0f, 1500.0f));
            SentToBuffers sent;
            stage.render(root.get());
            const SoTerrainStatistics statistics = node->getStatistics();
            EXPECT_EQ(SentToBuffers::sum(sent.arrays) + SentToBuffers::sum(sent.indices), statistics.uploadedBytes) << "frame " << frame;
            // Positions go up whole, and before attributes.
            const std::size_t positions = sent.arrays.empty() ? 0 : sent.arrays.front(), attributes = SentToBuffers::sum(sent.arrays, 1);
            if (frame == 0) {
                ASSERT_GT(positions, 0u);
                stride = attributes / (positions / 12);
                ASSERT_GT(stride, 0u);
                continue;
            }
            ASSERT_LE(statistics.newVertexBytes, std::size_t(budget) << 10) << "frame " << frame;
            ASSERT_EQ(statistics.newVertexBytes, attributes / stride * (12 + stride)) << "frame " << frame;
            ASSERT_EQ(attributes % stride, 0u) << "frame " << frame;
            // All else is positions and indices of what is drawn.
            ASSERT_EQ(positions % 12, 0u) << "frame " << frame;
            ASSERT_LE(sent.indices.size(), 1u) << "frame " << frame;
            if (!sent.indices.empty()) {
                ASSERT_EQ(sent.indices.front(), std::size_t(12) * statistics.triangles) << "frame " << frame;
            }
            largest = std::max(largest, statistics.newVertexBytes);
            total += statistics.newVertexBytes;
            waitForJobs();
        }
        std::printf("uploadBudget %d KB: at most %zu KB of new vertices in a frame, %zu KB in all\n", budget, largest >> 10, total >> 10);
        if (budget <= 64) {
            EXPECT_GT(largest, std::size_t(budget) << 9) << "or the budget did not matter";
        }
    }
}

TEST(Tiles, MayGoBeforeTheyAreBuilt) {
    const Surface surface = surfaceOf(fractalMap(65, 65, 20.0));
    Stage stage(64, 48);
    int unfinished = 0;
    for (int i = 0; i < 1000; ++i) {
        const auto root = tilesOver(surface, true);
        static_cast<SoChunkedLoDTerrain*>(terrainIn(root.get()))->tileSize = 8;
        stage.render(root.get());
        unfinished += !terrainIn(root.get())->getStatistics().converged;
    }
    EXPECT_EQ(unfinished, 1000) << "or nothing was in flight";
}

TEST(Tiles, FollowTheCoordinatesWhileTheyAreBuilt) {
    const Surface flat = surfaceOf(mapOf(257, 257, [](double, double) { return 0.0; })), hills = surfaceOf(fractalMap(257, 257, 30.0));
    Stage stage;
    for (int i = 0; i < 20; ++i) {
        const auto root = tilesOver(i % 2 ? flat : hills, true);
        stage.render(root.get());
        SoSearchAction search;
        search.setType(SoCoordinate3::getClassTypeId());
        search.apply(root.get());
        ASSERT_TRUE(search.getPath());
        auto* coordinates = static_cast<SoCoordinate3*>(search.getPath()->getTail());
        const Surface& other = i % 2 ? hills : flat;
        coordinates->point.setValues(0, int(other.points.size()), other.points.data());
        static_cast<SoChunkedLoDTerrain*>(terrainIn(root.get()))->background = FALSE;
        const Image changed = stage.render(root.get());
        EXPECT_LE(terrainIn(root.get())->getStatistics().errorPixels, 1.0);
        EXPECT_GT(coveredPixels(changed), 1000);
    }
}

TEST(BadTileInput, IsToldOnceEach) {
    const auto root = tilesOver(surfaceOf(fractalMap(65, 65, 3.0)), false);
    auto* node = static_cast<SoChunkedLoDTerrain*>(terrainIn(root.get()));
    Stage stage;
    for (SoSFInt32* field : {&node->memoryBudget, &node->uploadBudget, &node->tileSize})
        for (const int wrong : {-1, INT_MIN}) {
            const int right = field->getValue();
            Messages messages;
            *field = wrong;
            EXPECT_GT(coveredPixels(stage.render(root.get())), 100);
            stage.render(root.get());
            EXPECT_EQ(messages.all().size(), 1u) << messages.text();
            EXPECT_NE(messages.text().find(std::to_string(wrong)), std::string::npos) << messages.text();
            *field = right;
        }
}
