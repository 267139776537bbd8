// Shows a height map or a scene file with level of detail, in a window or without a display, and measures it.
#include <cstdio>
#include <cstdlib>
#include <string>

#include <SoTerrain/SoTerrain.h>

#include "Clock.h"
#include "CoinStart.h"
#include "DebugViews.h"
#include "Offscreen.h"
#include "Options.h"
#include "Scene.h"
#include "ShippedData.h"
#include "Window.h"

namespace {

int fail(const terrain::Error& error) {
    std::fprintf(stderr, "SoTerrainTest: %s\n", error.message().c_str());
    return EXIT_FAILURE;
}

int refuse(const terrain::Error& error) {
    std::fprintf(stderr, "SoTerrainTest: %s\n%s", error.message().c_str(), app::usage().c_str());
    return 2;
}

// Without a word about what to show: the terrain that comes with the program, or an invitation to open one.
void nameShippedTerrain(app::Options& options) {
    options.frustumCulling = true;
    const auto map = app::installedFile("terrain.png");
    if (!map) return;
    options.heightMap = *map;
    options.texture = app::installedFile("terrain_texture.jpg").value_or("");
}

int show(app::Options options) {
    const double started = app::nowMs();
    for (std::string* file : {&options.heightMap, &options.texture, &options.scene}) *file = app::findShipped(*file);
    // The window system comes first: without one there is no reason to read a large map.
    if (!options.offscreen) {
        if (auto problem = app::openDisplay("SoTerrainTest"))
            return options.namesTerrain() ? fail(*problem) : refuse(app::missingTerrain());
    }
    app::startCoin();
    // Settings of the last time that don't apply to this terrain are nobody's mistake.
    const bool tells = options.namesTerrain();
    if (!tells) {
        nameShippedTerrain(options);
        app::recallSettings(options);
    }
    const app::Errand errand = options.offscreen ? app::runHere : app::windowErrand(options);
    auto scene = options.namesTerrain() ? app::Scene::build(options, tells, errand) : app::Scene::empty();
    if (!scene) return fail(scene.error());
    if (!tells) app::applyDebugOptions(scene.value(), options);
    const auto run = options.offscreen ? app::runOffscreen : app::runWindow;
    if (auto problem = run(options, scene.value(), started)) return fail(*problem);
    return EXIT_SUCCESS;
}

}  // namespace

int main(int argc, char** argv) {
    const auto options = app::parseOptions(argc, argv);
    if (!options) return refuse(options.error());
    if (options.value().help) {
        std::fputs(app::help().c_str(), stdout);
        return EXIT_SUCCESS;
    }
    if (options.value().version) {
        std::printf("SoTerrainTest %s\n", SoTerrain::getVersion());
        return EXIT_SUCCESS;
    }
    return show(options.value());
}
