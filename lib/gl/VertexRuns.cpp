#include "gl/VertexRuns.h"

#include <algorithm>

namespace terrain {

namespace {

void append(std::vector<VertexRun>& runs, const VertexRun& run) {
    if (!runs.empty() && runs.back().end >= run.first)
        runs.back().end = std::max(runs.back().end, run.end);
    else
        runs.push_back(run);
}

std::vector<VertexRun> pagesOf(std::span<const std::uint32_t> vertices, std::size_t poolSize, std::size_t most) {
    // Every second page at worst, so twice as many.
    const std::size_t pages = 2 * most, size = (poolSize + pages - 1) / pages;
    std::vector<std::uint8_t> isTouched(pages);
    for (const std::uint32_t vertex : vertices) isTouched[vertex / size] = 1;
    std::vector<VertexRun> runs;
    for (std::size_t page = 0; page < pages; ++page)
        if (isTouched[page]) append(runs, {std::uint32_t(page * size), std::uint32_t(std::min((page + 1) * size, poolSize))});
    return runs;
}

}  // namespace

std::vector<VertexRun> vertexRuns(std::span<const std::uint32_t> vertices, std::size_t poolSize, std::size_t most) {
    std::vector<VertexRun> pieces, runs;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        if (i > 0 && vertices[i] == vertices[i - 1] + 1)
            ++pieces.back().end;
        else
            pieces.push_back({vertices[i], vertices[i] + 1});
    }
    if (pieces.size() > most) return pagesOf(vertices, poolSize, most);
    std::sort(pieces.begin(), pieces.end(), [](const VertexRun& a, const VertexRun& b) { return a.first < b.first; });
    for (const VertexRun& piece : pieces) append(runs, piece);
    return runs;
}

}  // namespace terrain
