// Bounding boxes, primitive counts and primitives are those of the full-resolution data.
#include "Scenes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <set>

#include <Inventor/SoPrimitiveVertex.h>
#include <Inventor/actions/SoCallbackAction.h>
#include <Inventor/actions/SoGetBoundingBoxAction.h>
#include <Inventor/actions/SoGetPrimitiveCountAction.h>
#include <Inventor/nodes/SoCoordinate3.h>
#include <Inventor/nodes/SoTransform.h>

using namespace test;

namespace {

constexpr float kHole = std::numeric_limits<float>::quiet_NaN();

SbBox3f boxOf(SoNode* root) {
    SoGetBoundingBoxAction action(SbViewportRegion(320, 240));
    action.apply(root);
    return action.getBoundingBox();
}

void expectBox(const SbBox3f& found, const SbBox3f& expected) {
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(found.getMin()[axis], expected.getMin()[axis], 1e-5f * (1.0f + std::fabs(expected.getMin()[axis]))) << "axis " << axis;
        EXPECT_NEAR(found.getMax()[axis], expected.getMax()[axis], 1e-5f * (1.0f + std::fabs(expected.getMax()[axis]))) << "axis " << axis;
    }
}

Surface withHoles() {
    auto map = fractalMap(41, 23, 20.0);
    for (const auto& [column, row] : {std::pair{0, 0}, {10, 10}, {11, 10}, {40, 22}}) map.heights[std::size_t(row * 41 + column)] = kHole;
    map.heights[std::size_t(5 * 41 + 5)] = 35.0f;
    return surfaceOf(map);
}

using Triangle = std::array<std::array<float, 3>, 3>;

/// Corners in order of size, so that triangles compare whatever corner they begin at.
Triangle sorted(const SbVec3f& a, const SbVec3f& b, const SbVec3f& c) {
    Triangle triangle{{{a[0], a[1], a[2]}, {b[0], b[1], b[2]}, {c[0], c[1], c[2]}}};
    std::sort(triangle.begin(), triangle.end());
    return triangle;
}

std::multiset<Triangle> expectedTriangles(const Surface& s) {
    std::multiset<Triangle> all;
    for (int row = 0; row < s.rows - 1; ++row)
        for (int column = 0; column < s.columns - 1; ++column) {
            if (s.isCellHole(column, row)) continue;
            all.insert(sorted(s.at(column, row), s.at(column + 1, row), s.at(column, row + 1)));
            all.insert(sorted(s.at(column + 1, row), s.at(column + 1, row + 1), s.at(column, row + 1)));
        }
    return all;
}

struct Collected {
    std::multiset<Triangle> triangles;
    float lowestUp = 1.0f;
    std::set<std::pair<float, float>> textureCorners;
};

void collect(void* closure, SoCallbackAction*, const SoPrimitiveVertex* a, const SoPrimitiveVertex* b, const SoPrimitiveVertex* c) {
    auto& all = *static_cast<Collected*>(closure);
    all.triangles.insert(sorted(a->getPoint(), b->getPoint(), c->getPoint()));
    for (const auto* vertex : {a, b, c}) {
        all.lowestUp = std::min(all.lowestUp, vertex->getNormal()[2]);
        all.textureCorners.insert({vertex->getTextureCoords()[0], vertex->getTextureCoords()[1]});
    }
}

class Primitives : public testing::TestWithParam<Kind> {};

}  // namespace

TEST_P(Primitives, BoxIsThatOfTheSamplesBeforeTheFirstFrame) {
    const Surface surface = withHoles();
    Ref<SoSeparator> root(shapeOf(GetParam(), surface));
    expectBox(boxOf(root.get()), surface.box());
}

TEST_P(Primitives, BoxDoesNotDependOnTheCamera) {
    const Surface surface = withHoles();
    const auto root = sceneOf(GetParam(), surface);
    Stage stage(64, 64);
    stage.render(root.get());
    const SbBox3f before = boxOf(root.get());
    auto* camera = static_cast<SoCamera*>(root->getChild(0));
    camera->position = SbVec3f(4000.0f, 0.0f, 900.0f);
    stage.render(root.get());
    expectBox(boxOf(root.get()), before);
    expectBox(before, surface.box());
}

TEST_P(Primitives, BoxFollowsATransform) {
    const Surface surface = withHoles();
    const auto dress = [](SoSeparator* group) {
        auto* transform = new SoTransform;
        transform->rotation = SbRotation(SbVec3f(1.0f, 0.3f, 0.2f), 0.5f);
        transform->scaleFactor = SbVec3f(1.0f, 2.0f, 0.1f);
        group->addChild(transform);
    };
    auto filled = withHoles();
    for (auto& point : filled.points)
        if (!std::isfinite(point[2])) point[2] = 10.0f;
    expectBox(boxOf(sceneOf(GetParam(), filled, {}, dress).get()), boxOf(sceneOf(Kind::Reference, filled, {}, dress).get()));
}

