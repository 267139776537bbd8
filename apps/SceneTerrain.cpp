// The terrain of a scene: put in, exchanged for another algorithm, placed.
#include <cstdio>

#include <Inventor/actions/SoCallbackAction.h>
#include <Inventor/actions/SoSearchAction.h>
#include <Inventor/fields/SoSFBool.h>
#include <Inventor/fields/SoSFFloat.h>
#include <Inventor/fields/SoSFInt32.h>
#include <Inventor/lists/SoFieldList.h>
#include <Inventor/nodekits/SoBaseKit.h>
#include <Inventor/nodes/SoCoordinate3.h>
#include <Inventor/nodes/SoIndexedFaceSet.h>
#include <Inventor/nodes/SoNormal.h>
#include <Inventor/nodes/SoNormalBinding.h>
#include <Inventor/nodes/SoQuadMesh.h>
#include <Inventor/nodes/SoTextureCoordinate2.h>
#include <SoTerrain/SoHeightMap.h>
#include <SoTerrain/SoHeightMapElement.h>
#include <SoTerrain/SoTerrainShape.h>

#include "HeightMapReading.h"
#include "Scene.h"

namespace app {

using terrain::Error;

namespace {

SoCallbackAction::Response noteSource(void* source, SoCallbackAction* action, const SoNode*) {
    const terrain::HeightSource* here = SoHeightMapElement::getInstance(action->getState())->getSource();
    *static_cast<std::shared_ptr<const terrain::HeightSource>*>(source) = here ? here->shared_from_this() : nullptr;
    return SoCallbackAction::PRUNE;
}

// Kits keep their nodes from who does not ask for them.
class InsideKits {
public:
    InsideKits() : former_(SoBaseKit::isSearchingChildren()) { SoBaseKit::setSearchingChildren(TRUE); }
    ~InsideKits() { SoBaseKit::setSearchingChildren(former_); }
    InsideKits(const InsideKits&) = delete;
    InsideKits& operator=(const InsideKits&) = delete;

private:
    SbBool former_;
};

// The fields that both have keep their values.
void copyFields(const SoNode& from, SoNode& to) {
    SoFieldList fields;
    from.getFields(fields);
    for (int i = 0; i < fields.getLength(); ++i) {
        SbName name;
        from.getFieldName(fields[i], name);
        SoField* field = to.getField(name);
        const bool is = field && field->getTypeId() == fields[i]->getTypeId() && !fields[i]->isDefault();
        if (is && !field->isSame(*fields[i])) field->copyFrom(*fields[i]);
    }
    to.setName(from.getName());
}

// What the options give a terrain node, field by field: set(flag, field, value) with an optional value.
template <class Set>
void forEachField(const Options& options, Set set) {
    const std::optional<float> error = options.pixelError ? std::optional(float(*options.pixelError)) : std::nullopt;
    set("-e", "pixelError", error);
    set("-r", "triangleCount", options.triangleCount);
    set("-g", "tileSize", options.tileSize);
    set("--clipmap-size", "clipmapSize", options.clipmapSize);
    set("--levels", "levels", options.clipmapLevels);
    set("--detail", "detailLevels", options.detailLevels);
}

bool setField(SoNode& node, const char* name, float value) {
    auto* field = dynamic_cast<SoSFFloat*>(node.getField(name));
    if (field) field->setValue(value);
    return field;
}

bool setField(SoNode& node, const char* name, int value) {
    auto* field = dynamic_cast<SoSFInt32*>(node.getField(name));
    if (field) field->setValue(value);
    return field;
}

void readField(const SoNode& node, const char* name, std::optional<int>& value) {
    if (const auto* field = dynamic_cast<SoSFInt32*>(node.getField(name))) value = field->getValue();
}

}  // namespace

NodePtr<SoPath> findNode(SoNode& root, const std::function<void(SoSearchAction&)>& wanted) {
    const InsideKits inside;
    SoSearchAction search;
    wanted(search);
    search.setInterest(SoSearchAction::FIRST);
    search.apply(&root);
    return NodePtr<SoPath>(search.getPath());
}

std::vector<SoNode*> findNodes(SoNode& root, SoType type) {
    const InsideKits inside;
    SoSearchAction search;
    search.setType(type);
    search.setInterest(SoSearchAction::ALL);
    search.apply(&root);
    std::vector<SoNode*> nodes;
    for (int i = 0; i < search.getPaths().getLength(); ++i)
        nodes.push_back(static_cast<SoFullPath*>(search.getPaths()[i])->getTail());
    return nodes;
}

// A flag that names a field the shape does not have is said to have no effect, and the program goes on.
void Scene::setFields(const Options& options, bool tells) {
    if (!terrain_) return;
    const auto complain = [&](const char* flag) {
        if (tells) std::fprintf(stderr, "SoTerrainTest: %s has no effect on %s\n", flag, algorithm_.c_str());
    };
    forEachField(options, [&](const char* flag, const char* name, const auto& value) {
        if (value && !setField(*terrain_, name, *value)) complain(flag);
    });
    auto* culling = dynamic_cast<SoSFBool*>(terrain_->getField("frustumCulling"));
    if (culling && (options.frustumCulling || options.scene.empty())) culling->setValue(options.frustumCulling);
    if (!culling && options.frustumCulling) complain("-c");
}

void Scene::readFields(Options& options) const {
    if (!terrain_) return;
    if (const auto* error = dynamic_cast<SoSFFloat*>(terrain_->getField("pixelError"))) options.pixelError = error->getValue();
    readField(*terrain_, "triangleCount", options.triangleCount);
    readField(*terrain_, "tileSize", options.tileSize);
    readField(*terrain_, "clipmapSize", options.clipmapSize);
    readField(*terrain_, "levels", options.clipmapLevels);
    readField(*terrain_, "detailLevels", options.detailLevels);
    if (const auto* culling = dynamic_cast<SoSFBool*>(terrain_->getField("frustumCulling")))
        options.frustumCulling = culling->getValue();
}

std::shared_ptr<const terrain::HeightSource> Scene::heightSource() const {
    std::shared_ptr<const terrain::HeightSource> source;
    if (!terrainPath_) return source;
    SoCallbackAction action;
    action.addPreCallback(terrain_->getTypeId(), noteSource, &source);
    action.apply(terrainPath_.get());
    return source;
}

// The samples of the node itself, so that no file is read for them.
const TerrainGrid* Scene::completeGrid() {
    if (!grid_ || grid_->source) return grid_ ? &*grid_ : nullptr;
    grid_->source = heightSource();
    grid_->heightScale = 1.0;
    grid_->heightOffset = 0.0;
    return grid_->source ? &*grid_ : nullptr;
}

double Scene::heightScale() const {
    return heightMap_ ? double(static_cast<SoHeightMap*>(heightMap_.get())->heightScale.getValue()) : grid_->heightScale;
}

bool Scene::offers(const Algorithm& algorithm) const {
    if (!terrain_) return false;
    if (isHeightMap())
        return algorithm.feed == Feed::HeightMap || (grid_ && double(grid_->columns) * grid_->rows <= maxCoinSamples);
    const bool known = terrain_->isOfType(SoTerrainShape::getClassTypeId()) || terrain_->isOfType(SoQuadMesh::getClassTypeId());
    if (!known || algorithm.feed == Feed::IndexedFaceSet) return false;
    return algorithm.feed == Feed::HeightMap || !heightSource();
}

bool Scene::shows(const Algorithm& algorithm) const {
    return terrain_ && terrain_->getTypeId() == SoType::fromName(algorithm.className);
}

std::optional<Error> Scene::setAlgorithm(const Algorithm& algorithm, const Options& options) {
    const SoType type = SoType::fromName(algorithm.className);
    if (!type.canCreateInstance()) return Error{"-a", "an algorithm of this build", std::string(algorithm.name)};
    if (!offers(algorithm)) return Error{std::string(algorithm.name), "a terrain that it can draw", "another one"};
    const NodePtr<SoNode> former(terrain_);
    if (isHeightMap()) {
        if (auto problem = putTerrain(algorithm, options)) return problem;
    } else {
        replaceTerrain(static_cast<SoNode*>(type.createInstance()));
        algorithm_ = algorithm.className;
    }
    setFields(options, false);
    copyFields(*former.get(), *terrain_);
    countedTriangles_.reset();
    return std::nullopt;
}

// In its place in a scene file; a kit's part is the kit's to exchange.
void Scene::replaceTerrain(SoNode* fresh) {
    const NodePtr<SoNode> held(fresh);
    auto* path = static_cast<SoFullPath*>(terrainPath_.get());
    const int length = path->getLength();
    for (int i = length - 2; i >= 0; --i) {
        SoNode* node = path->getNode(i);
        if (!node->isOfType(SoBaseKit::getClassTypeId())) continue;
        auto* kit = static_cast<SoBaseKit*>(node);
        kit->setPart("terrain", fresh);
        terrain_ = kit->getPart("terrain", FALSE);
        terrainPath_ = findNode(*root_.get(), [this](SoSearchAction& search) { search.setNode(terrain_); });
        return;
    }
    auto* parent = static_cast<SoGroup*>(path->getNode(length - 2));
    const int index = path->getIndex(length - 1);
    const NodePtr<SoPath> above(path->copy(0, length - 1));
    parent->replaceChild(index, fresh);
    auto* below = static_cast<SoFullPath*>(above.get());
    below->append(index);
    terrain_ = fresh;
    terrainPath_ = above;
}

void Scene::addHeightMap(const Options& options) {
    if (heightMap_) return;
    const TerrainGrid& grid = *grid_;
    auto* map = new SoHeightMap;
    map->filename = options.heightMap.c_str();
    map->spacing.setValue(float(grid.spacing.x), float(grid.spacing.y));
    map->heightScale = float(grid.heightScale);
    map->heightOffset = float(grid.heightOffset);
    if (options.channel) map->channel = *options.channel;
    if (options.rawSize) map->rawSize.setValue(options.rawSize->x, options.rawSize->y);
    if (options.rawType) map->rawType = int(*options.rawType);
    if (grid.source) HeightMapReading::give(map, grid.source);
    heightMap_ = NodePtr<SoNode>(map);
    const int group = group_ ? root_->findChild(group_) : root_->getNumChildren();
    root_->insertChild(map, group);
}

std::optional<Error> Scene::addCoinArrays(SoSeparator& group, Feed feed, const std::string& name) {
    const TerrainGrid* grid = completeGrid();
    if (!grid || !grid->source->map() || double(grid->columns) * grid->rows > maxCoinSamples) {
        return Error{name, "a map that fits into memory and 32-bit indices, for Coin's own shapes",
                     std::to_string(grid_->columns) + "x" + std::to_string(grid_->rows)};
    }
    SoCoordinate3* coordinates = makeCoordinates(*grid);
    auto* binding = new SoNormalBinding;
    binding->value = feed == Feed::QuadMesh ? SoNormalBinding::PER_VERTEX : SoNormalBinding::PER_VERTEX_INDEXED;
    group.addChild(coordinates);
    group.addChild(binding);
    group.addChild(makeNormals(*coordinates, grid->columns, grid->rows));
    const glm::dvec2 step(1.0 / (grid->columns - 1), 1.0 / (grid->rows - 1));
    group.addChild(makeTextureCoordinates(grid->columns, grid->rows, step));
    return std::nullopt;
}

// Over a height map, in a group of its own, which takes the place of the former one.
std::optional<Error> Scene::putTerrain(const Algorithm& algorithm, const Options& options) {
    const NodePtr<SoSeparator> group(new SoSeparator);
    SoNode* fresh = nullptr;
    if (algorithm.feed == Feed::HeightMap) {
        const SoType type = SoType::fromName(algorithm.className);
        if (!type.canCreateInstance()) return Error{"-a", "an algorithm of this build", std::string(algorithm.name)};
        addHeightMap(options);
        fresh = static_cast<SoNode*>(type.createInstance());
    } else {
        if (auto problem = addCoinArrays(*group.get(), algorithm.feed, options.heightMap)) return problem;
        fresh = algorithm.feed == Feed::QuadMesh ? static_cast<SoNode*>(makeQuadMesh(*grid_)) : makeFaceSet(*grid_);
    }
    group->addChild(fresh);
    if (group_)
        root_->replaceChild(group_, group.get());
    else
        root_->addChild(group.get());
    group_ = group.get();
    terrain_ = fresh;
    algorithm_ = algorithm.name;
    auto* path = new SoPath(root_.get());
    path->append(group_);
    path->append(terrain_);
    terrainPath_ = NodePtr(path);
    // The node has the samples itself; a second copy is kept only for those who need it.
    if (algorithm.feed == Feed::HeightMap && !options.measureError) grid_->source.reset();
    return std::nullopt;
}

}  // namespace app
