// Where a ray meets the full-resolution surface.
#pragma once

#include <optional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "height/SampleGrid.h"
#include "lod/BoxPyramid.h"

namespace terrain {

/// Where a line meets a triangle of a cell (see kCellTriangles).
struct RayHit {
    double distance;  ///< in lengths of the direction, from the origin
    int column;
    int row;
    int triangle;            ///< 0 or 1
    glm::dvec3 barycentric;  ///< weights of the triangle's corners
    glm::dvec3 point;        ///< in the frame of the grid
};

/// All hits of the line origin + t direction (frame coordinates) with t in [first, last], nearest first: a descent over the pyramid
/// (maximum mipmaps: Tevs et al., "Maximum Mipmaps for Fast, Accurate, and Scalable Dynamic Height Field Rendering", I3D 2008) that
/// looks only into blocks whose bounds the line meets. Cells with a hole are not there.
std::vector<RayHit> castRay(const SampleGrid& grid, const BoxPyramid& boxes, const glm::dvec3& origin, const glm::dvec3& direction,
                            double first, double last);

/// The point of the full-resolution surface over (column, row), which need not be whole numbers. Regular grids only; none outside
/// of the grid and in a hole.
struct SurfacePoint {
    float height;
    int column;
    int row;
    int triangle;
};
std::optional<SurfacePoint> surfaceAt(const SampleGrid& grid, const glm::dvec2& position);

}  // namespace terrain
