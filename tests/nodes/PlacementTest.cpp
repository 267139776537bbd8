// SoTerrainPlacement: what follows it stands on the ground, in every action, and stays there when the ground changes.
#include "Actions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <limits>

#include <Inventor/SoPickedPoint.h>
#include <Inventor/actions/SoCallbackAction.h>
#include <Inventor/actions/SoGetBoundingBoxAction.h>
#include <Inventor/actions/SoGetMatrixAction.h>
#include <Inventor/actions/SoGetPrimitiveCountAction.h>
#include <Inventor/actions/SoRayPickAction.h>
#include <Inventor/actions/SoSearchAction.h>
#include <Inventor/elements/SoModelMatrixElement.h>
#include <Inventor/misc/SoState.h>
#include <Inventor/nodekits/SoNodeKitListPart.h>
#include <Inventor/nodes/SoCoordinate3.h>
#include <Inventor/nodes/SoCube.h>
#include <Inventor/nodes/SoLightModel.h>
#include <Inventor/nodes/SoSphere.h>
#include <Inventor/nodes/SoTransform.h>

#include <SoTerrain/SoHeightMap.h>
#include <SoTerrain/SoTerrainKit.h>
#include <SoTerrain/SoTerrainPlacement.h>

using namespace test;

namespace {

constexpr int kSide = 33;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Heights 2 + x / 2 + y / 4.
std::vector<float> slope() {
    std::vector<float> heights;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) heights.push_back(2.0f + 0.5f * float(x) + 0.25f * float(y));
    return heights;
}

SoNode* coordinatesOf(const std::vector<float>& heights, int up = 2) {
    auto* node = new SoCoordinate3;
    std::vector<SbVec3f> points;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            SbVec3f p;
            p[up == 0 ? 1 : 0] = float(x);
            p[up == 2 ? 1 : 2] = float(y);
            p[up] = heights[std::size_t(y * kSide + x)];
            points.push_back(p);
        }
    node->point.setValues(0, int(points.size()), points.data());
    return node;
}

/// Ground, and a small cube that is placed on it in separators of their own.
struct Placed {
    Ref<SoSeparator> root{new SoSeparator};
    SoHeightMap* map = new SoHeightMap;
    SoSeparator* group = new SoSeparator;
    SoTerrainPlacement* placement = new SoTerrainPlacement;
    SoSeparator* inner = new SoSeparator;
    SoCube* cube = new SoCube;

    explicit Placed(SoNode* heights = nullptr) {
        Ref<SoHeightMap> unused(map);
        if (!heights) {
            EXPECT_TRUE(map->setHeights(kSide, kSide, slope().data()));
            heights = map;
        }
        root->addChild(heights);
        root->addChild(group);
        group->addChild(placement);
        group->addChild(inner);
        inner->addChild(cube);
        placement->point = SbVec2f(10.5f, 8.0f);
        cube->width = cube->height = cube->depth = 1.0f;
    }
    SbVec3f centre() const { return boxOf(root.get()).getCenter(); }
    SbMatrix matrix() const {
        SoSearchAction search;
        search.setNode(cube);
        search.apply(root.get());
        SoGetMatrixAction action(kRegion);
        action.apply(search.getPath());
        EXPECT_TRUE((action.getMatrix() * action.getInverse()).equals(SbMatrix::identity(), 1e-4f));
        return action.getMatrix();
    }
    SbVec3f origin() const {
        SbVec3f at;
        matrix().multVecMatrix(SbVec3f(0.0f, 0.0f, 0.0f), at);
        return at;
    }
    /// Where SoCallbackAction has the cube.
    SbVec3f called() const {
        SbVec3f at(kNaN, kNaN, kNaN);
        SoCallbackAction action(kRegion);
        action.addPreCallback(
            SoCube::getClassTypeId(),
            [](void* closure, SoCallbackAction* where, const SoNode*) {
                where->getModelMatrix().multVecMatrix(SbVec3f(0.0f, 0.0f, 0.0f), *static_cast<SbVec3f*>(closure));
                return SoCallbackAction::CONTINUE;
            },
            &at);
        action.apply(root.get());
        return at;
    }
};

const SbVec3f kExpected(10.5f, 8.0f, 2.0f + 5.25f + 2.0f);

void expectNear(const SbVec3f& found, const SbVec3f& expected, const char* what) {
    EXPECT_LT((found - expected).length(), 1e-4f)
        << what << ": " << found.toString().getString() << " for " << expected.toString().getString();
}

}  // namespace

