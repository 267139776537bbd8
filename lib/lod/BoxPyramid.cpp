#include "lod/BoxPyramid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <glm/common.hpp>

namespace terrain {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr BoxPyramid::Bounds kNothing{glm::vec3(kInfinity), glm::vec3(-kInfinity)};

void include(BoxPyramid::Bounds& bounds, const BoxPyramid::Bounds& other) {
    bounds.low = glm::min(bounds.low, other.low);
    bounds.high = glm::max(bounds.high, other.high);
}

int blocksAcross(int samples, int blockCells) {
    return std::max(1, (samples - 2) / blockCells + 1);
}

}  // namespace

BoxPyramid::Bounds BoxPyramid::exactBounds(const SampleGrid& grid, int column0, int row0, int column1, int row1) {
    bool hasHoles = false;
    return measured(grid, column0, row0, column1, row1, hasHoles);
}

BoxPyramid::Bounds BoxPyramid::measured(const SampleGrid& grid, int column0, int row0, int column1, int row1, bool& hasHoles) {
    Bounds bounds = kNothing;
    column0 = std::max(column0, 0);
    row0 = std::max(row0, 0);
    column1 = std::min(column1, grid.columns() - 1);
    row1 = std::min(row1, grid.rows() - 1);
    if (grid.isRegular()) {
        for (int row = row0; row <= row1; ++row)
            for (int column = column0; column <= column1; ++column)
                if (const float height = grid.height(column, row); std::isfinite(height)) {
                    bounds.low.z = std::min(bounds.low.z, height);
                    bounds.high.z = std::max(bounds.high.z, height);
                } else {
                    hasHoles = true;
                }
        bounds.low.x = float(column0);
        bounds.low.y = float(row0);
        bounds.high.x = float(column1);
        bounds.high.y = float(row1);
        return bounds;
    }
    for (int row = row0; row <= row1; ++row)
        for (int column = column0; column <= column1; ++column) {
            const glm::vec3 p = grid.framePosition(column, row);
            if (grid.isHole(column, row))
                hasHoles = true;
            else
                include(bounds, {p, p});
        }
    return bounds;
}

BoxPyramid::BoxPyramid(const SampleGrid& grid) : gridColumns_(grid.columns()), gridRows_(grid.rows()), regular_(grid.isRegular()) {
    const std::size_t floatsPerBlock = regular_ ? 2 : 6;
    for (int columns = blocksAcross(gridColumns_, kBlockCells), rows = blocksAcross(gridRows_, kBlockCells);;
         columns = (columns + 1) / 2, rows = (rows + 1) / 2) {
        levels_.push_back(
            {columns, rows, std::vector<float>(std::size_t(columns) * std::size_t(rows) * floatsPerBlock)});
        if (columns == 1 && rows == 1) break;
    }
    holes_.resize(std::size_t(columns(0)) * std::size_t(rows(0)));
    for (int row = 0; row < rows(0); ++row) {
        for (int column = 0; column < columns(0); ++column) measureBlock(grid, column, row);
        grid.releaseRows(row * kBlockCells, kBlockCells);
    }
    for (std::size_t level = 1; level < levels_.size(); ++level)
        for (int row = 0; row < levels_[level].rows; ++row)
            for (int column = 0; column < levels_[level].columns; ++column) joinBlock(level, column, row);
    findAll(grid);
}

void BoxPyramid::store(Level& level, int column, int row, const Bounds& bounds) {
    float* values = &level.values[(std::size_t(row) * std::size_t(level.columns) + std::size_t(column)) * (regular_ ? 2 : 6)];
    for (int axis = regular_ ? 2 : 0; axis < 3; ++axis) {
        *values++ = bounds.low[axis];
        *values++ = bounds.high[axis];
    }
}

void BoxPyramid::measureBlock(const SampleGrid& grid, int column, int row) {
    bool hasHoles = false;
    const glm::ivec2 first(column * kBlockCells, row * kBlockCells);
    store(levels_.front(), column, row,
          measured(grid, first.x, first.y, first.x + kBlockCells, first.y + kBlockCells, hasHoles));
    const std::size_t block = std::size_t(row) * std::size_t(columns(0)) + std::size_t(column);
    blocksWithHoles_ += hasHoles ? 1 : 0;
    blocksWithHoles_ -= holes_[block] ? 1 : 0;
    holes_[block] = hasHoles;
}

void BoxPyramid::joinBlock(std::size_t level, int column, int row) {
    const Level& fine = levels_[level - 1];
    Bounds bounds = kNothing;
    for (int y = 2 * row; y < std::min(2 * row + 2, fine.rows); ++y)
        for (int x = 2 * column; x < std::min(2 * column + 2, fine.columns); ++x) include(bounds, stored(fine, x, y));
    store(levels_[level], column, row, bounds);
}

