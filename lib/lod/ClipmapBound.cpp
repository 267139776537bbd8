// What of a clipmap's errors can be seen: ClipmapErrors::screenError().
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <glm/common.hpp>

#include "lod/ClipmapErrors.h"
#include "lod/ClipmapSurface.h"

namespace terrain {

/// Best first: the blocks whose bounds are largest are looked at closer, until that is one of the finest.
class ClipmapErrors::Search {
public:
    Search(const ClipmapErrors& errors, const ScreenSpace& screen, const SampleGrid& grid, const BoxPyramid& boxes, int sourceLevel,
           bool blending, const ClipRect& region, const ClipRect& hole, float enough)
        : level_(errors.levels_[std::size_t(sourceLevel)]), values_(level_.errors(blending).data()), screen_(screen), grid_(grid),
          boxes_(boxes), last_(grid.columns() - 1, grid.rows() - 1), sourceLevel_(sourceLevel), blending_(blending),
          region_(region.cutTo({glm::ivec2(0), {lastVertex(last_.x, sourceLevel), lastVertex(last_.y, sourceLevel)}})), hole_(hole),
          enough_(enough) {
        open_.reserve(64);
    }

    float run() {
        if (region_.high.x <= region_.low.x || region_.high.y <= region_.low.y) return 0.0f;
        const int extent = std::max(region_.high.x - region_.low.x, region_.high.y - region_.low.y);
        int layer = 0;
        while (layer + 1 < int(level_.layers.size()) && (2 * kBlockCells << layer) < extent) ++layer;
        const int width = kBlockCells << layer;
        for (int row = region_.low.y / width; row <= (region_.high.y - 1) / width; ++row)
            for (int column = region_.low.x / width; column <= (region_.high.x - 1) / width; ++column) open(layer, {column, row});
        while (!open_.empty()) {
            const Block block = open_.front();
            std::pop_heap(open_.begin(), open_.end());
            open_.pop_back();
            if (isFinest(block)) return block.bound;
            for (int i = 0; i < 4; ++i) open(block.layer - 1, 2 * block.at + glm::ivec2(i % 2, i / 2));
        }
        return leftOut_;
    }

private:
    /// Below the finest layer a block's error holds for each of its parts, down to this: single cells.
    static constexpr int kSmallest = -3;

    struct Block {
        float bound, error;
        int layer;
        glm::ivec2 at;
        bool operator<(const Block& other) const { return bound < other.bound; }
    };

    /// Looking closer helps below the finest layer only where the block is too large to have a bound at all.
    bool isFinest(const Block& block) const {
        return block.layer <= 0 && (std::isfinite(block.bound) || !std::isfinite(block.error) || block.layer == kSmallest);
    }
    float errorOf(int layer, glm::ivec2 at) const {
        const Layer& finest = level_.layers[std::size_t(std::max(layer, 0))];
        if (layer < 0) at = at >> -layer;
        if (at.x >= finest.blocks.x || at.y >= finest.blocks.y) return 0.0f;
        return values_[finest.first + std::size_t(at.y) * std::size_t(finest.blocks.x) + std::size_t(at.x)];
    }
    void open(int layer, glm::ivec2 at) {
        const float error = errorOf(layer, at);
        if (!(error > 0.0f)) return;
        const int width = layer < 0 ? kBlockCells >> -layer : kBlockCells << layer;
        const ClipRect rect = withoutHole(ClipRect{at * width, (at + 1) * width}.cutTo(region_));
        if (rect.high.x <= rect.low.x || rect.high.y <= rect.low.y) return;
        const BoxPyramid::Bounds bounds = boundsOf(rect, layer < 0);
        if (bounds.isEmpty()) return;
        const Box box = boxOf(bounds);
        if (screen_.isOutside(box)) return;
        const float bound = screen_.screenError(error, box);
        if (!(bound > enough_)) {
            leftOut_ = std::max(leftOut_, bound);
            return;
        }
        open_.push_back({bound, error, layer, at});
        std::push_heap(open_.begin(), open_.end());
    }
    /// The smallest rectangle around what is left of one.
    ClipRect withoutHole(ClipRect rect) const {
        for (int axis = 0; axis < 2; ++axis) {
            const int other = 1 - axis;
            if (rect.low[other] < hole_.low[other] || rect.high[other] > hole_.high[other]) continue;
            if (rect.low[axis] >= hole_.low[axis]) rect.low[axis] = std::max(rect.low[axis], hole_.high[axis]);
            if (rect.high[axis] <= hole_.high[axis]) rect.high[axis] = std::min(rect.high[axis], hole_.low[axis]);
        }
        return rect;
    }
    BoxPyramid::Bounds boundsOf(ClipRect rect, bool closer) const {
        // Vertices blend towards heights from all of the coarser cells around.
        if (blending_) rect = {(rect.low >> 1) * 2, ((rect.high + 1) >> 1) * 2};
        const auto sample = [this](glm::ivec2 vertex) {
            const auto along = [this](int v, int last) {
                return int(std::min(std::int64_t(v) << sourceLevel_, std::int64_t(last)));
            };
            return glm::ivec2(along(vertex.x, last_.x), along(vertex.y, last_.y));
        };
        const glm::ivec2 low = sample(rect.low), high = sample(rect.high);
        // What is smaller than the pyramid's blocks.
        if (closer && std::max(high.x - low.x, high.y - low.y) < 2 * BoxPyramid::kBlockCells)
            return BoxPyramid::exactBounds(grid_, low.x, low.y, high.x, high.y);
        return boxes_.bounds(low.x, low.y, high.x, high.y);
    }

    const Level& level_;
    const float* values_;
    const ScreenSpace& screen_;
    const SampleGrid& grid_;
    const BoxPyramid& boxes_;
    glm::ivec2 last_;
    int sourceLevel_;
    bool blending_;
    ClipRect region_, hole_;
    float enough_, leftOut_ = 0.0f;
    std::vector<Block> open_;
};

float ClipmapErrors::screenError(const ScreenSpace& screen, const SampleGrid& grid, const BoxPyramid& boxes, int sourceLevel,
                                 bool blending, const ClipRect& region, const ClipRect& hole, float enough) const {
    if (sourceLevel < 0) return 0.0f;
    if (sourceLevel >= levels()) return std::numeric_limits<float>::infinity();
    if (levels_[std::size_t(sourceLevel)].errors(blending).empty()) return 0.0f;
    return Search(*this, screen, grid, boxes, sourceLevel, blending, region, hole, enough).run();
}

}  // namespace terrain
