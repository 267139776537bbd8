// Selections, lassos, event callbacks, draggers and highlights treat every terrain node as they treat Coin's triangles.
#include "Actions.h"

#include <gtest/gtest.h>

#include <memory>

#include <Inventor/SoPickedPoint.h>
#include <Inventor/SoPrimitiveVertex.h>
#include <Inventor/actions/SoBoxHighlightRenderAction.h>
#include <Inventor/actions/SoHandleEventAction.h>
#include <Inventor/actions/SoLineHighlightRenderAction.h>
#include <Inventor/draggers/SoTranslate1Dragger.h>
#include <Inventor/events/SoLocation2Event.h>
#include <Inventor/events/SoMouseButtonEvent.h>
#include <Inventor/nodes/SoEventCallback.h>
#include <Inventor/nodes/SoExtSelection.h>
#include <Inventor/nodes/SoIndexedFaceSet.h>
#include <Inventor/nodes/SoLocateHighlight.h>
#include <Inventor/nodes/SoTransform.h>

#include <SoTerrain/SoTerrainDetail.h>

using namespace test;

namespace {

void send(SoNode* root, SoEvent& event, const SbVec2s& position) {
    event.setPosition(position);
    SoHandleEventAction action(kRegion);
    action.setEvent(&event);
    action.apply(root);
}

void press(SoNode* root, const SbVec2s& position, SoMouseButtonEvent::Button button = SoMouseButtonEvent::BUTTON1) {
    SoMouseButtonEvent event;
    event.setButton(button);
    event.setState(SoButtonEvent::DOWN);
    send(root, event, position);
}

void release(SoNode* root, const SbVec2s& position) {
    SoMouseButtonEvent event;
    event.setButton(SoMouseButtonEvent::BUTTON1);
    event.setState(SoButtonEvent::UP);
    send(root, event, position);
}

void move(SoNode* root, const SbVec2s& position) {
    SoLocation2Event event;
    send(root, event, position);
}

/// The children of the scene under a selection node.
template <class T>
Ref<T> selectionOf(std::optional<Where> where) {
    const auto scene = groundScene(where);
    Ref<T> selection(new T);
    for (int i = 0; i < scene->getNumChildren(); ++i) selection->addChild(scene->getChild(i));
    return selection;
}

struct Lasso {
    const char* what;
    std::vector<SbVec2s> corners;
};
const Lasso kLassos[] = {
    {"all", {{1, 1}, {318, 1}, {318, 238}, {1, 238}}},
    {"a part of the ground", {{120, 80}, {200, 80}, {200, 150}, {120, 150}}},
    {"a corner of the view", {{1, 1}, {12, 1}, {12, 9}, {1, 9}}},
    {"the left half", {{1, 1}, {150, 1}, {150, 238}, {1, 238}}},
};

struct Selected {
    int paths = 0;
    int triangles = 0;
    SoNode* tail = nullptr;
    bool operator==(const Selected& other) const { return paths == other.paths && triangles == other.triangles; }
};
std::ostream& operator<<(std::ostream& out, const Selected& s) { return out << s.paths << " paths, " << s.triangles << " triangles"; }

Selected select(SoExtSelection* root, const Lasso& lasso, SoExtSelection::LassoType type, SoExtSelection::LassoPolicy policy, bool filter) {
    Selected found;
    root->deselectAll();
    root->lassoType = type;
    root->lassoPolicy = policy;
    root->setTriangleFilterCallback(filter ? [](void* closure, SoCallbackAction*, const SoPrimitiveVertex*, const SoPrimitiveVertex*, const SoPrimitiveVertex*) {
        ++static_cast<Selected*>(closure)->triangles;
        return SbBool(FALSE);
    } : static_cast<SoExtSelectionTriangleCB*>(nullptr), &found);
    if (type == SoExtSelection::RECTANGLE) {
        press(root, lasso.corners[0]);
        move(root, lasso.corners[2]);
        release(root, lasso.corners[2]);
    } else {
        for (const SbVec2s& corner : lasso.corners) {
            move(root, corner);
            press(root, corner);
            release(root, corner);
        }
        press(root, lasso.corners[0], SoMouseButtonEvent::BUTTON2);
    }
    found.paths = root->getNumSelected();
    if (found.paths > 0) found.tail = static_cast<SoFullPath*>(root->getPath(0))->getTail();
    return found;
}

template <class Action>
terrain::Image highlighted(Stage& stage, std::optional<Where> where) {
    const auto root = selectionOf<SoSelection>(where);
    SoNode* shape = where ? static_cast<SoNode*>(terrainIn(root.get())) : findIn(root.get(), SoIndexedFaceSet::getClassTypeId());
    if (where) static_cast<SoTerrainShape*>(shape)->pixelError = 0.5f;
    // Coin looks for the selection below the root.
    Ref<SoSeparator> scene(new SoSeparator);
    scene->addChild(root.get());
    root->select(shape);
    EXPECT_EQ(root->getNumSelected(), 1);
    stage.clear();
    Action action(stage.region());
    action.setCacheContext(stage.cacheContext());
    glEnable(GL_DEPTH_TEST);
    action.setColor(SbColor(1.0f, 0.0f, 0.0f));
    action.apply(scene.get());
    EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
    return stage.picture();
}

class ActionLasso : public OnEveryNode {};
class ActionEvent : public OnEveryNode {};
class ActionHighlight : public OnEveryNode {};

}  // namespace