TEST(Placement, StandsOnTheGroundInEveryAction) {
    const auto heights = slope();
    for (const bool overMap : {true, false}) {
        Placed scene(overMap ? nullptr : coordinatesOf(heights));
        expectNear(scene.centre(), kExpected, "box");
        expectNear(scene.origin(), kExpected, "matrix");
        expectNear(scene.called(), kExpected, "callback");
        scene.placement->offset = 1.5f;
        expectNear(scene.centre(), kExpected + SbVec3f(0.0f, 0.0f, 1.5f), "offset");
        SoGetPrimitiveCountAction count(kRegion);
        count.apply(scene.root.get());
        EXPECT_EQ(count.getTriangleCount(), 12);
    }
}

TEST(Placement, AgreesWithTheHeightsOfTheTerrainNode) {
    const Where where{Kind::Roam, true};
    const auto root = groundShape(where);
    SoTerrainShape* terrain = terrainIn(root.get());
    auto* placement = new SoTerrainPlacement;
    auto* group = new SoSeparator;
    root->addChild(group);
    group->addChild(placement);
    group->addChild(new SoSphere);
    placement->verticesPerRow = terrain->verticesPerRow.getValue();
    placement->verticesPerColumn = terrain->verticesPerColumn.getValue();
    int tried = 0;
    const SbBox3f box = ground().box();
    Messages messages;
    for (int i = 0; i < 60; ++i) {
        const SbVec2f at(box.getMin()[0] + (box.getMax()[0] - box.getMin()[0]) * float(i % 10) / 9.3f,
                         box.getMin()[1] + (box.getMax()[1] - box.getMin()[1]) * float(i) / 61.0f);
        float height = 0.0f;
        placement->point = at;
        SoPath* path = new SoPath(root.get());
        path->ref();
        path->append(group);
        path->append(group->getChild(1));
        SoGetMatrixAction action(kRegion);
        action.apply(path);
        path->unref();
        SbVec3f origin;
        action.getMatrix().multVecMatrix(SbVec3f(0.0f, 0.0f, 0.0f), origin);
        const bool isGround = terrain->heightAt(at[0], at[1], height);
        expectNear(origin, isGround ? SbVec3f(at[0], at[1], height) : SbVec3f(0.0f, 0.0f, 0.0f), "place");
        tried += isGround;
    }
    EXPECT_GT(tried, 30);
    EXPECT_LT(tried, 60);
}

TEST(Placement, TurnsAndTiltsByTheNormalOfTheGround) {
    const SbVec3f normal = [] {
        SbVec3f n(-0.5f, -0.25f, 1.0f);
        n.normalize();
        return n;
    }();
    for (int up = 0; up < 3; ++up) {
        Placed scene(coordinatesOf(slope(), up));
        SbVec3f vertical(0.0f, 0.0f, 0.0f), expected, place;
        vertical[up] = 1.0f;
        for (SbVec3f* v : {&expected, &place}) {
            const SbVec3f& from = v == &expected ? normal : kExpected;
            (*v)[up == 0 ? 1 : 0] = from[0];
            (*v)[up == 2 ? 1 : 2] = from[1];
            (*v)[up] = from[2];
        }
        expectNear(scene.origin(), place, "upright");
        SbVec3f axis;
        scene.matrix().multDirMatrix(vertical, axis);
        expectNear(axis, vertical, "upright");
        scene.placement->heading = 1.5707963f;
        SbVec3f ahead(0.0f, 0.0f, 0.0f), turned;
        ahead[(up + 1) % 3] = 1.0f;
        scene.matrix().multDirMatrix(ahead, turned);
        expectNear(turned, vertical.cross(ahead), "a quarter turn, counterclockwise from above");
        scene.placement->align = TRUE;
        scene.matrix().multDirMatrix(vertical, axis);
        expectNear(axis, expected, "aligned");
        expectNear(scene.origin(), place, "aligned");
        // The heading comes before the tilt.
        scene.matrix().multDirMatrix(ahead, axis);
        SbRotation(vertical, expected).multVec(turned, turned);
        expectNear(axis, turned, "heading and tilt");
    }
}

