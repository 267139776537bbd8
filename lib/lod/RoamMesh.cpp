#include "lod/RoamMesh.h"

#include <algorithm>
#include <bit>

namespace terrain {

namespace {

/// One more element, with less slack than doubling leaves: these arrays are most of what a mesh holds.
template <class T>
void grow(std::vector<T>& items) {
    if (items.size() == items.capacity()) items.reserve(items.size() + items.size() / 8 + 256);
    items.emplace_back();
}

}  // namespace

RoamMesh::RoamMesh(const TerrainModel& model, const SampleGrid& grid)
    : model_(model), side_(model_.errors->side()), whole_(model_.errors->isWhole()), regular_(grid.isRegular()),
      columns_(grid.columns()), bounds_(grid.isRegular(), model_.boxes->all()) {
    const int n = model_.errors->exponent();
    const glm::ivec2 corner[4] = {{0, 0}, {side_, 0}, {side_, side_}, {0, side_}};
    for (std::size_t i = 0; i < 4; ++i) corners_[i] = addVertex(grid, corner[i]);
    // A single cell has no diamond at all.
    if (n == 0) return;
    const DiamondShape shape(glm::ivec2(side_ / 2));
    if (model_.errors->error(grid, shape) > 0.0f) root_ = create(grid, shape);
}

std::uint32_t RoamMesh::addVertex(const SampleGrid& grid, glm::ivec2 at) {
    if (!grid.contains(at.x, at.y) || grid.isHole(at.x, at.y)) return kNoVertex;
    std::uint32_t vertex;
    if (freeVertex_ == kNone) {
        vertex = std::uint32_t(positions_.size());
        grow(positions_);
        grow(vertices_);
        grow(samples_);
    } else {
        vertex = freeVertex_;
        freeVertex_ = vertices_[vertex].edge[0];
    }
    vertices_[vertex] = Vertex{};
    positions_[vertex] = vertices_[vertex].target = grid.position(at.x, at.y);
    samples_[vertex] = std::uint32_t(grid.index(at.x, at.y));
    newVertices_.push_back(vertex);
    return vertex;
}

std::uint32_t RoamMesh::vertexAt(glm::ivec2 at) const {
    const bool right = at.x == side_, top = at.y == side_;
    if ((right || at.x == 0) && (top || at.y == 0)) return corners_[top ? (right ? 2 : 3) : (right ? 1 : 0)];
    const std::uint32_t number = table_.find(at);
    return number == kNone || !isSplit(number) ? kNoVertex : links(number).vertex;
}

void RoamMesh::bound(const SampleGrid& grid, const DiamondShape& shape, std::uint32_t number) {
    const glm::ivec2 low = shape.centre - shape.size, high = shape.centre + shape.size;
    // In space the pyramid's blocks would be far too wide for the smallest diamonds.
    const BoxPyramid::Bounds bounds = !regular_ && shape.size <= 2 ? BoxPyramid::exactBounds(grid, low.x, low.y, high.x, high.y)
                                                                   : model_.boxes->bounds(low.x, low.y, high.x, high.y);
    bounds_.set(number, shape.centre, shape.size, bounds, model_.errors->error(grid, shape));
}

std::uint32_t RoamMesh::create(const SampleGrid& grid, const DiamondShape& shape) {
    std::uint32_t number;
    if (freeCount_ == 0) {
        number = std::uint32_t(bounds_.append());
        grow(diamonds_);
        blocks_.resize(bounds_.blocks());
        freeDiamonds_.resize(number / 64 + 1);
    } else {
        // The lowest first keeps what is in use together.
        while (freeDiamonds_[freeWord_] == 0) ++freeWord_;
        const unsigned bit = unsigned(std::countr_zero(freeDiamonds_[freeWord_]));
        freeDiamonds_[freeWord_] &= freeDiamonds_[freeWord_] - 1;
        --freeCount_;
        number = std::uint32_t(freeWord_ * 64 + bit);
    }
    diamonds_[number] = Diamond{};
    blockOf(number).leaf |= bitOf(number);
    blockOf(number).due = std::uint16_t(frame_ + 1);
    bound(grid, shape, number);
    table_.insert(shape.centre, number);
    // Before the first selection there is no view; that selection evaluates what is there.
    if (space_) {
        evaluate(number);
        enqueue(number);
    }
    return number;
}

void RoamMesh::destroy(std::uint32_t number) {
    table_.erase(bounds_.centre(number));
    bounds_.clear(number);
    Block& block = blockOf(number);
    block.leaf &= std::uint16_t(~bitOf(number));
    block.hidden &= std::uint16_t(~bitOf(number));
    freeDiamonds_[number / 64] |= std::uint64_t(1) << (number % 64);
    freeWord_ = std::min(freeWord_, std::size_t(number / 64));
    ++freeCount_;
}

std::uint8_t RoamMesh::findSolidCells(const SampleGrid& grid, glm::ivec2 centre) const {
    std::uint8_t solid = 0;
    const auto valid = [&grid](int column, int row) { return grid.contains(column, row) && !grid.isHole(column, row); };
    for (const int dy : {-1, 1})
        for (const int dx : {-1, 1})
            if (valid(centre.x, centre.y) && valid(centre.x + dx, centre.y) && valid(centre.x, centre.y + dy) &&
                valid(centre.x + dx, centre.y + dy))
                solid = std::uint8_t(solid | 1u << cellBit(dx, dy));
    return solid;
}

void RoamMesh::relink(std::uint32_t number, std::uint32_t from, std::uint32_t to) {
    for (unsigned half = 0; half < 2; ++half)
        if (const std::uint32_t parent = diamonds_[number].parent[half]; parent != kNone)
            for (std::uint32_t& link : links(parent).child)
                if ((link & ~kHiddenLink) == from + half) link = to + half;
}

void RoamMesh::showOrHide(std::uint32_t leaf) {
    const bool hidden = bounds_.priority(leaf) == 0.0f;
    if (((blockOf(leaf).hidden & bitOf(leaf)) != 0) == hidden) return;
    blockOf(leaf).hidden ^= bitOf(leaf);
    relink(leaf, 2 * leaf, leafLink(leaf, 0));
}

bool RoamMesh::split(const SampleGrid& grid, std::uint32_t number) {
    const DiamondShape shape(bounds_.centre(number));
    // Both triangles must be there: a parent that is not split yet is split first, and its parents before it (ROAM's forced split).
    for (std::size_t half = 0; half < 2 && number != root_; ++half) {
        const glm::ivec2 apex = shape.corner[half ? 3 : 1];
        if (diamonds_[number].parent[half] != kNone || !inSquare(apex)) continue;
        std::uint32_t parent = table_.find(apex);
        if (parent == kNone) {
            // Its own parents may be split already and have passed it over: beyond the grid an error can be 0 where a child's is
            // not.
            const DiamondShape parentShape(apex);
            parent = create(grid, parentShape);
            linkToParents(parent, parentShape);
        }
        if (split(grid, parent)) continue;
        // No operations are left. What no split diamond refers to must not stay.
        if (diamonds_[parent].parent[0] == kNone && diamonds_[parent].parent[1] == kNone && parent != root_) destroy(parent);
        return false;
    }
    if (operations_ >= operationCap_) return false;
    if (freeLinks_ == kNone) {
        diamonds_[number].links = std::uint32_t(links_.size());
        grow(links_);
    } else {
        diamonds_[number].links = freeLinks_;
        freeLinks_ = links_[freeLinks_].child[0];
    }
    Links& l = links(number);
    l = Links{};
    Block& block = blockOf(number);
    block.leaf &= std::uint16_t(~bitOf(number));
    block.mergeable |= bitOf(number);
    l.finest = shape.isFinest();
    l.atRim = number != root_ && isAtRim(shape);
    l.vertex = addVertex(grid, shape.centre);
    if (l.vertex != kNoVertex) vertices_[l.vertex].edge = {vertexAt(shape.corner[0]), vertexAt(shape.corner[2])};
    if (l.finest && !whole_) l.solidCells = findSolidCells(grid, shape.centre);
    for (const std::uint32_t parent : diamonds_[number].parent)
        if (parent != kNone && links(parent).splitChildren++ == 0) blockOf(parent).mergeable &= std::uint16_t(~bitOf(parent));
    relink(number, 2 * number, splitLink(diamonds_[number].links, 0));
    meshTriangles_ += l.atRim ? 1 : 2;
    ++report_.splits;
    ++operations_;
    if (!shape.isFinest()) adoptChildren(grid, number, shape);
    return true;
}

void RoamMesh::link(std::uint32_t parent, unsigned side, std::uint32_t child, const DiamondShape& childShape) {
    const unsigned half = childShape.corner[1] == bounds_.centre(parent) ? 0 : 1;
    links(parent).child[side] = leafLink(child, half);
    diamonds_[child].parent[half] = parent;
}

void RoamMesh::linkToParents(std::uint32_t number, const DiamondShape& shape) {
    for (const std::size_t apex : {1u, 3u}) {
        const std::uint32_t parent = inSquare(shape.corner[apex]) ? table_.find(shape.corner[apex]) : kNone;
        if (parent == kNone || !isSplit(parent)) continue;
        const DiamondShape parentShape(shape.corner[apex]);
        for (unsigned side = 0; side < 4; ++side)
            if (parentShape.child(int(side)) == shape.centre) link(parent, side, number, shape);
    }
}

void RoamMesh::adoptChildren(const SampleGrid& grid, std::uint32_t number, const DiamondShape& shape) {
    for (int side = 0; side < 4; ++side) {
        const glm::ivec2 centre = shape.child(side);
        // At the rim of the square one half of the diamond, and its two sides, do not exist.
        if (!inSquare(centre)) continue;
        const DiamondShape childShape(centre);
        std::uint32_t child = table_.find(centre);
        if (child == kNone) {
            if (!(model_.errors->error(grid, childShape) > 0.0f)) continue;
            child = create(grid, childShape);
        }
        link(number, unsigned(side), child, childShape);
    }
}

void RoamMesh::merge(std::uint32_t number) {
    for (const std::uint32_t link : links(number).child) {
        if (link == kFlatLink) continue;
        const std::uint32_t leaf = (link & ~kHiddenLink) / 2;
        Diamond& child = diamonds_[leaf];
        child.parent[link % 2] = kNone;
        if (child.parent[0] == kNone && child.parent[1] == kNone) destroy(leaf);
    }
    for (const std::uint32_t parent : diamonds_[number].parent)
        if (parent != kNone && --links(parent).splitChildren == 0) blockOf(parent).mergeable |= bitOf(parent);
    Block& block = blockOf(number);
    block.mergeable &= std::uint16_t(~bitOf(number));
    block.leaf |= bitOf(number);
    block.hidden = std::uint16_t((block.hidden & ~bitOf(number)) | (bounds_.priority(number) == 0.0f ? bitOf(number) : 0));
    relink(number, splitLink(diamonds_[number].links, 0), leafLink(number, 0));
    if (const std::uint32_t vertex = links(number).vertex; vertex != kNoVertex) {
        vertices_[vertex].edge[0] = freeVertex_;
        freeVertex_ = vertex;
    }
    meshTriangles_ -= links(number).atRim ? 1 : 2;
    links(number).child[0] = freeLinks_;
    freeLinks_ = diamonds_[number].links;
    diamonds_[number].links = kNone;
    leafError_ = std::max(leafError_, bounds_.priority(number));
    ++report_.merges;
    ++operations_;
}

std::size_t RoamMesh::bytes() const {
    const auto held = [](const auto& items) { return items.capacity() * sizeof(items[0]); };
    return bounds_.bytes() + held(diamonds_) + held(blocks_) + held(freeDiamonds_) + held(links_) + table_.bytes() +
           held(positions_) + held(vertices_) + held(samples_) + held(newVertices_) + held(indices_) + held(splitQueue_) +
           held(mergeQueue_) + held(moving_) + held(moved_);
}

}  // namespace terrain