TEST_P(ActionLasso, SelectsWhatCoinsShapeWouldBeSelectedBy) {
    const auto reference = selectionOf<SoExtSelection>({}), ours = selectionOf<SoExtSelection>(GetParam());
    int selections = 0, misses = 0;
    for (const auto type : {SoExtSelection::RECTANGLE, SoExtSelection::LASSO})
        for (const auto policy : {SoExtSelection::FULL_BBOX, SoExtSelection::PART_BBOX, SoExtSelection::FULL, SoExtSelection::PART})
            for (const Lasso& lasso : kLassos) {
                const Selected expected = select(reference.get(), lasso, type, policy, false), found = select(ours.get(), lasso, type, policy, false);
                EXPECT_EQ(found, expected) << lasso.what << ", type " << type << ", policy " << policy;
                EXPECT_EQ(found.tail, found.paths > 0 ? terrainIn(ours.get()) : nullptr);
                (found.paths > 0 ? selections : misses) += 1;
            }
    EXPECT_GT(selections, 8);
    EXPECT_GT(misses, 8);
}

TEST_P(ActionLasso, FiltersTheSameTriangles) {
    const auto reference = selectionOf<SoExtSelection>({}), ours = selectionOf<SoExtSelection>(GetParam());
    for (const Lasso& lasso : kLassos) {
        const Selected expected = select(reference.get(), lasso, SoExtSelection::LASSO, SoExtSelection::PART, true);
        EXPECT_EQ(select(ours.get(), lasso, SoExtSelection::LASSO, SoExtSelection::PART, true), expected) << lasso.what;
    }
    EXPECT_GT(select(ours.get(), kLassos[1], SoExtSelection::LASSO, SoExtSelection::PART, true).triangles, 50);
}

TEST_P(ActionEvent, ClicksSelectTheNodeAndLetItGo) {
    const auto root = selectionOf<SoSelection>(GetParam());
    const auto click = [&](const SbVec2s& position) {
        press(root.get(), position);
        release(root.get(), position);
    };
    click(SbVec2s(250, 150));
    ASSERT_EQ(root->getNumSelected(), 1);
    EXPECT_EQ(static_cast<SoFullPath*>(root->getPath(0))->getTail(), terrainIn(root.get()));
    click(SbVec2s(5, 235));
    EXPECT_EQ(root->getNumSelected(), 0);
}

TEST_P(ActionEvent, CallbacksFindThePointUnderTheMouse) {
    SbVec3f points[2] = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
    for (const bool isOurs : {false, true}) {
        const auto scene = isOurs ? groundScene(GetParam()) : groundScene({});
        auto* callback = new SoEventCallback;
        callback->addEventCallback(SoMouseButtonEvent::getClassTypeId(), [](void* closure, SoEventCallback* node) {
            if (const SoPickedPoint* picked = node->getPickedPoint()) *static_cast<SbVec3f*>(closure) = picked->getPoint();
            node->setHandled();
        }, &points[isOurs]);
        scene->insertChild(callback, 1);
        press(scene.get(), SbVec2s(250, 150));
    }
    EXPECT_GT(points[0].length(), 1.0f);
    EXPECT_LT((points[0] - points[1]).length(), 1e-3f);
}

