// Which vertices the levels of a geometry clipmap hold, and which patches draw them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/common.hpp>
#include <glm/vec2.hpp>

namespace terrain {

/// Vertices `low` to `high`, both included, of a level. Empty where high < low on any axis.
struct ClipRect {
    glm::ivec2 low{0};
    glm::ivec2 high{-1};

    bool isEmpty() const { return high.x < low.x || high.y < low.y; }
    int columns() const { return std::max(0, high.x - low.x + 1); }
    int rows() const { return std::max(0, high.y - low.y + 1); }
    std::int64_t samples() const { return std::int64_t(columns()) * rows(); }
    bool contains(glm::ivec2 v) const { return v.x >= low.x && v.y >= low.y && v.x <= high.x && v.y <= high.y; }
    bool contains(const ClipRect& r) const { return r.isEmpty() || (contains(r.low) && contains(r.high)); }
    ClipRect shrunk(int by) const { return {low + by, high - by}; }
    /// The same of an empty rectangle is empty.
    ClipRect cutTo(const ClipRect& r) const { return {glm::max(low, r.low), glm::min(high, r.high)}; }
    bool operator==(const ClipRect&) const = default;
};

/// What a user chooses of a clipmap; 0 is the default of each.
struct ClipmapShape {
    static constexpr int kSmallest = 15, kLargest = 1023, kMostDetail = 8;

    int size = 255;           ///< n: vertices along a side of a level, 2^k - 1
    int levels = 0;           ///< 0: as many as cover the grid, wherever the viewer is
    int detailLevels = 0;     ///< levels finer than the samples
    int transitionWidth = 0;  ///< in cells of each level; 0: n / 10

    bool operator==(const ClipmapShape&) const = default;

    /// The size nearest to what is wanted.
    static int validSize(int wanted);
};

/// The levels of a geometry clipmap over a finite grid (Losasso and Hoppe: "Geometry clipmaps", 2004; Asirvatham and Hoppe:
/// "Terrain rendering using GPU-based geometry clipmaps", 2005).
///
/// Level 0 is the finest one here. A *unit* is its distance of vertices: 2^-detailLevels samples; that of level l is 2^l units.
/// Vertex v of level l stands at unit v 2^l, whatever the viewer does, or at the last sample where that is beyond it: so cells that
/// reach over the border end exactly there, and cells beyond have no area.
///
/// With the viewer at unit p and q = floor(p / 2^(l + 1)), level l begins at vertex 2 q - (2 m - 2), m = (n + 1) / 4. That is even,
/// so a level's perimeter stands on vertices of the coarser one; and with q' = floor(p / 2^l) in {2 q, 2 q + 1} of the finer level,
/// that one begins m - 1 or m cells behind it: its hole, 2 m cells wide, leaves one row and one column for the trim. This holds for
/// any p, also negative.
class ClipmapLayout {
public:
    /// `shape` must be valid: see validSize().
    ClipmapLayout(int columns, int rows, const ClipmapShape& shape);

    int size() const { return size_; }
    int blockSize() const { return (size_ + 1) / 4; }
    int levels() const { return levels_; }
    int detailLevels() const { return detailLevels_; }
    int transitionWidth() const { return transition_; }
    /// Texels along a side of what holds a level: n + 1, a power of two, so that addresses wrap around by a mask.
    int pitch() const { return size_ + 1; }
    int texel(int vertex) const { return vertex & size_; }

    int unitsPerSample() const { return 1 << detailLevels_; }
    /// Last unit along each axis.
    glm::ivec2 lastUnit() const { return last_; }
    /// Distance of a level's vertices, in samples.
    double spacing(int level) const { return double(1 << level) / double(unitsPerSample()); }
    /// Level whose vertices are every 2^level-th sample; below 0 for levels finer than the samples.
    int sourceLevel(int level) const { return level - detailLevels_; }

