#include "lod/ClipmapScan.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <glm/geometric.hpp>

#include "base/VectorClones.h"
#include "lod/ClipmapSurface.h"

namespace terrain {

namespace {

struct Ramp {
    const float *base, *slope, *fold;
};

__attribute__((always_inline)) inline float larger(float a, float b) {
    return a > b ? a : b;
}
__attribute__((always_inline)) inline float along(const Ramp& ramp, std::size_t i, float u, float past) {
    return ramp.base[i] + u * ramp.slope[i] + past * ramp.fold[i];
}

SOTERRAIN_VECTOR_CLONES
void deviate(std::size_t count, const float* heights, const float* turn, float u, const Ramp* ramps, float* plain) {
    const Ramp surface = ramps[0];
#pragma omp simd
    for (std::size_t i = 0; i < count; ++i)
        plain[i] = larger(plain[i], std::fabs(along(surface, i, u, larger(0.0f, u - turn[i])) - heights[i]));
}

SOTERRAIN_VECTOR_CLONES
void deviateBlending(std::size_t count, const float* heights, const float* turn, float u, const Ramp* ramps, float* plain,
                     float* blending) {
    const Ramp surface = ramps[0], rising = ramps[1], falling = ramps[2];
#pragma omp simd
    for (std::size_t i = 0; i < count; ++i) {
        const float past = larger(0.0f, u - turn[i]);
        const float off = along(surface, i, u, past) - heights[i];
        const float up = std::fabs(off + along(rising, i, u, past)), down = std::fabs(off + along(falling, i, u, past));
        plain[i] = larger(plain[i], std::fabs(off));
        blending[i] = larger(blending[i], larger(up, down));
    }
}

SOTERRAIN_VECTOR_CLONES
void deviateInSpace(std::size_t count, const float* xs, const float* ys, const float* zs, const float* turn, float u,
                    const Ramp* ramps, float* plain, float* blending) {
    const Ramp surfaceX = ramps[0], surfaceY = ramps[1], surfaceZ = ramps[2], difference = ramps[3];
#pragma omp simd
    for (std::size_t i = 0; i < count; ++i) {
        const float past = larger(0.0f, u - turn[i]);
        const float x = along(surfaceX, i, u, past) - xs[i], y = along(surfaceY, i, u, past) - ys[i];
        const float z = along(surfaceZ, i, u, past) - zs[i];
        const float off = std::sqrt(x * x + y * y + z * z);
        plain[i] = larger(plain[i], off);
        blending[i] = larger(blending[i], off + along(difference, i, u, past));
    }
}

int blocksAcross(int cells) {
    return std::max(1, (cells - 1) / ClipmapScan::kBlockCells + 1);
}

}  // namespace

ClipmapScan::ClipmapScan(const SampleGrid& grid, int level, bool coarsest)
    : level_(level), blend_(!coarsest), regular_(grid.isRegular()), lastColumn_(grid.columns() - 1), lastRow_(grid.rows() - 1),
      cells_(lastVertex(lastColumn_, level)), blockColumns_(blocksAcross(cells_)),
      blockRows_(blocksAcross(lastVertex(lastRow_, level))) {
    const std::size_t columns = std::size_t(grid.columns());
    if (level_ > 0) {
        turn_.resize(columns);
        for (int x = 0; x <= lastColumn_; ++x) {
            const int low = x >> level_ << level_;
            const auto high = int(std::min(low + (std::int64_t(1) << level_), std::int64_t(lastColumn_)));
            turn_[std::size_t(x)] = x == lastColumn_ ? 1.0f : 1.0f - float(x - low) / float(high - low);
        }
        channels_.resize(!regular_ ? 4 : blend_ ? 3 : 1);
        for (Channel& channel : channels_) {
            for (auto* values : {&channel.low, &channel.high}) values->resize(std::size_t(cells_) + 1);
            for (auto* values : {&channel.base, &channel.slope, &channel.fold}) values->resize(columns);
        }
    }
    if (regular_)
        pairs_.resize(2 * (std::size_t(cells_) + 1));
    else
        positions_.resize(2 * (std::size_t(cells_) + 1));
    for (Peaks* peaks : {&peaks_, &before_}) {
        peaks->plain.resize(columns);
        peaks->blending.resize(columns);
    }
}

void ClipmapScan::addRow(const SampleGrid& grid, const std::array<const float*, 3>& samples) {
    const std::int64_t blockHeight = std::int64_t(kBlockCells) << level_;
    // The row between two rows of blocks belongs to both.
    const bool isBorder = row_ > 0 && row_ < lastRow_ && row_ % blockHeight == 0;
    if (row_ % (std::int64_t(1) << level_) == 0 || row_ == lastRow_) beginCells(grid);
    if (isBorder) {
        std::swap(before_, peaks_);
        std::fill(peaks_.plain.begin(), peaks_.plain.end(), 0.0f);
        std::fill(peaks_.blending.begin(), peaks_.blending.end(), 0.0f);
    }
    measure(samples);
    if (isBorder) {
        for (std::size_t i = 0; i < peaks_.plain.size(); ++i) {
            before_.plain[i] = larger(before_.plain[i], peaks_.plain[i]);
            before_.blending[i] = larger(before_.blending[i], peaks_.blending[i]);
        }
        finishBlocks(before_);
    }
    if (row_ == lastRow_) finishBlocks(peaks_);
    ++row_;
}

void ClipmapScan::beginCells(const SampleGrid& grid) {
    const int vertexRow = row_ == lastRow_ ? lastVertex(lastRow_, level_) : row_ >> level_;
    if (level_ == 0) return readVertices(grid, vertexRow);
    if (row_ == 0) readVertices(grid, 0);
    for (Channel& channel : channels_) channel.low = channel.high;
    // Past the last row there is none, and the last one alone counts.
    if (row_ < lastRow_) readVertices(grid, vertexRow + 1);
    for (Channel& channel : channels_) expand(channel);
    cellRow_ = row_;
    cellHeight_ = int(std::min<std::int64_t>(std::int64_t(1) << level_, std::max(1, lastRow_ - row_)));
}

void ClipmapScan::readVertices(const SampleGrid& grid, int vertexRow) {
    const ClipRect row{{0, vertexRow}, {cells_, vertexRow}};
    if (!regular_) {
        fillLevel(grid, level_, row, positions_.data());
        for (std::size_t i = 0; level_ > 0 && i <= std::size_t(cells_); ++i) {
            const glm::vec3 fine = positions_[2 * i];
            for (int axis = 0; axis < 3; ++axis) channels_[std::size_t(axis)].high[i] = fine[axis];
            channels_[3].high[i] = glm::length(positions_[2 * i + 1] - fine);
        }
        return;
    }
    fillLevel(grid, level_, row, pairs_.data());
    for (std::size_t i = 0; level_ > 0 && i <= std::size_t(cells_); ++i) {
        const float fine = pairs_[2 * i], difference = pairs_[2 * i + 1] - fine;
        channels_[0].high[i] = fine;
        if (!blend_) continue;
        channels_[1].high[i] = difference > 0.0f ? difference : 0.0f;
        channels_[2].high[i] = difference < 0.0f ? difference : 0.0f;
    }
}

void ClipmapScan::expand(Channel& channel) const {
    const std::size_t last = std::size_t(lastColumn_), step = std::size_t(1) << level_;
    for (std::size_t cell = 0, x = 0; x < last; ++cell) {
        const float low = channel.low[cell], width = channel.low[cell + 1] - low;
        const float slope = channel.high[cell] - low, fold = channel.high[cell + 1] - channel.low[cell + 1] - slope;
        for (const std::size_t end = std::min(x + step, last); x < end; ++x) {
            channel.base[x] = low + (1.0f - turn_[x]) * width;
            channel.slope[x] = slope;
            channel.fold[x] = fold;
        }
    }
    channel.base[last] = channel.low.back();
    channel.slope[last] = channel.high.back() - channel.low.back();
    channel.fold[last] = 0.0f;
}

void ClipmapScan::measure(const std::array<const float*, 3>& samples) {
    const std::size_t count = turn_.size();
    float *plain = peaks_.plain.data(), *blending = peaks_.blending.data();
    if (level_ == 0) {
        if (!blend_) return;
        for (std::size_t i = 0; i < peaks_.blending.size(); ++i)
            blending[i] = larger(blending[i], regular_ ? std::fabs(pairs_[2 * i + 1] - pairs_[2 * i])
                                                       : glm::length(positions_[2 * i + 1] - positions_[2 * i]));
        return;
    }
    Ramp ramps[4] = {};
    for (std::size_t i = 0; i < channels_.size(); ++i)
        ramps[i] = {channels_[i].base.data(), channels_[i].slope.data(), channels_[i].fold.data()};
    const float u = float(row_ - cellRow_) / float(cellHeight_);
    if (!regular_)
        deviateInSpace(count, samples[0], samples[1], samples[2], turn_.data(), u, ramps, plain, blending);
    else if (blend_)
        deviateBlending(count, samples[0], turn_.data(), u, ramps, plain, blending);
    else
        deviate(count, samples[0], turn_.data(), u, ramps, plain);
}

void ClipmapScan::finishBlocks(const Peaks& peaks) {
    if (level_ > 0) finishBlocks(peaks.plain, plain_);
    if (blend_) finishBlocks(peaks.blending, blending_);
}

void ClipmapScan::finishBlocks(const std::vector<float>& peaks, std::vector<float>& blocks) const {
    const std::int64_t width = std::int64_t(kBlockCells) << level_;
    for (int block = 0; block < blockColumns_; ++block) {
        const auto first = peaks.begin() + block * width,
                   last = peaks.begin() + std::min<std::int64_t>((block + 1) * width, lastColumn_);
        blocks.push_back(*std::max_element(first, last + 1));
    }
}

}  // namespace terrain