void BoxPyramid::update(const SampleGrid& grid, const SampleRect& rect) {
    const SampleRect changed = rect.cutTo({glm::ivec2(0), glm::ivec2(gridColumns_ - 1, gridRows_ - 1)});
    if (changed.isEmpty()) return;
    // Samples between two blocks belong to both.
    const glm::ivec2 end(columns(0) - 1, rows(0) - 1);
    glm::ivec2 low = glm::min(glm::max(changed.low - 1, glm::ivec2(0)) / kBlockCells, end);
    glm::ivec2 high = glm::min(changed.high / kBlockCells, end);
    for (std::size_t level = 0; level < levels_.size(); ++level, low /= 2, high /= 2)
        for (int row = low.y; row <= high.y; ++row)
            for (int column = low.x; column <= high.x; ++column)
                if (level == 0)
                    measureBlock(grid, column, row);
                else
                    joinBlock(level, column, row);
    findAll(grid);
}

void BoxPyramid::findAll(const SampleGrid& grid) {
    all_ = block(levelCount() - 1, 0, 0);
    if (!regular_ || all_.isEmpty()) return;
    // Border columns and rows without any valid sample do not count.
    ResidentRows resident = grid.residentRows();
    const auto columnIsEmpty = [&](int column) {
        for (int row = 0; row < grid.rows(); ++row) {
            resident.visit(row);
            if (!grid.isHole(column, row)) return false;
        }
        return true;
    };
    const auto rowIsEmpty = [&](int row) {
        resident.visit(row);
        for (int column = 0; column < grid.columns(); ++column)
            if (!grid.isHole(column, row)) return false;
        return true;
    };
    int left = 0, right = grid.columns() - 1, bottom = 0, top = grid.rows() - 1;
    while (columnIsEmpty(left)) ++left;
    while (columnIsEmpty(right)) --right;
    while (rowIsEmpty(bottom)) ++bottom;
    while (rowIsEmpty(top)) --top;
    all_.low = {float(left), float(bottom), all_.low.z};
    all_.high = {float(right), float(top), all_.high.z};
}

BoxPyramid::Bounds BoxPyramid::stored(const Level& level, int column, int row) const {
    const std::size_t index = std::size_t(row) * std::size_t(level.columns) + std::size_t(column);
    Bounds bounds = kNothing;
    if (regular_) {
        bounds.low.z = level.values[index * 2];
        bounds.high.z = level.values[index * 2 + 1];
        return bounds;
    }
    for (int axis = 0; axis < 3; ++axis) {
        bounds.low[axis] = level.values[index * 6 + std::size_t(axis) * 2];
        bounds.high[axis] = level.values[index * 6 + std::size_t(axis) * 2 + 1];
    }
    return bounds;
}

BoxPyramid::Bounds BoxPyramid::block(int level, int column, int row) const {
    Bounds bounds = stored(levels_[std::size_t(level)], column, row);
    if (regular_) {
        const std::int64_t cells = std::int64_t(kBlockCells) << level;
        bounds.low.x = float(column * cells);
        bounds.low.y = float(row * cells);
        bounds.high.x = float(std::min<std::int64_t>((column + 1) * cells, gridColumns_ - 1));
        bounds.high.y = float(std::min<std::int64_t>((row + 1) * cells, gridRows_ - 1));
    }
    return bounds;
}

BoxPyramid::Bounds BoxPyramid::bounds(int column0, int row0, int column1, int row1) const {
    column0 = std::max(column0, 0);
    row0 = std::max(row0, 0);
    column1 = std::min(column1, gridColumns_ - 1);
    row1 = std::min(row1, gridRows_ - 1);
    Bounds bounds = kNothing;
    if (column0 > column1 || row0 > row1) return bounds;
    // At the level whose blocks are as large as the rectangle, at most 2 x 2 of them (3 x 3 when it is off their grid) cover it.
    const int extent = std::max(column1 - column0, row1 - row0);
    int level = 0;
    while (level + 1 < levelCount() && (kBlockCells << (level + 1)) <= extent) ++level;
    const Level& blocks = levels_[std::size_t(level)];
    const int cells = kBlockCells << level;
    const int lastColumn = std::min(std::max(column1 - 1, column0) / cells, blocks.columns - 1);
    const int lastRow = std::min(std::max(row1 - 1, row0) / cells, blocks.rows - 1);
    for (int row = std::min(row0 / cells, lastRow); row <= lastRow; ++row)
        for (int column = std::min(column0 / cells, lastColumn); column <= lastColumn; ++column)
            include(bounds, stored(blocks, column, row));
    if (regular_) {
        bounds.low.x = float(column0);
        bounds.low.y = float(row0);
        bounds.high.x = float(column1);
        bounds.high.y = float(row1);
    }
    return bounds;
}

std::size_t BoxPyramid::bytes() const {
    std::size_t total = 0;
    for (const Level& level : levels_) total += level.values.capacity() * sizeof(float);
    return total;
}

}  // namespace terrain
