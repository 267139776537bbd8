#include "lod/ClipmapErrors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "lod/BruteForceMesh.h"
#include "lod/ClipmapScan.h"
#include "lod/ClipmapSurface.h"

namespace terrain {

namespace {

static_assert(ClipmapErrors::kBlockCells == ClipmapScan::kBlockCells);

constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct CellError {
    float plain = 0.0f, blending = 0.0f;
    void include(const CellError& other) {
        plain = std::max(plain, other.plain);
        blending = std::max(blending, other.blending);
    }
};

/// A drawn cell of a level, sample by sample.
class Cell {
public:
    Cell(const SampleGrid& grid, int level, bool coarsest, glm::ivec2 cell) : grid_(grid) {
        const glm::ivec2 last(grid.columns() - 1, grid.rows() - 1);
        for (int i = 0; i < 4; ++i) {
            const glm::ivec2 vertex = cell + glm::ivec2(i % 2, i / 2);
            fine_[i] = value(levelPosition(grid, level, vertex));
            difference_[i] = coarsest ? glm::vec3(0.0f) : value(coarserPosition(grid, level, vertex)) - fine_[i];
        }
        low_ = {clipmapStation(last.x, level, cell.x).place, clipmapStation(last.y, level, cell.y).place};
        high_ = {clipmapStation(last.x, level, cell.x + 1).place, clipmapStation(last.y, level, cell.y + 1).place};
    }
    CellError error() const {
        CellError error;
        for (int row = low_.y; row <= high_.y; ++row)
            for (int column = low_.x; column <= high_.x; ++column) error.include(errorAt({column, row}));
        return error;
    }

private:
    /// Where only heights differ, these alone.
    glm::vec3 value(const glm::vec3& position) const {
        return grid_.isRegular() ? glm::vec3(position[grid_.heightAxis()], 0.0f, 0.0f) : position;
    }
    CellError errorAt(glm::ivec2 sample) const {
        const glm::vec2 t = glm::vec2(sample - low_) / glm::vec2(high_ - low_);
        const bool upper = t.x + t.y > 1.0f;
        const float weights[4] = {upper ? 0.0f : 1.0f - t.x - t.y, upper ? 1.0f - t.y : t.x, upper ? 1.0f - t.x : t.y,
                                  upper ? t.x + t.y - 1.0f : 0.0f};
        glm::vec3 off = -value(grid_.position(sample.x, sample.y));
        float rising = 0.0f, falling = 0.0f, length = 0.0f;
        for (int i = 0; i < 4; ++i) {
            off += weights[i] * fine_[i];
            rising += weights[i] * std::max(0.0f, difference_[i].x);
            falling += weights[i] * std::min(0.0f, difference_[i].x);
            length += weights[i] * glm::length(difference_[i]);
        }
        if (!grid_.isRegular()) return {glm::length(off), glm::length(off) + length};
        return {std::fabs(off.x), std::max(std::fabs(off.x + rising), std::fabs(off.x + falling))};
    }

    const SampleGrid& grid_;
    glm::vec3 fine_[4], difference_[4];
    glm::ivec2 low_, high_;
};

/// Whether any of the values is a hole's.
bool anyHole(const float* values, int count) {
    int holes = 0;
#pragma omp simd
    for (int i = 0; i < count; ++i) holes |= values[i] - values[i] == 0.0f ? 0 : 1;
    return holes != 0;
}

}  // namespace

/// Corrects the errors of blocks with holes, level by level.
class ClipmapErrors::Holes {
public:
    explicit Holes(const SampleGrid& grid) : grid_(grid), last_(grid.columns() - 1, grid.rows() - 1) { readCells(); }

    /// To be called for each level in turn. `blocks` are those of the finest layer.
    void correct(Level& level, int sourceLevel, glm::ivec2 blocks) {
        if (sourceLevel > 1) merge(sourceLevel);
        std::size_t index = 0;
        for (int row = 0; row < blocks.y; ++row)
            for (int column = 0; column < blocks.x; ++column, ++index) {
                if (!hasHole(sourceLevel, {column, row})) continue;
                const CellError error = errorOf(sourceLevel, level.blending.empty(), {column, row});
                if (!level.plain.empty()) level.plain[index] = error.plain;
                if (!level.blending.empty()) level.blending[index] = error.blending;
            }
    }

private:
    enum State : std::uint8_t { Missing = 1, There = 2 };  ///< what a cell of a level covers of full-resolution cells, both or one

