// How the blocks of Geo Mip-Mapping are cut into triangles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

namespace terrain {

/// A grid of `columns` x `rows` samples in blocks of `tileSize` cells (a power of two). Blocks at the far borders are as large as
/// what is left, one cell larger than others rather than one cell wide.
struct BlockLayout {
    BlockLayout() = default;
    BlockLayout(int columns, int rows, int tileSize);

    int tileSize = 2;
    int exponent = 1;  ///< 2^exponent = tileSize: the last level, two triangles a block
    int columns = 2;   ///< samples
    int rows = 2;
    int blockColumns = 1;
    int blockRows = 1;

    std::size_t block(int column, int row) const { return std::size_t(row) * std::size_t(blockColumns) + std::size_t(column); }
    std::size_t blockCount() const { return std::size_t(blockColumns) * std::size_t(blockRows); }
    int width(int blockColumn) const { return blockColumn + 1 < blockColumns ? tileSize : columns - 1 - blockColumn * tileSize; }
    int height(int blockRow) const { return blockRow + 1 < blockRows ? tileSize : rows - 1 - blockRow * tileSize; }
};

/// A block of a layout.
struct BlockAt {
    std::uint32_t number = 0;
    std::uint16_t column = 0;
    std::uint16_t row = 0;

    bool operator==(const BlockAt&) const = default;
};

/// The triangles of a block of width x height cells at all levels, counter-clockwise, as places in an array of samples with `pitch`
/// places a row.
///
/// At level k, below the last, the block's lines are 0, s, 2 s, ... and its far border, s = 2^k. Between the outermost lines but
/// one lie the inner cells; the rest are four trapezoids from corner to corner of inner cells and block, whose outer side has the
/// lines of a border level m >= k: that of the coarser of the two blocks that share the border. So blocks of any difference of
/// level meet in the same vertices, and no side depends on another. The last level is two triangles.
///
/// Diagonals alternate from cell to cell. That makes the edges of each level a part of those of the next finer one, as long as
/// m <= k + 1, in blocks of full size: what a geomorph slides onto is exactly the coarser surface.
class GeoMipmapShape {
public:
    static constexpr int kLargestTile = 128;
    /// Sides in counter-clockwise order.
    enum Side { Bottom, Right, Top, Left };

    using Place = std::uint16_t;
    using Triangle = std::array<Place, 3>;

    GeoMipmapShape(int width, int height, int exponent);

    int width() const { return width_; }
    int height() const { return height_; }
    int exponent() const { return exponent_; }
    /// Of every shape of the same exponent.
    static int pitch(int exponent) { return (1 << exponent) + 2; }
    int pitch() const { return pitch(exponent_); }
    glm::ivec2 at(Place place) const { return {place % pitch(), place / pitch()}; }
    /// Whether the block has such a level: the first and the last always.
    bool hasLevel(int level) const { return levels_[std::size_t(level)].exists; }
    /// Every level, each as fine as its number says: only those slide.
    bool isFull() const { return width_ == height_ && width_ == 1 << exponent_; }
    int sideLength(int side) const { return side % 2 == 0 ? width_ : height_; }

    /// Lines of a side of `length` cells at a level, the first 0, the last `length`.
    std::vector<int> lines(int length, int level) const;
    /// How many lines those are.
    int lineCount(int length, int level) const { return level == exponent_ ? 2 : (length - 1) / (1 << level) + 2; }

    std::span<const Triangle> inner(int level) const { return levels_[std::size_t(level)].inner; }
    /// One side of a block of `level` whose border has `borderLevel`, at least as coarse; none where the block is too narrow for
    /// it.
    std::span<const Triangle> side(int side, int level, int borderLevel) const {
        return levels_[std::size_t(level)].sides[std::size_t(side)][std::size_t(borderLevel)];
    }
    /// The last level, with the diagonal from the first to the last sample or the other one.
    std::span<const Triangle> flat(bool otherDiagonal) const { return flat_[otherDiagonal ? 1 : 0]; }
    /// All cells of the finest level, cut by the diagonals that BruteForceMesh.h defines, row by row.
    std::span<const Triangle> cells() const { return cells_; }

private:
    struct Level {
        bool exists = false;
        std::vector<Triangle> inner;
        std::array<std::vector<std::vector<Triangle>>, 4> sides;  ///< by side, then by the border's level
    };
    Place place(glm::ivec2 p) const { return Place(p.y * pitch() + p.x); }
    /// The point `along` a side, counter-clockwise, and `across` cells inwards.
    glm::ivec2 onSide(int side, int along, int across) const;
    std::vector<int> linesAlong(int side, int level) const;
    void cutInner(int level);
    std::vector<Triangle> cutSide(int side, int level, int borderLevel) const;

    int width_;
    int height_;
    int exponent_;
    std::vector<Level> levels_;
    std::array<std::vector<Triangle>, 2> flat_;
    std::vector<Triangle> cells_;
};

}  // namespace terrain
