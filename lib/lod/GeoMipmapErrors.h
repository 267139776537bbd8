// For every block of Geo Mip-Mapping, the exact error of drawing it at each level.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "height/EditLog.h"
#include "height/SampleGrid.h"
#include "lod/BoxPyramid.h"
#include "lod/ErrorHierarchy.h"
#include "lod/GeoMipmapShape.h"

namespace terrain {

/// Errors are the largest deviations, from the triangles of GeoMipmapShape, of all samples that these cover: vertically for a
/// regular grid, in space, at equal parameters, for a curved one. They are stored in two bytes each, rounded up
/// (ErrorHierarchy::encode()), and those of levels made monotone: at least as large as every finer one's.
///
/// A block with a hole in it has its finest level only; a side of it may have a coarser border where no cell along it is a hole.
///
/// With tiles of 8, 16 and 32 cells the table takes 1.1, 0.5 and 0.2 bytes a sample. Building visits every sample about twice for
/// each level, sixteen blocks at once.
class GeoMipmapErrors {
public:
    static constexpr int kSmallestTile = 2, kLargestTile = GeoMipmapShape::kLargestTile;

    /// `tileSize`: a power of two from kSmallestTile to kLargestTile. `edits`: of the grid; null where it never changes.
    GeoMipmapErrors(const SampleGrid& grid, int tileSize, std::shared_ptr<const EditLog> edits = nullptr);

    /// Brings up to date what depends on samples that have changed since it was last told. What building it anew gives.
    void follow(const SampleGrid& grid);

    const BlockLayout& layout() const { return layout_; }
    const GeoMipmapShape& shape(int column, int row) const {
        return shapes_[(column + 1 == layout_.blockColumns ? 1u : 0u) + (row + 1 == layout_.blockRows ? 2u : 0u)];
    }

    /// Of the whole block at a level whose borders have the same level; infinite where there is no such level.
    float level(std::size_t block, int level) const { return level == 0 ? 0.0f : ErrorHierarchy::decode(at(block)[level - 1]); }
    /// Of one side of a block of `level` whose border has `borderLevel`, a coarser one.
    float side(std::size_t block, int side, int level, int borderLevel) const {
        return ErrorHierarchy::decode(at(block)[sideSlot(side, level, borderLevel)]);
    }
    /// Which diagonal the last level has: see GeoMipmapShape::flat().
    bool hasOtherDiagonal(std::size_t block) const { return (flags_[block] & kOtherDiagonal) != 0; }
    bool hasHoles(std::size_t block) const { return (flags_[block] & kHoles) != 0; }

    /// A pyramid of bounds over the blocks, in the frame: level 0 is the blocks, each next one has four of the last in one.
    int boundsLevels() const { return int(bounds_.size()); }
    BoxPyramid::Bounds bounds(int level, int column, int row) const;
    int boundsColumns(int level) const { return bounds_[std::size_t(level)].columns; }
    int boundsRows(int level) const { return bounds_[std::size_t(level)].rows; }

    std::size_t bytes() const;

private:
    static constexpr std::uint8_t kOtherDiagonal = 1, kHoles = 2;
    static constexpr std::size_t kLanes = 16;

    struct BoundsLevel {
        int columns = 0;
        int rows = 0;
        std::vector<float> values;  ///< low then high of z (regular) or of x, y, z (curved)
    };
    struct Program;
    struct Lanes;

    const std::uint16_t* at(std::size_t block) const { return &codes_[block * slots_]; }
    int sideSlot(int side, int level, int borderLevel) const {
        const int n = layout_.exponent;
        return n + 4 * (level * n - level * (level - 1) / 2 + borderLevel - level - 1) + side;
    }
    Program programFor(const GeoMipmapShape& shape) const;
    /// Blocks from `low` to `high`, both included.
    void build(const SampleGrid& grid, glm::ivec2 low, glm::ivec2 high);
    void load(const SampleGrid& grid, glm::ivec2 first, int count, Lanes& lanes);
    void store(const Program& program, const GeoMipmapShape& shape, std::size_t block, std::size_t lane, const Lanes& lanes);
    void storeHoles(const SampleGrid& grid, const GeoMipmapShape& shape, std::size_t block);
    void buildBounds();

    BlockLayout layout_;
    bool regular_;
    std::vector<GeoMipmapShape> shapes_;  ///< inner block, at the far column, at the far row, at both
    std::size_t slots_;                   ///< codes of a block: levels from 1 on, then sides
    std::vector<std::uint16_t> codes_;
    std::vector<std::uint8_t> flags_;
    std::vector<BoundsLevel> bounds_;
    std::shared_ptr<const EditLog> edits_;
    std::uint64_t version_ = 0;  ///< of the edits that are in it
};

}  // namespace terrain
