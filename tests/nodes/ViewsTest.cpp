// Several nodes, several places of one node, several views of one place.
#include "Scenes.h"

#include <gtest/gtest.h>

#include <cmath>

#include <Inventor/SoDB.h>
#include <Inventor/nodes/SoTransform.h>
#include <Inventor/nodes/SoTransformSeparator.h>
#include <Inventor/sensors/SoNodeSensor.h>
#include <Inventor/sensors/SoSensorManager.h>

#include <SoTerrain/SoROAMTerrain.h>

using namespace test;
using terrain::Image;

namespace {

Surface ground(std::uint32_t seed = 1) { return surfaceOf(fractalMap(129, 129, 30.0, seed)); }

SoTransform* placed(float x, float y, float z, float turn = 0.0f) {
    auto* transform = new SoTransform;
    transform->translation = SbVec3f(x, y, z);
    transform->rotation = SbRotation(SbVec3f(0.0f, 0.0f, 1.0f), turn);
    return transform;
}

SoCamera* circling(float angle) {
    const SbVec3f centre(64.0f, 64.0f, 15.0f);
    return cameraAt(centre + SbVec3f(70.0f * std::cos(angle), 70.0f * std::sin(angle), 35.0f), centre, 1.0f, 400.0f);
}

/// A camera before a group that somebody else shares.
Ref<SoSeparator> viewOf(SoCamera* camera, SoNode* shared) {
    Ref<SoSeparator> root(new SoSeparator);
    root->addChild(camera);
    root->addChild(shared);
    return root;
}

Ref<SoSeparator> texturedTerrain(Kind kind, const Surface& surface, float pixelError = 2.0f) {
    Ref<SoSeparator> group(new SoSeparator);
    unlitTexture(group.get());
    group->addChild(shapeOf(kind, surface, {.pixelError = pixelError}));
    return group;
}

Image half(const Image& whole, bool right) {
    Image part{whole.width / 2, whole.height, 3, {}};
    for (int y = 0; y < whole.height; ++y) {
        const auto first = whole.pixels.begin() + (std::ptrdiff_t(y) * whole.width + (right ? part.width : 0)) * 3;
        part.pixels.insert(part.pixels.end(), first, first + part.width * 3);
    }
    return part;
}

SbViewportRegion halfRegion(bool right) {
    SbViewportRegion region(640, 240);
    region.setViewportPixels(right ? 320 : 0, 0, 320, 240);
    return region;
}

void processSensors() {
    SoDB::getSensorManager()->processDelayQueue(TRUE);
    SoDB::getSensorManager()->processImmediateQueue();
}

SoROAMTerrain* roamIn(SoNode* root) { return static_cast<SoROAMTerrain*>(terrainIn(root)); }

}  // namespace

TEST(Scenes, WithTwoNodesShowBoth) {
    const auto dress = [](Kind kind) {
        return [kind](SoSeparator* group) {
            unlitTexture(group);
            auto* other = new SoSeparator;
            other->addChild(placed(20.0f, 10.0f, 25.0f, 0.3f));
            other->addChild(shapeOf(kind, surfaceOf(fractalMap(65, 97, 20.0, 5))));
            group->addChild(other);
        };
    };
    Stage stage;
    std::vector<Image> pictures;
    for (const Kind kind : {Kind::Reference, Kind::BruteForce, Kind::Roam, Kind::GeoMipmap}) pictures.push_back(stage.render(sceneOf(kind, ground(), {}, dress(kind)).get()));
    savePicture("two_nodes", pictures);
    expectAlike(pictures[0], pictures[1], 0.3, "brute force");
    expectAlike(pictures[0], pictures[2], 4.0, "ROAM");
    expectAlike(pictures[0], pictures[3], 4.0, "Geo Mip-Mapping");
}

TEST(Scenes, WithBothKindsOfNodeOnOneSetOfCoordinatesAgree) {
    const Surface surface = ground();
    const auto root = sceneOf(Kind::BruteForce, surface, {}, unlitTexture);
    Stage stage;
    const Image alone = stage.render(root.get());
    auto* group = static_cast<SoSeparator*>(static_cast<SoSeparator*>(root->getChild(2))->getChild(4));
    group->addChild(nodeOf(Kind::Roam, surface.columns, surface.rows, 0.0f));
    expectAlike(alone, stage.render(root.get()), 2.0);
}

