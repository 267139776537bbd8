// Fields of every node are copied, connected, driven and watched as Coin's own are, and nodes go when nobody needs them.
#include "Actions.h"

#include <gtest/gtest.h>

#include <Inventor/SoDB.h>
#include <Inventor/SoPickedPoint.h>
#include <Inventor/actions/SoGetPrimitiveCountAction.h>
#include <Inventor/actions/SoRayPickAction.h>
#include <Inventor/engines/SoCalculator.h>
#include <Inventor/engines/SoComposeVec2f.h>
#include <Inventor/engines/SoElapsedTime.h>
#include <Inventor/fields/SoFields.h>
#include <Inventor/nodes/SoCoordinate3.h>
#include <Inventor/sensors/SoFieldSensor.h>
#include <Inventor/sensors/SoNodeSensor.h>
#include <Inventor/sensors/SoSensorManager.h>
#include <Inventor/SoLists.h>

#include <SoTerrain/SoHeightMap.h>

using namespace test;

namespace {

void count(void* closure, SoSensor*) { ++*static_cast<int*>(closure); }

/// How often a node changed, at once.
class NodeWatch {
public:
    explicit NodeWatch(SoNode* node) : sensor_(count, &changes) {
        sensor_.setPriority(0);
        sensor_.attach(node);
    }
    int changes = 0;

private:
    SoNodeSensor sensor_;
};

/// Whether a node still is.
class Life {
public:
    explicit Life(SoNode* node) {
        sensor_.setDeleteCallback([](void* closure, SoSensor*) { *static_cast<bool*>(closure) = false; }, &isAlive);
        sensor_.attach(node);
    }
    bool isAlive = true;

private:
    SoNodeSensor sensor_;
};

SoCalculator* fourth(float of) {
    auto* engine = new SoCalculator;
    engine->a = of;
    engine->expression = "oa = a / 4";
    return engine;
}

int triangles(SoNode* root) {
    SoGetPrimitiveCountAction action;
    action.apply(root);
    return action.getTriangleCount();
}

class ActionCopy : public OnEveryNode {};
class ActionConnect : public OnEveryNode {};
class ActionNotify : public OnEveryNode {};
class ActionLife : public OnEveryNode {};

}  // namespace

TEST_P(ActionCopy, WithConnectionsIsDrivenByACopyOfTheEngineInside) {
    const auto root = groundShape(GetParam());
    auto* engine = fourth(6.0f);
    terrainIn(root.get())->pixelError.connectFrom(&engine->oa);
    // An engine that drives nodes below the root alone is copied with them.
    Ref<SoSeparator> copy(static_cast<SoSeparator*>(root->copy(TRUE)));
    SoTerrainShape* node = terrainIn(copy.get());
    ASSERT_NE(node, terrainIn(root.get()));
    SoEngineOutput* output = nullptr;
    ASSERT_TRUE(node->pixelError.getConnectedEngine(output));
    auto* driver = static_cast<SoCalculator*>(output->getContainer());
    EXPECT_EQ(node->pixelError.getValue(), 1.5f);
    driver->a = 10.0f;
    EXPECT_EQ(node->pixelError.getValue(), 2.5f);
    EXPECT_EQ(terrainIn(root.get())->pixelError.getValue(), driver == engine ? 2.5f : 1.5f);
    Ref<SoSeparator> loose(static_cast<SoSeparator*>(root->copy(FALSE)));
    EXPECT_EQ(triangles(copy.get()), triangles(root.get()));
    EXPECT_EQ(triangles(loose.get()), triangles(root.get()));
}

TEST_P(ActionCopy, LooksTheSameInASceneOfItsOwn) {
    const auto root = groundScene(GetParam());
    Stage stage(160, 120);
    const auto before = stage.render(root.get());
    Ref<SoSeparator> copy(static_cast<SoSeparator*>(root->copy()));
    EXPECT_TRUE(stage.render(copy.get()).pixels == before.pixels);
    // What is changed there stays there.
    if (GetParam().overMap)
        findIn<SoHeightMap>(copy.get())->heightScale = 0.0f;
    else
        findIn<SoCoordinate3>(copy.get())->point.set1Value(900, SbVec3f(0.0f, 0.0f, 99.0f));
    EXPECT_FALSE(stage.render(copy.get()).pixels == before.pixels);
    EXPECT_TRUE(stage.render(root.get()).pixels == before.pixels);
}

