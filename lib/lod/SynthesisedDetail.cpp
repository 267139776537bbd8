#include "lod/SynthesisedDetail.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/common.hpp>

namespace terrain {

namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// The four-point subdivision of b and c, with a before and d after them. As 9 (b + c) - (a + d) of 16ths, but all products are
/// exact.
inline float subdivision(float a, float b, float c, float d) {
    const float inner = b + c;
    return 0.5f * inner + 0.0625f * (inner - (a + d));
}

inline float subdivisionOfThoseThere(float a, float b, float c, float d) {
    return subdivision(std::isnan(a) ? b : a, b, c, std::isnan(d) ? c : d);
}

/// Quantiles of the standard normal distribution at the middles of equal shares, scaled to variance 1 and rounded to 2^-16: so they
/// do not depend on the last digits of a library's erfc.
SynthesisedDetail::NoiseTable makeQuantiles() {
    constexpr int count = SynthesisedDetail::kNoiseValues;
    std::array<double, count / 2> upper;
    double squares = 0.0;
    for (int i = 0; i < count / 2; ++i) {
        const double above = (count / 2 - i - 0.5) / count;
        double low = 0.0, high = 8.0;
        for (int step = 0; step < 52; ++step) {
            const double middle = (low + high) / 2;
            (0.5 * std::erfc(middle / std::sqrt(2.0)) > above ? low : high) = middle;
        }
        upper[std::size_t(i)] = low;
        squares += 2.0 * low * low;
    }
    SynthesisedDetail::NoiseTable table;
    for (std::size_t i = 0; i < count / 2; ++i) {
        const float value = float(std::round(upper[i] * std::sqrt(count / squares) * 65536.0) / 65536.0);
        table[count / 2 + i] = value;
        table[count / 2 - 1 - i] = -value;
    }
    return table;
}

const SynthesisedDetail::NoiseTable& quantiles() {
    static const SynthesisedDetail::NoiseTable table = makeQuantiles();
    return table;
}

ClipRect domain(const SampleGrid& grid, int level) {
    return {glm::ivec2(0), SynthesisedDetail::lastVertex(grid, level)};
}

/// A row of a level on columns `low` to `high`, from the coarser level's row, which begins at `first` and is cut at `last`.
void refineRow(const float* coarser, int first, int last, int low, int high, float* out) {
    for (int x = low; x <= high; ++x) {
        const int k = x >> 1;
        const float* at = coarser + (k - first);
        *out++ = x % 2 == 0 ? at[0] : subdivisionOfThoseThere(k > 0 ? at[-1] : at[0], at[0], at[1], k + 2 <= last ? at[2] : at[1]);
    }
}

}  // namespace

SynthesisedDetail::SynthesisedDetail(const SampleGrid& grid, const DetailShape& shape) : seed_(shape.seed) {
    if (!grid.isRegular()) return;
    levels_ = std::clamp(shape.levels, 0, ClipmapShape::kMostDetail);
    while (levels_ > 0 && (std::int64_t(std::max(grid.columns(), grid.rows())) << levels_) > (1 << 30)) --levels_;
    if (levels_ == 0) return;
    const bool given = std::isfinite(shape.amplitude) && shape.amplitude != 0.0f;
    amplitude_ = given ? std::max(shape.amplitude, 0.0f) : detailAmplitudeOf(grid);
    for (std::size_t i = 0; i < table_.size(); ++i) table_[i] = amplitude_ * quantiles()[i];
}

/// pcg3d of Jarzynski and Olano, "Hash Functions for GPU Rendering", 2020.
std::uint32_t SynthesisedDetail::noiseIndex(glm::ivec2 vertex, int level, std::uint32_t seed) {
    std::uint32_t x = std::uint32_t(vertex.x) * 1664525u + 1013904223u;
    std::uint32_t y = std::uint32_t(vertex.y) * 1664525u + 1013904223u;
    std::uint32_t z = (seed + std::uint32_t(level) * 0x9E3779B9u) * 1664525u + 1013904223u;
    x += y * z;
    y += z * x;
    z += x * y;
    x ^= x >> 16;
    y ^= y >> 16;
    z ^= z >> 16;
    // Of the second round only x is wanted.
    x += y * z;
    return (x >> 16) % kNoiseValues;
}

