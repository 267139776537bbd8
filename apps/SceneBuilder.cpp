#include <algorithm>
#include <cmath>

#include <Inventor/SbViewportRegion.h>
#include <Inventor/SoDB.h>
#include <Inventor/SoInput.h>
#include <Inventor/SoPath.h>
#include <Inventor/actions/SoGetBoundingBoxAction.h>
#include <Inventor/actions/SoSearchAction.h>
#include <Inventor/errors/SoReadError.h>
#include <Inventor/fields/SoSFBool.h>
#include <Inventor/nodes/SoDirectionalLight.h>
#include <Inventor/nodes/SoPerspectiveCamera.h>
#include <SoTerrain/SoHeightMap.h>
#include <SoTerrain/SoTerrainShape.h>

#include "DebugViews.h"
#include "HeightMapReading.h"
#include "Scene.h"

namespace app {

using terrain::Error;
using terrain::Result;

namespace {

// Pictures and measured errors are those of complete frames, however long tiles take.
bool waitsForTiles(const Options& options) {
    return !options.output.empty() || options.measureError;
}

/// The first that Coin finds wrong with what it reads, while this exists; it is printed all the same.
class ReadComplaint {
public:
    ReadComplaint() : print_(SoReadError::getHandlerCallback()) { SoReadError::setHandlerCallback(take, this); }
    ~ReadComplaint() { SoReadError::setHandlerCallback(print_, nullptr); }
    ReadComplaint(const ReadComplaint&) = delete;
    ReadComplaint& operator=(const ReadComplaint&) = delete;

    std::string text() const { return first_.empty() ? "a file that Coin can't read" : first_; }

private:
    static void take(const SoError* error, void* self) {
        auto* complaint = static_cast<ReadComplaint*>(self);
        std::string text = error->getDebugString().getString();
        const std::string head = "Coin read error: ";
        if (text.starts_with(head)) text.erase(0, head.size());
        if (complaint->first_.empty()) complaint->first_ = text.substr(0, text.find('\n'));
        if (complaint->print_) complaint->print_(error, nullptr);
    }

    SoErrorCB* const print_;
    std::string first_;
};

}  // namespace

/// Builds one scene; each step returns what went wrong, if anything did.
class SceneBuilder {
public:
    SceneBuilder(const Options& options, bool tells, const Errand& errand) : options_(options), tells_(tells), errand_(errand) {}

    std::optional<Error> fromHeightMap();
    std::optional<Error> fromFile();
    Scene take() { return std::move(scene_); }

private:
    Result<std::shared_ptr<const terrain::HeightSource>> read(const std::string& path, terrain::HeightFileOptions how);
    void addRoot();
    void addCamera();
    NodePtr<SoPath> find(SoType type) const;
    void chooseTerrain();
    std::optional<Error> readHeightMaps();
    void readGridOfScene();
    void placeSceneCamera();