TEST_P(Primitives, OfNothingButHolesHaveNoBox) {
    Ref<SoSeparator> root(shapeOf(GetParam(), surfaceOf(mapOf(5, 5, [](double, double) { return kHole; }))));
    EXPECT_TRUE(boxOf(root.get()).isEmpty());
}

TEST_P(Primitives, CountIsThatOfAllTriangles) {
    const Surface surface = withHoles();
    Ref<SoSeparator> root(shapeOf(GetParam(), surface));
    SoGetPrimitiveCountAction action;
    action.apply(root.get());
    EXPECT_EQ(action.getTriangleCount(), int(expectedTriangles(surface).size()));
}

TEST_P(Primitives, AreAllTriangles) {
    const Surface surface = withHoles();
    Ref<SoSeparator> root(shapeOf(GetParam(), surface, {.normals = false}));
    Collected all;
    SoCallbackAction action;
    action.addTriangleCallback(SoTerrainShape::getClassTypeId(), collect, &all);
    action.apply(root.get());
    EXPECT_EQ(all.triangles, expectedTriangles(surface));
    EXPECT_GT(all.lowestUp, 0.0f);
    EXPECT_TRUE(all.textureCorners.count({1.0f, 0.0f}) && all.textureCorners.count({0.0f, 1.0f}));
}

TEST_P(Primitives, FollowAnEditOfTheCoordinates) {
    Surface surface = withHoles();
    const auto root = sceneOf(GetParam(), surface, {.pixelError = 0.0f}, unlitTexture);
    Stage stage;
    const auto before = stage.render(root.get());
    for (int row = 8; row < 16; ++row)
        for (int column = 18; column < 30; ++column) surface.points[surface.index(column, row)][2] += 12.0f;
    surface.points[surface.index(0, 0)][2] = 50.0f;
    auto* group = static_cast<SoSeparator*>(static_cast<SoSeparator*>(root->getChild(2))->getChild(static_cast<SoSeparator*>(root->getChild(2))->getNumChildren() - 1));
    auto* coordinates = static_cast<SoCoordinate3*>(group->getChild(0));
    SbVec3f* points = coordinates->point.startEditing();
    std::copy(surface.points.begin(), surface.points.end(), points);
    coordinates->point.finishEditing();
    const auto after = stage.render(root.get());
    auto* camera = static_cast<SoCamera*>(static_cast<SoNode*>(root->getChild(0)->copy()));
    const auto fresh = stage.render(sceneOf(GetParam(), surface, {.pixelError = 0.0f}, unlitTexture, camera).get());
    savePicture("edited_" + identifierOf(GetParam()), {before, after, fresh});
    EXPECT_EQ(after.pixels, fresh.pixels);
    EXPECT_NE(after.pixels, before.pixels);
    expectBox(boxOf(root->getChild(2)), surface.box());
    float height = 0.0f;
    EXPECT_TRUE(terrainIn(root.get())->heightAt(20.0f, 10.0f, height));
    EXPECT_EQ(height, surface.at(20, 10)[2]);
}

TEST_P(Primitives, FromAStartIndexAreThatPartOfTheCoordinates) {
    const Surface surface = surfaceOf(fractalMap(20, 20, 5.0));
    Ref<SoSeparator> root(shapeOf(GetParam(), surface));
    SoTerrainShape* node = terrainIn(root.get());
    node->startIndex = 40;
    node->verticesPerColumn = 18;
    SbBox3f expected;
    for (int row = 2; row < 20; ++row)
        for (int column = 0; column < 20; ++column) expected.extendBy(surface.at(column, row));
    expectBox(boxOf(root.get()), expected);
}

TEST_P(Primitives, WithoutSizesMakeASquare) {
    const Surface surface = surfaceOf(fractalMap(20, 20, 5.0));
    Ref<SoSeparator> root(shapeOf(GetParam(), surface));
    terrainIn(root.get())->verticesPerRow = 0;
    terrainIn(root.get())->verticesPerColumn = 0;
    SoGetPrimitiveCountAction action;
    action.apply(root.get());
    EXPECT_EQ(action.getTriangleCount(), 19 * 19 * 2);
}

INSTANTIATE_TEST_SUITE_P(, Primitives, testing::ValuesIn(kOurKinds),
                         [](const auto& info) { return "Of" + identifierOf(info.param); });
