// Terrain finer than its samples, made up in place.
#pragma once

#include <array>
#include <cstdint>

#include <glm/vec2.hpp>

#include "height/SampleGrid.h"
#include "lod/ClipmapLayout.h"

namespace terrain {

/// What a user chooses of detail.
struct DetailShape {
    int levels = 0;  ///< finer than the samples, each with twice the vertices along an axis; at most ClipmapShape::kMostDetail
    float amplitude = 0.0f;  ///< standard deviation of level 1's noise, in heights of the grid; 0: from the data, < 0: no noise
    std::uint32_t seed = 0;

    bool operator==(const DetailShape&) const = default;
};

/// Synthesis by subdivision and noise (Losasso and Hoppe: "Geometry clipmaps", 2004, sect. 5): the same ground whenever, in
/// whichever parts and wherever, on the CPU or the GPU (see gl/DetailShader.h), it is computed.
///
/// Level 0 is the samples; level d has a vertex every 2^-d samples, from (0, 0) to lastVertex(d). Its even vertices are those of
/// level d - 1, unchanged. One that is odd on an axis is the four-point subdivision (-a + 9 b + 9 c - d) / 16 of those around it,
/// rows first and then columns where it is odd on both, plus Gaussian noise of standard deviation amplitude * 2^-(d - 1). Where a
/// is beyond the grid or in a hole it is taken to be b, and d to be c: so no level reaches over a border, a cell of samples with a
/// hole is one on every level, and a cell without one is none.
///
/// The order of operations leaves nothing to round differently, whether or not products are fused with sums: factors but the
/// amplitude are powers of two, and that one is in the table of the noise.
class SynthesisedDetail {
public:
    static constexpr int kNoiseValues = 1024;
    using NoiseTable = std::array<float, kNoiseValues>;

    /// Of a grid that is passed to every call; nothing of it is kept. Curved grids get no levels, and very large ones as few as
    /// make lastVertex() an int. Without an amplitude this reads up to 2^20 samples.
    SynthesisedDetail(const SampleGrid& grid, const DetailShape& shape);

    int levels() const { return levels_; }
    /// The one used, from 0 on.
    float amplitude() const { return amplitude_; }
    std::uint32_t seed() const { return seed_; }
    static glm::ivec2 lastVertex(const SampleGrid& grid, int level) {
        return glm::ivec2(grid.columns() - 1, grid.rows() - 1) << level;
    }

    /// Heights of the vertices `rect` of a level, row after row, to `out`; NaN in holes. Vertices beyond the grid are the nearest
    /// ones in it. Costs about as much as there are vertices, plus a few along the perimeter on each coarser level.
    void fill(const SampleGrid& grid, int level, const ClipRect& rect, float* out) const;
    /// The same for a `rect` in the grid from heights of the coarser level, all those of coarserNeeded().
    void refine(const SampleGrid& grid, int level, const ClipRect& rect, const ClipRect& coarser, const float* coarserHeights,
                float* out) const;
    /// What of level - 1 makes `rect` of a level: half of it and up to two vertices around, cut to the grid.
    static ClipRect coarserNeeded(const SampleGrid& grid, int level, const ClipRect& rect);

    /// Height of the finest level's triangles (diagonals from (1, 0) to (0, 1), as kCellTriangles) over a place in samples, which
    /// need not be whole; NaN outside of the grid and in a hole.
    float height(const SampleGrid& grid, double column, double row) const;

    /// The noise at a vertex of a level from 1 on, whether or not it gets any.
    float noise(glm::ivec2 vertex, int level) const { return table_[noiseIndex(vertex, level, seed_)] * noiseScale(level); }
    static std::uint32_t noiseIndex(glm::ivec2 vertex, int level, std::uint32_t seed);
    static float noiseScale(int level) { return 1.0f / float(1 << (level - 1)); }
    /// Noise of level 1 by noiseIndex(): quantiles of the normal distribution, times the amplitude.
    const NoiseTable& noiseTable() const { return table_; }

    /// How far the detail's heights lie from the full-resolution surface of the samples at the most, where neighbouring samples
    /// differ by `step` or less within two samples around. Larger where a hole may be among these. Rounding (levels() * 4 ulp) is
    /// not in it.
    ///
    /// Subdivision of a row, however it ends, makes largest heights kGain times as large at most, and of steps D heights within
    /// kBend D of the straight lines (sums over its weights, which a test adds up). So those of rows and then columns are within
    /// kBend (1 + kGain) D of the bilinear interpolation, which is within D / 2 of the cell's triangles; and noise grows by kGain
    /// on each axis.
    ///
    /// Which weights there are in the midst of holes depends on both axes. Whichever of a and d there are, new heights of a row are
    /// within D / 8 of the middle of their neighbours and 5 / 8 D of each. Columns of such rows have steps 5 / 4 D, so heights odd
    /// on both axes are within 9 / 32 D of a mean of four, within 25 / 32 D of the diagonal, and of their neighbours too; noise n
    /// adds n, and 2 n to steps. That is summed over the levels.
    float largest(float step, bool holes = true) const { return sums(0, step, holes).deviation; }
    /// How far the finest level's heights in a cell of `level` lie outside of the range of its corners, likewise: steps and holes
    /// are those of that level, within two of its vertices around.
    float overshoot(int level, float step, bool holes = true) const { return sums(level, step, holes).overshoot; }

    static constexpr float kGain = 1.2512f;
    static constexpr float kBend = 0.1412f;

private:
    struct Sums {
        float deviation;
        float overshoot;
    };
    Sums sums(int level, float step, bool holes) const;
    void readSamples(const SampleGrid& grid, const ClipRect& rect, float* out) const;
    void fillWithin(const SampleGrid& grid, int level, const ClipRect& rect, float* out) const;

    int levels_ = 0;
    float amplitude_ = 0.0f;
    std::uint32_t seed_ = 0;
    NoiseTable table_{};
};

/// Half the standard deviation of what the four-point subdivision of every second sample leaves of the samples between: of a
/// self-similar terrain, what it would leave of the next finer ones. 0 for a curved grid, and for one with fewer than 7 samples
/// along an axis.
float detailAmplitudeOf(const SampleGrid& grid);

}  // namespace terrain
