// From the diamonds of a mesh to triangles and vertex positions.
#include <algorithm>
#include <cmath>

#include "base/ProfileScope.h"
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

void RoamMesh::emitHalfCells(const Links& split, unsigned half, std::uint32_t first, std::uint32_t apex, std::uint32_t last)
{
    if (split.solidCells == 0xf) {
        put(apex, split.vertex, first);
        put(last, split.vertex, apex);
        return;
    }
    // Without a centre there is no solid cell around it.
    if (split.vertex == kNoVertex) return;
    const int sample = int(samples_[split.vertex]);
    const DiamondShape shape({sample % columns_, sample / columns_});
    const glm::ivec2 toApex = shape.corner[half ? 3 : 1] - shape.centre;
    const auto isSolid = [&](std::size_t end) {
        const glm::ivec2 toCell = toApex + shape.corner[end] - shape.centre;
        return (split.solidCells >> cellBit(toCell.x, toCell.y) & 1) != 0;
    };
    if (isSolid(half ? 2 : 0)) put(apex, split.vertex, first);
    if (isSolid(half ? 0 : 2)) put(last, split.vertex, apex);
}

void RoamMesh::emitLink(std::uint32_t link, std::uint32_t first, std::uint32_t apex, std::uint32_t last)
{
    if (link == kNone)
        put(first, apex, last);
    else if (link & kSplitLink)
        emitSplit(links_[(link & ~kSplitLink) / 2], link % 2, first, apex, last);
    else if (bounds_.priority(link / 2) > 0.0f)
        put(first, apex, last);
}

void RoamMesh::emitSplit(const Links& split, unsigned half, std::uint32_t first, std::uint32_t apex, std::uint32_t last)
{
    if (split.finest) {
        emitHalfCells(split, half, first, apex, last);
        return;
    }
    // The middle is the apex of both halves.
    emitLink(split.child[2 * half], apex, split.vertex, first);
    emitLink(split.child[2 * half + 1], last, split.vertex, apex);
}

void RoamMesh::emit()
{
    const ProfileScope scope("roam: emit triangles");
    const std::size_t most = std::size_t(meshTriangles_) * 3;
    if (most > indices_.capacity()) indices_.reserve(most + most / 8);
    indices_.resize(most);
    out_ = indices_.data();
    const auto [c0, c1, c2, c3] = corners_;
    if (root_ != kNone) {
        const auto link = [this](unsigned half) {
            return isSplit(root_) ? splitLink(diamonds_[root_].links, half) : leafLink(root_, half);
        };
        emitLink(link(0), c2, c3, c0);
        emitLink(link(1), c0, c1, c2);
    } else if (c0 != kNoVertex && c1 != kNoVertex && c2 != kNoVertex && c3 != kNoVertex) {
        put(c2, c3, c0);
        put(c0, c1, c2);
    }
    indices_.resize(std::size_t(out_ - indices_.data()));
    report_.triangles = std::uint32_t(indices_.size() / 3);
}

void RoamMesh::boundError()
{
    // A deferred priority is known only not to exceed the threshold.
    float worst = 0.0f;
    for (std::uint32_t number = 0; number < bounds_.size(); ++number)
        if (!isSplit(number)) worst = std::max(worst, bounds_.priority(number));
    report_.errorPixels = worst > 0.0f && mayDefer_ ? std::max(worst, request_.threshold) : worst;
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

void RoamMesh::collectMoving(float full)
{
    moving_.clear();
    if (!settings_.geomorph) return;
    std::array<std::uint32_t, 34> start{};
    const auto levelOf = [this](std::uint32_t number) {
        return std::size_t(DiamondShape(bounds_.centre(number)).level(model_.errors->exponent()));
    };
    splitQueue_.clear();
    for (std::uint32_t number = 0; number < bounds_.size(); ++number)
        if (bounds_.priority(number) < full && isSplit(number) && links(number).vertex != kNoVertex) {
            splitQueue_.push_back({0.0f, number});
            ++start[levelOf(number) + 1];
        }
    for (std::size_t level = 1; level < start.size(); ++level) start[level] += start[level - 1];
    moving_.resize(splitQueue_.size());
    for (const Candidate& c : splitQueue_) moving_[start[levelOf(c.diamond)]++] = c.diamond;
}

void RoamMesh::morph()
{
    const ProfileScope scope("roam: morph");
    // Where a limit stopped refinement, the error that was reached takes the place of the error that was asked for.
    const float full = std::isfinite(report_.errorPixels) ? std::max(settings_.pixelError, report_.errorPixels) : settings_.pixelError;
    const float start = kMorphStart * full;
    collectMoving(full);
    for (const std::uint32_t vertex : moved_) vertices_[vertex].morph = 1.0f;
    for (const std::uint32_t number : moving_) {
        vertices_[links(number).vertex].morph = std::max(0.0f, (bounds_.priority(number) - start) / (full - start));
        // What is still on its way shows up to the error of not being split.
        report_.errorPixels = std::max(report_.errorPixels, bounds_.priority(number));
    }
    for (auto number = moving_.rbegin(); number != moving_.rend(); ++number)
        for (const std::uint32_t parent : diamonds_[*number].parent)
            if (parent != kNone && links(parent).vertex != kNoVertex) {
                float& above = vertices_[links(parent).vertex].morph;
                above = std::max(above, vertices_[links(*number).vertex].morph);
            }
    // What was moving and no longer is comes to rest before what hangs on it moves.
    for (const std::uint32_t vertex : moved_)
        if (vertices_[vertex].morph >= 1.0f) place(vertex);
    moved_.clear();
    for (const std::uint32_t number : moving_) {
        place(links(number).vertex);
        moved_.push_back(links(number).vertex);
    }
}

}  // namespace terrain
