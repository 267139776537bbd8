// The two queues of ROAM: what to split, what to merge, and in which order.
#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>

#include "base/ProfileScope.h"
#include "lod/RoamMesh.h"

namespace terrain {

namespace {

// Heaps of the standard library keep the largest element first.
const auto kHighestFirst = [](const auto& a, const auto& b) { return a.priority < b.priority; };
const auto kLowestFirst = [](const auto& a, const auto& b) { return a.priority > b.priority; };

}  // namespace

DrawList RoamMesh::select(const SampleGrid& grid, const View& view, const LodSettings& settings) {
    const bool isFirst = !space_;
    // Where there is nothing left to do, how much of it a frame may do is the same to the mesh.
    LodSettings unlimited = settings;
    unlimited.operationLimit = settings_.operationLimit;
    const bool atRest = !isFirst && !wasEdited_ && report_.converged && view == view_ && unlimited == settings_;
    SelectionReport last = report_;
    report_ = SelectionReport{};
    positionsChanged_ = std::exchange(wasEdited_, false);
    // The corners are new to whoever draws the first list.
    if (!isFirst) newVertices_.clear();
    // A first mesh is all new, later ones but for a few vertices are not.
    if (newVertices_.capacity() > 4096 && newVertices_.empty()) newVertices_.shrink_to_fit();
    newVertices_.insert(newVertices_.end(), edited_.begin(), edited_.end());
    edited_.clear();
    if (atRest) {
        report_.triangles = last.triangles;
        report_.errorPixels = last.errorPixels;
    } else {
        prepare(grid, view, settings, last.converged);
        refine(grid, isFirst || settings.operationLimit == 0 ? std::numeric_limits<std::uint32_t>::max() : settings.operationLimit);
        emit();
        boundError();
        morph();
    }
    DrawList list;
    list.positions = positions_;
    list.samples = samples_;
    list.indices = indices_;
    list.newVertices = newVertices_;
    list.positionsChanged = positionsChanged_ || !newVertices_.empty();
    list.indicesChanged = !atRest;
    list.report = report_;
    return list;
}

void RoamMesh::prepare(const SampleGrid& grid, const View& view, const LodSettings& settings, bool wasDone) {
    const bool sameSettings = settings == settings_;
    view_ = view;
    settings_ = settings;
    ++frame_;
    operations_ = 0;
    space_.emplace(view, grid.localFromFrame(), grid.isRegular() ? ErrorDirection::Vertical : ErrorDirection::Any);
    // A budget needs all priorities in order, not only on which side of a threshold they are.
    mayDefer_ = motion_.advance(view, grid.localFromFrame()) && sameSettings && wasDone && settings.cull &&
                settings.triangleBudget == 0 && space_->largestFactor() <= request_.assumedFactor;
    const float assumedFactor = mayDefer_ ? request_.assumedFactor : 1.05f * space_->largestFactor();
    const glm::vec4 w = space_->depth();
    const float depthPerLength = glm::length(glm::vec3(w) / motion_.unitLength());
    const float depthAtEye = std::max(0.0f, glm::dot(glm::vec3(w), motion_.eye()) + w.w);
    request_ = {&*space_,   &motion_,       settings.cull, splitThreshold(), settings.pixelError,
                depthAtEye, depthPerLength, assumedFactor};
    update(grid);
}

void RoamMesh::evaluate(std::uint32_t number) {
    bounds_.evaluate(number, request_);
    blockOf(number).due = std::uint16_t(frame_ + 1);
    if (blockOf(number).leaf & bitOf(number)) showOrHide(number);
}

void RoamMesh::enqueue(std::uint32_t number) {
    const Candidate candidate{bounds_.priority(number), number};
    if (!isSplit(number)) {
        if (candidate.priority > splitThreshold()) {
            splitQueue_.push_back(candidate);
            std::push_heap(splitQueue_.begin(), splitQueue_.end(), kHighestFirst);
        } else {
            leafError_ = std::max(leafError_, candidate.priority);
        }
    } else if (isMergeable(number) && (settings_.triangleBudget > 0 || candidate.priority <= splitThreshold())) {
        mergeQueue_.push_back(candidate);
        std::push_heap(mergeQueue_.begin(), mergeQueue_.end(), kLowestFirst);
    }
}

void RoamMesh::gather(const SampleGrid& grid, std::size_t number, const BlockEvaluation& found) {
    const Block& block = blocks_[number];
    const auto forEach = [&](unsigned bits, auto visit) {
        for (; bits != 0; bits &= bits - 1)
            visit(std::uint32_t(number * RoamBounds::kBlock) + std::uint32_t(std::countr_zero(bits)));
    };
    const unsigned below = ~unsigned(found.above);
    forEach(block.leaf & found.above, [&](std::uint32_t d) {
        splitQueue_.push_back({bounds_.priority(d), d});
        if (const glm::ivec2 vertex = bounds_.centre(d); grid.contains(vertex.x, vertex.y)) grid.prefetch(vertex.x, vertex.y);
    });
    forEach(block.mergeable & (settings_.triangleBudget > 0 ? ~0u : below), [this](std::uint32_t d) {
        mergeQueue_.push_back({bounds_.priority(d), d});
    });
    forEach(block.leaf & ~unsigned(block.hidden ^ found.inView), [this](std::uint32_t d) { showOrHide(d); });
    // Where some are deferred the threshold is all that is known of those below it.
    const auto rest = std::uint16_t(block.leaf & below & found.inView);
    if (rest != 0) leafError_ = std::max(leafError_, mayDefer_ ? request_.threshold : bounds_.largestPriority(number, rest));
}

void RoamMesh::update(const SampleGrid& grid) {
    const ProfileScope scope("roam: evaluate");
    splitQueue_.clear();
    mergeQueue_.clear();
    leafError_ = 0.0f;
    for (std::size_t block = 0; block < bounds_.blocks(); ++block) {
        if (mayDefer_ && blocks_[block].due != frame_) continue;
        const BlockEvaluation found = bounds_.evaluateBlock(block, request_);
        blocks_[block].due = std::uint16_t(frame_ + found.frames);
        gather(grid, block, found);
    }
    std::make_heap(splitQueue_.begin(), splitQueue_.end(), kHighestFirst);
    std::make_heap(mergeQueue_.begin(), mergeQueue_.end(), kLowestFirst);
}

std::uint32_t RoamMesh::triangleCost(std::uint32_t number) const {
    if (number == root_) return 2;
    const Diamond& d = diamonds_[number];
    const DiamondShape shape(bounds_.centre(number));
    std::uint32_t cost = isAtRim(shape) ? 1 : 2;
    for (std::size_t half = 0; half < 2; ++half) {
        const glm::ivec2 apex = shape.corner[half ? 3 : 1];
        if (d.parent[half] != kNone || !inSquare(apex)) continue;
        const std::uint32_t parent = table_.find(apex);
        // A parent without a record needs up to two more splits a level above it.
        cost += parent != kNone ? triangleCost(parent) : std::uint32_t(4 * shape.level(model_.errors->exponent()));
    }
    return cost;
}

void RoamMesh::mergeAndQueueParents(std::uint32_t number) {
    const auto parents = diamonds_[number].parent;
    merge(number);
    for (const std::uint32_t parent : parents)
        if (parent != kNone && isMergeable(parent)) {
            // Its own evaluation may have been deferred.
            evaluate(parent);
            enqueue(parent);
        }
}

bool RoamMesh::makeRoom(const Candidate& candidate) {
    while (meshTriangles_ + triangleCost(candidate.diamond) > settings_.triangleBudget) {
        if (mergeQueue_.empty() || !(mergeQueue_.front().priority < candidate.priority)) return false;
        if (operations_ >= operationCap_) {
            report_.converged = false;
            return false;
        }
        std::pop_heap(mergeQueue_.begin(), mergeQueue_.end(), kLowestFirst);
        const Candidate lowest = mergeQueue_.back();
        mergeQueue_.pop_back();
        if (!isCurrent(lowest) || !isMergeable(lowest.diamond)) continue;
        // Its own parents must stay.
        const auto& parents = diamonds_[candidate.diamond].parent;
        if (parents[0] == lowest.diamond || parents[1] == lowest.diamond) continue;
        mergeAndQueueParents(lowest.diamond);
    }
    return true;
}

void RoamMesh::refine(const SampleGrid& grid, std::uint32_t limit) {
    const ProfileScope scope("roam: split and merge");
    const std::uint32_t budget = settings_.triangleBudget;
    while (budget > 0 && meshTriangles_ > budget && !mergeQueue_.empty()) {
        std::pop_heap(mergeQueue_.begin(), mergeQueue_.end(), kLowestFirst);
        const Candidate lowest = mergeQueue_.back();
        mergeQueue_.pop_back();
        if (isCurrent(lowest) && isMergeable(lowest.diamond)) mergeAndQueueParents(lowest.diamond);
    }
    // A quarter of the operations is kept for merges, so that a mesh in flight does not only grow.
    operationCap_ = limit - std::min(limit / 4, std::uint32_t(mergeQueue_.size()));
    while (!splitQueue_.empty()) {
        const Candidate candidate = splitQueue_.front();
        if (isCurrent(candidate) && !isSplit(candidate.diamond)) {
            if (budget > 0 && !makeRoom(candidate)) break;
        }
        // Making room may have changed the queue, but never its top.
        std::pop_heap(splitQueue_.begin(), splitQueue_.end(), kHighestFirst);
        splitQueue_.pop_back();
        if (!isCurrent(candidate) || isSplit(candidate.diamond)) continue;
        if (!split(grid, candidate.diamond)) {
            // It stays what it is, and counts as such.
            leafError_ = std::max(leafError_, candidate.priority);
            report_.converged = false;
            break;
        }
        if (budget > 0) enqueue(candidate.diamond);
    }
    coarsen(limit);
}

void RoamMesh::coarsen(std::uint32_t limit) {
    while (!mergeQueue_.empty() && mergeQueue_.front().priority <= splitThreshold()) {
        if (operations_ >= limit) {
            report_.converged = false;
            return;
        }
        std::pop_heap(mergeQueue_.begin(), mergeQueue_.end(), kLowestFirst);
        const Candidate lowest = mergeQueue_.back();
        mergeQueue_.pop_back();
        if (isCurrent(lowest) && isMergeable(lowest.diamond)) mergeAndQueueParents(lowest.diamond);
    }
}

}  // namespace terrain
