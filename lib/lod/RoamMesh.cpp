#include "lod/RoamMesh.h"

#include <algorithm>
#include <bit>

#include <glm/common.hpp>

namespace terrain {

namespace {

/// One more element, with less slack than doubling leaves: these arrays are most of what a mesh holds.
template <class T>
void grow(std::vector<T>& items)
{
    if (items.size() == items.capacity()) items.reserve(items.size() + items.size() / 8 + 256);
    items.emplace_back();
}

}  // namespace

RoamMesh::RoamMesh(const TerrainModel& model, const SampleGrid& grid)
    : model_(model), side_(model_.errors->side()), whole_(model_.errors->isWhole()),
      regular_(grid.isRegular()), lastSample_(grid.columns() - 1, grid.rows() - 1)
{
    const int n = model_.errors->exponent();
    const glm::ivec2 corner[4] = {{0, 0}, {side_, 0}, {side_, side_}, {0, side_}};
    for (std::size_t i = 0; i < 4; ++i) corners_[i] = addVertex(grid, corner[i]);
    // A single cell has no diamond at all.
    if (n == 0) return;
    const DiamondShape shape(glm::ivec2(side_ / 2));
    if (model_.errors->error(shape) > 0.0f) root_ = create(grid, shape);
}

std::uint32_t RoamMesh::addVertex(const SampleGrid& grid, glm::ivec2 at)
{
    if (!grid.contains(at.x, at.y) || grid.isHole(at.x, at.y)) return kNoVertex;
    std::uint32_t vertex;
    if (freeVertices_.empty()) {
        vertex = std::uint32_t(positions_.size());
        grow(positions_);
        grow(vertices_);
        grow(samples_);
    } else {
        vertex = freeVertices_.back();
        freeVertices_.pop_back();
    }
    vertices_[vertex] = Vertex{};
    positions_[vertex] = vertices_[vertex].target = grid.position(at.x, at.y);
    samples_[vertex] = std::uint32_t(grid.index(at.x, at.y));
    newVertices_.push_back(vertex);
    return vertex;
}

std::uint32_t RoamMesh::find(glm::ivec2 centre) const
{
    return table_.find(centre, [this](std::uint32_t number) { return diamonds_[number].centre; });
}

std::uint32_t RoamMesh::vertexAt(glm::ivec2 at) const
{
    const bool right = at.x == side_, top = at.y == side_;
    if ((right || at.x == 0) && (top || at.y == 0)) return corners_[top ? (right ? 2 : 3) : (right ? 1 : 0)];
    const std::uint32_t number = find(at);
    return number == kNone ? kNoVertex : links_[number].vertex;
}

void RoamMesh::bound(const SampleGrid& grid, const DiamondShape& shape, std::uint32_t number)
{
    // Small diamonds are worth exact bounds: the pyramid's blocks are larger than they are.
    const glm::ivec2 low = shape.centre - shape.size, high = shape.centre + shape.size;
    const BoxPyramid::Bounds bounds = shape.size <= 2 ? BoxPyramid::exactBounds(grid, low.x, low.y, high.x, high.y)
                                                      : model_.boxes->bounds(low.x, low.y, high.x, high.y);
    Diamond& d = diamonds_[number];
    d.nowhere = bounds.isEmpty();
    if (d.nowhere) return;
    d.lowest = bounds.low.z;
    d.highest = bounds.high.z;
    if (!regular_) boxes_[number] = boxOf(bounds);
}

Box RoamMesh::boxOfDiamond(std::uint32_t number) const
{
    if (!regular_) return boxes_[number];
    const Diamond& d = diamonds_[number];
    const int size = int(1u << std::countr_zero(std::uint32_t(d.centre.x | d.centre.y)));
    const glm::ivec2 low = glm::max(d.centre - size, glm::ivec2(0)), high = glm::min(d.centre + size, lastSample_);
    return boxBetween({float(low.x), float(low.y), d.lowest}, {float(high.x), float(high.y), d.highest});
}

std::uint32_t RoamMesh::create(const SampleGrid& grid, const DiamondShape& shape)
{
    std::uint32_t number;
    if (freeDiamonds_.empty()) {
        number = std::uint32_t(diamonds_.size());
        grow(diamonds_);
        grow(links_);
        grow(labels_);
        grow(priorities_);
        if (!regular_) grow(boxes_);
    } else {
        number = freeDiamonds_.back();
        freeDiamonds_.pop_back();
    }
    Diamond& d = diamonds_[number];
    Links& links = links_[number];
    d = Diamond{};
    links = Links{.serial = links.serial};
    labels_[number] = Label(kAlive | parity_);
    priorities_[number] = 0.0f;
    d.centre = shape.centre;
    d.level = std::uint8_t(shape.level(model_.errors->exponent()));
    d.error = model_.errors->error(shape);
    links.finest = shape.isFinest();
    for (const std::size_t apex : {1u, 3u})
        if (d.level > 0 && inSquare(shape.corner[apex])) ++d.parentCount;
    bound(grid, shape, number);
    table_.insert(number, [this](std::uint32_t other) { return diamonds_[other].centre; });
    // Before the first selection there is no view; that selection evaluates what is there.
    if (space_) {
        label(number);
        evaluate(number);
        enqueue(number);
    }
    return number;
}

void RoamMesh::destroy(std::uint32_t number)
{
    table_.erase(number, [this](std::uint32_t other) { return diamonds_[other].centre; });
    ++links_[number].serial;
    labels_[number] = 0;
    freeDiamonds_.push_back(number);
}

std::uint8_t RoamMesh::findSolidCells(const SampleGrid& grid, glm::ivec2 centre) const
{
    std::uint8_t solid = 0;
    const auto valid = [&grid](int column, int row) { return grid.contains(column, row) && !grid.isHole(column, row); };
    for (const int dy : {-1, 1})
        for (const int dx : {-1, 1})
            if (valid(centre.x, centre.y) && valid(centre.x + dx, centre.y) && valid(centre.x, centre.y + dy) &&
                valid(centre.x + dx, centre.y + dy))
                solid = std::uint8_t(solid | 1u << cellBit(dx, dy));
    return solid;
}

void RoamMesh::split(const SampleGrid& grid, std::uint32_t number)
{
    const DiamondShape shape(diamonds_[number].centre);
    const bool isRoot = diamonds_[number].level == 0;
    // Both triangles must be there: a parent that is not split yet is split first, and its parents before it (ROAM's forced split).
    for (std::size_t half = 0; half < 2 && !isRoot; ++half) {
        const glm::ivec2 apex = shape.corner[half ? 3 : 1];
        if (diamonds_[number].parent[half] != kNone || !inSquare(apex)) continue;
        std::uint32_t parent = find(apex);
        if (parent == kNone) parent = create(grid, DiamondShape(apex));
        split(grid, parent);
    }
    Links& links = links_[number];
    labels_[number] |= kSplit;
    links.vertex = addVertex(grid, shape.centre);
    if (links.vertex != kNoVertex) vertices_[links.vertex].edge = {vertexAt(shape.corner[0]), vertexAt(shape.corner[2])};
    if (links.finest && !whole_) links.solidCells = findSolidCells(grid, shape.centre);
    for (const std::uint32_t parent : diamonds_[number].parent)
        if (parent != kNone) ++diamonds_[parent].splitChildren;
    meshTriangles_ += splitTriangles(diamonds_[number]);
    ++report_.splits;
    ++operations_;
    if (!links.finest) adoptChildren(grid, number, shape);
}

void RoamMesh::adoptChildren(const SampleGrid& grid, std::uint32_t number, const DiamondShape& shape)
{
    for (int side = 0; side < 4; ++side) {
        const glm::ivec2 centre = shape.child(side);
        // At the rim of the square one half of the diamond, and its two sides, do not exist.
        if (!inSquare(centre)) continue;
        const DiamondShape childShape(centre);
        std::uint32_t child = find(centre);
        if (child == kNone) {
            if (!(model_.errors->error(childShape) > 0.0f)) continue;
            child = create(grid, childShape);
        }
        const unsigned half = childShape.corner[1] == shape.centre ? 0 : 1;
        links_[number].child[std::size_t(side)] = 2 * child + half;
        diamonds_[child].parent[half] = number;
    }
}

void RoamMesh::merge(std::uint32_t number)
{
    Links& links = links_[number];
    for (std::uint32_t& link : links.child) {
        if (link == kNone) continue;
        Diamond& child = diamonds_[link / 2];
        child.parent[link % 2] = kNone;
        if (child.parent[0] == kNone && child.parent[1] == kNone) destroy(link / 2);
        link = kNone;
    }
    for (const std::uint32_t parent : diamonds_[number].parent)
        if (parent != kNone) --diamonds_[parent].splitChildren;
    if (links.vertex != kNoVertex) freeVertices_.push_back(links.vertex);
    links.vertex = kNoVertex;
    labels_[number] = Label(labels_[number] & ~kSplit);
    meshTriangles_ -= splitTriangles(diamonds_[number]);
    ++report_.merges;
    ++operations_;
}

std::size_t RoamMesh::bytes() const
{
    std::size_t total = diamonds_.capacity() * (sizeof(Diamond) + sizeof(Links) + sizeof(Label) + sizeof(float)) + table_.bytes();
    total += positions_.capacity() * sizeof(glm::vec3) + vertices_.capacity() * sizeof(Vertex) + boxes_.capacity() * sizeof(Box);
    total += (samples_.capacity() + freeVertices_.capacity() + newVertices_.capacity() + indices_.capacity() + freeDiamonds_.capacity() + byLevel_.capacity()) *
             sizeof(std::uint32_t);
    total += (splitQueue_.capacity() + mergeQueue_.capacity()) * sizeof(Candidate);
    return total;
}

}  // namespace terrain