    int cells(int axis, int level) const { return lastVertex(last_[axis], level); }
    std::uint8_t& state(glm::ivec2 cell) { return states_[std::size_t(cell.y) * std::size_t(columns_) + std::size_t(cell.x)]; }

    /// The states of level 1.
    void readCells() {
        columns_ = cells(0, 1);
        states_.assign(std::size_t(columns_) * std::size_t(cells(1, 1)), 0);
        std::vector<std::uint8_t> low(std::size_t(grid_.columns())), high = low;
        ResidentRows resident = grid_.residentRows();
        for (int row = 0; row <= last_.y; ++row) {
            resident.visit(row);
            std::swap(low, high);
            for (int column = 0; column <= last_.x; ++column) high[std::size_t(column)] = grid_.isHole(column, row);
            for (std::size_t i = 0; row > 0 && i < std::size_t(last_.x); ++i)
                state({int(i / 2), (row - 1) / 2}) |= low[i] | low[i + 1] | high[i] | high[i + 1] ? Missing : There;
        }
    }
    /// From the states of the level before to those of `level`.
    void merge(int level) {
        const int fineColumns = columns_, fineRows = cells(1, level - 1);
        std::vector<std::uint8_t> fine = std::move(states_);
        columns_ = cells(0, level);
        states_.assign(std::size_t(columns_) * std::size_t(cells(1, level)), 0);
        for (int row = 0; row < fineRows; ++row)
            for (int column = 0; column < fineColumns; ++column)
                state({column / 2, row / 2}) |= fine[std::size_t(row) * std::size_t(fineColumns) + std::size_t(column)];
    }
    bool hasHole(int level, glm::ivec2 block) {
        // Of level 0 by the cells of level 1, which cover it.
        const int width = level == 0 ? kBlockCells / 2 : kBlockCells, shown = std::max(level, 1);
        const glm::ivec2 low = block * width, high = glm::min(low + width, glm::ivec2(cells(0, shown), cells(1, shown)));
        for (int row = low.y; row < high.y; ++row)
            for (int column = low.x; column < high.x; ++column)
                if (state({column, row}) & Missing) return true;
        return false;
    }
    bool isDrawn(int level, glm::ivec2 cell) const {
        for (int i = 0; i < 4; ++i)
            if (grid_.isHole(clipmapStation(last_.x, level, cell.x + i % 2).place,
                             clipmapStation(last_.y, level, cell.y + i / 2).place))
                return false;
        return true;
    }
    CellError errorOf(int level, bool coarsest, glm::ivec2 block) {
        const glm::ivec2 low = block * kBlockCells,
                         high = glm::min(low + kBlockCells, glm::ivec2(cells(0, level), cells(1, level)));
        CellError error;
        std::vector<glm::ivec2> drawn;
        for (int row = low.y; row < high.y; ++row)
            for (int column = low.x; column < high.x; ++column) {
                const bool draws = isDrawn(level, {column, row});
                if (level > 0 && (state({column, row}) & (draws ? Missing : There))) return {kInfinity, kInfinity};
                if (draws) drawn.push_back({column, row});
            }
        for (const glm::ivec2 cell : drawn) error.include(Cell(grid_, level, coarsest, cell).error());
        return error;
    }

