// Measures one node class on the standard flight.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "base/Result.h"

namespace app {

/// What is measured. The scene is the same for every class: texture, texture coordinates, coordinates and normals from the state, a
/// camera and one directional light.
struct BenchRequest {
    std::string className;
    std::string map;
    std::string texture;  ///< empty: none
    int frames = 60;
    double pixelError = 2.0;
    int errorEvery = 20;  ///< frames between measurements of the screen error
};

/// Flies and measures, in this process, which should have done nothing else before. The map's top row lies at y = 0. Keys:
/// `class`, `renderer`, `samples`,
/// `frame_ms` (whole frame until GL has finished) and `cpu_ms` (this thread, rasterisation off), each with median, p95, worst,
/// `triangles` (mean), `error_px` with rms, p999, max, `not_drawn`,
/// `growth_bytes` (resident set, from before the node's first frame to after its second), and for our own nodes `memory_bytes`,
/// `buffer_bytes` and `bound_px`,
/// `start_ms` (first frame less the same frame again, after a warm-up without the node).
/// Error: an unreadable file, an unknown class, no GL.
terrain::Result<nlohmann::ordered_json> runBench(const BenchRequest& request);

}  // namespace app
