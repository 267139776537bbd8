// The longest-edge bisection of a square grid, by arithmetic on vertex coordinates.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include <glm/vec2.hpp>

namespace terrain {

/// A diamond: the two right triangles that share a longest edge, named by the middle of that edge, which is the vertex that
/// splitting it adds (Duchaineau et al., "ROAMing Terrain", 1997, sect. 4; Lindstrom and Pascucci, 2002, sect. 3). On the grid of
/// (2^n + 1) x (2^n + 1) vertices, let s be the largest power of two that divides both coordinates of the centre:
///  - square: both coordinates are odd multiples of s; the diamond is the axis-aligned square of half side s and the edge a
///  diagonal;
///  - edge:   one is an even multiple; the diamond is the tilted square of half diagonal s and the edge is axis-aligned.
/// The corners q0..q3 stand counter-clockwise (x to the right, y up) and the longest edge runs from q0 to q2, so that the triangles
/// are (q0, q1, q2) and (q2, q3, q0) with their right angles at q1 and q3. Those two *apexes* are the centres of the diamond's
/// parents; the middles of the sides (q0 q1), (q1 q2), (q2 q3), (q3 q0) are the centres of its children.
struct DiamondShape {
    glm::ivec2 centre;
    int size;  ///< s
    bool isSquare;
    std::array<glm::ivec2, 4> corner;

    explicit DiamondShape(glm::ivec2 at) : centre(at), size(std::int32_t(1u << std::countr_zero(std::uint32_t(at.x | at.y)))) {
        const int s = size;
        isSquare = (at.x & at.y & s) != 0;
        if (isSquare) {
            // The diagonal runs through the parent square's centre, the corner with odd multiples of 2 s.
            const glm::ivec2 parent{(at.x + s) & (2 * s) ? at.x + s : at.x - s, (at.y + s) & (2 * s) ? at.y + s : at.y - s};
            const glm::ivec2 d = parent - at;
            // A quarter turn counter-clockwise of (x, y) is (-y, x).
            corner = {at + d, at + glm::ivec2(-d.y, d.x), at - d, at + glm::ivec2(d.y, -d.x)};
        } else if (at.x & s) {
            corner = {at + glm::ivec2(s, 0), at + glm::ivec2(0, s), at - glm::ivec2(s, 0), at - glm::ivec2(0, s)};
        } else {
            corner = {at - glm::ivec2(0, s), at + glm::ivec2(s, 0), at + glm::ivec2(0, s), at - glm::ivec2(s, 0)};
        }
    }

    /// Refinement steps below the root diamond of a grid of side 2^n: 0 for the root, 2 n - 1 for the finest.
    int level(int n) const { return 2 * (n - 1 - std::countr_zero(std::uint32_t(size))) + (isSquare ? 0 : 1); }
    /// Finest diamonds have no children: their triangles, once split, are half cells.
    bool isFinest() const { return size == 1 && !isSquare; }
    glm::ivec2 child(int side) const { return (corner[std::size_t(side)] + corner[std::size_t((side + 1) & 3)]) / 2; }
};

}  // namespace terrain