    const SampleGrid& grid_;
    glm::ivec2 last_;
    int columns_ = 0;
    std::vector<std::uint8_t> states_;
};

ClipmapErrors::ClipmapErrors(const SampleGrid& grid, int levels, SampleGate* gate) : levels_(std::size_t(std::max(levels, 0))) {
    if (levels_.empty()) return;
    scan(grid, gate);
    buildLayers();
}

namespace {

/// Adds all rows of the grid to all scans. Whether there is a hole.
bool scanRows(const SampleGrid& grid, std::vector<ClipmapScan>& scans, SampleGate* gate) {
    // Some rows for each level in turn, so that they and what that level holds stay in the cache.
    constexpr int kRows = 16;
    const int axes = grid.isRegular() ? 1 : 3, columns = grid.columns();
    const bool inPlace = grid.isRegular() && grid.heightStride() == 1;
    std::vector<float> copied(inPlace ? 0 : std::size_t(kRows * axes) * std::size_t(columns));
    bool holes = false;
    for (int first = 0; first < grid.rows(); first += kRows) {
        const int count = std::min(kRows, grid.rows() - first);
        const auto reading = gate ? std::make_unique<SampleGate::Reading>(*gate) : nullptr;
        std::array<std::array<const float*, 3>, kRows> rows{};
        for (int i = 0; i < count; ++i) {
            float* copy = copied.data() + std::size_t(inPlace ? 0 : i * axes) * std::size_t(columns);
            for (int axis = 0; axis < axes; ++axis)
                rows[std::size_t(i)][std::size_t(axis)] =
                    inPlace ? grid.heightRow(first + i) : copy + std::size_t(axis) * std::size_t(columns);
            for (int column = 0; !inPlace && column < columns; ++column) {
                const glm::vec3 p = axes == 1 ? glm::vec3(grid.height(column, first + i)) : grid.position(column, first + i);
                for (int axis = 0; axis < axes; ++axis) copy[axis * columns + column] = p[axis];
            }
            for (int axis = 0; axis < axes; ++axis) holes = holes || anyHole(rows[std::size_t(i)][std::size_t(axis)], columns);
        }
        for (ClipmapScan& scan : scans)
            for (int i = 0; i < count; ++i) scan.addRow(grid, rows[std::size_t(i)]);
        grid.releaseRows(first, count);
    }
    return holes;
}

}  // namespace

void ClipmapErrors::scan(const SampleGrid& grid, SampleGate* gate) {
    std::vector<ClipmapScan> scans;
    for (int level = 0; level < levels(); ++level) scans.emplace_back(grid, level, level + 1 == levels());
    const bool holes = scanRows(grid, scans, gate);
    for (std::size_t i = 0; i < levels_.size(); ++i) {
        levels_[i].plain = scans[i].plain();
        levels_[i].blending = scans[i].blending();
        levels_[i].layers.push_back({{scans[i].blockColumns(), scans[i].blockRows()}, 0});
    }
    if (!holes) return;
    const auto reading = gate ? std::make_unique<SampleGate::Reading>(*gate) : nullptr;
    Holes correction(grid);
    for (int level = 0; level < levels(); ++level) correction.correct(levels_[std::size_t(level)], level, blocks(level, 0));
}

void ClipmapErrors::buildLayers() {
    for (Level& level : levels_) {
        std::size_t total = 0;
        for (glm::ivec2 blocks = level.layers.front().blocks;; blocks = (blocks + 1) / 2) {
            if (total > 0) level.layers.push_back({blocks, total});
            total += std::size_t(blocks.x) * std::size_t(blocks.y);
            if (blocks == glm::ivec2(1)) break;
        }
        for (std::vector<float>* errors : {&level.plain, &level.blending}) {
            if (errors->empty()) continue;
            std::vector<float> all(total, 0.0f);
            std::copy(errors->begin(), errors->end(), all.begin());
            for (std::size_t i = 1; i < level.layers.size(); ++i) {
                const Layer &fine = level.layers[i - 1], &coarse = level.layers[i];
                for (int row = 0; row < fine.blocks.y; ++row)
                    for (int column = 0; column < fine.blocks.x; ++column) {
                        float& largest =
                            all[coarse.first + std::size_t(row / 2) * std::size_t(coarse.blocks.x) + std::size_t(column / 2)];
                        largest = std::max(largest,
                                           all[fine.first + std::size_t(row) * std::size_t(fine.blocks.x) + std::size_t(column)]);
                    }
            }
            *errors = std::move(all);
        }
    }
}

/// Errors of one level of a part of a grid that begins and ends with blocks, or with the grid.
ClipmapErrors::Level ClipmapErrors::measured(const SampleGrid& grid, int level, bool coarsest) {
    std::vector<ClipmapScan> scans;
    scans.emplace_back(grid, level, coarsest);
    const bool holes = scanRows(grid, scans, nullptr);
    Level result{{{{scans.front().blockColumns(), scans.front().blockRows()}, 0}}, scans.front().plain(), scans.front().blending()};
    if (!holes) return result;
    Holes correction(grid);
    Level none;
    for (int finer = 0; finer < level; ++finer) correction.correct(none, finer, glm::ivec2(0));
    correction.correct(result, level, result.layers.front().blocks);
    return result;
}

void ClipmapErrors::updateLayers(const Level& level, std::vector<float>& errors, glm::ivec2 low, glm::ivec2 high) {
    for (std::size_t i = 1; i < level.layers.size(); ++i) {
        const Layer &fine = level.layers[i - 1], &coarse = level.layers[i];
        low /= 2;
        high /= 2;
        for (int row = low.y; row <= high.y; ++row)
            for (int column = low.x; column <= high.x; ++column) {
                float largest = 0.0f;
                for (int y = 2 * row; y < std::min(2 * row + 2, fine.blocks.y); ++y)
                    for (int x = 2 * column; x < std::min(2 * column + 2, fine.blocks.x); ++x)
                        largest = std::max(largest, errors[fine.first + std::size_t(y) * std::size_t(fine.blocks.x) + std::size_t(x)]);
                errors[coarse.first + std::size_t(row) * std::size_t(coarse.blocks.x) + std::size_t(column)] = largest;
            }
    }
}

void ClipmapErrors::updateLevel(const SampleGrid& grid, int number, const SampleRect& rect) {
    Level& level = levels_[std::size_t(number)];
    const glm::ivec2 last(grid.columns() - 1, grid.rows() - 1), blocks = level.layers.front().blocks;
    const int step = 1 << number, width = kBlockCells << number;
    // A vertex of the level changes the cells around it and, where the coarser level has it, what its neighbours blend towards.
    const auto hasVertex = [&](int axis) { return rect.high[axis] == last[axis] || rect.high[axis] / step > (rect.low[axis] - 1 + step) / step - 1; };
    const SampleRect around = rect.widened(hasVertex(0) && hasVertex(1) ? 3 * step : 1).cutTo({glm::ivec2(0), last});
    const glm::ivec2 low = glm::min(around.low / width, blocks - 1), high = glm::min(around.high / width, blocks - 1);
    SampleRect part{low * width, glm::min((high + 1) * width, last)};
    const bool isExact = part.samples() <= kExactly;
    // Whole cells of the coarser level at least.
    if (!isExact) part = {around.low / (2 * step) * (2 * step), glm::min((around.high / (2 * step) + 1) * (2 * step), last)};
    if (part.columns() < 2) part.low.x = std::max(0, part.low.x - 2 * step);
    if (part.rows() < 2) part.low.y = std::max(0, part.low.y - 2 * step);
    const Level now = measured(grid.part(part.low.x, part.low.y, part.columns(), part.rows()), number, number + 1 == levels());
    const auto take = [&](std::vector<float>& errors, const std::vector<float>& found) {
        if (errors.empty()) return;
        const float largest = *std::max_element(found.begin(), found.end());
        for (int row = low.y; row <= high.y; ++row)
            for (int column = low.x; column <= high.x; ++column) {
                float& error = errors[std::size_t(row) * std::size_t(blocks.x) + std::size_t(column)];
                const std::size_t at = std::size_t(row - low.y) * std::size_t(high.x - low.x + 1) + std::size_t(column - low.x);
                error = isExact ? found[at] : std::max(error, largest);
            }
        updateLayers(level, errors, low, high);
    };
    take(level.plain, now.plain);
    take(level.blending, now.blending);
}

void ClipmapErrors::update(const SampleGrid& grid, const GridEdits& edits) {
    for (int level = 0; level < levels(); ++level)
        for (const SampleRect& rect : edits.rects) updateLevel(grid, level, rect);
}

float ClipmapErrors::error(int sourceLevel, bool blending, int layer, glm::ivec2 block) const {
    const std::vector<float>& errors = levels_[std::size_t(sourceLevel)].errors(blending);
    if (errors.empty()) return 0.0f;
    const Layer& at = layerOf(sourceLevel, layer);
    return errors[at.first + std::size_t(block.y) * std::size_t(at.blocks.x) + std::size_t(block.x)];
}

std::size_t ClipmapErrors::bytes() const {
    std::size_t total = levels_.capacity() * sizeof(Level);
    for (const Level& level : levels_)
        total += level.layers.capacity() * sizeof(Layer) + (level.plain.capacity() + level.blending.capacity()) * sizeof(float);
    return total;
}

}  // namespace terrain
