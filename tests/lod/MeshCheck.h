// What has to hold of any mesh over a grid, checked without regard to how it was made.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "base/View.h"
#include "height/SampleGrid.h"
#include "lod/DrawList.h"

namespace terrain::test {

/// A drawn triangle: its vertices and where on the grid they stand.
struct GridTriangle {
    std::array<std::uint32_t, 3> vertex;
    std::array<glm::ivec2, 3> corner;
};

/// The triangles of a list of a pool of vertices, or of the whole grid.
std::vector<GridTriangle> trianglesOf(const SampleGrid& grid, const DrawList& list);

/// The checks below return what is wrong, in words; nothing when all is well.
///
/// All edges of the triangles of a diamond mesh run along rows, columns or diagonals of the grid, so that a cell falls into four
/// quarters, between its diagonals, each of which lies wholly in a triangle or wholly out of it. Of other meshes one point of each
/// quarter is looked at, which lies on no edge; where no vertex lies within an edge and each edge has its two sides, that is enough.

/// Triangles have an area, stand on samples that exist, turn the right way, share each edge with at most one other, and no vertex
/// lies within the edge of another triangle.
std::string conformityProblem(const SampleGrid& grid, const std::vector<GridTriangle>& triangles, bool clockwise);

/// No quarter is covered twice, and none in a hole.
std::string overlapProblem(const SampleGrid& grid, const std::vector<GridTriangle>& triangles);

/// Every quarter of every valid cell is covered, and edges that only one triangle has run along the border or a hole.
std::string completenessProblem(const SampleGrid& grid, const std::vector<GridTriangle>& triangles);

/// Every quarter that has a corner or its middle in view is covered.
std::string visibilityProblem(const SampleGrid& grid, const std::vector<GridTriangle>& triangles, const View& view);

/// Largest distance on the screen, in pixels, between a sample in view and the point of the drawn surface that stands for it.
/// Where the drawn point is not in front of the eye the distance is infinite.
double worstScreenError(const SampleGrid& grid, const DrawList& list, const std::vector<GridTriangle>& triangles, const View& view);

/// Everything above but the error; `complete` for a mesh that was not culled.
std::string meshProblem(const SampleGrid& grid, const DrawList& list, const View& view, bool clockwise, bool complete);

}  // namespace terrain::test
