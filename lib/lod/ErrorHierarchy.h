// For every diamond of a grid, the exact error of drawing it flat.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

#include "height/SampleGrid.h"
#include "height/SampleRect.h"
#include "lod/BoxPyramid.h"
#include "lod/DiamondTopology.h"

namespace terrain {

/// The error of a diamond is the largest deviation of any full-resolution sample that its two triangles cover (corners, sides and
/// interior) from those triangles drawn flat: vertically for a regular grid, in space, at equal parameters, for a curved one. It is
/// exact, not the sum of deviations along the hierarchy that ROAM's wedgies are, and then made monotone: at least as large as every
/// child's, so that refining by it never has to look ahead.
///
/// The grid is embedded in the square of (2^n + 1)^2 vertices. A diamond with a triangle that lies partly outside of the grid or
/// partly in a hole has an infinite error and so is always split. A cell is a hole when any of its four samples is.
///
/// The finest diamonds, half of all, cover nothing but their corners and centre: their error is computed when it is asked for. The
/// others are stored in 2 bytes, so that the whole takes 1 byte a sample: the upper half of a float, rounded up, so that what is
/// stored is never smaller than what was measured and at most 0.4 % larger. Building visits every sample about twice for each of
/// the 2 n levels: O(N log N).
class ErrorHierarchy {
public:
    ErrorHierarchy() = default;
    explicit ErrorHierarchy(const SampleGrid& grid);

    /// Samples within `rect` have changed, of a grid of the same size and kind: brings up to date what depends on them. Bit for bit
    /// what building it anew gives. `boxes` are up to date. Of large diamonds of a regular grid it looks only where heights by these
    /// may be further off than what is known already (TriangleSearch.h); of a curved one it goes over the samples of all diamonds that
    /// hold changed ones: about three times the grid's at most, in consecutive rows.
    void update(const SampleGrid& grid, const SampleRect& rect, const BoxPyramid& boxes);

    /// The error of a diamond depends on samples within so many times its size of its centre: because errors are monotone, on all that
    /// its children's depend on, half of whose triangles are not its own.
    static constexpr int kReach = 3;

    /// n: the square has 2^n cells a side; 0 for a grid of a single cell.
    int exponent() const { return exponent_; }
    int side() const { return 1 << exponent_; }
    /// Error of a diamond, in units of the frame; infinite where it must be split, 0 where it need never be. `grid` is the one that
    /// the hierarchy was built from.
    float error(const SampleGrid& grid, const DiamondShape& diamond) const;
    /// True when every triangle is to be drawn: no holes, and the grid fills its square.
    bool isWhole() const { return whole_; }
    bool hasHoles() const { return hasHoles_; }
    std::size_t bytes() const { return codes_.capacity() * sizeof(std::uint16_t) + states_.capacity(); }

    static std::uint16_t encode(float error);
    static float decode(std::uint16_t code) { return std::bit_cast<float>(std::uint32_t(code) << 15); }

private:
    /// Place of a diamond that is not finest: both coordinates are even, or both are odd.
    std::size_t place(glm::ivec2 centre) const {
        return std::size_t(centre.y) * std::size_t((columns_ + 1) / 2) + std::size_t(centre.x / 2);
    }

    int columns_ = 0;
    int rows_ = 0;
    int exponent_ = 0;
    bool whole_ = true;
    bool hasHoles_ = false;
    std::vector<std::uint16_t> codes_;
    /// By centre, of both triangles: whether they lie in the valid part. Kept from the first update of a grid with holes on.
    std::vector<std::uint8_t> states_;
};

}  // namespace terrain
