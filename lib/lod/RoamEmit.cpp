// From the diamonds of a mesh to triangles and vertex positions.
#include <algorithm>
#include <cmath>

#include "base/ProfileScope.h"
#include "lod/RoamMesh.h"

namespace terrain {

/// One walk over the triangles. It writes through a pointer that it hands from call to call, so that it stays in a register; what
/// need not be asked for each triangle is a template parameter.
template <bool Whole, bool Clockwise>
class RoamMesh::Emitter {
public:
    explicit Emitter(const RoamMesh& mesh) : mesh_(mesh), links_(mesh.links_.data()) {}

    std::uint32_t* put(std::uint32_t* out, std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
        // Only a triangle outside of the grid or in a hole has a corner that does not exist.
        if (!Whole && (a == kNoVertex || b == kNoVertex || c == kNoVertex)) return out;
        out[0] = a;
        out[1] = Clockwise ? c : b;
        out[2] = Clockwise ? b : c;
        return out + 3;
    }

    std::uint32_t* link(std::uint32_t* out, std::uint32_t link, std::uint32_t first, std::uint32_t apex, std::uint32_t last) const {
        if (link & kSplitLink) return split(out, links_[(link & ~kSplitLink) / 2], link % 2, first, apex, last);
        // Written in any case, and then written over: cheaper than a branch that can't be foreseen.
        std::uint32_t* const drawn = put(out, first, apex, last);
        return link & kHiddenLink ? out : drawn;
    }

private:
    std::uint32_t* split(std::uint32_t* out, const Links& d, unsigned half, std::uint32_t first, std::uint32_t apex,
                         std::uint32_t last) const {
        if (d.finest) return halfCells(out, d, half, first, apex, last);
        const std::uint32_t left = d.child[2 * half], right = d.child[2 * half + 1], middle = d.vertex;
        if (right & kSplitLink) __builtin_prefetch(&links_[(right & ~kSplitLink) / 2]);
        // The middle is the apex of both halves.
        out = link(out, left, apex, middle, first);
        return link(out, right, last, middle, apex);
    }

    std::uint32_t* halfCells(std::uint32_t* out, const Links& d, unsigned half, std::uint32_t first, std::uint32_t apex,
                             std::uint32_t last) const {
        if (Whole || d.solidCells == 0xf) return put(put(out, apex, d.vertex, first), last, d.vertex, apex);
        // Without a centre there is no solid cell around it.
        if (d.vertex == kNoVertex) return out;
        const int sample = int(mesh_.samples_[d.vertex]);
        const DiamondShape shape({sample % mesh_.columns_, sample / mesh_.columns_});
        const glm::ivec2 toApex = shape.corner[half ? 3 : 1] - shape.centre;
        const auto isSolid = [&](std::size_t end) {
            const glm::ivec2 toCell = toApex + shape.corner[end] - shape.centre;
            return (d.solidCells >> cellBit(toCell.x, toCell.y) & 1) != 0;
        };
        if (isSolid(half ? 2 : 0)) out = put(out, apex, d.vertex, first);
        if (isSolid(half ? 0 : 2)) out = put(out, last, d.vertex, apex);
        return out;
    }

    const RoamMesh& mesh_;
    const Links* links_;
};

template <bool Whole, bool Clockwise>
std::uint32_t* RoamMesh::emitAll(std::uint32_t* out) const {
    const Emitter<Whole, Clockwise> emitter(*this);
    const auto [c0, c1, c2, c3] = corners_;
    if (root_ != kNone) {
        const auto link = [this](unsigned half) {
            return isSplit(root_) ? splitLink(diamonds_[root_].links, half) : leafLink(root_, half);
        };
        out = emitter.link(out, link(0), c2, c3, c0);
        return emitter.link(out, link(1), c0, c1, c2);
    }
    // One cell, or a flat square: cut as the full resolution is.
    if (c0 == kNoVertex || c1 == kNoVertex || c2 == kNoVertex || c3 == kNoVertex) return out;
    return emitter.put(emitter.put(out, c0, c1, c3), c1, c2, c3);
}

void RoamMesh::emit() {
    const ProfileScope scope("roam: emit triangles");
    const std::size_t most = std::size_t(meshTriangles_) * 3;
    if (most + 3 > indices_.capacity()) indices_.reserve(most + most / 8 + 3);
    indices_.resize(most + 3);
    std::uint32_t* const begin = indices_.data();
    const std::uint32_t* const end = whole_ ? (settings_.clockwise ? emitAll<true, true>(begin) : emitAll<true, false>(begin))
                                            : (settings_.clockwise ? emitAll<false, true>(begin) : emitAll<false, false>(begin));
    indices_.resize(std::size_t(end - begin));
    report_.triangles = std::uint32_t(indices_.size() / 3);
}

void RoamMesh::boundError() {
    float worst = leafError_;
    for (const Candidate& left : splitQueue_)
        if (isCurrent(left) && !isSplit(left.diamond)) worst = std::max(worst, left.priority);
    // A deferred priority is known only not to exceed the threshold.
    report_.errorPixels = worst > 0.0f && mayDefer_ ? std::max(worst, request_.threshold) : worst;
}

void RoamMesh::place(std::uint32_t number) {
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

void RoamMesh::collectMoving(float full) {
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

void RoamMesh::morph() {
    const ProfileScope scope("roam: morph");
    // Where a limit stopped refinement, the error that was reached takes the place of the error that was asked for.
    const float full =
        std::isfinite(report_.errorPixels) ? std::max(settings_.pixelError, report_.errorPixels) : settings_.pixelError;
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