TEST_P(ActionCopy, OneNodeInTwoScenesServesBoth) {
    const auto first = groundScene(GetParam()), second = groundScene(GetParam(), {.holes = false});
    auto* place = static_cast<SoSeparator*>(static_cast<SoSeparator*>(second->getChild(2))->getChild(0));
    place->replaceChild(place->getNumChildren() - 1, terrainIn(first.get()));
    ASSERT_EQ(terrainIn(first.get()), terrainIn(second.get()));
    const auto apart = groundScene(GetParam(), {.holes = false});
    Stage stage(160, 120);
    const auto holes = stage.render(groundScene(GetParam()).get()), whole = stage.render(apart.get());
    const auto above = [](SoNode* root) {
        SoRayPickAction action(kRegion);
        action.setRay(SbVec3f(29.0f, 30.0f, 90.0f), SbVec3f(0.0f, 0.0f, -1.0f));
        action.apply(root);
        return action.getPickedPoint() != nullptr;
    };
    for (int i = 0; i < 3; ++i) {
        expectAlike(holes, stage.render(first.get()), 1.0, "with holes");
        expectAlike(whole, stage.render(second.get()), 1.0, "without holes");
        EXPECT_FALSE(above(first.get()));
        EXPECT_TRUE(above(second.get()));
    }
}

TEST_P(ActionConnect, EveryFieldFollowsAnother) {
    Messages messages;
    for (const SoType type : {terrainIn(groundShape(GetParam()).get())->getTypeId(), SoHeightMap::getClassTypeId()}) {
        Ref<SoNode> source(static_cast<SoNode*>(type.createInstance())), target(static_cast<SoNode*>(type.createInstance()));
        SoFieldList fields;
        const int number = source->getFields(fields);
        for (int i = 0; i < number; ++i) {
            SbName name;
            source->getFieldName(fields[i], name);
            EXPECT_TRUE(target->getField(name)->connectFrom(fields[i])) << name.getString();
            NodeWatch watch(target.get());
            SbString before;
            fields[i]->get(before);
            fields[i]->touch();
            EXPECT_EQ(watch.changes, 1) << name.getString();
            SbString now;
            target->getField(name)->get(now);
            EXPECT_EQ(now, before) << name.getString();
            target->getField(name)->disconnect();
        }
    }
}

TEST_P(ActionConnect, EnginesTimeAndGlobalFieldsDriveThePicture) {
    const auto root = groundScene(GetParam());
    SoTerrainShape* node = terrainIn(root.get());
    auto* engine = fourth(2.0f);
    node->pixelError.connectFrom(&engine->oa);
    Stage stage(160, 120);
    for (const float a : {2.0f, 100.0f}) {
        engine->a = a;
        const auto fresh = groundScene(GetParam());
        terrainIn(fresh.get())->pixelError = a / 4.0f;
        stage.render(fresh.get());
        stage.render(root.get());
        EXPECT_EQ(node->pixelError.getValue(), a / 4.0f);
        EXPECT_GT(node->getStatistics().triangles, 0u);
    }
    auto* clock = new SoElapsedTime;
    auto* slow = new SoCalculator;
    slow->expression = "oa = 2 + a";
    slow->a.connectFrom(&clock->timeOut);
    node->pixelError.connectFrom(&slow->oa);
    stage.render(root.get());
    EXPECT_GE(node->pixelError.getValue(), 2.0f);
    auto* shared = static_cast<SoSFFloat*>(SoDB::createGlobalField("soterrainTestError", SoSFFloat::getClassTypeId()));
    ASSERT_NE(shared, nullptr);
    node->pixelError.connectFrom(shared);
    shared->setValue(7.0f);
    EXPECT_EQ(node->pixelError.getValue(), 7.0f);
    node->pixelError.disconnect();
    if (!GetParam().overMap) return;
    auto* compose = new SoComposeVec2f;
    compose->x = 3.0f;
    compose->y = 2.5f;
    auto* map = findIn<SoHeightMap>(root.get());
    map->spacing.connectFrom(&compose->vector);
    EXPECT_FLOAT_EQ(boxOf(root->getChild(2)).getMax()[0], 8.0f + 3.0f * 40.0f);
    compose->x = 6.0f;
    EXPECT_FLOAT_EQ(boxOf(root->getChild(2)).getMax()[0], 8.0f + 6.0f * 40.0f);
}