    const Options& options_;
    bool tells_;
    const Errand& errand_;
    bool isCancelled_ = false;
    Scene scene_;
};

void SceneBuilder::addRoot() {
    scene_.root_ = NodePtr(new SoSeparator);
    scene_.root_->renderCaching = SoSeparator::OFF;
    scene_.drawStyle_ = new SoDrawStyle;
    scene_.root_->addChild(scene_.drawStyle_);
}

void SceneBuilder::addCamera() {
    auto* camera = new SoPerspectiveCamera;
    auto* light = new SoDirectionalLight;
    light->direction.setValue(0.5f, 0.5f, -1.0f);
    scene_.root_->addChild(camera);
    scene_.root_->addChild(light);
    scene_.camera_ = camera;
    const float reach = std::max(scene_.size(), scene_.box_.getMax()[2] - scene_.box_.getMin()[2]);
    camera->nearDistance = 0.001f * reach;
    camera->farDistance = 3.0f * reach;
    scene_.home_ = standardFlight(scene_.flightArea(), 1.0).at(0.0);
    scene_.setPose(scene_.home_);
}

std::optional<Error> SceneBuilder::fromHeightMap() {
    terrain::HeightFileOptions how;
    how.channel = options_.channel.value_or(how.channel);
    how.rawSize = options_.rawSize.value_or(how.rawSize);
    how.rawType = options_.rawType.value_or(how.rawType);
    Result<TerrainGrid> grid = Error{options_.heightMap, "a height map", "nothing"};
    errand_("Reading " + options_.heightMap, [&](terrain::ReadProgress& progress) {
        how.progress = &progress;
        auto source = terrain::openHeightFile(options_.heightMap, how);
        grid = source ? placeGrid(std::move(source).value(), options_.spacing, options_.heightScale) : source.error();
        // Also when that came after the last sample: what follows takes long, too.
        if (progress.isCancelled) grid = Error{options_.heightMap, "to be read to its end", "that it was cancelled"};
    });
    if (!grid) return grid.error();
    scene_.grid_ = std::move(grid).value();
    scene_.box_.extendBy(SbVec3f(0.0f, 0.0f, float(scene_.grid_->minimum)));
    const SbVec3f end = scene_.grid_->point(scene_.grid_->columns - 1, scene_.grid_->rows - 1, 0.0f);
    scene_.box_.extendBy(SbVec3f(end[0], end[1], float(scene_.grid_->maximum)));
    addRoot();
    addCamera();
    scene_.material_ = new SoMaterial;
    scene_.root_->addChild(scene_.material_);
    if (auto problem = scene_.setTexture(options_.texture, errand_)) return problem;
    const Algorithm& algorithm = options_.algorithm ? *options_.algorithm : *findAlgorithm("roam");
    if (auto problem = scene_.putTerrain(algorithm, options_)) return problem;
    scene_.setFields(options_, tells_);
    if (tells_) applyDebugOptions(scene_, options_);
    scene_.waitForTiles(waitsForTiles(options_));
    return std::nullopt;
}

NodePtr<SoPath> SceneBuilder::find(SoType type) const {
    return findNode(*scene_.root_.get(), [type](SoSearchAction& search) { search.setType(type); });
}

// The first of our shapes, or else the first shape.
void SceneBuilder::chooseTerrain() {
    scene_.terrainPath_ = find(SoTerrainShape::getClassTypeId());
    if (!scene_.terrainPath_) scene_.terrainPath_ = find(SoShape::getClassTypeId());
    if (!scene_.terrainPath_) return;
    scene_.terrain_ = static_cast<SoFullPath*>(scene_.terrainPath_.get())->getTail();
    scene_.algorithm_ = scene_.terrain_->getTypeId().getName().getString();
}

Result<std::shared_ptr<const terrain::HeightSource>> SceneBuilder::read(const std::string& path, terrain::HeightFileOptions how) {
    Result<std::shared_ptr<const terrain::HeightSource>> source = Error{path, "a height map", "nothing"};
    errand_("Reading " + path, [&](terrain::ReadProgress& progress) {
        how.progress = &progress;
        source = terrain::openHeightFile(path, how);
        isCancelled_ = isCancelled_ || progress.isCancelled;
    });
    return source;
}

// The program must not go on with a scene that lacks its terrain; its nodes have told what is wrong with their files.
std::optional<Error> SceneBuilder::readHeightMaps() {
    for (SoNode* node : findNodes(*scene_.root_.get(), SoHeightMap::getClassTypeId())) {
        auto* map = static_cast<SoHeightMap*>(node);
        const HeightMapReading::File file = HeightMapReading::file(map);
        if (file.path.empty()) continue;
        auto source = read(file.path, file.options);
        if (source)
            HeightMapReading::give(map, std::move(source).value());
        else if (isCancelled_)
            return source.error();
        if (!map->isLoaded()) {
            const std::string name = map->filename.getValue().getString();
            return Error{options_.scene, "height maps that can be read", name + ", which cannot"};
        }
    }
    return std::nullopt;
}

// A scene whose terrain stands on a file can be measured against the node's own samples.
void SceneBuilder::readGridOfScene() {
    const NodePtr<SoPath> path = find(SoHeightMap::getClassTypeId());
    if (!path || !scene_.terrain_) return;
    const auto* node = static_cast<SoHeightMap*>(static_cast<SoFullPath*>(path.get())->getTail());
    if (node->origin.getValue() != SbVec2f(0.0f, 0.0f)) return;
    auto source = scene_.heightSource();
    if (!source) return;
    const glm::dvec2 spacing = source->extent().spacing;
    auto grid = placeGrid(std::move(source), spacing, 1.0);
    if (grid) scene_.grid_ = std::move(grid).value();
}

// The camera of the file, or one that sees everything: from the south and above where there is a terrain, as a viewer's elsewhere.
void SceneBuilder::placeSceneCamera() {
    if (const NodePtr<SoPath> path = find(SoCamera::getClassTypeId())) {
        scene_.camera_ = static_cast<SoCamera*>(static_cast<SoFullPath*>(path.get())->getTail());
        scene_.ownClipping_ = scene_.camera_->nearDistance.isDefault() && scene_.camera_->farDistance.isDefault();
    } else {
        scene_.camera_ = new SoPerspectiveCamera;
        scene_.root_->insertChild(scene_.camera_, 0);
        if (scene_.terrain_ && scene_.terrain_->isOfType(SoTerrainShape::getClassTypeId())) {
            scene_.camera_->orientation = lookAlong(SbVec3f(), SbVec3f(0.0f, 1.0f, -0.6f)).orientation;
        }
        scene_.camera_->viewAll(scene_.root_.get(), SbViewportRegion(1024, 768));
        scene_.ownClipping_ = true;
    }
    scene_.home_ = scene_.pose();
    scene_.setPose(scene_.home_);
}

std::optional<Error> SceneBuilder::fromFile() {
    SoInput input;
    if (!input.openFile(options_.scene.c_str(), TRUE)) {
        return Error{options_.scene, "a readable scene file", "no such file, or no permission"};
    }
    const ReadComplaint complaint;
    SoSeparator* content = SoDB::readAll(&input);
    if (!content) return Error{options_.scene, "an Inventor scene", complaint.text()};
    addRoot();
    scene_.root_->addChild(content);
    if (!find(SoLight::getClassTypeId())) {
        auto* sun = new SoDirectionalLight;
        sun->direction.setValue(0.5f, 0.5f, -1.0f);
        scene_.root_->insertChild(sun, 0);
    }
    chooseTerrain();
    if (auto problem = readHeightMaps()) return problem;
    scene_.setFields(options_, tells_);
    if (tells_) applyDebugOptions(scene_, options_);
    scene_.waitForTiles(waitsForTiles(options_));
    SoGetBoundingBoxAction bounds(SbViewportRegion(1024, 768));
    bounds.apply(scene_.root_.get());
    scene_.box_ = bounds.getBoundingBox();
    readGridOfScene();
    placeSceneCamera();
    return std::nullopt;
}

Result<Scene> Scene::build(const Options& options, bool tells, const Errand& errand) {
    SceneBuilder builder(options, tells, errand);
    if (auto problem = options.scene.empty() ? builder.fromHeightMap() : builder.fromFile()) return *problem;
    return builder.take();
}

}  // namespace app
