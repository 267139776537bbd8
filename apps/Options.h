// The command line of SoTerrainTest.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "Algorithms.h"
#include "HeightTools.h"
#include "base/Result.h"
#include "height/HeightSource.h"

namespace app {

struct DebugPicture;

struct Options {
    std::string heightMap;                    ///< -h
    std::string scene;                        ///< --scene
    std::string texture;                      ///< -t
    std::string profile;                      ///< -p
    std::string flight;                       ///< --flight
    std::string record;                       ///< --record
    std::string output;                       ///< --output
    std::string summary;                      ///< --summary
    std::string lineOut;                      ///< --line-out
    std::vector<glm::dvec2> picks;            ///< --pick
    std::vector<glm::dvec2> profileLine;      ///< --profile-line
    std::vector<Marker> markers;              ///< --marker
    const Algorithm* algorithm = nullptr;     ///< -a; null: roam for a height map, whatever a scene file holds for a scene
    std::optional<double> animationTime;      ///< -A, milliseconds
    std::optional<double> frameTime;          ///< -F, milliseconds
    std::optional<double> pixelError;         ///< -e, pixels
    std::optional<int> triangleCount;         ///< -r
    std::optional<int> tileSize;              ///< -g, cells
    std::optional<int> clipmapSize;           ///< --clipmap-size, vertices along a side; 0: as the pixel error needs
    std::optional<int> clipmapLevels;         ///< --levels of a clipmap; 0: as many as cover the map
    std::optional<int> detailLevels;          ///< --detail, levels finer than the samples
    std::optional<int> frames;                ///< --frames
    std::optional<int> repeat;                ///< --repeat, flights that are measured
    std::optional<int> measureError;          ///< --measure-error: every so many frames
    std::optional<glm::dvec2> spacing;        ///< --spacing
    std::optional<double> heightScale;        ///< --height-scale
    std::optional<int> channel;               ///< --channel, from 0
    std::optional<glm::ivec2> rawSize;        ///< --raw-size, columns and rows
    std::optional<terrain::RawType> rawType;  ///< --raw-type
    std::optional<glm::ivec2> offscreen;      ///< --offscreen, pixels
    const DebugPicture* debugPicture = nullptr;  ///< --debug-view
    std::optional<double> freezeAt;           ///< --freeze-at, milliseconds of the animation
    bool overlay = false;                     ///< --overlay
    bool meters = false;                      ///< --meters
    bool fullScreen = false;                  ///< -f
    bool frustumCulling = false;              ///< -c
    bool animate = false;                     ///< -v
    bool synchronize = false;                 ///< -s
    bool stats = false;                       ///< --stats
    bool noSettings = false;                  ///< --no-settings
    bool help = false;
    bool version = false;

    /// Whether there is something to show.
    bool namesTerrain() const { return !heightMap.empty() || !scene.empty(); }
    /// Whether the run is measured, and ends by itself: then nothing but the command line may have a say.
    bool isMeasured() const {
        return frames || !profile.empty() || stats || !summary.empty() || measureError || repeat || !record.empty();
    }
    /// Whether every frame of a flight is drawn complete, so that it has the same triangles whenever it is flown.
    bool replays() const { return (!flight.empty() && !synchronize) || repeat; }
    /// Whether the height tools have something to do.
    bool asksGround() const { return !picks.empty() || !profileLine.empty() || !markers.empty(); }
    /// Whether there is more to draw than one picture.
    bool animates() const { return animate || frames || !flight.empty(); }

    static constexpr double defaultAnimationTime = 10000.0;
    static constexpr double defaultFrameTime = 40.0;
};

/// As --raw-type names it.
const char* rawTypeName(terrain::RawType type);
/// Nothing when no type has this name.
std::optional<terrain::RawType> findRawType(std::string_view name);

/// What is wrong where a terrain is needed and none is named.
terrain::Error missingTerrain();
/// Reads a command line as main() gets it. Error: an unknown option, a missing or bad value, options that contradict each other; no
/// terrain, where it can't be chosen in a window.
terrain::Result<Options> parseOptions(int argc, char* const argv[]);
/// One paragraph of options, for errors.
std::string usage();
/// Everything: options, keys, defaults.
std::string help();

}  // namespace app
