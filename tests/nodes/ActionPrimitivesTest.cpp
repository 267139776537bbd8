// Triangles, counts, boxes and conversions of every terrain node are those of Coin's triangles of the same ground.
#include "Actions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <Inventor/SoPrimitiveVertex.h>
#include <Inventor/VRMLnodes/SoVRMLGroup.h>
#include <Inventor/VRMLnodes/SoVRMLIndexedFaceSet.h>
#include <Inventor/actions/SoAudioRenderAction.h>
#include <Inventor/actions/SoCallbackAction.h>
#include <Inventor/actions/SoGetMatrixAction.h>
#include <Inventor/actions/SoGetPrimitiveCountAction.h>
#include <Inventor/actions/SoGetBoundingBoxAction.h>
#include <Inventor/actions/SoReorganizeAction.h>
#include <Inventor/actions/SoSearchAction.h>
#include <Inventor/actions/SoToVRML2Action.h>
#include <Inventor/actions/SoToVRMLAction.h>
#include <Inventor/fields/SoMFVec3f.h>
#include <Inventor/nodekits/SoShapeKit.h>
#include <Inventor/nodes/SoComplexity.h>
#include <Inventor/nodes/SoDrawStyle.h>
#include <Inventor/nodes/SoMaterial.h>
#include <Inventor/nodes/SoMaterialBinding.h>
#include <Inventor/nodes/SoMatrixTransform.h>
#include <Inventor/nodes/SoShapeHints.h>

#include <SoTerrain/SoTerrainDetail.h>

using namespace test;

namespace {

struct Corner {
    SbVec3f point, normal;
    SbVec4f texture;
    int material;
    bool operator<(const Corner& other) const {
        return std::lexicographical_compare(point.getValue(), point.getValue() + 3, other.point.getValue(), other.point.getValue() + 3);
    }
};
using Triangle = std::array<Corner, 3>;

/// What a traversal with callbacks at every kind of primitive brings.
struct Traversal {
    std::vector<Triangle> triangles;  ///< corners in order of their places, and the triangles likewise
    int lines = 0, points = 0, before = 0, after = 0;
    int downward = 0;        ///< triangles that are clockwise from above
    int wrongDetails = 0;    ///< vertices whose detail does not tell their coordinate
    int wrongCells = 0;      ///< materials that are not those of the cell
};

void onTriangle(void* closure, SoCallbackAction*, const SoPrimitiveVertex* a, const SoPrimitiveVertex* b, const SoPrimitiveVertex* c) {
    auto& all = *static_cast<Traversal*>(closure);
    const SoPrimitiveVertex* vertices[3] = {a, b, c};
    Triangle triangle;
    for (int i = 0; i < 3; ++i) {
        const SoPrimitiveVertex& v = *vertices[i];
        triangle[std::size_t(i)] = {v.getPoint(), v.getNormal(), v.getTextureCoords(), v.getMaterialIndex()};
        const SoDetail* detail = v.getDetail();
        if (!detail || !detail->isOfType(SoFaceDetail::getClassTypeId())) {
            ++all.wrongDetails;
            continue;
        }
        const int index = static_cast<const SoFaceDetail*>(detail)->getPoint(i)->getCoordinateIndex();
        all.wrongDetails += index < 0 || index >= int(ground().points.size()) || ground().points[std::size_t(index)] != v.getPoint();
        if (detail->isOfType(SoTerrainDetail::getClassTypeId())) all.wrongCells += static_cast<const SoTerrainDetail*>(detail)->getFaceIndex() != v.getMaterialIndex();
    }
    all.downward += (b->getPoint() - a->getPoint()).cross(c->getPoint() - a->getPoint())[2] <= 0.0f;
    std::sort(triangle.begin(), triangle.end());
    all.triangles.push_back(triangle);
}

Traversal traverse(SoNode* root, SoCallbackAction::Response response = SoCallbackAction::CONTINUE) {
    Traversal all;
    SoCallbackAction action;
    action.addTriangleCallback(SoShape::getClassTypeId(), onTriangle, &all);
    action.addLineSegmentCallback(SoShape::getClassTypeId(), [](void* closure, SoCallbackAction*, const SoPrimitiveVertex*, const SoPrimitiveVertex*) {
        ++static_cast<Traversal*>(closure)->lines; }, &all);
    action.addPointCallback(SoShape::getClassTypeId(), [](void* closure, SoCallbackAction*, const SoPrimitiveVertex*) {
        ++static_cast<Traversal*>(closure)->points; }, &all);
    static SoCallbackAction::Response answer;
    answer = response;
    action.addPreCallback(SoShape::getClassTypeId(), [](void* closure, SoCallbackAction*, const SoNode*) {
        ++static_cast<Traversal*>(closure)->before;
        return answer; }, &all);
    action.addPostCallback(SoShape::getClassTypeId(), [](void* closure, SoCallbackAction*, const SoNode*) {
        ++static_cast<Traversal*>(closure)->after;
        return SoCallbackAction::CONTINUE; }, &all);
    action.apply(root);
    std::sort(all.triangles.begin(), all.triangles.end());
    return all;
}

void expectSameTriangles(const std::vector<Triangle>& expected, const std::vector<Triangle>& found, bool attributes = true) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            ASSERT_EQ(found[i][k].point, expected[i][k].point) << "triangle " << i;
            if (!attributes) continue;
            ASSERT_LT((found[i][k].normal - expected[i][k].normal).length(), 1e-4f) << "triangle " << i;
            ASSERT_TRUE(found[i][k].texture.equals(expected[i][k].texture, 1e-8f)) << "triangle " << i;
            ASSERT_EQ(found[i][k].material, expected[i][k].material) << "triangle " << i;
        }
}

