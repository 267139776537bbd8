// Where a ray meets the surface with synthesised detail.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "lod/RayCast.h"
#include "lod/SynthesisedDetail.h"

namespace terrain {

/// castRay() over the triangles of the finest level. Column, row, triangle and weights of a hit are those of the samples' triangle
/// in which it lies, seen from above; distance and point are on the detail. The same descent with boxes as much larger as the
/// detail may leave them, and on from the samples' cells to those of each finer level, which are made on the way: a hit costs a few
/// dozen vertices on each level.
std::vector<RayHit> castRay(const SampleGrid& grid, const BoxPyramid& boxes, const SynthesisedDetail& detail,
                            const glm::dvec3& origin, const glm::dvec3& direction, double first, double last);

/// surfaceAt() of the finest level; the triangle is that of the samples.
std::optional<SurfacePoint> surfaceAt(const SampleGrid& grid, const SynthesisedDetail& detail, const glm::dvec2& position);

/// The finest level's triangle over a place in the grid: corners in the frame, in the order of kCellTriangles. Heights are NaN in
/// holes.
std::array<glm::dvec3, 3> finestTriangle(const SampleGrid& grid, const SynthesisedDetail& detail, const glm::dvec2& position);

/// Bounds of the terrain with its detail: never smaller than exact. Empty where those of the samples are.
BoxPyramid::Bounds detailBounds(const BoxPyramid& boxes, const SynthesisedDetail& detail);

}  // namespace terrain
