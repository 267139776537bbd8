// Heights of the levels of a geometry clipmap: a level's own, and what the next coarser one shows at the same place.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "height/SampleGrid.h"
#include "lod/ClipmapLayout.h"

namespace terrain {

/// Levels of samples: vertex v of level j >= 0 stands at sample min(v 2^j, last) along each axis, so that the last cell of a row
/// ends exactly at the last sample. Vertices outside of [0, lastVertex()] are taken for the nearest of these. Cells are cut in two
/// by the diagonal from (1, 0) to (0, 1), like those of the full-resolution surface.

/// The last vertex of a level that has a place of its own, along an axis with `last` + 1 samples.
inline int lastVertex(int last, int sourceLevel) {
    return int((std::int64_t(last) + (std::int64_t(1) << sourceLevel) - 1) >> sourceLevel);
}

/// Where a vertex stands along an axis, and the edge of the coarser level that it stands on.
struct ClipmapStation {
    int place;           ///< sample of the vertex itself
    int low, high;       ///< samples of the ends of the coarser edge; both are `place` where the coarser level has that vertex too
    float share = 0.0f;  ///< of `high`: 1/2, or more where the border cuts the coarser edge
};
inline ClipmapStation clipmapStation(int last, int sourceLevel, int vertex) {
    const std::int64_t step = std::int64_t(1) << sourceLevel, v = std::clamp(vertex, 0, lastVertex(last, sourceLevel));
    const int place = int(std::min<std::int64_t>(v * step, last));
    if (v % 2 == 0 || place == last) return {place, place, place, 0.0f};
    const int low = int((v - 1) * step), high = int(std::min<std::int64_t>((v + 1) * step, last));
    return {place, low, high, high - low == 2 * step ? 0.5f : float(step) / float(high - low)};
}

/// Height of a vertex of a regular grid; not finite in a hole.
float levelHeight(const SampleGrid& grid, int sourceLevel, glm::ivec2 vertex);

/// Height of level `sourceLevel` + 1's triangulated surface at a vertex of level `sourceLevel`: its own height where both have it,
/// else the mean of the ends of the coarser edge or diagonal that it stands on. Where the border cuts the coarser cell it is the
/// height of the coarser triangle at the vertex's real place. levelHeight() where that takes a sample that is a hole.
float coarserHeight(const SampleGrid& grid, int sourceLevel, glm::ivec2 vertex);

/// The same in local coordinates, of any grid.
glm::vec3 levelPosition(const SampleGrid& grid, int sourceLevel, glm::ivec2 vertex);
glm::vec3 coarserPosition(const SampleGrid& grid, int sourceLevel, glm::ivec2 vertex);

/// Writes levelHeight() and coarserHeight() of the rectangle's vertices, row after row, 2 * rect.samples() floats. Bit for bit the
/// same as vertex by vertex, but faster. Regular grids only.
void fillLevel(const SampleGrid& grid, int sourceLevel, const ClipRect& rect, float* fineAndCoarse);

/// Likewise levelPosition() and coarserPosition(): 2 * rect.samples() positions.
void fillLevel(const SampleGrid& grid, int sourceLevel, const ClipRect& rect, glm::vec3* fineAndCoarse);

}  // namespace terrain