ClipRect SynthesisedDetail::coarserNeeded(const SampleGrid& grid, int level, const ClipRect& rect) {
    return ClipRect{(rect.low >> 1) - 1, ((rect.high + 1) >> 1) + 1}.cutTo(domain(grid, level - 1));
}

void SynthesisedDetail::refine(const SampleGrid& grid, int level, const ClipRect& rect, const ClipRect& coarser,
                               const float* coarserHeights, float* out) const {
    const glm::ivec2 last = lastVertex(grid, level - 1);
    const int columns = rect.columns();
    // The four coarser rows around an odd one, each refined along itself once, by the last two bits of their numbers.
    std::vector<float> rows(std::size_t(columns) * 4);
    int made[4] = {-1, -1, -1, -1};
    const auto refined = [&](int k) {
        float* row = rows.data() + std::size_t(k & 3) * std::size_t(columns);
        if (made[k & 3] != k) {
            const float* from = coarserHeights + std::ptrdiff_t(k - coarser.low.y) * coarser.columns();
            refineRow(from, coarser.low.x, last.x, rect.low.x, rect.high.x, row);
            made[k & 3] = k;
        }
        return row;
    };
    const float scale = noiseScale(level);
    for (int y = rect.low.y; y <= rect.high.y; ++y, out += columns) {
        const int k = y >> 1;
        if (y % 2 == 0) {
            std::copy_n(refined(k), columns, out);
        } else {
            const float* a = refined(std::max(k - 1, 0));
            const float *b = refined(k), *c = refined(k + 1), *d = refined(std::min(k + 2, last.y));
            for (int i = 0; i < columns; ++i) out[i] = subdivisionOfThoseThere(a[i], b[i], c[i], d[i]);
        }
        const int step = y % 2 == 0 ? 2 : 1, first = y % 2 == 0 ? 1 - rect.low.x % 2 : 0;
        for (int i = first; i < columns; i += step) out[i] += scale * table_[noiseIndex({rect.low.x + i, y}, level, seed_)];
    }
}

void SynthesisedDetail::readSamples(const SampleGrid& grid, const ClipRect& rect, float* out) const {
    const std::size_t stride = grid.heightStride();
    for (int y = rect.low.y; y <= rect.high.y; ++y) {
        const float* row = grid.heightRow(y);
        for (int x = rect.low.x; x <= rect.high.x; ++x) {
            const float height = row[std::size_t(x) * stride];
            *out++ = std::isfinite(height) ? height : kNaN;
        }
    }
}

void SynthesisedDetail::fillWithin(const SampleGrid& grid, int level, const ClipRect& rect, float* out) const {
    if (level == 0) return readSamples(grid, rect, out);
    const ClipRect coarser = coarserNeeded(grid, level, rect);
    std::vector<float> heights(std::size_t(coarser.samples()));
    fillWithin(grid, level - 1, coarser, heights.data());
    refine(grid, level, rect, coarser, heights.data(), out);
}

void SynthesisedDetail::fill(const SampleGrid& grid, int level, const ClipRect& rect, float* out) const {
    if (rect.isEmpty()) return;
    const glm::ivec2 last = lastVertex(grid, level);
    const ClipRect within{glm::clamp(rect.low, glm::ivec2(0), last), glm::clamp(rect.high, glm::ivec2(0), last)};
    if (within == rect) return fillWithin(grid, level, rect, out);
    std::vector<float> heights(std::size_t(within.samples()));
    fillWithin(grid, level, within, heights.data());
    for (int y = rect.low.y; y <= rect.high.y; ++y) {
        const float* row = heights.data() + std::ptrdiff_t(std::clamp(y, 0, last.y) - within.low.y) * within.columns();
        for (int x = rect.low.x; x <= rect.high.x; ++x) *out++ = row[std::clamp(x, 0, last.x) - within.low.x];
    }
}

