#include "FaceNormal.h"

#include "lod/BruteForceMesh.h"

SbVec3f faceNormal(const terrain::SampleGrid & grid, const glm::dvec3 (&corner)[3])
{
    return normalOfDirections(grid, glm::vec3(corner[1] - corner[0]), glm::vec3(corner[2] - corner[0]));
}

SbVec3f faceNormal(const terrain::SampleGrid & grid, int column, int row, int triangle)
{
    glm::dvec3 corner[3];
    for (int i = 0; i < 3; ++i) {
        const auto & offset = terrain::kCellTriangles[triangle][i];
        corner[i] = grid.framePosition(column + offset[0], row + offset[1]);
    }
    return faceNormal(grid, corner);
}