TEST(Scenes, WithOneNodeUnderTwoTransformsShowItTwice) {
    Stage stage;
    std::vector<Image> pictures;
    for (const Kind kind : {Kind::Reference, Kind::BruteForce, Kind::Roam, Kind::GeoMipmap}) {
        const auto shared = texturedTerrain(kind, ground());
        Ref<SoSeparator> root(new SoSeparator);
        root->addChild(cameraAt(SbVec3f(0.0f, -110.0f, 90.0f), SbVec3f(80.0f, 60.0f, 0.0f), 1.0f, 600.0f));
        for (const auto& transform : {placed(0.0f, 0.0f, 0.0f), placed(220.0f, 30.0f, -10.0f, 0.8f)}) {
            auto* place = new SoSeparator;
            place->addChild(transform);
            place->addChild(shared.get());
            root->addChild(place);
        }
        for (int frame = 0; frame < 3; ++frame) stage.render(root.get());
        pictures.push_back(stage.picture());
    }
    savePicture("two_transforms", pictures);
    expectAlike(pictures[0], pictures[1], 0.3, "brute force");
    expectAlike(pictures[0], pictures[2], 5.0, "ROAM");
    expectAlike(pictures[0], pictures[3], 5.0, "Geo Mip-Mapping");
}

class Views : public testing::TestWithParam<Kind> {};

TEST_P(Views, OfOneNodeInOneFrameEachLookAsTheyDoAlone) {
    const Surface surface = ground();
    const auto shared = texturedTerrain(GetParam(), surface), aloneLeft = texturedTerrain(GetParam(), surface), aloneRight = texturedTerrain(GetParam(), surface);
    Stage both(640, 240), left, right;
    Image picture, first, second;
    for (int frame = 0; frame < 6; ++frame) {
        const float angle = 0.2f * float(frame);
        both.clear();
        for (const bool isRight : {false, true}) {
            const SbViewportRegion region = halfRegion(isRight);
            both.draw(viewOf(circling(isRight ? 3.0f - angle : angle), shared.get()).get(), &region);
        }
        picture = both.picture();
        first = left.render(viewOf(circling(angle), aloneLeft.get()).get());
        second = right.render(viewOf(circling(3.0f - angle), aloneRight.get()).get());
        // Rounding of the viewport's offset may move single pixels of an edge.
        expectAlike(half(picture, false), first, 0.05, "left");
        expectAlike(half(picture, true), second, 0.05, "right");
    }
    savePicture("two_views_" + identifierOf(GetParam()), {picture, first, second});
}

TEST_P(Views, OfTwoCamerasInOneSceneLookLikeCoinsOwnShape) {
    Stage stage;
    std::vector<Image> pictures;
    for (const Kind kind : {Kind::Reference, GetParam()}) {
        const auto shared = texturedTerrain(kind, ground());
        Ref<SoSeparator> root(new SoSeparator);
        for (const float angle : {0.3f, 1.9f}) root->addChild(viewOf(circling(angle), shared.get()).get());
        for (int frame = 0; frame < 2; ++frame) stage.render(root.get());
        pictures.push_back(stage.picture());
    }
    expectAlike(pictures[0], pictures[1], 3.0);
}

TEST_P(Views, OfManySizesOfTheViewportLookLikeCoinsOwnShape) {
    const auto reference = texturedTerrain(Kind::Reference, ground()), ours = texturedTerrain(GetParam(), ground());
    for (const auto& [width, height] : {std::pair{64, 64}, {500, 40}, {37, 311}, {320, 240}}) {
        Stage stage(width, height);
        expectAlike(stage.render(viewOf(circling(1.0f), reference.get()).get()), stage.render(viewOf(circling(1.0f), ours.get()).get()), 5.0,
                    std::to_string(width) + "x" + std::to_string(height));
    }
}

INSTANTIATE_TEST_SUITE_P(, Views, testing::ValuesIn(kOurKinds),
                         [](const auto& info) { return identifierOf(info.param); });

