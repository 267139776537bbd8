#include "FaceNormal.h"

#include "lod/BruteForceMesh.h"

SbVec3f faceNormal(const terrain::SampleGrid & grid, const SbVec3f (&corner)[3])
{
    SbVec3f normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    normal.normalize();
    if (grid.isRegular() && normal[grid.heightAxis()] < 0.0f) normal.negate();
    return normal;
}

SbVec3f faceNormal(const terrain::SampleGrid & grid, int column, int row, int triangle)
{
    SbVec3f corner[3];
    for (int i = 0; i < 3; ++i) {
        const auto & offset = terrain::kCellTriangles[triangle][i];
        const glm::vec3 p = grid.position(column + offset[0], row + offset[1]);
        corner[i].setValue(p.x, p.y, p.z);
    }
    return faceNormal(grid, corner);
}
