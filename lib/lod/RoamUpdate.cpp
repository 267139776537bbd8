// How a mesh follows samples that change.
#include <algorithm>

#include "base/ProfileScope.h"
#include "lod/RoamMesh.h"

namespace terrain {

bool RoamMesh::update(const SampleGrid& grid, const GridEdits& edits) {
    if (edits.holes) return false;
    const ProfileScope scope("roam: edit");
    const bool isWithinSteps = bounds_.holds(model_.boxes->all());
    if (!isWithinSteps) bounds_.rescale(model_.boxes->all());
    const std::size_t count = bounds_.size();
    for (std::uint32_t number = 0; number < count; ++number) {
        if (freeDiamonds_[number / 64] >> (number % 64) & 1) continue;
        const DiamondShape shape(bounds_.centre(number));
        const int reach = ErrorHierarchy::kReach * shape.size;
        const bool isTouched = edits.touches({shape.centre - reach, shape.centre + reach});
        if (isTouched || !isWithinSteps) boundAgain(grid, shape, number);
        if (isTouched && isSplit(number) && !links(number).finest) addMissingChildren(grid, number);
    }
    // A grid that was flat has no diamond.
    if (root_ == kNone && model_.errors->exponent() > 0) {
        const DiamondShape shape(glm::ivec2(side_ / 2));
        if (model_.errors->error(grid, shape) > 0.0f) root_ = create(grid, shape);
    }
    moveVertices(grid, edits);
    wasEdited_ = true;
    return true;
}

void RoamMesh::boundAgain(const SampleGrid& grid, const DiamondShape& shape, std::uint32_t number) {
    bound(grid, shape, number);
    // What is there must count as seen, even where it is flat now.
    constexpr float kNothing = 1e-30f;
    if (model_.errors->error(grid, shape) == 0.0f)
        bounds_.set(number, shape.centre, shape.size,
                    model_.boxes->bounds(shape.centre.x - shape.size, shape.centre.y - shape.size, shape.centre.x + shape.size,
                                         shape.centre.y + shape.size),
                    kNothing);
    blockOf(number).due = std::uint16_t(frame_ + 1);
}

/// What was flat when the diamond was split, and is not any more.
void RoamMesh::addMissingChildren(const SampleGrid& grid, std::uint32_t number) {
    const DiamondShape shape(bounds_.centre(number));
    for (int side = 0; side < 4; ++side) {
        if (links(number).child[std::size_t(side)] != kFlatLink) continue;
        const DiamondShape childShape(shape.child(side));
        if (!inSquare(childShape.centre) || table_.find(childShape.centre) != kNone) continue;
        if (model_.errors->error(grid, childShape) > 0.0f) linkToParents(create(grid, childShape), childShape);
    }
}

void RoamMesh::moveVertices(const SampleGrid& grid, const GridEdits& edits) {
    // Normals look one sample around.
    const GridEdits around = edits.widened(1);
    std::vector<bool> isFree(vertices_.size());
    for (std::uint32_t vertex = freeVertex_; vertex != kNone; vertex = vertices_[vertex].edge[0]) isFree[vertex] = true;
    for (std::uint32_t vertex = 0; vertex < vertices_.size(); ++vertex) {
        if (isFree[vertex]) continue;
        const glm::ivec2 sample(int(samples_[vertex]) % columns_, int(samples_[vertex]) / columns_);
        if (!around.contains(sample)) continue;
        edited_.push_back(vertex);
        vertices_[vertex].target = grid.position(sample.x, sample.y);
        // What slides is placed by morph().
        if (vertices_[vertex].morph >= 1.0f) positions_[vertex] = vertices_[vertex].target;
    }
}

}  // namespace terrain
