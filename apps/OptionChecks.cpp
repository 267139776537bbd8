#include "OptionChecks.h"

#include "FrameName.h"

namespace app {

using terrain::Error;

namespace {

std::optional<Error> checkRepetitions(const Options& o) {
    if (!o.repeat) return std::nullopt;
    if (!o.animates()) return Error{"--repeat", "-v, --flight or --frames with it", "none of them"};
    if (o.synchronize) return Error{"--repeat", "every frame of each flight", "-s, which leaves some out"};
    if (o.output.empty() && o.record.empty() && !o.measureError) return std::nullopt;
    return Error{"--repeat", "frames that are measured alone", "--output, --record or --measure-error"};
}

// A scene file says itself what the options of a height map say.
std::optional<Error> checkScene(const Options& o) {
    if (o.scene.empty()) return std::nullopt;
    if (!o.heightMap.empty()) return Error{"terrain", "-h heightmap or --scene file.iv", "both"};
    if (o.spacing || o.heightScale) return Error{"--spacing, --height-scale", "-h heightmap", "--scene"};
    if (o.channel || o.rawSize || o.rawType)
        return Error{"--channel, --raw-size, --raw-type", "-h heightmap (a scene's SoHeightMap has fields for them)", "--scene"};
    if (o.algorithm) return Error{"-a", "-h heightmap (a scene file names its nodes itself)", "--scene"};
    if (!o.texture.empty()) return Error{"-t", "-h heightmap (a scene file names its textures itself)", "--scene"};
    return std::nullopt;
}

std::optional<Error> checkOutput(const Options& o) {
    if (o.output.empty()) return std::nullopt;
    if (!o.offscreen) return Error{"--output", "--offscreen with it", "a window"};
    if (auto problem = checkFrameName(o.output)) return problem;
    const bool many = o.animate || !o.flight.empty() || o.frames.value_or(1) > 1;
    if (many && !hasFrameNumber(o.output)) return Error{"--output", "a name with %d or %04d for several frames", o.output};
    return std::nullopt;
}

}  // namespace

std::optional<Error> checkCombination(const Options& o) {
    if (auto problem = checkRepetitions(o)) return problem;
    if (!o.lineOut.empty() && o.profileLine.empty()) return Error{"--line-out", "--profile-line with it", "none"};
    if (!o.record.empty() && o.record == o.flight) return Error{"--record", "another file than --flight", o.record};
    if (!o.namesTerrain() && (o.offscreen || o.isMeasured() || o.asksGround() || !o.output.empty())) return missingTerrain();
    if (auto problem = checkScene(o)) return problem;
    return checkOutput(o);
}

}  // namespace app
