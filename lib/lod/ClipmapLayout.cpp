#include "lod/ClipmapLayout.h"

#include <array>
#include <cmath>

#include <glm/vector_relational.hpp>

namespace terrain {

int ClipmapShape::validSize(int wanted) {
    int size = kSmallest;
    while (size < kLargest && wanted - size > 2 * size + 1 - wanted) size = 2 * size + 1;
    return size;
}

ClipmapLayout::ClipmapLayout(int columns, int rows, const ClipmapShape& shape)
    : size_(shape.size), levels_(shape.levels), detailLevels_(std::clamp(shape.detailLevels, 0, ClipmapShape::kMostDetail)),
      transition_(shape.transitionWidth) {
    // Units are ints.
    while (detailLevels_ > 0 && (std::int64_t(std::max(columns, rows)) << detailLevels_) > (1 << 30)) --detailLevels_;
    last_ = glm::ivec2(columns - 1, rows - 1) << detailLevels_;
    const std::int64_t reach = 2 * blockSize() - 2, longest = std::max(last_.x, last_.y);
    // Levels of detail are made from the samples themselves, which are a level however small the grid is.
    int covering = detailLevels_ + 1;
    while ((reach << (covering - 1)) < longest) ++covering;
    // Levels of samples count from the finest sample on: those finer come on top.
    levels_ = levels_ > 0 ? std::min(levels_ + detailLevels_, covering) : covering;
    // No wider than leaves the finer level's perimeter where this level is its own.
    const int widest = blockSize() - 3;
    transition_ = std::clamp(transition_ > 0 ? transition_ : size_ / 10, 1, widest);
}

glm::dvec2 ClipmapLayout::viewerUnits(glm::dvec2 sample) const {
    const glm::dvec2 unit = sample * double(unitsPerSample());
    const auto within = [](double u, int last) { return u > 0.0 ? std::min(u, double(last)) : 0.0; };
    return {within(unit.x, last_.x), within(unit.y, last_.y)};
}

ClipRect ClipmapLayout::place(int level, glm::dvec2 viewer) const {
    const double step = double(std::int64_t(2) << level);
    const glm::ivec2 low(2 * int(std::floor(viewer.x / step)) - (2 * blockSize() - 2),
                         2 * int(std::floor(viewer.y / step)) - (2 * blockSize() - 2));
    return {low, low + (size_ - 1)};
}

float ClipmapLayout::blend(int level, glm::ivec2 vertex, glm::dvec2 viewer) const {
    if (level + 1 >= levels_) return 0.0f;
    const ClipRect all = place(level, viewer);
    if (vertex.x <= all.low.x || vertex.y <= all.low.y || vertex.x >= all.high.x || vertex.y >= all.high.y) return 1.0f;
    const glm::dvec2 away = glm::abs(glm::dvec2(vertex) - viewerAt(level, viewer));
    const double inner = double(size_ - 1) / 2.0 - transition_ - 1.0;
    return float(std::clamp((std::max(away.x, away.y) - inner) / transition_, 0.0, 1.0));
}

int footprintCells(const ClipmapLayout& layout) {
    constexpr int kMost = 32;
    const int cells = layout.blockSize() - 1, pieces = (cells + kMost - 1) / kMost;
    return (cells + pieces - 1) / pieces;
}

namespace {

/// Adds rectangles of cells between vertices, cut to the grid and to what a footprint covers.
class Tiler {
public:
    Tiler(const ClipmapLayout& layout, int level, ClipmapPatches& patches)
        : domain_(layout.domain(level)), level_(level), block_(footprintCells(layout)), strip_(2 * layout.blockSize()),
          patches_(patches) {}

    void blocks(glm::ivec2 low, glm::ivec2 high) { tile(Footprint::Block, low, high, {block_, block_}); }
    void columns(glm::ivec2 low, glm::ivec2 high) { tile(Footprint::Column, low, high, {2, strip_}); }
    void rows(glm::ivec2 low, glm::ivec2 high) { tile(Footprint::Row, low, high, {strip_, 2}); }
    void seam(glm::ivec2 low, glm::ivec2 high) {
        // Where the grid ends there is nothing beyond.
        const int across = low.x == high.x ? 0 : 1;
        if (low[across] <= domain_.low[across] || low[across] >= domain_.high[across]) return;
        low = glm::max(low, domain_.low), high = glm::min(high, domain_.high);
        if (low != high && glm::all(glm::lessThanEqual(low, high))) patches_[Footprint::Seam].push_back({low, high, level_});
    }

private:
    void tile(Footprint footprint, glm::ivec2 low, glm::ivec2 high, glm::ivec2 step) {
        low = glm::max(low, domain_.low), high = glm::min(high, domain_.high);
        for (int y = low.y; y < high.y; y += step.y)
            for (int x = low.x; x < high.x; x += step.x)
                patches_[footprint].push_back({{x, y}, glm::min(glm::ivec2(x, y) + step, high), level_});
    }

