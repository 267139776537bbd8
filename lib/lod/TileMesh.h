// One tile of Chunked LoD: a part of the terrain at one level, as few triangles as keep the level's error.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "lod/TileSamples.h"

namespace terrain {

/// A place in the quadtree of tiles, which has two levels for each size of tile, one after the other with half the step in error:
/// so detail follows the distance more closely than tiles of one size for each error can. Levels 0 and 1 span the tile size in
/// cells; each two levels above twice as many at twice the stride, and each two below, down to `TileTree::kSmallest` cells, half as
/// many at stride 1.
struct TileId {
    int level = 0;
    int column = 0;
    int row = 0;
    auto operator<=>(const TileId&) const = default;

    bool hasFourChildren() const { return (level & 1) == 0; }
    TileId parent() const { return level & 1 ? TileId{level + 1, column >> 1, row >> 1} : TileId{level + 1, column, row}; }
    /// 0 to 3, or 0 alone: the same place at the same size.
    TileId child(int i) const {
        return hasFourChildren() ? TileId{level - 1, 2 * column + (i & 1), 2 * row + (i >> 1)} : TileId{level - 1, column, row};
    }
};

/// Extents of the quadtree over a grid.
struct TileTree {
    static constexpr int kSmallest = 8, kLargest = 128;
    int columns = 0;
    int rows = 0;
    int tileCells = 64;  ///< power of two, kSmallest to 128

    /// Level of the one tile that covers everything.
    int rootLevel() const;
    /// Level at which every sample is a vertex unless it lies in the plane of its neighbours.
    int leafLevel() const;
    int extent(int level) const { return level >= 0 ? tileCells << (level >> 1) : tileCells >> -(level >> 1); }
    int stride(int level) const { return level >= 2 ? 1 << (level >> 1) : 1; }
    glm::ivec2 firstSample(const TileId& id) const { return glm::ivec2(id.column, id.row) * extent(id.level); }
    /// Of its cells, those beyond the grid included.
    SampleRect samplesOf(const TileId& id) const { return {firstSample(id), firstSample(id) + extent(id.level)}; }
    /// Whether any cell of the grid lies in the tile.
    bool contains(const TileId& id) const {
        return id.column * extent(id.level) < columns - 1 && id.row * extent(id.level) < rows - 1;
    }
};

/// A mesh by longest-edge bisection of the tile's square, restricted to the samples at the level's stride, with the fewest splits
/// that keep `target`; it refines its parent's mesh (Ulrich, "Rendering Massive Terrains using Chunked Level of Detail Control",
/// 2002: the chunks adapt inside). `error` is exact: the largest deviation of all full-resolution samples from the triangles.
struct TileMesh {
    TileId id;
    float error = 0.0f;                  ///< in units of the frame; infinite where a hole can't be shown at this stride
    float parentError = 0.0f;            ///< of the parent's mesh; 0 for the root
    std::vector<glm::ivec2> at;          ///< (column, row) by vertex
    std::vector<glm::vec3> fall;         ///< from each vertex to the parent's surface, in the frame; empty where it can't morph
    std::vector<std::uint16_t> indices;  ///< three a triangle, counter-clockwise in the (column, row) plane
    std::array<std::vector<std::uint16_t>, 4>
        border;  ///< vertices along row low, column high, row high, column low; counter-clockwise

    std::vector<std::uint8_t> active;  ///< by point of the lattice, row after row: is a vertex by bisection
    int latticeCells = 0;              ///< along a side

    std::size_t bytes() const;
};

/// Builds one tile. `parent` must be that of id, or null for the root. Any thread.
std::shared_ptr<const TileMesh> buildTile(const TileSamples& samples, const TileTree& tree, const TileId& id,
                                          const TileMesh* parent);

/// The same tile after samples have changed, none of which has become a hole or was one: its vertices stay, and its error is at least
/// the exact one, at most what it was before or what its triangles with changed samples have. It does not morph.
std::shared_ptr<const TileMesh> changedTile(const TileSamples& samples, const TileMesh& before, const GridEdits& edits);

}  // namespace terrain
