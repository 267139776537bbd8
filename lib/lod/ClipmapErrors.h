// How far the levels of a geometry clipmap lie from the samples, and what of it can be seen.
#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec2.hpp>

#include "base/View.h"
#include "height/EditLog.h"
#include "height/SampleGate.h"
#include "height/SampleGrid.h"
#include "lod/BoxPyramid.h"
#include "lod/ClipmapLayout.h"

namespace terrain {

/// Exact errors of the levels of samples (see ClipmapSurface.h), over blocks of `kBlockCells` cells of each level and in a pyramid
/// of maxima above these: 0.14 bytes a sample. Two of each block, both over all samples that its cells cover, borders included:
///
/// - plain: largest |F - h|, where h is the sample's height and F that of the level's own triangulated surface. 0 on level 0.
/// - blending: the same when every vertex stands anywhere between its own height and the coarser surface's there, each by a share
///   of its own. With P and N the interpolated positive and negative parts of the differences between the two that is
///   max |F - h + P|, |F - h + N|. On the coarsest level it is the plain one.
///
/// Of a curved grid they are distances in local coordinates, the blending one bounded by |F - h| plus the interpolated length of
/// the differences.
///
/// A cell with a hole at one of its corners is not drawn. Errors of cells that hide or leave out what is there are infinite: that
/// are drawn and cover a hole, or are not drawn and cover a full-resolution cell without one. Where all of a cell is missing from
/// the full resolution too, nothing is wrong: 0, as on level 0. Vertices that have no coarser surface keep their own height.
class ClipmapErrors {
public:
    static constexpr int kBlockCells = 8;

    ClipmapErrors() = default;
    /// Of levels 0 to levels - 1. Takes about 25 ns a sample, and goes over the samples once in order: rows ahead of it are read
    /// only where they hold vertices of a level.
    /// `gate`: held for some rows at a time; null where nobody edits meanwhile.
    ClipmapErrors(const SampleGrid& grid, int levels, SampleGate* gate = nullptr);

    /// Samples have changed, of a grid of the same size and kind: brings up to date what depends on them. Blocks of coarse levels are
    /// large; where they hold more samples than kExactly, errors only grow, to a bound that may be larger than exact.
    void update(const SampleGrid& grid, const GridEdits& edits);
    static constexpr std::int64_t kExactly = std::int64_t(1) << 21;

    int levels() const { return int(levels_.size()); }
    /// Layers of a level's pyramid, and blocks of each along both axes: of kBlockCells * 2^layer cells of the level.
    int layers(int sourceLevel) const { return int(levels_[std::size_t(sourceLevel)].layers.size()); }
    glm::ivec2 blocks(int sourceLevel, int layer) const { return layerOf(sourceLevel, layer).blocks; }
    /// Error of a block, in units of height.
    float error(int sourceLevel, bool blending, int layer, glm::ivec2 block) const;

    /// Bound, in pixels, on the error of every sample in view that lies in `region` but not inside of `hole` (rectangles of
    /// vertices of the level), drawn at that level. `boxes` must be of `grid`, and `screen` of its frame. Nothing is looked at
    /// closer that can't exceed `enough`, so a result up to that may be larger than it had to be. 0 for levels finer than the
    /// samples, which have all of these; infinite for coarser ones than there are.
    float screenError(const ScreenSpace& screen, const SampleGrid& grid, const BoxPyramid& boxes, int sourceLevel, bool blending,
                      const ClipRect& region, const ClipRect& hole, float enough) const;

    std::size_t bytes() const;

private:
    struct Layer {
        glm::ivec2 blocks{0};
        std::size_t first = 0;
    };
    struct Level {
        std::vector<Layer> layers;
        std::vector<float> plain, blending;  ///< by layer, row, column; empty: 0, or the same as plain
        const std::vector<float>& errors(bool blend) const { return blend && !blending.empty() ? blending : plain; }
    };
    class Holes;
    class Search;
    const Layer& layerOf(int sourceLevel, int layer) const { return levels_[std::size_t(sourceLevel)].layers[std::size_t(layer)]; }
    void scan(const SampleGrid& grid, SampleGate* gate);
    void buildLayers();
    void updateLevel(const SampleGrid& grid, int level, const SampleRect& rect);
    static Level measured(const SampleGrid& grid, int level, bool coarsest);
    static void updateLayers(const Level& level, std::vector<float>& errors, glm::ivec2 low, glm::ivec2 high);

    std::vector<Level> levels_;
};

}  // namespace terrain
