// The height source over a map.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "height/HeightSource.h"

namespace terrain {

namespace {

/// The samples of one axis of a tile: first, first + stride, ... and always `last`, even where the map ends within a stride.
struct Span {
    std::int64_t first = 0;
    std::int64_t last = 0;
    std::int64_t stride = 1;

    int count() const { return int((last - first + stride - 1) / stride) + 1; }
    std::int64_t sample(int i) const { return std::min(first + i * stride, last); }
};

/// Whether tile `index` of `cells` strides begins before the last of `size` samples. Divides, since the product could overflow.
bool beginsInside(int index, std::int64_t tileSpan, int size) {
    return index >= 0 && index <= (std::int64_t(size) - 2) / tileSpan;
}

Span spanOf(int index, std::int64_t tileSpan, std::int64_t stride, int size) {
    const std::int64_t first = index * tileSpan;
    return {first, std::min(first + tileSpan, std::int64_t(size) - 1), stride};
}

class MapSource : public HeightSource {
public:
    explicit MapSource(HeightMap map) : map_(std::move(map)) {}

    HeightExtent extent() const override { return {map_.columns, map_.rows, map_.origin, map_.spacing}; }

    int levelCount() const override {
        const std::int64_t cells = std::int64_t(std::max(map_.columns, map_.rows)) - 1;
        int levels = 1;
        while ((std::int64_t(1) << (levels - 1)) < cells) ++levels;
        return levels;
    }

    Result<HeightTile> load(const TileKey& key) const override;
    const HeightMap* map() const override { return &map_; }

    std::size_t bytes() const override { return sizeof *this + map_.heights.memoryBytes() + map_.projection.capacity(); }

private:
    void measure(HeightTile& tile, const Span& columns, const Span& rows) const;

    HeightMap map_;
};

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

    const Span columns = spanOf(key.column, tileSpan, stride, map_.columns);
    const Span rows = spanOf(key.row, tileSpan, stride, map_.rows);
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

}  // namespace

Result<std::shared_ptr<const HeightSource>> makeMapSource(HeightMap map) {
    const std::string size = std::to_string(map.columns) + " x " + std::to_string(map.rows);
    if (map.columns < 2 || map.rows < 2) return Error{"height map", "at least 2 x 2 samples", size};
    if (map.heights.size() != std::uint64_t(map.columns) * std::uint64_t(map.rows))
        return Error{"height map", std::to_string(std::uint64_t(map.columns) * std::uint64_t(map.rows)) + " samples for " + size,
                     std::to_string(map.heights.size())};
    return std::shared_ptr<const HeightSource>(std::make_shared<MapSource>(std::move(map)));
}

}  // namespace terrain
