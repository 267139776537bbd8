// Bounds of rectangular parts of a grid, from a pyramid of minima and maxima.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "base/Box.h"
#include "height/SampleGrid.h"
#include "height/SampleRect.h"

namespace terrain {

/// Maximum mipmap (and minimum) over blocks of `kBlockCells` cells, doubled from level to level: 0.17 bytes a sample for a regular
/// grid, 0.5 for a curved one. Boxes are in the grid's frame. Holes do not count.
class BoxPyramid {
public:
    static constexpr int kBlockCells = 8;

    struct Bounds {
        glm::vec3 low;
        glm::vec3 high;
        bool isEmpty() const { return !(low.z <= high.z); }
    };

    BoxPyramid() = default;
    explicit BoxPyramid(const SampleGrid& grid);

    /// Samples within `rect` have changed, of a grid of the same size and kind: brings up to date what depends on them. Bit for bit
    /// what building it anew gives.
    void update(const SampleGrid& grid, const SampleRect& rect);

    int levelCount() const { return int(levels_.size()); }
    int columns(int level) const { return levels_[std::size_t(level)].columns; }
    int rows(int level) const { return levels_[std::size_t(level)].rows; }
    /// Bounds of block (column, row) of a level: kBlockCells * 2^level cells wide, its border samples included. For a regular grid
    /// x and y are the block's own extent. Empty when all its samples are holes.
    Bounds block(int level, int column, int row) const;
    /// Bounds of the samples [column0, column1] x [row0, row1], cut to the grid; somewhat larger than exact, never smaller.
    Bounds bounds(int column0, int row0, int column1, int row1) const;
    /// Exact bounds of the same, sample by sample.
    static Bounds exactBounds(const SampleGrid& grid, int column0, int row0, int column1, int row1);
    /// Exact bounds of all valid samples.
    const Bounds& all() const { return all_; }
    /// Whether any sample is one.
    bool hasHoles() const { return blocksWithHoles_ > 0; }
    std::size_t bytes() const;

private:
    struct Level {
        int columns = 0;
        int rows = 0;
        std::vector<float> values;  ///< per block low then high: of z (regular) or of x, y, z (curved)
    };
    /// Exact bounds; sets `hasHoles` when there is any.
    static Bounds measured(const SampleGrid& grid, int column0, int row0, int column1, int row1, bool& hasHoles);
    void findAll(const SampleGrid& grid);
    void store(Level& level, int column, int row, const Bounds& bounds);
    void measureBlock(const SampleGrid& grid, int column, int row);
    void joinBlock(std::size_t level, int column, int row);
    Bounds stored(const Level& level, int column, int row) const;

    int gridColumns_ = 0;
    int gridRows_ = 0;
    bool regular_ = true;
    std::vector<Level> levels_;
    Bounds all_{};
    std::vector<bool> holes_;  ///< by block of the first level
    std::size_t blocksWithHoles_ = 0;
};

/// The box of bounds that are not empty.
inline Box boxOf(const BoxPyramid::Bounds& bounds) {
    return boxBetween(bounds.low, bounds.high);
}

}  // namespace terrain
