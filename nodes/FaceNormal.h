// Geometric normals of a grid's triangles.
#ifndef SOTERRAIN_FACENORMAL_H
#define SOTERRAIN_FACENORMAL_H

#include <Inventor/SbVec3f.h>

#include "height/SampleGrid.h"

/// Unit normal of a triangle in local coordinates, up where up is known.
SbVec3f faceNormal(const terrain::SampleGrid & grid, const SbVec3f (&corner)[3]);
/// Of a cell's triangle, 0 or 1 (terrain::kCellTriangles).
SbVec3f faceNormal(const terrain::SampleGrid & grid, int column, int row, int triangle);

#endif