TEST(Freeze, KeepsTheMeshWhileTheCameraMoves) {
    const auto terrain = texturedTerrain(Kind::Roam, ground());
    Stage stage;
    const auto root = viewOf(circling(0.0f), terrain.get());
    stage.render(root.get());
    SoROAMTerrain* node = roamIn(root.get());
    const auto before = node->getStatistics();
    node->freeze = TRUE;
    root->replaceChild(0, circling(2.5f));
    const Image frozen = stage.render(root.get());
    EXPECT_EQ(node->getStatistics().triangles, before.triangles);
    EXPECT_EQ(node->getStatistics().splits + node->getStatistics().merges, 0u);
    node->freeze = FALSE;
    const Image thawed = stage.render(root.get());
    savePicture("freeze", {frozen, thawed});
    EXPECT_NE(frozen.pixels, thawed.pixels);
    EXPECT_GT(node->getStatistics().splits, 0u);
}

TEST(FrustumCulling, ChangesNothingOnScreen) {
    const auto terrain = texturedTerrain(Kind::Roam, ground());
    const auto root = viewOf(circling(0.7f), terrain.get());
    Stage stage;
    const Image culled = stage.render(root.get());
    const auto before = roamIn(root.get())->getStatistics().triangles;
    roamIn(root.get())->frustumCulling = FALSE;
    const Image all = stage.render(root.get());
    EXPECT_GT(roamIn(root.get())->getStatistics().triangles, before);
    expectAlike(culled, all, 3.0);
}

TEST(Convergence, AfterAJumpIsToldAndAskedForUntilItIsThere) {
    const auto terrain = texturedTerrain(Kind::Roam, ground(), 0.5f);
    Stage stage;
    const auto root = viewOf(circling(0.0f), terrain.get());
    SoROAMTerrain* node = roamIn(root.get());
    node->operationCount = 200;
    stage.render(root.get());
    EXPECT_TRUE(node->getStatistics().converged);
    processSensors();

    int redraws = 0;
    SoNodeSensor sensor([](void* count, SoSensor*) { ++*static_cast<int*>(count); }, &redraws);
    sensor.attach(root.get());
    root->replaceChild(0, circling(3.0f));
    processSensors();
    redraws = 0;
    stage.render(root.get());
    EXPECT_FALSE(node->getStatistics().converged);
    EXPECT_LE(node->getStatistics().splits + node->getStatistics().merges, 200u + 64u);
    int frames = 1;
    for (; frames < 500 && !node->getStatistics().converged; ++frames) {
        redraws = 0;
        processSensors();
        ASSERT_GT(redraws, 0) << "nobody asks for frame " << frames;
        stage.render(root.get());
    }
    EXPECT_TRUE(node->getStatistics().converged);
    EXPECT_GT(frames, 2);
    EXPECT_LE(node->getStatistics().errorPixels, 0.5);
    redraws = 0;
    processSensors();
    EXPECT_EQ(redraws, 0) << "at rest nothing is to be redrawn";
    const Image there = stage.picture();
    const auto reference = texturedTerrain(Kind::Reference, ground());
    expectAlike(stage.render(viewOf(circling(3.0f), reference.get()).get()), there, 2.0);
}

TEST(Cameras, BehindATransformShowTheSame) {
    // Where the transform goes with the camera, and where the ground goes too.
    const auto scene = [](Kind kind, bool groundToo) {
        const Surface surface = ground();
        Ref<SoSeparator> root(new SoSeparator);
        SoGroup* before = root.get();
        if (!groundToo) root->addChild(before = new SoTransformSeparator);
        before->addChild(placed(900.0f, -300.0f, 40.0f, 0.7f));
        SoCamera* camera = circling(1.0f);
        if (!groundToo) {
            // As far away from where the transform takes it as without one.
            const SbRotation back(SbVec3f(0.0f, 0.0f, 1.0f), -0.7f);
            SbVec3f place;
            back.multVec(camera->position.getValue() - SbVec3f(900.0f, -300.0f, 40.0f), place);
            camera->position = place;
            camera->orientation = camera->orientation.getValue() * back;
        }
        before->addChild(camera);
        root->addChild(texturedTerrain(kind, surface, 0.5f).get());
        return root;
    };
    Stage stage;
    for (const bool groundToo : {false, true}) {
        const Image reference = stage.render(viewOf(circling(1.0f), texturedTerrain(Kind::Reference, ground()).get()).get());
        for (const Kind kind : kOurKinds) {
            const Image found = stage.render(scene(kind, groundToo).get());
            savePicture("camera_transformed_" + identifierOf(kind) + (groundToo ? "_ground" : ""), {reference, found});
            expectAlike(reference, found, 3.0, nameOf(kind));
        }
    }
}
