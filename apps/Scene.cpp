#include "Scene.h"

#include <algorithm>
#include <cmath>

#include <Inventor/SbViewportRegion.h>
#include <Inventor/SoPath.h>
#include <Inventor/actions/SoGetMatrixAction.h>
#include <Inventor/actions/SoGetPrimitiveCountAction.h>
#include <Inventor/actions/SoSearchAction.h>
#include <Inventor/fields/SoSFBool.h>
#include <Inventor/fields/SoSFNode.h>
#include <Inventor/lists/SoFieldList.h>
#include <Inventor/nodekits/SoBaseKit.h>
#include <Inventor/nodes/SoQuadMesh.h>
#include <SoTerrain/SoTerrainShape.h>

#include "ImageFile.h"
#include "Texture.h"

namespace app {

namespace {

SoTerrainShape* asTerrain(SoNode* node) {
    if (!node || !node->isOfType(SoTerrainShape::getClassTypeId())) return nullptr;
    return static_cast<SoTerrainShape*>(node);
}

SoSFBool* flagOf(SoNode* node, const char* name) {
    return dynamic_cast<SoSFBool*>(node->getField(name));
}

// Nearest and farthest point of a box along the direction of view.
void boxRange(const SbBox3f& box, const Pose& pose, float& nearest, float& farthest) {
    SbVec3f direction;
    pose.orientation.multVec(SbVec3f(0.0f, 0.0f, -1.0f), direction);
    nearest = 1e30f;
    farthest = -1e30f;
    for (int corner = 0; corner < 8; ++corner) {
        const SbVec3f point(corner & 1 ? box.getMax()[0] : box.getMin()[0], corner & 2 ? box.getMax()[1] : box.getMin()[1],
                            corner & 4 ? box.getMax()[2] : box.getMin()[2]);
        const float distance = (point - pose.position).dot(direction);
        nearest = std::min(nearest, distance);
        farthest = std::max(farthest, distance);
    }
}

}  // namespace

float Scene::size() const {
    const SbVec3f extent = box_.getMax() - box_.getMin();
    const float side = std::max(extent[0], extent[1]);
    return side > 0.0f ? side : 1.0f;
}

float Scene::localSize() const {
    if (!terrainPath_) return size();
    SoGetMatrixAction matrices(SbViewportRegion(1, 1));
    matrices.apply(terrainPath_.get());
    SbVec3f across;
    matrices.getInverse().multDirMatrix(SbVec3f(size(), 0.0f, 0.0f), across);
    return across.length();
}

FlightArea Scene::flightArea() const {
    const SbVec3f extent = box_.getMax() - box_.getMin();
    // The standard placement has heights up to 0.051 and flies at 0.07; elsewhere that gap over the highest point is kept.
    FlightArea area{box_.getMin(), extent[0], extent[1], box_.getMax()[2] + (0.07f - float(standardHeight)) * size()};
    if (!grid_) return area;
    area.width = float(grid_->columns * grid_->spacing.x);
    area.depth = float(grid_->rows * grid_->spacing.y);
    const bool standard =
        area.width == 1.0f && area.depth == 1.0f && grid_->minimum >= 0.0 && grid_->maximum <= 1.001 * standardHeight;
    if (standard) area.altitude = 0.07f;
    return area;
}

void Scene::setPose(const Pose& pose) {
    camera_->position = pose.position;
    camera_->orientation = pose.orientation;
    if (!ownClipping_ || box_.isEmpty()) return;
    float nearest = 0.0f, farthest = 0.0f;
    boxRange(box_, pose, nearest, farthest);
    const float depth = std::max(farthest, 1e-3f * size());
    camera_->farDistance = depth * 1.01f;
    camera_->nearDistance = std::max(nearest * 0.99f, depth * 1e-3f);
}

Pose Scene::pose() const {
    return {camera_->position.getValue(), camera_->orientation.getValue()};
}

std::optional<float> Scene::groundHeight(const SbVec3f& point) const {
    SoTerrainShape* shape = asTerrain(terrain_);
    if (!shape) return grid_ ? grid_->heightAt(point[0], point[1]) : std::nullopt;
    SoGetMatrixAction matrices(SbViewportRegion(1, 1));
    matrices.apply(terrainPath_.get());
    SbVec3f local, world;
    matrices.getInverse().multVecMatrix(point, local);
    float height = 0.0f;
    if (!shape->heightAt(local[0], local[1], height, nullptr, terrainPath_.get())) return std::nullopt;
    matrices.getMatrix().multVecMatrix(SbVec3f(local[0], local[1], height), world);
    return world[2];
}

FrameFigures Scene::figures() {
    FrameFigures figures;
    if (SoTerrainShape* shape = asTerrain(terrain_)) {
        const SoTerrainStatistics s = shape->getStatistics();
        figures.triangles = s.triangles;
        figures.terrain = {s.selectMilliseconds, s.uploadMilliseconds, s.drawMilliseconds, s.patches,  s.errorPixels,
                           s.memoryBytes,        s.bufferBytes,        s.pendingPatches,   s.converged};
        return figures;
    }
    if (terrain_ && terrain_->isOfType(SoQuadMesh::getClassTypeId())) {
        // Coin counts two triangles for every point rather than for every cell.
        const auto* mesh = static_cast<SoQuadMesh*>(terrain_);
        const int columns = mesh->verticesPerRow.getValue(), rows = mesh->verticesPerColumn.getValue();
        figures.triangles = columns > 1 && rows > 1 ? 2 * std::uint64_t(columns - 1) * std::uint64_t(rows - 1) : 0;
        return figures;
    }
    if (!countedTriangles_) {
        SoGetPrimitiveCountAction count(SbViewportRegion(1, 1));
        count.apply(root_.get());
        countedTriangles_ = std::uint64_t(std::max(0, count.getTriangleCount()));
    }
    figures.triangles = *countedTriangles_;
    return figures;
}

std::vector<SoTerrainShape*> Scene::terrainShapes() const {
    SoSearchAction search;
    search.setType(SoTerrainShape::getClassTypeId());
    search.setInterest(SoSearchAction::ALL);
    const SbBool searchesKits = SoBaseKit::isSearchingChildren();
    SoBaseKit::setSearchingChildren(TRUE);
    search.apply(root_.get());
    SoBaseKit::setSearchingChildren(searchesKits);
    const SoPathList& found = search.getPaths();
    std::vector<SoTerrainShape*> shapes;
    for (int i = 0; i < found.getLength(); ++i) shapes.push_back(asTerrain(static_cast<SoFullPath*>(found[i])->getTail()));
    return shapes;
}

bool Scene::isComplete() const {
    const auto shapes = terrainShapes();
    return std::all_of(shapes.begin(), shapes.end(), [](const SoTerrainShape* shape) { return shape->getStatistics().converged; });
}

void Scene::waitForTiles(bool on) {
    for (const auto& node : hurried_) flagOf(node.get(), "background")->setValue(TRUE);
    hurried_.clear();
    if (!on) return;
    for (SoTerrainShape* shape : terrainShapes()) {
        SoSFBool* background = flagOf(shape, "background");
        if (!background || !background->getValue()) continue;
        background->setValue(FALSE);
        hurried_.emplace_back(shape);
    }
}

void Scene::restart() {
    for (SoTerrainShape* shape : terrainShapes()) shape->restart();
}

void Scene::holdMeshes(bool on) {
    const auto setQuietly = [](SoSFBool* flag, SbBool value) {
        const SbBool notified = flag->enableNotify(FALSE);
        flag->setValue(value);
        flag->enableNotify(notified);
    };
    for (const auto& node : held_) setQuietly(flagOf(node.get(), "freeze"), FALSE);
    held_.clear();
    if (!on) return;
    for (SoTerrainShape* shape : terrainShapes()) {
        if (shape->freeze.getValue()) continue;
        setQuietly(&shape->freeze, TRUE);
        held_.emplace_back(shape);
    }
}

std::vector<std::pair<std::string, std::string>> Scene::settings() const {
    std::vector<std::pair<std::string, std::string>> settings;
    SoFieldList fields;
    if (terrain_) terrain_->getFields(fields);
    for (int i = 0; i < fields.getLength(); ++i) {
        // What holds data or other nodes is no setting.
        if (!fields[i]->isOfType(SoSField::getClassTypeId()) || fields[i]->isOfType(SoSFNode::getClassTypeId())) continue;
        SbName name;
        SbString value;
        if (!terrain_->getFieldName(fields[i], name)) continue;
        fields[i]->get(value);
        settings.emplace_back(name.getString(), value.getString());
    }
    return settings;
}

terrain::Result<std::unique_ptr<ErrorMeter>> Scene::makeErrorMeter() {
    if (!grid_) return terrain::Error{"--measure-error", "a terrain over an SoHeightMap", "none"};
    SoNode* parent = static_cast<SoFullPath*>(terrainPath_.get())->getNodeFromTail(1);
    return std::make_unique<ErrorMeter>(*grid_, static_cast<SoGroup*>(parent), terrain_);
}

// White under a texture, which the light then shows in its own colours; the colour of earth without one.
std::optional<terrain::Error> Scene::setTexture(const std::string& path, const Errand& errand) {
    NodePtr<SoTexture2> texture;
    if (!path.empty()) {
        terrain::Result<terrain::Image> read = terrain::Image{};
        errand("Reading " + path, [&](terrain::ReadProgress&) { read = readImage(path); });
        if (!read) return read.error();
        texture = NodePtr(makeTexture(std::move(read).value()));
    }
    if (texture_) root_->removeChild(texture_.get());
    if (texture) root_->insertChild(texture.get(), root_->findChild(material_) + 1);
    texture_ = texture;
    const SbColor color = texture_ ? SbColor(1.0f, 1.0f, 1.0f) : SbColor(0.62f, 0.57f, 0.47f);
    material_->diffuseColor = color;
    material_->ambientColor = color * 0.4f;
    return std::nullopt;
}

void Scene::setWireframe(bool on) {
    drawStyle_->style = on ? SoDrawStyle::LINES : SoDrawStyle::FILLED;
    drawStyle_->setOverride(on);
}

bool Scene::wireframe() const {
    return drawStyle_->style.getValue() == SoDrawStyle::LINES;
}

}  // namespace app
