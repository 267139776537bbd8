#include "DebugViews.h"

#include <algorithm>
#include <cstdio>

#include <Inventor/nodes/SoNode.h>
#include <SoTerrain/SoTerrainShape.h>

#include "Scene.h"

namespace app {

namespace {

SoTerrainShape* terrainOf(const Scene& scene) {
    SoNode* node = scene.terrain();
    return node && node->isOfType(SoTerrainShape::getClassTypeId()) ? static_cast<SoTerrainShape*>(node) : nullptr;
}

}  // namespace

const std::vector<DebugPicture>& debugPictures() {
    static const std::vector<DebugPicture> pictures = {
        {"none", "T&errain itself", "Show the terrain as it is", SoTerrainShape::NONE},
        {"tiles", "T&iles", "Show each tile or block of the mesh in a colour of its own", SoTerrainShape::TILES},
        {"levels", "Le&vels of detail", "Show how large triangles are, from yellow (full detail) to violet",
         SoTerrainShape::LEVELS},
        {"errors", "E&rrors in pixels", "Show how far the mesh is from the samples, from blue to red (pixel error)",
         SoTerrainShape::ERRORS},
        {"loading", "L&oading", "Show what stands in for finer tiles, and what is new", SoTerrainShape::LOADING}};
    return pictures;
}

const DebugPicture* findDebugPicture(std::string_view name) {
    const auto& all = debugPictures();
    const auto found = std::find_if(all.begin(), all.end(), [name](const DebugPicture& picture) { return name == picture.name; });
    return found == all.end() ? nullptr : &*found;
}

bool canDebug(const Scene& scene) {
    return terrainOf(scene) != nullptr;
}

int debugPicture(const Scene& scene) {
    const SoTerrainShape* terrain = terrainOf(scene);
    return terrain ? terrain->debugView.getValue() : int(SoTerrainShape::NONE);
}

void setDebugPicture(Scene& scene, int value) {
    if (SoTerrainShape* terrain = terrainOf(scene)) terrain->debugView = value;
}

bool hasEdges(const Scene& scene) {
    const SoTerrainShape* terrain = terrainOf(scene);
    return terrain && terrain->wireframeOverlay.getValue();
}

void setEdges(Scene& scene, bool on) {
    if (SoTerrainShape* terrain = terrainOf(scene)) terrain->wireframeOverlay = on;
}

bool isFrozen(const Scene& scene) {
    const SoTerrainShape* terrain = terrainOf(scene);
    return terrain && terrain->freeze.getValue();
}

void setFrozen(Scene& scene, bool on) {
    SoTerrainShape* terrain = terrainOf(scene);
    if (!terrain) return;
    terrain->frozenFrustum = on;
    terrain->freeze = on;
}

void applyDebugOptions(Scene& scene, const Options& options) {
    const bool wanted = options.debugPicture || options.overlay || options.freezeAt;
    if (wanted && !canDebug(scene))
        std::fprintf(stderr, "SoTerrainTest: --debug-view, --overlay and --freeze-at have no effect on %s\n",
                     scene.algorithm().c_str());
    if (options.debugPicture) setDebugPicture(scene, options.debugPicture->value);
    if (options.overlay) setEdges(scene, true);
}

void freezeInTime(Scene& scene, const Options& options, double timeMs) {
    if (!options.freezeAt) return;
    // A flight may begin again.
    const bool late = timeMs > *options.freezeAt;
    if (late != isFrozen(scene)) setFrozen(scene, late);
}

}  // namespace app