TEST_P(ActionEvent, DraggersOverTheGroundAreDragged) {
    SbVec3f moved[2] = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
    for (const bool isOurs : {false, true}) {
        const auto scene = isOurs ? groundScene(GetParam()) : groundScene({});
        auto* place = new SoTransform;
        place->translation = SbVec3f(38.0f, 33.0f, 26.0f);
        place->scaleFactor = SbVec3f(8.0f, 8.0f, 8.0f);
        scene->addChild(place);
        auto* dragger = new SoTranslate1Dragger;
        scene->addChild(dragger);
        const SbViewVolume view = static_cast<SoCamera*>(scene->getChild(0))->getViewVolume(kRegion.getViewportAspectRatio());
        SbVec3f centre;
        view.projectToScreen(place->translation.getValue(), centre);
        const SbVec2s at(short(centre[0] * 320.0f), short(centre[1] * 240.0f));
        press(scene.get(), at);
        move(scene.get(), SbVec2s(short(at[0] + 20), at[1]));
        move(scene.get(), SbVec2s(short(at[0] + 40), at[1]));
        release(scene.get(), SbVec2s(short(at[0] + 40), at[1]));
        moved[isOurs] = dragger->translation.getValue();
    }
    EXPECT_GT(moved[0].length(), 0.1f);
    EXPECT_LT((moved[0] - moved[1]).length(), 1e-3f);
}

TEST_P(ActionHighlight, BoxesAndLinesAreDrawnAroundIt) {
    Stage stage(160, 120);
    const auto boxes = std::pair{highlighted<SoBoxHighlightRenderAction>(stage, {}), highlighted<SoBoxHighlightRenderAction>(stage, GetParam())};
    const auto lines = std::pair{highlighted<SoLineHighlightRenderAction>(stage, {}), highlighted<SoLineHighlightRenderAction>(stage, GetParam())};
    savePicture("action_highlight_" + nameOfWhere({GetParam(), 0}), {boxes.first, boxes.second, lines.first, lines.second});
    const double allowed = GetParam().kind == Kind::BruteForce ? 1.0 : 10.0;
    expectAlike(boxes.first, boxes.second, allowed, "box");
    const auto redOf = [](const terrain::Image& image) {
        int red = 0;
        for (std::size_t i = 0; i < image.pixels.size(); i += 3) red += image.pixels[i] > 200 && image.pixels[i + 1] < 60 && image.pixels[i + 2] < 60;
        return red;
    };
    EXPECT_NEAR(redOf(boxes.first), redOf(boxes.second), 0.1 * redOf(boxes.first));
    // With level of detail there are fewer lines.
    EXPECT_GT(redOf(lines.second), redOf(lines.first) / 8);
    EXPECT_LT(redOf(lines.second), redOf(lines.first) * 11 / 10 + 1);
}

TEST_P(ActionHighlight, LocateHighlightColoursIt) {
    Stage stage(160, 120);
    const auto shows = [&](std::optional<Where> where, bool on) {
        const auto scene = groundScene(where);
        auto* highlight = new SoLocateHighlight;
        highlight->mode = on ? SoLocateHighlight::ON : SoLocateHighlight::OFF;
        highlight->style = SoLocateHighlight::EMISSIVE;
        highlight->color = SbColor(0.0f, 0.0f, 0.8f);
        highlight->addChild(scene->getChild(2));
        scene->replaceChild(2, highlight);
        return stage.render(scene.get());
    };
    const auto expected = shows({}, true), found = shows(GetParam(), true);
    expectAlike(expected, found, GetParam().kind == Kind::BruteForce ? 1.0 : 10.0, "highlighted");
    EXPECT_GT(meanColor(found)[2], meanColor(shows(GetParam(), false))[2] + 50.0);
}

INSTANTIATE_TEST_SUITE_P(, ActionLasso, testing::ValuesIn(everywhere()), nameOfWhere);
INSTANTIATE_TEST_SUITE_P(, ActionEvent, testing::ValuesIn(everywhere()), nameOfWhere);
INSTANTIATE_TEST_SUITE_P(, ActionHighlight, testing::ValuesIn(everywhere()), nameOfWhere);
