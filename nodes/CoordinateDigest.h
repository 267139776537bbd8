// Which of many points have changed, told by a digest of each block of them.
#ifndef SOTERRAIN_COORDINATEDIGEST_H
#define SOTERRAIN_COORDINATEDIGEST_H

#include <cstdint>
#include <optional>
#include <vector>

#include "height/EditLog.h"

/// 64 bits for each block of kBlock x kBlock points of a grid, and as many for which of them are holes. Coin tells that coordinates have
/// changed, not which: comparing digests takes about a millisecond for a million points.
class CoordinateDigest {
public:
    static constexpr int kBlock = 32;

    CoordinateDigest() = default;
    /// Of columns x rows points, three floats each, row after row.
    CoordinateDigest(const float * points, int columns, int rows);

    /// Blocks in which `now`, of as many points, differs.
    terrain::GridEdits changes(const CoordinateDigest & now) const;
    std::size_t bytes() const { return blocks_.capacity() * sizeof(Block); }

private:
    struct Block {
        std::uint64_t values = 0;
        std::uint64_t holes = 0;
    };
    int columns_ = 0, rows_ = 0, across_ = 0;
    std::vector<Block> blocks_;
};

#endif