TEST_P(ActionNotify, EveryChangeIsToldOnce) {
    const auto root = groundScene(GetParam());
    SoTerrainShape* node = terrainIn(root.get());
    SoFieldList fields;
    const int number = node->getFields(fields);
    for (int i = 0; i < number; ++i) {
        if (fields[i]->isOfType(SoSFTrigger::getClassTypeId())) continue;
        int told = 0;
        SoFieldSensor sensor(count, &told);
        sensor.setPriority(0);
        sensor.attach(fields[i]);
        NodeWatch atNode(node), atRoot(root.get());
        fields[i]->touch();
        SbName name;
        node->getFieldName(fields[i], name);
        EXPECT_EQ(told, 1) << name.getString();
        EXPECT_EQ(atNode.changes, 1) << name.getString();
        EXPECT_EQ(atRoot.changes, 1) << name.getString();
    }
    NodeWatch atNode(node);
    node->touch();
    EXPECT_EQ(atNode.changes, 1);
}

TEST_P(ActionNotify, ActionsTellOfNoChange) {
    const auto root = groundScene(GetParam());
    Stage stage(160, 120);
    for (int i = 0; i < 20; ++i) {
        stage.render(root.get());
        SoDB::getSensorManager()->processDelayQueue(TRUE);
        if (terrainIn(root.get())->getStatistics().converged) break;
    }
    NodeWatch watch(root.get());
    stage.render(root.get());
    boxOf(root.get());
    triangles(root.get());
    written(root.get());
    SoRayPickAction action(kRegion);
    action.setPoint(SbVec2s(250, 150));
    action.apply(root.get());
    float height = 0.0f;
    terrainIn(root.get())->heightAt(50.0f, 30.0f, height);
    SoDB::getSensorManager()->processDelayQueue(TRUE);
    EXPECT_EQ(watch.changes, 0);
}

TEST_P(ActionLife, NodesGoWithTheirLastReference) {
    auto root = groundScene(GetParam(), {.holes = GetParam().overMap});
    Ref<SoSeparator> copy(static_cast<SoSeparator*>(root->copy(TRUE)));
    Life terrain(terrainIn(root.get())), copied(terrainIn(copy.get())), data(static_cast<SoSeparator*>(static_cast<SoSeparator*>(root->getChild(2))->getChild(0))->getChild(0));
    {
        Stage stage(160, 120);
        stage.render(root.get());
        stage.render(copy.get());
        SoRayPickAction action(kRegion);
        action.setPoint(SbVec2s(250, 150));
        action.apply(root.get());
        ASSERT_NE(action.getPickedPoint(), nullptr);
        Ref<SoSeparator> back(readBack(written(copy.get())).get());
        auto* engine = fourth(8.0f);
        terrainIn(copy.get())->pixelError.connectFrom(&engine->oa);
    }
    EXPECT_TRUE(terrain.isAlive && copied.isAlive && data.isAlive);
    root = {};
    EXPECT_FALSE(terrain.isAlive);
    EXPECT_FALSE(data.isAlive);
    EXPECT_TRUE(copied.isAlive);
    copy = {};
    EXPECT_FALSE(copied.isAlive);
}

INSTANTIATE_TEST_SUITE_P(, ActionCopy, testing::ValuesIn(everywhere()), nameOfWhere);
INSTANTIATE_TEST_SUITE_P(, ActionConnect, testing::ValuesIn(everywhere()), nameOfWhere);
INSTANTIATE_TEST_SUITE_P(, ActionNotify, testing::ValuesIn(everywhere()), nameOfWhere);
INSTANTIATE_TEST_SUITE_P(, ActionLife, testing::ValuesIn(everywhere()), nameOfWhere);
