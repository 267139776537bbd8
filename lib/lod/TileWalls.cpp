#include "lod/TileWalls.h"

namespace terrain {

void appendWall(std::span<const BorderVertex> right, std::span<const BorderVertex> left, bool clockwise,
                std::vector<std::uint32_t>& indices) {
    if (right.empty() || left.empty()) return;
    const auto put = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        indices.insert(indices.end(), {a, clockwise ? c : b, clockwise ? b : c});
    };
    std::size_t i = 0, j = 0;
    while (i + 1 < right.size() || j + 1 < left.size()) {
        // The line that is behind goes on.
        const bool advanceRight = j + 1 == left.size() || (i + 1 < right.size() && right[i + 1].at <= left[j + 1].at);
        if (advanceRight) {
            put(right[i].vertex, right[i + 1].vertex, left[j].vertex);
            ++i;
        } else {
            put(right[i].vertex, left[j + 1].vertex, left[j].vertex);
            ++j;
        }
    }
}

}  // namespace terrain
