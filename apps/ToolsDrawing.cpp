#include "ToolsDrawing.h"

#include <Inventor/SbMatrix.h>
#include <Inventor/SbViewportRegion.h>
#include <Inventor/SoPath.h>
#include <Inventor/SoPickedPoint.h>
#include <Inventor/actions/SoGetMatrixAction.h>
#include <Inventor/actions/SoRayPickAction.h>
#include <Inventor/lists/SoPickedPointList.h>
#include <Inventor/nodekits/SoBaseKit.h>
#include <Inventor/nodekits/SoNodeKitListPart.h>
#include <Inventor/nodes/SoBaseColor.h>
#include <Inventor/nodes/SoDrawStyle.h>
#include <Inventor/nodes/SoFont.h>
#include <Inventor/nodes/SoLightModel.h>
#include <Inventor/nodes/SoMaterialBinding.h>
#include <Inventor/nodes/SoPickStyle.h>
#include <Inventor/nodes/SoShapeHints.h>
#include <Inventor/nodes/SoSwitch.h>
#include <Inventor/nodes/SoTexture2.h>
#include <SoTerrain/SoTerrainDrape.h>
#include <SoTerrain/SoTerrainPlacement.h>
#include <SoTerrain/SoTerrainShape.h>

#include "SceneGround.h"
#include "ToolsPin.h"

