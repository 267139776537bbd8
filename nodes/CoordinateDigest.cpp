#include "CoordinateDigest.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace {

std::uint64_t mixed(std::uint64_t hash, std::uint64_t value)
{
    hash = (hash ^ value) * 0x9e3779b97f4a7c15ull;
    return hash ^ hash >> 32;
}

}  // namespace

CoordinateDigest::CoordinateDigest(const float * points, int columns, int rows)
    : columns_(columns), rows_(rows), across_((columns + kBlock - 1) / kBlock), blocks_(std::size_t(across_) * std::size_t((rows + kBlock - 1) / kBlock))
{
    for (int row = 0; row < rows; ++row)
        for (int first = 0; first < columns; first += kBlock) {
            Block & block = blocks_[std::size_t(row / kBlock) * std::size_t(across_) + std::size_t(first / kBlock)];
            const int count = std::min(kBlock, columns - first);
            const float * p = points + (std::size_t(row) * std::size_t(columns) + std::size_t(first)) * 3;
            std::uint32_t holes = 0;
            for (int i = 0; i < count; ++i, p += 3) {
                block.values = mixed(block.values, std::uint64_t(std::bit_cast<std::uint32_t>(p[0])) << 32 | std::bit_cast<std::uint32_t>(p[1]));
                block.values = mixed(block.values, std::bit_cast<std::uint32_t>(p[2]));
                holes |= std::isfinite(p[0] + p[1] + p[2]) ? 0u : 1u << i;
            }
            block.holes = mixed(block.holes, holes);
        }
}

terrain::GridEdits CoordinateDigest::changes(const CoordinateDigest & now) const
{
    terrain::GridEdits edits;
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
        if (blocks_[i].values == now.blocks_[i].values) continue;
        edits.holes = edits.holes || blocks_[i].holes != now.blocks_[i].holes;
        const glm::ivec2 low = glm::ivec2(int(i) % across_, int(i) / across_) * kBlock;
        terrain::GridEdits one;
        one.rects.push_back({low, glm::min(low + kBlock, glm::ivec2(columns_, rows_)) - 1});
        edits.include(one);
    }
    return edits;
}