void dressUp(SoSeparator* group) {
    addTexture(group);
    auto* material = new SoMaterial;
    for (int i = 0; i < int(ground().points.size()); ++i) material->diffuseColor.set1Value(i, SbColor(0.5f, float(i % 7) / 7.0f, 0.2f));
    group->addChild(material);
    auto* binding = new SoMaterialBinding;
    binding->value = SoMaterialBinding::PER_VERTEX_INDEXED;
    group->addChild(binding);
}

SbMatrix sheared() { return {1.0f, 0.2f, 0.0f, 0.0f, -0.3f, 1.1f, 0.1f, 0.0f, 0.0f, 0.4f, -0.9f, 0.0f, 5.0f, -7.0f, 3.0f, 1.0f}; }

void shear(SoSeparator* group) {
    auto* transform = new SoMatrixTransform;
    transform->matrix = sheared();
    group->addChild(transform);
}

class ActionCallback : public OnEveryNode {};
class ActionCount : public OnEveryNode {};
class ActionBox : public OnEveryNode {};
class ActionSearch : public OnEveryNode {};
class ActionConvert : public OnEveryNode {};

}  // namespace

TEST_P(ActionCallback, TrianglesAreThoseOfCoinsShapeWithTheirAttributes) {
    const Traversal expected = traverse(groundScene({}, {.dress = dressUp}).get()), found = traverse(groundScene(GetParam(), {.dress = dressUp}).get());
    EXPECT_GT(expected.triangles.size(), 1500u);
    expectSameTriangles(expected.triangles, found.triangles);
    EXPECT_EQ(found.downward, 0);
}

TEST_P(ActionCallback, VerticesTellCellAndCoordinate) {
    for (const auto ordering : {SoShapeHints::UNKNOWN_ORDERING, SoShapeHints::CLOCKWISE}) {
        const Traversal found = traverse(groundScene(GetParam(), {.dress = [&](SoSeparator* group) {
            auto* hints = new SoShapeHints;
            hints->vertexOrdering = ordering;
            group->addChild(hints);
            dressUp(group);
            static_cast<SoMaterialBinding*>(group->getChild(group->getNumChildren() - 1))->value = SoMaterialBinding::PER_FACE;
        }}).get());
        EXPECT_EQ(found.wrongDetails, 0);
        EXPECT_EQ(found.wrongCells, 0);
        EXPECT_EQ(found.downward, ordering == SoShapeHints::CLOCKWISE ? int(found.triangles.size()) : 0);
    }
}

TEST_P(ActionCallback, BringsTrianglesAloneInEveryDrawStyle) {
    for (const auto style : {SoDrawStyle::LINES, SoDrawStyle::POINTS, SoDrawStyle::INVISIBLE}) {
        const auto dress = [&](SoSeparator* group) {
            auto* draw = new SoDrawStyle;
            draw->style = style;
            group->addChild(draw);
        };
        const Traversal expected = traverse(groundScene({}, {.dress = dress}).get()), found = traverse(groundScene(GetParam(), {.dress = dress}).get());
        expectSameTriangles(expected.triangles, found.triangles, false);
        EXPECT_EQ(found.lines + found.points, expected.lines + expected.points);
    }
}

TEST_P(ActionCallback, IsCalledOnceBeforeAndAfterAndMayPrune) {
    const Traversal found = traverse(groundScene(GetParam()).get());
    EXPECT_EQ(found.before, 1);
    EXPECT_EQ(found.after, 1);
    const Traversal pruned = traverse(groundScene(GetParam()).get(), SoCallbackAction::PRUNE), reference = traverse(groundScene({}).get(), SoCallbackAction::PRUNE);
    EXPECT_TRUE(pruned.triangles.empty());
    EXPECT_EQ(pruned.before, reference.before);
    EXPECT_EQ(pruned.after, reference.after);
}