    /// Place of a vertex in units, cut to the grid.
    glm::ivec2 unitAt(glm::ivec2 vertex, int level) const {
        return {cut(std::int64_t(vertex.x) << level, last_.x), cut(std::int64_t(vertex.y) << level, last_.y)};
    }
    /// Vertices of a level that have a place of their own: all others stand where the nearest of these does.
    ClipRect domain(int level) const { return {glm::ivec2(0), (last_ + (1 << level) - 1) >> level}; }
    /// The viewer's place in units, cut to the grid, for one at (column, row).
    glm::dvec2 viewerUnits(glm::dvec2 sample) const;
    /// What a level holds with the viewer there.
    ClipRect place(int level, glm::dvec2 viewer) const;
    /// The viewer in a level's own vertices.
    glm::dvec2 viewerAt(int level, glm::dvec2 viewer) const { return viewer / double(1 << level); }
    /// Share of the coarser level at a vertex, from 0 to 1: eq. (1) of the 2005 article, by the distance to the viewer on the axis
    /// on which it is larger. 1 on the perimeter of place(), and 0 everywhere on the coarsest level.
    float blend(int level, glm::ivec2 vertex, glm::dvec2 viewer) const;

private:
    static int cut(std::int64_t unit, int last) { return int(std::clamp<std::int64_t>(unit, 0, last)); }

    int size_;
    int levels_;
    int detailLevels_;
    int transition_;
    glm::ivec2 last_;
};

/// A rectangle of cells of one level, drawn by one footprint: vertex (i, j) of the footprint stands at min(low + (i, j), high), so
/// that what of the footprint is beyond has no area.
struct ClipmapPatch {
    glm::ivec2 low{0};
    glm::ivec2 high{0};
    int level = 0;
    bool operator==(const ClipmapPatch&) const = default;
};

/// The footprints, each a mesh of its own that is drawn once for all its patches on all levels.
enum class Footprint {
    Block,   ///< kBlockCells x kBlockCells cells: m x m blocks are drawn in as many of them as it takes, so that more is culled
    Column,  ///< 2 x 2 m cells: the strips of m x 3 vertices, and the trim's columns
    Row,     ///< 2 m x 2 cells, likewise
    Seam     ///< triangles without area along one side of a level's perimeter, n - 1 cells long
};
inline constexpr int kFootprints = 4;

/// Cells along a side of a block's footprint.
int footprintCells(const ClipmapLayout& layout);

struct ClipmapPatches {
    std::vector<ClipmapPatch> by[kFootprints];

    std::vector<ClipmapPatch>& operator[](Footprint f) { return by[int(f)]; }
    const std::vector<ClipmapPatch>& operator[](Footprint f) const { return by[int(f)]; }
    void clear() {
        for (auto& patches : by) patches.clear();
    }
};

/// Covers `active` without `hole` (in vertices of the same level; empty for the finest level drawn) by patches, each cell once, and
/// adds the seams along the perimeter of `active`. Where both are where the viewer has them these are the footprints of the 2005
/// article (sect. 3: twelve m x m blocks, four m x 3 strips, the L-shaped trim), anywhere else, where an update fell behind, the
/// four rectangles of the 2004 article (sect. 4). All is cut to the grid: nothing lies beyond it.
void coverLevel(const ClipmapLayout& layout, int level, const ClipRect& active, const ClipRect& hole, ClipmapPatches& patches);

/// The 2004 article's regions (sect. 4): what of each level is drawn. `valid[l]` is what is there of level l, in its domain. Cut to
/// the coarser level less two cells, and to even vertices; levels below `finest` are empty. Where a level is empty, so are all
/// finer ones.
std::vector<ClipRect> activeRegions(const ClipmapLayout& layout, std::span<const ClipRect> valid, int finest, glm::dvec2 viewer);

/// The finer level's region in vertices of the coarser one.
inline ClipRect coarserRect(const ClipRect& fine) {
    return {fine.low >> 1, fine.high >> 1};
}

/// What a level leaves to the next finer one, of these active regions; empty where that draws nothing.
inline ClipRect holeIn(std::span<const ClipRect> active, int level) {
    const bool isDrawn = level > 0 && !active[std::size_t(level) - 1].isEmpty();
    return isDrawn ? coarserRect(active[std::size_t(level) - 1]) : ClipRect{};
}

}  // namespace terrain
