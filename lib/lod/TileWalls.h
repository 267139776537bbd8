// What closes the gaps between tiles of different levels.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

namespace terrain {

/// A vertex of a tile's border: where it stands along the border, in samples, and its number.
struct BorderVertex {
    int at = 0;
    std::uint32_t vertex = 0;
};

/// Appends the triangles of the upright wall between two lines of vertices along one border, both in the order in which one goes
/// along it: those of the tiles on its right and on its left. Two tiles approximate a border each in its own way; the wall spans
/// just what lies between them, so it is as deep as the errors of both sides make it and needs no vertices of its own. Its
/// triangles face the side whose line is lower, where alone the gap can be seen, if front faces are those that are
/// counter-clockwise seen from above.
void appendWall(std::span<const BorderVertex> right, std::span<const BorderVertex> left, bool clockwise,
                std::vector<std::uint32_t>& indices);

}  // namespace terrain