TEST(Placement, MovesNothingBesideTheTerrainAndOverHolesAfterOneWarning) {
    Placed scene;
    Messages messages;
    const auto expectUnmoved = [&](const char* text) {
        for (int i = 0; i < 3; ++i) expectNear(scene.centre(), SbVec3f(0.0f, 0.0f, 0.0f), text);
        expectNear(scene.origin(), SbVec3f(0.0f, 0.0f, 0.0f), text);
        ASSERT_EQ(messages.all().size(), 1u) << messages.text();
        EXPECT_NE(messages.text().find(text), std::string::npos) << messages.text();
        messages.clear();
    };
    scene.placement->point = SbVec2f(-1.0f, 3.0f);
    expectUnmoved("expected a place on the ground, found -1");
    scene.placement->point = SbVec2f(kNaN, 3.0f);
    expectUnmoved("expected a place on the ground, found nan");
    const float hole[] = {kNaN};
    ASSERT_TRUE(scene.map->setHeights(10, 8, 1, 1, hole));
    scene.placement->point = SbVec2f(10.25f, 8.25f);
    expectUnmoved("in a hole");
    scene.placement->point = SbVec2f(5.0f, 5.0f);
    scene.placement->heading = kNaN;
    expectUnmoved("offset and heading");
    scene.placement->heading = 0.0f;
    scene.placement->verticesPerRow = 50;
    expectUnmoved("expected 50 x 33 = 1650 samples from startIndex 0, found 1089");
    scene.placement->verticesPerRow = 0;
    scene.root->removeChild(0);
    expectUnmoved("expected an SoHeightMap or an SoCoordinate3 before it, found neither");
    auto* curved = static_cast<SoCoordinate3*>(coordinatesOf(slope()));
    curved->point.set1Value(40, SbVec3f(3.3f, 1.4f, 2.0f));
    scene.root->insertChild(curved, 0);
    scene.placement->touch();
    expectUnmoved("found a curved one");
}

TEST(Placement, FollowsEditsAtOnce) {
    Placed scene;
    expectNear(scene.centre(), kExpected, "before");
    std::vector<float> hill(16, 40.0f);
    ASSERT_TRUE(scene.map->setHeights(9, 7, 4, 4, hill.data()));
    const SbVec3f expected(10.5f, 8.0f, 40.0f);
    expectNear(scene.centre(), expected, "box");
    expectNear(scene.origin(), expected, "matrix");
    expectNear(scene.called(), expected, "callback");
    // Coordinates that change do the same.
    auto heights = slope();
    auto* coordinates = static_cast<SoCoordinate3*>(coordinatesOf(heights));
    Placed other(coordinates);
    expectNear(other.centre(), kExpected, "before");
    for (int y = 7; y < 11; ++y)
        for (int x = 9; x < 13; ++x) coordinates->point.set1Value(y * kSide + x, SbVec3f(float(x), float(y), 40.0f));
    expectNear(other.centre(), expected, "box");
    expectNear(other.origin(), expected, "matrix");
}

TEST(Placement, InARenderCacheIsDrawnAnewWhenTheGroundChanges) {
    Stage stage;
    Placed scene;
    scene.root->insertChild(cameraAt(SbVec3f(16.0f, -30.0f, 30.0f), SbVec3f(16.0f, 16.0f, 15.0f), 1.0f, 200.0f), 0);
    auto* light = new SoLightModel;
    light->model = SoLightModel::BASE_COLOR;
    scene.root->insertChild(light, 1);
    scene.cube->width = scene.cube->height = scene.cube->depth = 6.0f;
    scene.group->renderCaching = SoSeparator::ON;
    scene.inner->renderCaching = SoSeparator::ON;
    scene.group->boundingBoxCaching = SoSeparator::ON;
    terrain::Image before;
    for (int frame = 0; frame < 4; ++frame) before = stage.render(scene.root.get());
    const std::vector<float> high(kSide * kSide, 22.0f);
    ASSERT_TRUE(scene.map->setHeights(0, 0, kSide, kSide, high.data()));
    const terrain::Image after = stage.render(scene.root.get());
    scene.group->renderCaching = SoSeparator::OFF;
    scene.inner->renderCaching = SoSeparator::OFF;
    scene.group->touch();
    const terrain::Image expected = stage.render(scene.root.get());
    EXPECT_TRUE(after.pixels == expected.pixels);
    EXPECT_FALSE(after.pixels == before.pixels);
    EXPECT_GT(coveredPixels(after), 200);
}

