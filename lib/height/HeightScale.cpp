#include "height/HeightScale.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace terrain {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Calls visit(first, count) for the samples of some rows after others, whose pages go again.
template <class Visit>
void forEachBand(const HeightMap& map, Visit visit) {
    constexpr int kBand = 64;
    for (int row = 0; row < map.rows; row += kBand) {
        const int rows = std::min(kBand, map.rows - row);
        visit(std::size_t(row) * std::size_t(map.columns), std::size_t(rows) * std::size_t(map.columns));
        map.releaseRows(row, rows);
    }
}

}  // namespace

HeightRange::HeightRange(const HeightMap& map) : low(kInfinity), high(-kInfinity) {
    forEachBand(map, [&](std::size_t first, std::size_t count) {
        // Comparisons with a hole's NaN are false.
        for (std::size_t i = first; i < first + count; ++i) {
            const float height = map.heights[i];
            if (height < low) low = height;
            if (height > high) high = height;
        }
    });
}

double HeightRange::rounding() const {
    if (!(low < high)) return kInfinity;
    const double largest = std::max(std::abs(double(low)), std::abs(double(high)));
    return 0.5 * double(std::numeric_limits<float>::epsilon()) * largest / (double(high) - double(low));
}

bool HeightScale::leadsTo(const HeightScale& other, const HeightRange& range) const {
    if (scale == 0.0f || !std::isfinite(scale + offset) || !std::isfinite(other.scale + other.offset)) return false;
    if (range.low > range.high) return true;
    return std::isfinite(float(converted(range.low, other))) && std::isfinite(float(converted(range.high, other)));
}

Result<std::shared_ptr<MapSource>> rescaled(const MapSource& source, const HeightScale& from, const HeightScale& to) {
    const HeightMap& map = *source.map();
    auto heights = map.heights.copy();
    if (!heights) return heights.error();
    HeightMap scaled{map.columns, map.rows, std::move(heights).value(), map.origin, map.spacing, map.projection};
    float* const samples = scaled.heights.change();
    forEachBand(scaled, [&](std::size_t first, std::size_t count) {
        for (std::size_t i = first; i < first + count; ++i) samples[i] = float(from.converted(samples[i], to));
    });
    return std::make_shared<MapSource>(std::move(scaled));
}

}  // namespace terrain