float SynthesisedDetail::height(const SampleGrid& grid, double column, double row) const {
    const glm::ivec2 last = grid.isRegular() ? lastVertex(grid, levels_) : glm::ivec2(-1);
    const double x = column * double(1 << levels_), y = row * double(1 << levels_);
    if (!(x >= 0.0 && y >= 0.0 && x <= last.x && y <= last.y)) return kNaN;
    const glm::ivec2 low(std::min(int(x), last.x - 1), std::min(int(y), last.y - 1));
    float z[4];
    fill(grid, levels_, {low, low + 1}, z);
    if (std::isnan(z[0] + z[1] + z[2] + z[3])) return kNaN;
    const double u = x - low.x, v = y - low.y, z00 = z[0], z10 = z[1], z01 = z[2], z11 = z[3];
    if (u + v <= 1.0) return float(z00 + u * (z10 - z00) + v * (z01 - z00));
    return float(z11 + (1.0 - u) * (z01 - z11) + (1.0 - v) * (z10 - z11));
}

SynthesisedDetail::Sums SynthesisedDetail::sums(int level, float step, bool holes) const {
    const float strongest = *std::max_element(table_.begin(), table_.end());
    Sums sums{0.0f, 0.0f};
    if (level < levels_ && !holes) {
        const float bend = kBend * (1.0f + kGain) * step;
        sums = {bend + 0.5f * step, bend};
    }
    for (int d = level + 1; d <= levels_; ++d) {
        const float noise = strongest * noiseScale(d);
        if (holes) {
            sums.deviation += 25.0f / 32.0f * step + noise;
            sums.overshoot += 9.0f / 32.0f * step + noise;
            step = 25.0f / 32.0f * step + 2.0f * noise;
        } else {
            const float grown = d < levels_ ? noise * kGain * kGain : noise;
            sums.deviation += grown;
            sums.overshoot += grown;
        }
    }
    return sums;
}

float detailAmplitudeOf(const SampleGrid& grid) {
    if (!grid.isRegular()) return 0.0f;
    // Blocks of four samples, three of them between the others, and of these at most 2^20. Only where all that predicts is there.
    const double blocks = double(grid.columns() / 2) * double(grid.rows() / 2);
    const int step = 2 * int(std::ceil(std::sqrt(std::max(1.0, 3.0 * blocks / (1 << 20)))));
    const auto alongRow = [&](int x, int y) {
        return subdivision(grid.height(x - 2, y), grid.height(x, y), grid.height(x + 2, y), grid.height(x + 4, y));
    };
    const auto alongColumn = [&](int x, int y) {
        return subdivision(grid.height(x, y - 2), grid.height(x, y), grid.height(x, y + 2), grid.height(x, y + 4));
    };
    double sum = 0.0, squares = 0.0, count = 0.0;
    const auto add = [&](int x, int y, float prediction) {
        const double residual = double(grid.height(x, y)) - double(prediction);
        if (!std::isfinite(residual)) return;
        sum += residual;
        squares += residual * residual;
        ++count;
    };
    for (int y = 2; y + 4 < grid.rows(); y += step)
        for (int x = 2; x + 4 < grid.columns(); x += step) {
            add(x + 1, y, alongRow(x, y));
            add(x, y + 1, alongColumn(x, y));
            add(x + 1, y + 1, subdivision(alongRow(x, y - 2), alongRow(x, y), alongRow(x, y + 2), alongRow(x, y + 4)));
        }
    if (count == 0.0) return 0.0f;
    const double mean = sum / count;
    return float(0.5 * std::sqrt(std::max(0.0, squares / count - mean * mean)));
}

}  // namespace terrain
