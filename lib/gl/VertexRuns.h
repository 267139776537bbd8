// Which parts of a buffer have to be sent again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace terrain {

/// Vertices from `first` to before `end`.
struct VertexRun {
    std::uint32_t first = 0;
    std::uint32_t end = 0;

    bool operator==(const VertexRun&) const = default;
};

/// Runs that hold all of these vertices, in ascending order and at most `most` of them: exactly these vertices where they lie in so
/// few pieces of consecutive ones; else whole pages of the `poolSize` vertices that there are. Vertices may come in any order.
std::vector<VertexRun> vertexRuns(std::span<const std::uint32_t> vertices, std::size_t poolSize, std::size_t most);

}  // namespace terrain
