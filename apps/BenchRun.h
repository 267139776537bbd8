// Measures one node class on one flight.
#pragma once

#include <optional>
#include <string>

#include <glm/vec2.hpp>
#include <nlohmann/json_fwd.hpp>

#include "base/Result.h"

namespace app {

/// What is measured. The scene is the same for every class: texture, texture coordinates, coordinates and normals from the state, a
/// camera and one directional light, 1024 x 768 pixels.
struct BenchRequest {
    std::string className;
    std::string fields;  ///< of the node, as an .iv file has them
    std::string map;
    std::string texture;  ///< empty: none
    std::string flight;   ///< as SoTerrainTest records them, over the map as that places it; empty: the standard flight
    std::optional<glm::dvec2> spacing;  ///< distance of samples; without it what the map says, or 1 / columns, 1 / rows
    std::optional<double> heightScale;  ///< factor on heights; without it what suits the map
    int frames = 60;
    double pixelError = 2.0;
    int errorEvery = 5;       ///< frames between measurements of the screen error; 0: none
    bool framesOnly = false;  ///< neither processor time, triangles nor errors, which take flights of their own
    int decimate = 1;         ///< takes each of so many columns and rows of the map
    double seconds = 0.0;     ///< a series of frames that takes longer ends early, after three frames at least; 0: none does
    bool series = false;      ///< tell all of each frame, too
    std::string pictures;     ///< beginning of the names of two pictures, "...shaded.jpg" and "...lines.jpg"; empty: none
};

nlohmann::ordered_json toJson(const BenchRequest& request);
BenchRequest benchRequest(const nlohmann::ordered_json& json);

/// Flies and measures, in this process, which should have done nothing else before. Keys:
/// `class`, `fields`, `renderer`, `gl_version`, `samples`, `columns`, `rows`,
/// `frame_ms` (whole frame until GL has finished) and `cpu_ms` (this thread, rasterisation off), each with median, p95, worst and
/// the number of `frames`, `triangles` (mean), `error_px` with rms, p999, max, `samples_in_view`, `not_drawn`, `growth_bytes`
/// (resident set, from before the node's first frame to after its second), and for our own nodes `memory_bytes`, `buffer_bytes`,
/// `bound_px`, `incomplete_frames` and `sent_bytes` (sent to GL in a frame after the first, mean), `start_ms` (first frame less the
/// same frame again, after a warm-up without the node); with `series` the arrays `frame_ms`, `cpu_ms`, `triangles` and, with the
/// number of the frame, `error_px` under `series`. Error: an unreadable file, an unknown class or field, no GL, a flight from which
/// nothing of the map is seen.
terrain::Result<nlohmann::ordered_json> runBench(const BenchRequest& request);

}  // namespace app
