// Chunked LoD as a node: what is on screen while tiles are built, budgets, and nodes that go before their tiles come.
#include "Scenes.h"

#include <gtest/gtest.h>

#include <chrono>
#include <climits>
#include <thread>

#include <Inventor/SoDB.h>
#include <Inventor/actions/SoSearchAction.h>
#include <Inventor/nodes/SoCoordinate3.h>
#include <Inventor/sensors/SoNodeSensor.h>
#include <Inventor/sensors/SoSensorManager.h>

#include <SoTerrain/SoChunkedLoDTerrain.h>

using namespace test;
using terrain::Image;

namespace {

Surface ground() { return surfaceOf(fractalMap(513, 513, 60.0)); }

Ref<SoSeparator> tilesOver(const Surface& surface, bool background) {
    Ref<SoSeparator> root = sceneOf(Kind::ChunkedLod, surface, {.pixelError = 1.0f}, unlitTexture);
    static_cast<SoChunkedLoDTerrain*>(terrainIn(root.get()))->background = background;
    return root;
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
}

TEST(Tiles, MayGoBeforeTheyAreBuilt) {
    const Surface surface = ground();
    Stage stage;
    for (int i = 0; i < 40; ++i) stage.render(tilesOver(surface, true).get());
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
