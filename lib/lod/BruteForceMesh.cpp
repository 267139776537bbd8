#include "lod/BruteForceMesh.h"

#include <algorithm>
#include <utility>

namespace terrain {

DrawList BruteForceMesh::select(const SampleGrid& grid, const View&, const LodSettings& settings) {
    DrawList list;
    list.wholeGrid = true;
    list.positionsChanged = !built_ || clockwise_ != settings.clockwise;
    list.indicesChanged = list.positionsChanged || edits_.holes;
    changed_ = std::exchange(edits_, {});
    list.changedSamples = changed_.rects;
    if (list.indicesChanged) {
        constexpr int kColumnsAtOnce = 12;
        const std::size_t cells = std::size_t(grid.columns() - 1) * std::size_t(grid.rows() - 1);
        indices_.clear();
        indices_.reserve(cells * 6);
        for (int first = 0; first < grid.columns() - 1; first += kColumnsAtOnce)
            for (int row = 0; row < grid.rows() - 1; ++row)
                for (int column = first; column < std::min(first + kColumnsAtOnce, grid.columns() - 1); ++column) {
                    if (isCellHole(grid, column, row)) continue;
                    for (const auto& triangle : kCellTriangles)
                        for (int i = 0; i < 3; ++i) {
                            const auto& corner = triangle[settings.clockwise ? 2 - i : i];
                            indices_.push_back(std::uint32_t(grid.index(column + corner[0], row + corner[1])));
                        }
                }
        triangles_ = std::uint32_t(indices_.size() / 3);
        built_ = true;
        clockwise_ = settings.clockwise;
    } else if (indices_.capacity() > 0) {
        // Whoever draws has them by now.
        std::vector<std::uint32_t>().swap(indices_);
    }
    list.indices = indices_;
    list.report.triangles = triangles_;
    return list;
}

bool BruteForceMesh::update(const SampleGrid& grid, const GridEdits& edits) {
    // Normals look one sample around.
    const SampleRect all{glm::ivec2(0), glm::ivec2(grid.columns() - 1, grid.rows() - 1)};
    edits_.include(edits.widened(1).within(all));
    return true;
}

}  // namespace terrain
