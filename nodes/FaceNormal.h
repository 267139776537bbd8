// Geometric normals of a grid's triangles.
#ifndef SOTERRAIN_FACENORMAL_H
#define SOTERRAIN_FACENORMAL_H

#include <cmath>

#include <Inventor/SbVec3f.h>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "height/SampleGrid.h"

/// Unit normal, in local coordinates, of two directions in the grid's frame, up where up is known. Far from zero local positions of
/// neighbouring samples may be the same floats; differences in the frame are exact there.
inline SbVec3f normalOfDirections(const terrain::SampleGrid & grid, const glm::vec3 & first, const glm::vec3 & second)
{
    const glm::dmat3 localFromFrame(grid.localFromFrame());
    const glm::dvec3 normal = glm::cross(localFromFrame * glm::dvec3(first), localFromFrame * glm::dvec3(second));
    const double length = std::sqrt(glm::dot(normal, normal));
    const int axis = grid.isRegular() ? grid.heightAxis() : 2;
    SbVec3f unit(0.0f, 0.0f, 0.0f);
    if (!(length > 0.0)) {
        unit[axis] = 1.0f;
        return unit;
    }
    const double factor = grid.isRegular() && normal[axis] < 0.0 ? -1.0 / length : 1.0 / length;
    unit.setValue(float(normal.x * factor), float(normal.y * factor), float(normal.z * factor));
    return unit;
}

/// Of a triangle with its corners in the frame.
SbVec3f faceNormal(const terrain::SampleGrid & grid, const glm::dvec3 (&corner)[3]);
/// Of a cell's triangle, 0 or 1 (terrain::kCellTriangles).
SbVec3f faceNormal(const terrain::SampleGrid & grid, int column, int row, int triangle);

#endif