TEST_P(ActionCount, IsThatOfAllTrianglesWhateverComplexityAndDecimationSay) {
    const auto count = [](SoNode* root, bool settings) {
        SoGetPrimitiveCountAction action(kRegion);
        if (settings) {
            action.setCanApproximate(TRUE);
            action.setDecimationValue(SoDecimationTypeElement::PERCENTAGE, 0.25f);
        }
        action.apply(root);
        EXPECT_EQ(action.getLineCount() + action.getPointCount() + action.getTextCount() + action.getImageCount(), 0);
        EXPECT_FALSE(action.containsNoPrimitives());
        EXPECT_FALSE(action.containsNonTriangleShapes());
        return action.getTriangleCount();
    };
    const auto coarse = [](SoSeparator* group) {
        auto* complexity = new SoComplexity;
        complexity->value = 0.05f;
        group->addChild(complexity);
    };
    const int expected = count(groundScene({}).get(), false);
    EXPECT_EQ(count(groundScene(GetParam()).get(), false), expected);
    EXPECT_EQ(count(groundScene(GetParam(), {.dress = coarse}).get(), true), expected);
    EXPECT_EQ(count(groundScene({}, {.dress = coarse}).get(), true), expected);
}

TEST_P(ActionBox, IsThatOfCoinsShapeUnderAnyTransform) {
    for (const bool holes : {false, true})
        for (const Dressing& dress : {Dressing(), Dressing(shear)}) {
            SoGetBoundingBoxAction expected(kRegion), found(kRegion);
            expected.apply(groundScene({}, {.dress = dress, .holes = holes}).get());
            found.apply(groundScene(GetParam(), {.dress = dress, .holes = holes}).get());
            EXPECT_TRUE(found.getBoundingBox().getMin().equals(expected.getBoundingBox().getMin(), 1e-6f));
            EXPECT_TRUE(found.getBoundingBox().getMax().equals(expected.getBoundingBox().getMax(), 1e-6f));
            EXPECT_NEAR(found.getXfBoundingBox().getVolume(), expected.getXfBoundingBox().getVolume(), 1e-4f * expected.getXfBoundingBox().getVolume());
        }
}

TEST_P(ActionBox, OfNothingIsEmpty) {
    Messages messages;
    const auto root = groundShape(GetParam());
    SoNode* data = root->getChild(0);
    if (GetParam().overMap) {
        static_cast<SoSFFloat*>(data->getField("noData"))->setValue(0.0f);
        static_cast<SoSFFloat*>(data->getField("heightScale"))->setValue(std::nanf(""));
    } else {
        auto* points = static_cast<SoMFVec3f*>(data->getField("point"));
        SbVec3f* all = points->startEditing();
        for (int i = 0; i < points->getNum(); ++i) all[i][2] = std::nanf("");
        points->finishEditing();
    }
    EXPECT_TRUE(boxOf(root.get()).isEmpty());
    EXPECT_TRUE(traverse(root.get()).triangles.empty());
    root->removeChild(0);
    EXPECT_TRUE(boxOf(root.get()).isEmpty());
    EXPECT_TRUE(traverse(root.get()).triangles.empty());
}

TEST_P(ActionSearch, FindsTheNodeByTypeNameAndIdentity) {
    const auto root = groundScene(GetParam());
    SoTerrainShape* node = terrainIn(root.get());
    node->setName("ground");
    const auto found = [&](const std::function<void(SoSearchAction&)>& what) {
        SoSearchAction search;
        what(search);
        search.apply(root.get());
        return search.getPath() ? static_cast<SoFullPath*>(search.getPath())->getTail() : nullptr;
    };
    EXPECT_EQ(found([](SoSearchAction& s) { s.setType(SoTerrainShape::getClassTypeId()); }), node);
    EXPECT_EQ(found([](SoSearchAction& s) { s.setType(SoTerrainShape::getClassTypeId(), FALSE); }), nullptr);
    EXPECT_EQ(found([&](SoSearchAction& s) { s.setType(SoType::fromName(node->getTypeId().getName()), FALSE); }), node);
    EXPECT_EQ(found([](SoSearchAction& s) { s.setType(SoShape::getClassTypeId()); }), node);
    EXPECT_EQ(found([](SoSearchAction& s) { s.setName("ground"); }), node);
    EXPECT_EQ(found([&](SoSearchAction& s) { s.setNode(node); }), node);
    EXPECT_EQ(SoNode::getByName("ground"), node);
}

