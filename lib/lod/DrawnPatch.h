// The mesh of the latest selection, part by part, for who wants to look at the algorithm itself.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "lod/DrawList.h"

namespace terrain {

/// Some triangles of one part of a mesh: a tile, a block, a piece of a level. A part may come in several of these. The spans are
/// valid during the call that gets it.
struct DrawnPatch {
    std::span<const glm::vec3> positions;    ///< as in DrawList, of the whole mesh
    std::span<const std::uint32_t> samples;  ///< likewise
    std::span<const glm::vec2> places;       ///< likewise
    bool wholeGrid = false;                  ///< likewise
    std::span<const std::uint32_t> indices;  ///< of this patch, three a triangle
    /// What tells neighbours apart: their `size` (a power of two that says how large they are, or what kind of part they are of) or
    /// the parity of their place in the rows and columns of parts of their size differs.
    glm::ivec2 place{0};
    int size = 0;
    bool closesGaps = false;  ///< walls and seams between parts: triangles without area in the (column, row) plane
    bool standsIn = false;    ///< for finer ones that are still to come
    bool isNew = false;       ///< not there in the selection before, and loaded for this one
};

using PatchVisitor = std::function<void(const DrawnPatch&)>;

}  // namespace terrain
