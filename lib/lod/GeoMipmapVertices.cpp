#include "lod/GeoMipmapVertices.h"

#include <algorithm>
#include <cmath>

namespace terrain {

GeoMipmapVertices::GeoMipmapVertices(std::shared_ptr<const GeoMipmapErrors> errors)
    : errors_(std::move(errors)), layout_(errors_->layout()) {
    const std::uint32_t columns = std::uint32_t(layout_.blockColumns), rows = std::uint32_t(layout_.blockRows);
    firstHorizontal_ = (columns + 1) * (rows + 1);
    firstVertical_ = firstHorizontal_ + columns * (rows + 1);
    firstInner_ = firstVertical_ + (columns + 1) * rows;
    ranges_.resize(firstInner_ + columns * rows);
    states_.resize(columns * rows);
    const std::size_t pitch = std::size_t(GeoMipmapShape::pitch(layout_.exponent));
    ids_.resize(pitch * pitch);
}

std::array<std::uint32_t, 9> GeoMipmapVertices::rangesOf(const BlockAt& at) const {
    const int column = at.column, row = at.row;
    return {cornerRange(column, row),
            cornerRange(column + 1, row),
            cornerRange(column, row + 1),
            cornerRange(column + 1, row + 1),
            sideRange(at, 0),
            sideRange(at, 1),
            sideRange(at, 2),
            sideRange(at, 3),
            innerRange(at)};
}

/// Position of a line of so many cells' extent, by its number from 0; the last is at the end.
int GeoMipmapVertices::lineAt(int line, int cells, int level) const {
    return level == layout_.exponent ? (line ? cells : 0) : std::min(line << level, cells);
}

GeoMipmapVertices::Extent GeoMipmapVertices::extent(std::uint32_t range, int level) const {
    const auto sampleAt = [&](glm::ivec2 block) {
        return glm::ivec2(block.x == layout_.blockColumns ? layout_.columns - 1 : block.x * layout_.tileSize,
                          block.y == layout_.blockRows ? layout_.rows - 1 : block.y * layout_.tileSize);
    };
    const auto inside = [&](int cells) { return level == layout_.exponent ? 0 : (cells - 1) >> level; };
    const auto split = [](std::uint32_t number, int columns) {
        return glm::ivec2(int(number % std::uint32_t(columns)), int(number / std::uint32_t(columns)));
    };
    if (range < firstHorizontal_) return {sampleAt(split(range, layout_.blockColumns + 1)), {0, 0}, {1, 1}};
    if (range < firstVertical_) {
        const glm::ivec2 at = split(range - firstHorizontal_, layout_.blockColumns);
        const int cells = layout_.width(at.x);
        return {sampleAt(at), {cells, 0}, {inside(cells), 1}};
    }
    if (range < firstInner_) {
        const glm::ivec2 at = split(range - firstVertical_, layout_.blockColumns + 1);
        const int cells = layout_.height(at.y);
        return {sampleAt(at), {0, cells}, {1, inside(cells)}};
    }
    const glm::ivec2 at = split(range - firstInner_, layout_.blockColumns), cells(layout_.width(at.x), layout_.height(at.y));
    return {sampleAt(at), cells, {inside(cells.x), inside(cells.y)}};
}

glm::ivec2 GeoMipmapVertices::sampleOf(const Extent& e, int level, int number) const {
    const glm::ivec2 line(number % e.count.x + 1, number / e.count.x + 1);
    return e.from + glm::ivec2(e.cells.x ? lineAt(line.x, e.cells.x, level) : 0, e.cells.y ? lineAt(line.y, e.cells.y, level) : 0);
}

/// All samples of a range, in the order of its vertices.
template <class Visit>
void GeoMipmapVertices::forSamples(const Extent& e, int level, const Visit& visit) const {
    for (int line = 1; line <= e.count.y; ++line) {
        const int row = e.from.y + (e.cells.y ? lineAt(line, e.cells.y, level) : 0);
        for (int i = 1; i <= e.count.x; ++i) visit(glm::ivec2(e.from.x + (e.cells.x ? lineAt(i, e.cells.x, level) : 0), row));
    }
}

void GeoMipmapVertices::use(const SampleGrid& grid, std::uint32_t number, std::uint8_t level) {
    Range& range = ranges_[number];
    ++range.users;
    if (range.level == level) return;
    if (range.level != kUnused) release(number);
    range.level = level;
    allocate(grid, number);
}

void GeoMipmapVertices::unuse(std::uint32_t number) {
    if (--ranges_[number].users == 0) emptied_.push_back(number);
}

void GeoMipmapVertices::release(std::uint32_t number) {
    Range& range = ranges_[number];
    const Extent e = extent(number, range.level);
    if (const std::uint32_t size = std::uint32_t(e.count.x * e.count.y); size > 0) {
        free_[size].push_back(range.first);
        drawnVertices_ -= size;
    }
    range.level = kUnused;
}

void GeoMipmapVertices::allocate(const SampleGrid& grid, std::uint32_t number) {
    Range& range = ranges_[number];
    const Extent e = extent(number, range.level);
    const std::uint32_t size = std::uint32_t(e.count.x * e.count.y);
    if (size == 0) return;
    drawnVertices_ += size;
    std::vector<std::uint32_t>& fitting = free_[size];
    if (fitting.empty()) {
        range.first = std::uint32_t(positions_.size());
        positions_.resize(positions_.size() + size);
        samples_.resize(positions_.size());
    } else {
        range.first = fitting.back();
        fitting.pop_back();
    }
    place(grid, number, true);
}

void GeoMipmapVertices::place(const SampleGrid& grid, std::uint32_t number, bool isNew) {
    const Range& range = ranges_[number];
    const Extent e = extent(number, range.level);
    std::uint32_t vertex = range.first;
    forSamples(e, range.level, [&](const glm::ivec2& sample) {
        // What lies in a hole is part of a range, but of no triangle.
        const glm::vec3 p = grid.position(sample.x, sample.y);
        positions_[vertex] = std::isfinite(p.x + p.y + p.z) ? p : glm::vec3(0.0f);
        if (isNew) {
            samples_[vertex] = std::uint32_t(grid.index(sample.x, sample.y));
            newVertices_.push_back(vertex);
        }
        ++vertex;
    });
}

void GeoMipmapVertices::update(const SampleGrid& grid, std::span<const DrawnBlock> blocks, std::span<const DrawnBlock> before) {
    ++update_;
    emptied_.clear();
    // Ranges of sizes that are not needed any more leave gaps, and all of the pool goes to GL: start afresh now and then.
    if (positions_.size() > drawnVertices_ + drawnVertices_ / 4 + 1024) {
        forget(before);
        before = {};
    }
    const auto isAsBefore = [this](const DrawnBlock& drawn) {
        const State& state = states_[drawn.at.number];
        return state.drawn && state.level == drawn.level && state.border == drawn.border;
    };
    for (const DrawnBlock& drawn : blocks)
        if (isAsBefore(drawn)) states_[drawn.at.number].update = update_;
    for (const DrawnBlock& drawn : before) {
        State& state = states_[drawn.at.number];
        if (state.update == update_) continue;
        state.drawn = false;
        for (const std::uint32_t range : rangesOf(drawn.at)) unuse(range);
    }
    for (const DrawnBlock& drawn : blocks) {
        State& state = states_[drawn.at.number];
        if (state.drawn) continue;
        state = {drawn.level, drawn.border, true, update_, update_};
        const std::array<std::uint32_t, 9> ranges = rangesOf(drawn.at);
        for (std::size_t corner = 0; corner < 4; ++corner) use(grid, ranges[corner], 0);
        for (std::size_t side = 0; side < 4; ++side) use(grid, ranges[4 + side], drawn.border[side]);
        use(grid, ranges[8], drawn.level);
    }
    for (const std::uint32_t number : emptied_)
        if (ranges_[number].users == 0 && ranges_[number].level != kUnused) release(number);
}

void GeoMipmapVertices::placeAgain(const SampleGrid& grid, std::span<const DrawnBlock> blocks, const GridEdits& edits) {
    if (edits.isEmpty()) return;
    const GridEdits around = edits.widened(1);
    std::vector<std::uint32_t> touched;
    for (const DrawnBlock& drawn : blocks) {
        const glm::ivec2 from = glm::ivec2(drawn.at.column, drawn.at.row) * layout_.tileSize;
        if (!around.touches({from, from + layout_.tileSize})) continue;
        for (const std::uint32_t number : rangesOf(drawn.at)) touched.push_back(number);
    }
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    for (const std::uint32_t number : touched) {
        const Extent e = extent(number, ranges_[number].level);
        if (e.count.x * e.count.y > 0) place(grid, number, true);
    }
}

void GeoMipmapVertices::forget(std::span<const DrawnBlock> blocks) {
    for (const DrawnBlock& drawn : blocks) {
        states_[drawn.at.number] = {};
        for (const std::uint32_t number : rangesOf(drawn.at)) ranges_[number] = {};
    }
    positions_.clear();
    samples_.clear();
    free_.clear();
    moved_.clear();
    drawnVertices_ = 0;
}

const std::uint32_t* GeoMipmapVertices::of(const DrawnBlock& drawn) {
    const int column = drawn.at.column, row = drawn.at.row;
    const int width = layout_.width(column), height = layout_.height(row), pitch = GeoMipmapShape::pitch(layout_.exponent);
    const auto first = [this](std::uint32_t number) { return ranges_[number].first; };
    ids_[0] = first(cornerRange(column, row));
    ids_[std::size_t(width)] = first(cornerRange(column + 1, row));
    ids_[std::size_t(height * pitch)] = first(cornerRange(column, row + 1));
    ids_[std::size_t(height * pitch + width)] = first(cornerRange(column + 1, row + 1));
    for (int side = 0; side < 4; ++side) {
        if (drawn.border[std::size_t(side)] == layout_.exponent) continue;
        const bool horizontal = side % 2 == 0;
        const int step = 1 << drawn.border[std::size_t(side)], start = side == GeoMipmapShape::Top     ? height * pitch
                                                                       : side == GeoMipmapShape::Right ? width
                                                                                                       : 0;
        std::uint32_t vertex = first(sideRange(drawn.at, side));
        for (int line = step; line < (horizontal ? width : height); line += step)
            ids_[std::size_t(start + line * (horizontal ? 1 : pitch))] = vertex++;
    }
    if (drawn.level == layout_.exponent) return ids_.data();
    const int step = 1 << drawn.level;
    std::uint32_t vertex = first(innerRange(drawn.at));
    for (int row = step; row < height; row += step)
        for (int column = step; column < width; column += step) ids_[std::size_t(row * pitch + column)] = vertex++;
    return ids_.data();
}

bool GeoMipmapVertices::morph(const SampleGrid& grid, std::span<const DrawnBlock> sliding, const BlockDetails& detail) {
    const bool anyBefore = !moved_.empty();
    for (const std::uint32_t number : moved_)
        if (ranges_[number].level != kUnused) place(grid, number, false);
    moved_.clear();
    // Borders first: what is inside stands between them. Each slides with the coarser of its blocks.
    for (const DrawnBlock& drawn : sliding)
        for (int side = 0; side < 4; ++side) {
            const float own = detail[drawn.at], beyond = detail.beyond(drawn.at, side);
            const bool isCoarser =
                own > beyond || (own == beyond && (side == GeoMipmapShape::Bottom || side == GeoMipmapShape::Left));
            const std::uint32_t range = sideRange(drawn.at, side);
            if (isCoarser && ranges_[range].level != kUnused) morphBorder(grid, range, own - float(drawn.level));
        }
    for (const DrawnBlock& drawn : sliding)
        if (states_[drawn.at.number].drawn) morphInner(grid, drawn, detail[drawn.at] - float(drawn.level));
    return anyBefore || !moved_.empty();
}

void GeoMipmapVertices::morphBorder(const SampleGrid& grid, std::uint32_t number, float coarse) {
    const Range& range = ranges_[number];
    const Extent e = extent(number, range.level);
    const int count = e.count.x * e.count.y;
    const glm::ivec2 step = e.cells.x ? glm::ivec2(1 << range.level, 0) : glm::ivec2(0, 1 << range.level);
    for (int i = 0; i < count; i += 2) {
        const glm::ivec2 p = sampleOf(e, range.level, i);
        const glm::vec3 truth = grid.position(p.x, p.y);
        const glm::vec3 middle = (grid.position(p.x - step.x, p.y - step.y) + grid.position(p.x + step.x, p.y + step.y)) * 0.5f;
        positions_[range.first + std::uint32_t(i)] = middle + (1.0f - coarse) * (truth - middle);
    }
    moved_.push_back(number);
}

void GeoMipmapVertices::morphInner(const SampleGrid& grid, const DrawnBlock& drawn, float coarse) {
    const std::uint32_t* ids = of(drawn);
    const glm::ivec2 from = glm::ivec2(drawn.at.column, drawn.at.row) * layout_.tileSize;
    const int step = 1 << drawn.level, cells = layout_.tileSize >> drawn.level, pitch = GeoMipmapShape::pitch(layout_.exponent);
    const bool last = drawn.level + 1 == layout_.exponent;
    for (int row = 1; row < cells; ++row)
        for (int column = 1; column < cells; ++column) {
            if (row % 2 == 0 && column % 2 == 0) continue;
            // Which edge of the next level the vertex stands on.
            glm::ivec2 along(column % 2, row % 2);
            if (along.x && along.y && (last ? errors_->hasOtherDiagonal(drawn.at.number) : (column / 2 + row / 2) % 2 == 1))
                along.y = -1;
            const glm::ivec2 p = glm::ivec2(column, row) * step, a = p - along * step, b = p + along * step;
            const auto truth = [&](glm::ivec2 at) { return grid.position(from.x + at.x, from.y + at.y); };
            const auto vertex = [&](glm::ivec2 at) { return ids[at.y * pitch + at.x]; };
            positions_[vertex(p)] = (positions_[vertex(a)] + positions_[vertex(b)]) * 0.5f +
                                    (1.0f - coarse) * (truth(p) - (truth(a) + truth(b)) * 0.5f);
        }
    moved_.push_back(innerRange(drawn.at));
}

std::size_t GeoMipmapVertices::bytes() const {
    const auto held = [](const auto& items) { return items.capacity() * sizeof(items[0]); };
    std::size_t total = held(ranges_) + held(states_) + held(emptied_) + held(moved_) + held(ids_) + held(positions_) +
                        held(samples_) + held(newVertices_);
    for (const auto& [size, firsts] : free_) total += held(firsts);
    return total;
}

}  // namespace terrain
