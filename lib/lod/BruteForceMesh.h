// Everything, always: the full-resolution triangles of a grid.
#pragma once

#include <vector>

#include "lod/LodAlgorithm.h"

namespace terrain {

/// Corners of the two triangles of cell (column, row) of the full-resolution surface, as offsets from the cell's first sample:
/// (0, 0), (1, 0), (0, 1) and (1, 0), (1, 1), (0, 1), counter-clockwise in the grid's plane. Picking, heights and primitives use
/// the same diagonal, from (1, 0) to (0, 1), which is how SoQuadMesh and most of its users cut a cell.
inline constexpr int kCellTriangles[2][3][2] = {{{0, 0}, {1, 0}, {0, 1}}, {{1, 0}, {1, 1}, {0, 1}}};

/// True when any corner of the cell is a hole: then nothing of it is drawn.
inline bool isCellHole(const SampleGrid& grid, int column, int row) {
    return grid.isHole(column, row) || grid.isHole(column + 1, row) || grid.isHole(column, row + 1) ||
           grid.isHole(column + 1, row + 1);
}

/// Indexes the whole grid once, in columns of cells narrow enough for a vertex cache to keep a row of them, and again only when
/// holes come or go.
class BruteForceMesh : public LodAlgorithm {
public:
    DrawList select(const SampleGrid& grid, const View& view, const LodSettings& settings) override;
    bool update(const SampleGrid& grid, const GridEdits& edits) override;
    void eachPatch(const SampleGrid& grid, const PatchVisitor& visit) const override;
    std::size_t bytes() const override { return indices_.capacity() * sizeof(std::uint32_t); }

private:
    std::vector<std::uint32_t> indices_;  ///< given away after the first selection
    GridEdits edits_, changed_;  ///< since the last selection, and in it
    std::uint32_t triangles_ = 0;
    bool built_ = false;
    bool clockwise_ = false;
};

}  // namespace terrain
