// From the diamonds of a mesh to triangles and vertex positions.
#include <algorithm>
#include <cmath>

#include "lod/RoamMesh.h"

namespace terrain {

void RoamMesh::put(std::uint32_t a, std::uint32_t b, std::uint32_t c)
{
    // Only a triangle outside of the grid or in a hole has a corner that does not exist.
    if (!whole_ && (a == kNoVertex || b == kNoVertex || c == kNoVertex)) return;
    out_[0] = a;
    out_[1] = settings_.clockwise ? c : b;
    out_[2] = settings_.clockwise ? b : c;
    out_ += 3;
}

void RoamMesh::emitHalfCells(std::uint32_t number, unsigned half, std::uint32_t first, std::uint32_t apex, std::uint32_t last)
{
    const Links& d = links_[number];
    if (d.solidCells == 0xf) {
        put(apex, d.vertex, first);
        put(last, d.vertex, apex);
        return;
    }
    const DiamondShape shape(diamonds_[number].centre);
    const glm::ivec2 toApex = shape.corner[half ? 3 : 1] - shape.centre;
    const auto isSolid = [&](std::size_t end) {
        const glm::ivec2 toCell = toApex + shape.corner[end] - shape.centre;
        return (d.solidCells >> cellBit(toCell.x, toCell.y) & 1) != 0;
    };
    if (isSolid(half ? 2 : 0)) put(apex, d.vertex, first);
    if (isSolid(half ? 0 : 2)) put(last, d.vertex, apex);
}

void RoamMesh::emitTriangle(std::uint32_t number, unsigned half, std::uint32_t first, std::uint32_t apex, std::uint32_t last)
{
    const Label label = labels_[number];
    if (label & kOutside) return;
    if (!(label & kSplit)) {
        report_.errorPixels = std::max(report_.errorPixels, priorities_[number]);
        put(first, apex, last);
        return;
    }
    const Links& d = links_[number];
    const std::uint32_t middle = d.vertex;
    if (d.finest) {
        emitHalfCells(number, half, first, apex, last);
        return;
    }
    // The middle is the apex of both halves.
    const auto descend = [&](std::uint32_t child, std::uint32_t from, std::uint32_t to) {
        if (child == kNone)
            put(from, middle, to);
        else
            emitTriangle(child / 2, child % 2, from, middle, to);
    };
    descend(d.child[2 * half], apex, first);
    descend(d.child[2 * half + 1], last, apex);
}

void RoamMesh::emit()
{
    indices_.resize(std::size_t(meshTriangles_) * 3);
    out_ = indices_.data();
    const auto [c0, c1, c2, c3] = corners_;
    if (root_ != kNone) {
        emitTriangle(root_, 0, c2, c3, c0);
        emitTriangle(root_, 1, c0, c1, c2);
    } else if (c0 != kNoVertex && c1 != kNoVertex && c2 != kNoVertex && c3 != kNoVertex) {
        put(c2, c3, c0);
        put(c0, c1, c2);
    }
    indices_.resize(std::size_t(out_ - indices_.data()));
    report_.triangles = std::uint32_t(indices_.size() / 3);
}

void RoamMesh::place(std::uint32_t number)
{
    const Vertex& v = vertices_[number];
    glm::vec3 position = v.target;
    if (v.morph < 1.0f && v.edge[0] != kNoVertex && v.edge[1] != kNoVertex) {
        const glm::vec3 flat = (vertices_[v.edge[0]].target + vertices_[v.edge[1]].target) * 0.5f;
        position = (positions_[v.edge[0]] + positions_[v.edge[1]]) * 0.5f + (position - flat) * v.morph;
    }
    if (positions_[number] == position) return;
    positions_[number] = position;
    positionsChanged_ = true;
}

void RoamMesh::sortByLevel()
{
    std::array<std::uint32_t, 64> start{};
    const auto isWanted = [this](std::size_t number) { return (labels_[number] & kSplit) && links_[number].vertex != kNoVertex; };
    for (std::size_t number = 0; number < labels_.size(); ++number)
        if (isWanted(number)) ++start[diamonds_[number].level + 1u];
    for (std::size_t level = 1; level < start.size(); ++level) start[level] += start[level - 1];
    byLevel_.resize(start.back());
    for (std::size_t number = 0; number < labels_.size(); ++number)
        if (isWanted(number)) byLevel_[start[diamonds_[number].level]++] = std::uint32_t(number);
}

void RoamMesh::morph()
{
    if (!settings_.geomorph && !morphed_) return;
    // Where a limit stopped refinement, the error that was reached takes the place of the error that was asked for.
    const float full = std::isfinite(report_.errorPixels) ? std::max(settings_.pixelError, report_.errorPixels) : settings_.pixelError;
    const float start = kMorphStart * full;
    const auto amount = [&](float priority) {
        return settings_.geomorph && priority < full ? std::max(0.0f, (priority - start) / (full - start)) : 1.0f;
    };
    sortByLevel();
    for (const std::uint32_t number : byLevel_) {
        const float t = vertices_[links_[number].vertex].morph = amount(priorities_[number]);
        // What is still on its way shows up to the error of not being split.
        if (t < 1.0f) report_.errorPixels = std::max(report_.errorPixels, priorities_[number]);
    }
    for (auto number = byLevel_.rbegin(); number != byLevel_.rend(); ++number)
        for (const std::uint32_t parent : diamonds_[*number].parent)
            if (parent != kNone && links_[parent].vertex != kNoVertex) {
                float& above = vertices_[links_[parent].vertex].morph;
                above = std::max(above, vertices_[links_[*number].vertex].morph);
            }
    for (const std::uint32_t number : byLevel_) place(links_[number].vertex);
    morphed_ = settings_.geomorph;
}

}  // namespace terrain