TEST(Placement, ChangesWhatCachesBelowDependOnWithTheMatrixAlone) {
    Placed scene;
    struct Seen {
        std::unique_ptr<SoElement> before;
        bool isSame = false;
    } seen;
    const auto look = [&] {
        SoCallbackAction action(kRegion);
        action.addPreCallback(
            SoCube::getClassTypeId(),
            [](void* closure, SoCallbackAction* where, const SoNode*) {
                auto& was = *static_cast<Seen*>(closure);
                const SoElement* now = where->getState()->getConstElement(SoModelMatrixElement::getClassStackIndex());
                was.isSame = was.before && now->matches(was.before.get());
                was.before.reset(now->copyMatchInfo());
                return SoCallbackAction::CONTINUE;
            },
            &seen);
        action.apply(scene.root.get());
        return seen.isSame;
    };
    look();
    EXPECT_TRUE(look());
    const float peak[] = {60.0f, 60.0f, 60.0f, 60.0f};
    ASSERT_TRUE(scene.map->setHeights(25, 20, 2, 2, peak));
    EXPECT_TRUE(look()) << "an edit elsewhere";
    ASSERT_TRUE(scene.map->setHeights(10, 8, 2, 2, peak));
    EXPECT_FALSE(look()) << "an edit below it";
    EXPECT_TRUE(look());
}

TEST(Placement, GivesPicksTheRightPoints) {
    Placed scene;
    scene.placement->align = TRUE;
    scene.placement->heading = 0.4f;
    scene.placement->offset = 0.5f;
    SoRayPickAction pick(kRegion);
    pick.setRay(SbVec3f(10.5f, 8.0f, 100.0f), SbVec3f(0.0f, 0.0f, -1.0f));
    pick.apply(scene.root.get());
    const SoPickedPoint* point = pick.getPickedPoint();
    ASSERT_NE(point, nullptr);
    EXPECT_EQ(static_cast<const SoFullPath*>(point->getPath())->getTail(), scene.cube);
    // The upper side of the cube, which is tilted: half a unit over its middle along the normal.
    EXPECT_NEAR(point->getObjectPoint(scene.cube)[2], 0.5f, 1e-4f);
    SbVec3f world;
    scene.matrix().multVecMatrix(point->getObjectPoint(scene.cube), world);
    expectNear(world, point->getPoint(), "point");
    EXPECT_GT(point->getPoint()[2], kExpected[2] + 1.0f);
}

TEST(Placement, OfOneNodeInTwoPlacesHasTheGroundOfEach) {
    Placed first;
    Placed second;
    const std::vector<float> flat(kSide * kSide, 7.0f);
    ASSERT_TRUE(second.map->setHeights(0, 0, kSide, kSide, flat.data()));
    second.group->replaceChild(second.placement, first.placement);
    for (int i = 0; i < 2; ++i) {
        expectNear(first.centre(), kExpected, "first");
        expectNear(second.origin(), SbVec3f(10.5f, 8.0f, 7.0f), "second");
        expectNear(first.origin(), kExpected, "first");
        expectNear(second.centre(), SbVec3f(10.5f, 8.0f, 7.0f), "second");
    }
    // Twice along one path.
    first.inner->insertChild(first.placement, 0);
    expectNear(first.origin(), first.called(), "twice");
}

TEST(Placement, StandsInAKitAndUnderTransforms) {
    Ref<SoSeparator> root(new SoSeparator);
    auto* kit = new SoTerrainKit;
    root->addChild(kit);
    auto* map = new SoHeightMap;
    ASSERT_TRUE(map->setHeights(kSide, kSide, slope().data()));
    kit->setPart("heightMap", map);
    static_cast<SoTransform*>(kit->getPart("transform", TRUE))->translation = SbVec3f(100.0f, 0.0f, 0.0f);
    Placed part;
    Ref<SoSeparator> group(part.group);
    part.root->removeAllChildren();
    static_cast<SoNodeKitListPart*>(kit->getPart("childList", TRUE))->addChild(group.get());
    SoSearchAction search;
    search.setNode(part.cube);
    search.setSearchingAll(TRUE);
    SoBaseKit::setSearchingChildren(TRUE);
    search.apply(root.get());
    SoBaseKit::setSearchingChildren(FALSE);
    ASSERT_NE(search.getPath(), nullptr);
    SoGetMatrixAction action(kRegion);
    action.apply(search.getPath());
    SbVec3f origin;
    action.getMatrix().multVecMatrix(SbVec3f(0.0f, 0.0f, 0.0f), origin);
    expectNear(origin, kExpected + SbVec3f(100.0f, 0.0f, 0.0f), "matrix");
    SoRayPickAction pick(kRegion);
    pick.setRay(SbVec3f(110.5f, 8.0f, 100.0f), SbVec3f(0.0f, 0.0f, -1.0f));
    pick.apply(root.get());
    ASSERT_NE(pick.getPickedPoint(), nullptr);
    expectNear(pick.getPickedPoint()->getPoint(), kExpected + SbVec3f(100.0f, 0.0f, 0.5f), "pick");
}
