#include "height/MapSource.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace terrain {

namespace {

/// Whether tile `index` of `cells` strides begins before the last of `size` samples. Divides, since the product could overflow.
bool beginsInside(int index, std::int64_t tileSpan, int size) {
    return index >= 0 && index <= (std::int64_t(size) - 2) / tileSpan;
}

}  // namespace

/// The samples of one axis of a tile: first, first + stride, ... and always `last`, even where the map ends within a stride.
struct MapSource::Span {
    std::int64_t first = 0;
    std::int64_t last = 0;
    std::int64_t stride = 1;

    int count() const { return int((last - first + stride - 1) / stride) + 1; }
    std::int64_t sample(int i) const { return std::min(first + i * stride, last); }
};

int MapSource::levelCount() const {
    const std::int64_t cells = std::int64_t(std::max(map_.columns, map_.rows)) - 1;
    int levels = 1;
    while ((std::int64_t(1) << (levels - 1)) < cells) ++levels;
    return levels;
}

Result<HeightTile> MapSource::load(const TileKey& key) const {
    const auto outside = [&](const std::string& expected) {
        return Error{"tile", expected,
                     "level " + std::to_string(key.level) + ", column " + std::to_string(key.column) + ", row " +
                         std::to_string(key.row) + ", cells " + std::to_string(key.cells)};
    };
    if (key.level < 0 || key.level >= levelCount()) return outside("a level from 0 to " + std::to_string(levelCount() - 1));
    if (key.cells < 1) return outside("at least 1 cell");
    const std::int64_t stride = std::int64_t(1) << key.level;
    const std::int64_t tileSpan = stride * key.cells;
    if (!beginsInside(key.column, tileSpan, map_.columns) || !beginsInside(key.row, tileSpan, map_.rows))
        return outside("a tile inside a map of " + std::to_string(map_.columns) + " x " + std::to_string(map_.rows));

    const auto spanOf = [&](int index, int size) {
        const std::int64_t first = index * tileSpan;
        return Span{first, std::min(first + tileSpan, std::int64_t(size) - 1), stride};
    };
    const Span columns = spanOf(key.column, map_.columns), rows = spanOf(key.row, map_.rows);
    HeightTile tile;
    tile.key = key;
    tile.columns = columns.count();
    tile.rows = rows.count();
    tile.heights.reserve(std::size_t(tile.columns) * std::size_t(tile.rows));
    for (int row = 0; row < tile.rows; ++row)
        for (int column = 0; column < tile.columns; ++column)
            tile.heights.push_back(map_.at(int(columns.sample(column)), int(rows.sample(row))));
    measure(tile, columns, rows);
    return tile;
}

void MapSource::measure(HeightTile& tile, const Span& columns, const Span& rows) const {
    // Comparisons with NaN are false, so holes drop out by themselves.
    float minimum = std::numeric_limits<float>::infinity();
    float maximum = -minimum;
    // So much of a map in scratch space is resident at a time.
    constexpr int kBand = 64;
    const std::int64_t rowCount = rows.last - rows.first + 1;
    for (std::int64_t row = rows.first; row <= rows.last; ++row) {
        for (std::int64_t column = columns.first; column <= columns.last; ++column) {
            const float height = map_.at(int(column), int(row));
            if (height < minimum) minimum = height;
            if (height > maximum) maximum = height;
        }
        if (rowCount > kBand && (row - rows.first) % kBand == kBand - 1) map_.releaseRows(int(row) - kBand + 1, kBand);
    }
    const bool empty = minimum > maximum;
    tile.minimum = empty ? std::numeric_limits<float>::quiet_NaN() : minimum;
    tile.maximum = empty ? std::numeric_limits<float>::quiet_NaN() : maximum;
}

void MapSource::setHeights(const SampleRect& rect, const float* heights) {
    if (rect.isEmpty()) return;
    GridEdits edits;
    edits.add(rect);
    const SampleGate::Editing editing(gate_);
    float* samples = map_.heights.change();
    for (int row = rect.low.y; row <= rect.high.y; ++row) {
        float* to = samples + std::size_t(row) * std::size_t(map_.columns) + std::size_t(rect.low.x);
        for (int i = 0; i < rect.columns(); ++i, ++to) {
            const float height = *heights++;
            const bool isHole = !std::isfinite(height);
            edits.holes = edits.holes || isHole == std::isfinite(*to);
            *to = isHole ? std::numeric_limits<float>::quiet_NaN() : height;
        }
    }
    edits_.add(edits);
}

void MapSource::place(glm::dvec2 origin, glm::dvec2 spacing) {
    const SampleGate::Editing editing(gate_);
    map_.origin = origin;
    map_.spacing = spacing;
}

Result<std::shared_ptr<MapSource>> MapSource::copy() const {
    auto heights = map_.heights.copy();
    if (!heights) return heights.error();
    return std::make_shared<MapSource>(
        HeightMap{map_.columns, map_.rows, std::move(heights).value(), map_.origin, map_.spacing, map_.projection});
}

Result<std::shared_ptr<const HeightSource>> makeMapSource(HeightMap map) {
    const std::string size = std::to_string(map.columns) + " x " + std::to_string(map.rows);
    if (map.columns < 2 || map.rows < 2) return Error{"height map", "at least 2 x 2 samples", size};
    if (map.heights.size() != std::uint64_t(map.columns) * std::uint64_t(map.rows))
        return Error{"height map", std::to_string(std::uint64_t(map.columns) * std::uint64_t(map.rows)) + " samples for " + size,
                     std::to_string(map.heights.size())};
    return std::shared_ptr<const HeightSource>(std::make_shared<MapSource>(std::move(map)));
}

}  // namespace terrain