namespace app {

namespace {

const SbColor lineColor(1.0f, 0.85f, 0.1f);
const SbColor markerColor(0.9f, 0.15f, 0.1f);
const SbColor spotColor(0.1f, 0.75f, 1.0f);
const SbColor cursorColor(1.0f, 1.0f, 1.0f);

void addColor(SoSeparator& group, const SbColor& color) {
    auto* node = new SoBaseColor;
    node->rgb = color;
    group.addChild(node);
}

}  // namespace

ToolsDrawing::ToolsDrawing(Scene& scene) : scene_(scene), root_(new SoSeparator) {
    auto* pick = new SoPickStyle;
    pick->style = SoPickStyle::UNPICKABLE;
    // The texture of the ground, its shading, materials and the wireframe are not theirs.
    auto* light = new SoLightModel;
    light->model = SoLightModel::BASE_COLOR;
    auto* style = new SoDrawStyle;
    style->lineWidth = 3.0f;
    style->pointSize = 9.0f;
    root_->renderCaching = SoSeparator::OFF;
    for (SoNode* node :
         std::initializer_list<SoNode*>{pick, light, style, new SoMaterialBinding, new SoTexture2, new SoShapeHints, new SoFont})
        root_->addChild(node);
    for (SoSeparator** part : {&line_, &cursor_, &markers_, &spot_}) root_->addChild(*part = new SoSeparator);
}

// The part of a kit is the kit's alone; what belongs to it goes into its list of children.
SoNode* ToolsDrawing::home() const {
    auto* path = static_cast<SoFullPath*>(scene_.terrainPath());
    if (!path || path->getLength() < 2) return nullptr;
    for (int i = path->getLength() - 2; i >= 0; --i) {
        SoNode* node = path->getNode(i);
        if (node->isOfType(SoBaseKit::getClassTypeId())) return static_cast<SoBaseKit*>(node)->getPart("childList", TRUE);
    }
    SoNode* parent = path->getNode(path->getLength() - 2);
    return parent->isOfType(SoSwitch::getClassTypeId()) ? nullptr : parent;
}

bool ToolsDrawing::follow() {
    if (scene_.terrain() && scene_.terrain() == terrain_.get()) return bool(home_);
    leave();
    terrain_ = NodePtr<SoNode>(scene_.terrain());
    home_ = NodePtr<SoNode>(scene_.terrain() ? home() : nullptr);
    if (!home_) return false;
    if (home_->isOfType(SoNodeKitListPart::getClassTypeId())) {
        static_cast<SoNodeKitListPart*>(home_.get())->addChild(root_.get());
    } else {
        auto* group = static_cast<SoGroup*>(home_.get());
        group->insertChild(root_.get(), group->findChild(scene_.terrain()) + 1);
    }
    showSpot(shownSpot_, spotLabel_);
    showLine(corners_, lineLabel_);
    showCursor(shownCursor_);
    showMarkers(shownMarkers_);
    return true;
}

void ToolsDrawing::leave() {
    if (!home_) return;
    const auto remove = [this](auto* group) {
        if (group->findChild(root_.get()) >= 0) group->removeChild(root_.get());
    };
    if (home_->isOfType(SoNodeKitListPart::getClassTypeId()))
        remove(static_cast<SoNodeKitListPart*>(home_.get()));
    else
        remove(static_cast<SoGroup*>(home_.get()));
}

void ToolsDrawing::forget() {
    showSpot(std::nullopt, "");
    showLine({}, "");
    showCursor(std::nullopt);
    showMarkers({});
}

SoSeparator* ToolsDrawing::standing(glm::dvec2 place) const {
    auto* object = new SoSeparator;
    auto* placement = new SoTerrainPlacement;
    placement->point.setValue(float(place.x), float(place.y));
    takeGrid(scene_, *placement);
    object->addChild(placement);
    return object;
}

void ToolsDrawing::addDrape(SoSeparator& group, const std::vector<glm::dvec2>& points, bool asPoints) const {
    auto* drape = new SoTerrainDrape;
    for (const glm::dvec2& point : points) drape->point.set1Value(drape->point.getNum(), SbVec2f(float(point.x), float(point.y)));
    if (asPoints) drape->kind = SoTerrainDrape::POINTS;
    SoNode* terrain = scene_.terrain();
    if (terrain && terrain->isOfType(SoTerrainShape::getClassTypeId())) drape->terrain = terrain;
    takeGrid(scene_, *drape);
    group.addChild(drape);
}

void ToolsDrawing::showSpot(const std::optional<Spot>& spot, const std::string& label) {
    shownSpot_ = spot;
    spotLabel_ = label;
    spot_->removeAllChildren();
    if (!spot || !home_) return;
    const float size = scene_.localSize();
    SoSeparator* object = standing(spot->at);
    addPin(*object, spotColor, 0.5f * size, label);
    spot_->addChild(object);
}

void ToolsDrawing::showLine(const std::vector<glm::dvec2>& corners, const std::string& label) {
    corners_ = corners;
    lineLabel_ = label;
    line_->removeAllChildren();
    if (corners.empty() || !home_) return;
    addColor(*line_, lineColor);
    if (corners.size() > 1) addDrape(*line_, corners, false);
    addDrape(*line_, corners, true);
    if (label.empty() || !spotAt(SceneGround(scene_), corners.back())) return;
    SoSeparator* end = standing(corners.back());
    addLabel(*end, label, 0.01f * scene_.localSize());
    line_->addChild(end);
}

void ToolsDrawing::showCursor(const std::optional<glm::dvec2>& place) {
    shownCursor_ = place;
    cursor_->removeAllChildren();
    if (!place || !home_) return;
    addColor(*cursor_, cursorColor);
    auto* style = new SoDrawStyle;
    style->pointSize = 13.0f;
    cursor_->addChild(style);
    addDrape(*cursor_, {*place}, true);
}

void ToolsDrawing::showMarkers(const std::vector<Marker>& markers) {
    shownMarkers_ = markers;
    markers_->removeAllChildren();
    if (!home_) return;
    for (const Marker& marker : markers) {
        // The placement of one without ground would warn in every frame.
        if (!SceneGround(scene_).at(marker.at)) continue;
        SoSeparator* object = standing(marker.at);
        addPin(*object, markerColor, scene_.localSize(), marker.name);
        markers_->addChild(object);
    }
}

std::optional<glm::dvec2> placeUnder(const Scene& scene, const SbVec2s& pixel, const SbVec2s& pictureSize) {
    if (!scene.terrainPath()) return std::nullopt;
    const SbViewportRegion region(pictureSize);
    SoRayPickAction pick(region);
    pick.setPoint(pixel);
    pick.setPickAll(TRUE);
    pick.apply(scene.root());
    const SoPickedPointList& points = pick.getPickedPointList();
    for (int i = 0; i < points.getLength(); ++i) {
        if (static_cast<SoFullPath*>(points[i]->getPath())->getTail() != scene.terrain()) continue;
        SoGetMatrixAction matrices(region);
        matrices.apply(scene.terrainPath());
        SbVec3f local;
        matrices.getInverse().multVecMatrix(points[i]->getPoint(), local);
        return glm::dvec2(local[0], local[1]);
    }
    return std::nullopt;
}

}  // namespace app
