#include "lod/TileSamples.h"

#include <utility>

namespace terrain {

TileSamples::TileSamples(const SampleGrid& grid, const BoxPyramid& boxes, std::shared_ptr<const void> owner,
                         std::shared_ptr<SampleGate> gate)
    : columns_(grid.columns()), rows_(grid.rows()), owner_(std::move(owner)),
      gate_(gate ? std::move(gate) : std::make_shared<SampleGate>()) {
    readBounds(grid, boxes);
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

void TileSamples::readBounds(const SampleGrid& grid, const BoxPyramid& boxes) {
    hasHoles_ = boxes.hasHoles();
    const BoxPyramid::Bounds& all = boxes.all();
    range_ = all.isEmpty() ? 0.0f : grid.isRegular() ? all.high.z - all.low.z : glm::length(all.high - all.low);
}

void TileSamples::update(const SampleGrid& grid, const BoxPyramid& boxes, const GridEdits& edits) {
    const SampleGate::Editing editing(*gate_);
    readBounds(grid, boxes);
    for (const SampleRect& rect : edits.rects)
        for (int row = rect.low.y; row <= rect.high.y; ++row)
            for (int column = rect.low.x; column <= rect.high.x; ++column) {
                const std::size_t sample = std::size_t(row) * std::size_t(columns_) + std::size_t(column);
                if (!points_.empty()) points_[sample] = grid.position(column, row);
                if (!copy_.empty()) copy_[sample] = grid.height(column, row);
            }
}

}  // namespace terrain