TEST_P(ActionSearch, FindsTheNodeInAKit) {
    Ref<SoShapeKit> kit(new SoShapeKit);
    SoTerrainShape* node = nodeOf(GetParam().kind, ground().columns, ground().rows);
    ASSERT_TRUE(kit->setPart("shape", node));
    const auto shape = groundShape(GetParam());
    ASSERT_TRUE(kit->setPart("coordinate3", GetParam().overMap ? nullptr : shape->getChild(0)));
    SoSearchAction search;
    search.setType(SoTerrainShape::getClassTypeId());
    search.apply(kit.get());
    EXPECT_EQ(search.getPath(), nullptr) << "kits hide their parts";
    const SbBool before = SoBaseKit::isSearchingChildren();
    SoBaseKit::setSearchingChildren(TRUE);
    search.apply(kit.get());
    SoBaseKit::setSearchingChildren(before);
    ASSERT_NE(search.getPath(), nullptr);
    EXPECT_EQ(static_cast<SoFullPath*>(search.getPath())->getTail(), node);
    if (!GetParam().overMap) {
        EXPECT_EQ(traverse(kit.get()).triangles.size(), traverse(groundShape({}).get()).triangles.size());
    }
}

TEST_P(ActionSearch, GivesTheMatrixOfItsPath) {
    const auto root = groundScene(GetParam(), {.dress = shear});
    SoSearchAction search;
    search.setType(SoTerrainShape::getClassTypeId());
    search.apply(root.get());
    SoGetMatrixAction action(kRegion);
    action.apply(search.getPath());
    EXPECT_TRUE(action.getMatrix().equals(sheared(), 1e-6f));
}

TEST_P(ActionConvert, ToVrml97GivesAnIndexedFaceSetOfTheSameTriangles) {
    const auto root = groundShape(GetParam());
    Ref<SoSeparator> dressed(new SoSeparator);
    dressUp(dressed.get());
    dressed->addChild(root.get());
    SoToVRML2Action action;
    action.apply(dressed.get());
    SoNode* converted = action.getVRML2SceneGraph();
    ASSERT_NE(converted, nullptr);
    auto* faces = findIn<SoVRMLIndexedFaceSet>(converted);
    ASSERT_NE(faces, nullptr);
    EXPECT_NE(faces->normal.getValue(), nullptr);
    EXPECT_NE(faces->texCoord.getValue(), nullptr);
    EXPECT_NE(faces->color.getValue(), nullptr);
    expectSameTriangles(traverse(groundShape({}).get()).triangles, traverse(converted).triangles, false);
    // And of the same looks: both have the same light and camera.
    const auto shows = [](SoNode* shape) {
        Ref<SoSeparator> scene(new SoSeparator);
        const auto around = groundScene({});
        scene->addChild(around->getChild(0));
        scene->addChild(around->getChild(1));
        scene->addChild(shape);
        Stage stage(160, 120);
        return stage.render(scene.get());
    };
    static_cast<SoSFFloat*>(terrainIn(root.get())->getField("pixelError"))->setValue(0.0f);
    const terrain::Image before = shows(dressed.get()), after = shows(converted);
    savePicture("action_vrml97_" + nameOfWhere({GetParam(), 0}), {before, after});
    // VRML97 has no ambient colour apart from the diffuse one.
    expectAlike(before, after, GetParam().kind == Kind::BruteForce ? 5.0 : 8.0, "converted");
}

TEST_P(ActionConvert, ToVrml1ConvertsVrml97Alone) {
    SoToVRMLAction action;
    const auto root = groundShape(GetParam());
    action.apply(root.get());
    SoNode* converted = action.getVRMLSceneGraph();
    EXPECT_TRUE(!converted || traverse(converted).triangles.empty());
    SoToVRML2Action to97;
    to97.apply(root.get());
    SoToVRMLAction back;
    back.apply(to97.getVRML2SceneGraph());
    ASSERT_NE(back.getVRMLSceneGraph(), nullptr);
    expectSameTriangles(traverse(groundShape({}).get()).triangles, traverse(back.getVRMLSceneGraph()).triangles, false);
}

TEST_P(ActionConvert, ReorganizingAndPlayingAudioLeaveItAsItIs) {
    const auto root = groundScene(GetParam());
    SoTerrainShape* node = terrainIn(root.get());
    const std::string before = written(root.get());
    SoReorganizeAction reorganize;
    reorganize.apply(root.get());
    SoAudioRenderAction audio;
    audio.apply(root.get());
    EXPECT_EQ(written(root.get()), before);
    EXPECT_EQ(terrainIn(root.get()), node);
}

INSTANTIATE_TEST_SUITE_P(, ActionCallback, testing::ValuesIn(everywhere()), nameOfWhere);
INSTANTIATE_TEST_SUITE_P(, ActionCount, testing::ValuesIn(everywhere()), nameOfWhere);
INSTANTIATE_TEST_SUITE_P(, ActionBox, testing::ValuesIn(everywhere()), nameOfWhere);
INSTANTIATE_TEST_SUITE_P(, ActionSearch, testing::ValuesIn(everywhere()), nameOfWhere);
INSTANTIATE_TEST_SUITE_P(, ActionConvert, testing::ValuesIn(everywhere()), nameOfWhere);
