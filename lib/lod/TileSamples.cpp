#include "lod/TileSamples.h"

#include <utility>

namespace terrain {

TileSamples::TileSamples(const SampleGrid& grid, const BoxPyramid& boxes, std::shared_ptr<const void> owner)
    : columns_(grid.columns()), rows_(grid.rows()), hasHoles_(boxes.hasHoles()), owner_(std::move(owner)) {
    if (const BoxPyramid::Bounds& all = boxes.all(); !all.isEmpty())
        range_ = grid.isRegular() ? all.high.z - all.low.z : glm::length(all.high - all.low);
    if (!grid.isRegular()) {
        points_.reserve(std::size_t(columns_) * std::size_t(rows_));
        for (int row = 0; row < rows_; ++row)
            for (int column = 0; column < columns_; ++column) points_.push_back(grid.position(column, row));
        return;
    }
    if (owner_ && grid.heightStride() == 1) {
        heights_ = grid.heightRow(0);
        pitch_ = std::size_t(grid.heightRow(1) - grid.heightRow(0));
        resident_ = grid.residentRows();
        return;
    }
    pitch_ = std::size_t(columns_);
    copy_.reserve(pitch_ * std::size_t(rows_));
    for (int row = 0; row < rows_; ++row)
        for (int column = 0; column < columns_; ++column) copy_.push_back(grid.height(column, row));
    heights_ = copy_.data();
}

}  // namespace terrain
