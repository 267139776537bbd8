// What an algorithm wants drawn.
#pragma once

#include <cstdint>
#include <span>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "height/SampleRect.h"

namespace terrain {

/// Index of a vertex that does not exist: outside of the grid or in a hole.
inline constexpr std::uint32_t kNoVertex = 0xffffffffu;

/// What the selection did, for statistics.
struct SelectionReport {
    std::uint32_t triangles = 0;
    std::uint32_t splits = 0;
    std::uint32_t merges = 0;
    std::uint32_t patches = 1;       ///< parts that are each drawn at one level: tiles, blocks
    std::uint32_t levels = 1;        ///< of detail that are drawn, of a clipmap
    std::uint32_t pending = 0;       ///< parts that are being built, or will be, while some in view are missing
    double buildMilliseconds = 0.0;  ///< of other threads, for parts built since the selection before
    bool converged = true;           ///< false: the limit on operations was met, the next call goes on
    float errorPixels = 0.0f;        ///< bound on the screen error of every sample in view; infinite when it could not be bounded
};

/// Triangles over a pool of vertices. The spans belong to the algorithm and are valid until its next selection.
struct DrawList {
    std::span<const glm::vec3> positions;    ///< local coordinates by vertex; free places hold stale values
    std::span<const std::uint32_t> samples;  ///< row * columns + column by vertex, of the nearest where there are `places`
    std::span<const glm::vec2> places;       ///< column and row by vertex; empty when all vertices are samples
    std::span<const std::uint32_t> indices;  ///< three a triangle, counter-clockwise in the grid's (column, row) plane
    /// How many of the indices, at their end, are of triangles without area that close what rounding leaves open. GL must draw them
    /// whichever way they face.
    std::size_t seamIndices = 0;
    std::span<const std::uint32_t> newVertices;  ///< vertices that stand for another sample than at the last selection
    bool wholeGrid = false;                      ///< vertex i is sample i: positions, samples and newVertices are empty
    std::span<const SampleRect> changedSamples;  ///< of a whole grid: those to be sent again when positionsChanged is false
    bool positionsChanged = false;               ///< since the last selection
    bool indicesChanged = false;                 ///< when not, indices may be empty: what was drawn last is drawn again
    SelectionReport report;
};

}  // namespace terrain
