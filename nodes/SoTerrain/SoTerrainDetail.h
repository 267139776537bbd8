// What a pick on a terrain tells.
#ifndef SOTERRAIN_SOTERRAINDETAIL_H
#define SOTERRAIN_SOTERRAINDETAIL_H

#include <Inventor/details/SoFaceDetail.h>
#include <Inventor/details/SoSubDetail.h>

/// Detail of a point on a terrain node: the cell that was hit, which of its two triangles, and the height. As an SoFaceDetail it also
/// gives the three corners of the triangle: coordinate indices count the coordinates from startIndex on, or the samples of the height map,
/// row after row, as SoQuadMesh's do; the face index is row * (columns - 1) + column. Triangle callbacks find one at each vertex.
class SoTerrainDetail : public SoFaceDetail {
    typedef SoFaceDetail inherited;
    SO_DETAIL_HEADER(SoTerrainDetail);

public:
    SoTerrainDetail();
    virtual ~SoTerrainDetail();
    static void initClass();
    virtual SoDetail * copy() const;

    /// Column of the cell: that of its first sample, from 0.
    int getColumn() const { return this->column; }
    /// Row of the cell, likewise.
    int getRow() const { return this->row; }
    /// 0: the triangle at the cell's first sample; 1: the one at its last.
    int getTriangle() const { return this->triangle; }
    /// Along the axis of the node's coordinates that heights run along (z for curved grids).
    float getHeight() const { return this->height; }

    /// Called by the node that was picked.
    void setCell(int column, int row, int triangle, float height);

private:
    int column;
    int row;
    int triangle;
    float height;
};

#endif