    ClipRect domain_;
    int level_;
    int block_, strip_;
    ClipmapPatches& patches_;
};

/// The L between the rectangle of a hole and what is in it, one cell wide: a column as high as the hole, and what is left of a row.
void coverTrim(Tiler& tiler, const ClipRect& hole, const ClipRect& inside) {
    const bool left = inside.low.x > hole.low.x, bottom = inside.low.y > hole.low.y;
    const int column = left ? hole.low.x : hole.high.x - 1, row = bottom ? hole.low.y : hole.high.y - 1;
    tiler.columns({column, hole.low.y}, {column + 1, hole.high.y});
    tiler.rows({left ? hole.low.x + 1 : hole.low.x, row}, {left ? hole.high.x : hole.high.x - 1, row + 1});
}

void coverFrame(Tiler& tiler, const ClipmapLayout& layout, glm::ivec2 low) {
    const int m = layout.blockSize();
    const std::array<int, 4> at{0, m - 1, 2 * m, 3 * m - 1};
    for (std::size_t j = 0; j < 4; ++j)
        for (std::size_t i = 0; i < 4; ++i) {
            if (i % 3 != 0 && j % 3 != 0) continue;
            const glm::ivec2 from = low + glm::ivec2(at[i], at[j]);
            tiler.blocks(from, from + (m - 1));
        }
    const int middle = 2 * m - 2, far = 3 * m - 1;
    for (const int start : {0, far}) {
        tiler.columns(low + glm::ivec2(middle, start), low + glm::ivec2(middle + 2, start + m - 1));
        tiler.rows(low + glm::ivec2(start, middle), low + glm::ivec2(start + m - 1, middle + 2));
    }
}

/// All of a square of 2 m x 2 m cells: the trim, the trim of the square of 2 m - 1 that is left, and four blocks.
void coverCentre(Tiler& tiler, const ClipmapLayout& layout, const ClipRect& hole) {
    const int m = layout.blockSize();
    const ClipRect inside{hole.low, hole.high - 1}, core{hole.low, hole.high - 2};
    coverTrim(tiler, hole, inside);
    coverTrim(tiler, inside, core);
    for (const int y : {0, m - 1})
        for (const int x : {0, m - 1}) tiler.blocks(hole.low + glm::ivec2(x, y), hole.low + glm::ivec2(x, y) + (m - 1));
}

/// The 2004 article's four rectangles around a hole.
void coverAround(Tiler& tiler, const ClipRect& active, const ClipRect& hole) {
    if (hole.isEmpty()) return tiler.blocks(active.low, active.high);
    tiler.blocks(active.low, {active.high.x, hole.low.y});
    tiler.blocks({active.low.x, hole.high.y}, active.high);
    tiler.blocks({active.low.x, hole.low.y}, {hole.low.x, hole.high.y});
    tiler.blocks({hole.high.x, hole.low.y}, {active.high.x, hole.high.y});
}

}  // namespace

void coverLevel(const ClipmapLayout& layout, int level, const ClipRect& active, const ClipRect& hole, ClipmapPatches& patches) {
    if (active.isEmpty()) return;
    Tiler tiler(layout, level, patches);
    const int m = layout.blockSize();
    const bool isWhole = active.columns() == layout.size() && active.rows() == layout.size();
    const ClipRect centre{active.low + (m - 1), active.low + (3 * m - 1)};
    if (isWhole && hole.isEmpty()) {
        coverFrame(tiler, layout, active.low);
        coverCentre(tiler, layout, centre);
    } else if (isWhole && hole.columns() == 2 * m && hole.rows() == 2 * m && centre.contains(hole)) {
        coverFrame(tiler, layout, active.low);
        coverTrim(tiler, centre, hole);
    } else {
        coverAround(tiler, active, hole);
    }
    if (level + 1 == layout.levels()) return;
    tiler.seam(active.low, {active.high.x, active.low.y});
    tiler.seam({active.low.x, active.high.y}, active.high);
    tiler.seam(active.low, {active.low.x, active.high.y});
    tiler.seam({active.high.x, active.low.y}, active.high);
}

std::vector<ClipRect> activeRegions(const ClipmapLayout& layout, std::span<const ClipRect> valid, int finest, glm::dvec2 viewer) {
    std::vector<ClipRect> active(valid.size());
    for (int level = layout.levels() - 1; level >= finest; --level) {
        const std::size_t l = std::size_t(level);
        const ClipRect wanted = layout.place(level, viewer);
        ClipRect region = valid[l].contains(wanted.cutTo(layout.domain(level))) ? wanted : wanted.cutTo(valid[l]);
        if (level + 1 < layout.levels()) {
            // Nor may it reach into where the coarser one blends along a border of what is there.
            const bool isCropped = active[l + 1] != layout.place(level + 1, viewer);
            const ClipRect within = active[l + 1].shrunk(isCropped ? 2 + layout.transitionWidth() : 2);
            if (within.isEmpty()) break;
            region = region.cutTo({within.low * 2, within.high * 2});
            region = {(region.low + 1) & ~1, region.high & ~1};
        }
        // A region without cells draws nothing, and neither can what is inside of it.
        if (region.columns() < 3 || region.rows() < 3) break;
        active[l] = region;
    }
    return active;
}

}  // namespace terrain
