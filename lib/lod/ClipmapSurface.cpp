#include "lod/ClipmapSurface.h"

#include <cmath>

namespace terrain {

namespace {

bool isFinite(float value) {
    // One subtraction, which a compiler can do for many values at once.
    return value - value == 0.0f;
}
bool isFinite(const glm::vec3& p) {
    return isFinite(p.x) && isFinite(p.y) && isFinite(p.z);
}

/// Exact at both ends, and the mean at one half.
template <class Value>
Value between(const Value& a, const Value& b, float share) {
    return share == 0.5f ? (a + b) * 0.5f : a + (b - a) * share;
}

/// The coarser surface at (x, y), by a function from samples to values; `fine` where it is not there.
template <class Value, class At>
Value coarser(const ClipmapStation& x, const ClipmapStation& y, const Value& fine, const At& at) {
    if (x.low == x.high && y.low == y.high) return fine;
    Value value;
    if (y.low == y.high) {
        value = between(at(x.low, y.place), at(x.high, y.place), x.share);
    } else if (x.low == x.high) {
        value = between(at(x.place, y.low), at(x.place, y.high), y.share);
    } else if (x.share == 0.5f && y.share == 0.5f) {
        value = between(at(x.high, y.low), at(x.low, y.high), 0.5f);
    } else {
        // Shares are at least one half, so that what the border cuts lies beyond the diagonal.
        const Value corner = at(x.high, y.high);
        value = corner + (at(x.low, y.high) - corner) * (1.0f - x.share) + (at(x.high, y.low) - corner) * (1.0f - y.share);
    }
    return isFinite(value) ? value : fine;
}

ClipmapStation columnAt(const SampleGrid& grid, int sourceLevel, int vertex) {
    return clipmapStation(grid.columns() - 1, sourceLevel, vertex);
}
ClipmapStation rowAt(const SampleGrid& grid, int sourceLevel, int vertex) {
    return clipmapStation(grid.rows() - 1, sourceLevel, vertex);
}

/// One row of pairs, from vertex `first` on; all coarser edges along it are whole. `fine`, `low`, `high`: heights of the vertices'
/// own row and of the coarser rows around it, the same one where they coincide.
void fillWhole(const float* fine, const float* low, const float* high, float share, std::size_t step, int first, int count,
               float* pairs) {
    const bool onRow = low == high, inMiddle = share == 0.5f;
    for (int i = 0; i < count; ++i) {
        const std::size_t at = std::size_t(first + i) * step;
        const float own = fine[at];
        float value = own;
        if ((first + i) % 2 == 0) {
            if (!onRow) value = between(low[at], high[at], share);
        } else if (onRow) {
            value = (fine[at - step] + fine[at + step]) * 0.5f;
        } else if (inMiddle) {
            value = (low[at + step] + high[at - step]) * 0.5f;
        } else {
            const float corner = high[at + step];
            value = corner + (high[at - step] - corner) * 0.5f + (low[at + step] - corner) * (1.0f - share);
        }
        pairs[2 * i] = own;
        pairs[2 * i + 1] = isFinite(value) ? value : own;
    }
}

}  // namespace

float levelHeight(const SampleGrid& grid, int sourceLevel, glm::ivec2 vertex) {
    return grid.height(columnAt(grid, sourceLevel, vertex.x).place, rowAt(grid, sourceLevel, vertex.y).place);
}

float coarserHeight(const SampleGrid& grid, int sourceLevel, glm::ivec2 vertex) {
    const ClipmapStation x = columnAt(grid, sourceLevel, vertex.x), y = rowAt(grid, sourceLevel, vertex.y);
    return coarser(x, y, grid.height(x.place, y.place), [&grid](int column, int row) { return grid.height(column, row); });
}

glm::vec3 levelPosition(const SampleGrid& grid, int sourceLevel, glm::ivec2 vertex) {
    return grid.position(columnAt(grid, sourceLevel, vertex.x).place, rowAt(grid, sourceLevel, vertex.y).place);
}

glm::vec3 coarserPosition(const SampleGrid& grid, int sourceLevel, glm::ivec2 vertex) {
    const ClipmapStation x = columnAt(grid, sourceLevel, vertex.x), y = rowAt(grid, sourceLevel, vertex.y);
    return coarser(x, y, grid.position(x.place, y.place), [&grid](int column, int row) { return grid.position(column, row); });
}

void fillLevel(const SampleGrid& grid, int sourceLevel, const ClipRect& rect, float* fineAndCoarse) {
    if (rect.isEmpty()) return;
    const auto at = [&grid](int column, int row) { return grid.height(column, row); };
    // Vertices from 0 on whose coarser edge lies within the grid.
    const int whole = 2 * int((std::int64_t(grid.columns()) - 1) >> (sourceLevel + 1));
    const int first = std::clamp(0, rect.low.x, rect.high.x + 1), last = std::clamp(whole, first, rect.high.x + 1);
    const std::size_t step = grid.heightStride() << sourceLevel;
    for (int row = rect.low.y; row <= rect.high.y; ++row) {
        const ClipmapStation y = rowAt(grid, sourceLevel, row);
        const auto single = [&](int column, float* pair) {
            const ClipmapStation x = columnAt(grid, sourceLevel, column);
            pair[0] = at(x.place, y.place);
            pair[1] = coarser(x, y, pair[0], at);
        };
        float* pairs = fineAndCoarse + std::size_t(row - rect.low.y) * std::size_t(rect.columns()) * 2;
        for (int column = rect.low.x; column < first; ++column) single(column, pairs + 2 * (column - rect.low.x));
        fillWhole(grid.heightRow(y.place), grid.heightRow(y.low), grid.heightRow(y.high), y.share, step, first, last - first,
                  pairs + 2 * (first - rect.low.x));
        for (int column = last; column <= rect.high.x; ++column) single(column, pairs + 2 * (column - rect.low.x));
    }
}

void fillLevel(const SampleGrid& grid, int sourceLevel, const ClipRect& rect, glm::vec3* fineAndCoarse) {
    const auto at = [&grid](int column, int row) { return grid.position(column, row); };
    for (int row = rect.low.y; row <= rect.high.y; ++row)
        for (int column = rect.low.x; column <= rect.high.x; ++column) {
            const ClipmapStation x = columnAt(grid, sourceLevel, column), y = rowAt(grid, sourceLevel, row);
            *fineAndCoarse++ = at(x.place, y.place);
            *fineAndCoarse = coarser(x, y, fineAndCoarse[-1], at);
            ++fineAndCoarse;
        }
}

}  // namespace terrain
