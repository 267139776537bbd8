// The two queues of ROAM: what to split, what to merge, and in which order.
#include <algorithm>
#include <limits>

#include "lod/RoamMesh.h"

namespace terrain {

namespace {

// Heaps of the standard library keep the largest element first.
const auto kHighestFirst = [](const auto& a, const auto& b) { return a.priority < b.priority; };
const auto kLowestFirst = [](const auto& a, const auto& b) { return a.priority > b.priority; };

}  // namespace

DrawList RoamMesh::select(const SampleGrid& grid, const View& view, const LodSettings& settings)
{
    const bool isFirst = !space_;
    const bool atRest = !isFirst && report_.converged && view == view_ && settings == settings_;
    const float bound = report_.errorPixels;
    const std::uint32_t triangles = report_.triangles;
    report_ = SelectionReport{};
    positionsChanged_ = false;
    if (atRest) {
        newVertices_.clear();
        report_.errorPixels = bound;
        report_.triangles = triangles;
    } else {
        // The corners are new to whoever draws the first list.
        if (!isFirst) newVertices_.clear();
        view_ = view;
        settings_ = settings;
        space_.emplace(view, grid.localFromFrame(), grid.isRegular() ? ErrorDirection::Vertical : ErrorDirection::Any);
        operations_ = 0;
        update();
        refine(grid, isFirst || settings.operationLimit == 0 ? std::numeric_limits<std::uint32_t>::max() : settings.operationLimit);
        emit();
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

float RoamMesh::splitThreshold() const
{
    return settings_.geomorph ? settings_.pixelError * kMorphStart : settings_.pixelError;
}

FrustumLabel RoamMesh::inheritedLabel(std::uint32_t number)
{
    // A diamond lies within its two parents: what holds of both holds of it.
    const Diamond& d = diamonds_[number];
    FrustumLabel inherited = d.parentCount > 0 ? FrustumLabel(0xff) : FrustumLabel(0);
    int known = 0;
    for (const std::uint32_t parent : d.parent)
        if (parent != kNone) {
            if ((labels_[parent] & kParity) != parity_) label(parent);
            inherited = FrustumLabel(inherited & labels_[parent]);
            ++known;
        }
    return known < d.parentCount ? FrustumLabel(0) : inherited;
}

void RoamMesh::label(std::uint32_t number)
{
    FrustumLabel found = diamonds_[number].nowhere ? kOutside : kInsideAll;
    if (found != kOutside && settings_.cull) {
        found = inheritedLabel(number);
        if (!(found & kOutside) && found != kInsideAll) found = space_->classify(boxOfDiamond(number), found);
    }
    labels_[number] = Label((labels_[number] & (kSplit | kAlive)) | parity_ | found);
}

void RoamMesh::evaluate(std::uint32_t number)
{
    priorities_[number] = isOutside(number) ? 0.0f : space_->screenError(diamonds_[number].error, boxOfDiamond(number), splitThreshold());
}

void RoamMesh::enqueue(std::uint32_t number)
{
    const Candidate candidate{priorities_[number], number, links_[number].serial};
    if (!isSplit(number)) {
        if (candidate.priority > splitThreshold()) {
            splitQueue_.push_back(candidate);
            std::push_heap(splitQueue_.begin(), splitQueue_.end(), kHighestFirst);
        }
    } else if (diamonds_[number].splitChildren == 0 && (settings_.triangleBudget > 0 || candidate.priority <= splitThreshold())) {
        mergeQueue_.push_back(candidate);
        std::push_heap(mergeQueue_.begin(), mergeQueue_.end(), kLowestFirst);
    }
}

void RoamMesh::update()
{
    splitQueue_.clear();
    mergeQueue_.clear();
    const float threshold = splitThreshold();
    const bool queueAllMerges = settings_.triangleBudget > 0;
    // Parents are labelled before their children wherever they stand, so that this runs through memory in order.
    parity_ ^= kParity;
    for (std::uint32_t number = 0; number < labels_.size(); ++number) {
        if (!(labels_[number] & kAlive)) continue;
        if ((labels_[number] & kParity) != parity_) label(number);
        evaluate(number);
        const float priority = priorities_[number];
        if (!isSplit(number)) {
            if (priority > threshold) splitQueue_.push_back({priority, number, links_[number].serial});
        } else if (diamonds_[number].splitChildren == 0 && (queueAllMerges || priority <= threshold)) {
            mergeQueue_.push_back({priority, number, links_[number].serial});
        }
    }
    std::make_heap(splitQueue_.begin(), splitQueue_.end(), kHighestFirst);
    std::make_heap(mergeQueue_.begin(), mergeQueue_.end(), kLowestFirst);
}

std::uint32_t RoamMesh::triangleCost(std::uint32_t number) const
{
    const Diamond& d = diamonds_[number];
    std::uint32_t cost = splitTriangles(d);
    if (d.level == 0) return cost;
    const DiamondShape shape(d.centre);
    for (std::size_t half = 0; half < 2; ++half) {
        const glm::ivec2 apex = shape.corner[half ? 3 : 1];
        if (d.parent[half] != kNone || !inSquare(apex)) continue;
        const std::uint32_t parent = find(apex);
        // A parent without a record needs up to two more splits a level above it.
        cost += parent != kNone ? triangleCost(parent) : std::uint32_t(2 * 2 * d.level);
    }
    return cost;
}

void RoamMesh::mergeAndQueueParents(std::uint32_t number)
{
    const auto parents = diamonds_[number].parent;
    merge(number);
    for (const std::uint32_t parent : parents)
        if (parent != kNone && isMergeable(parent)) enqueue(parent);
}

bool RoamMesh::makeRoom(const Candidate& candidate)
{
    while (meshTriangles_ + triangleCost(candidate.diamond) > settings_.triangleBudget) {
        if (mergeQueue_.empty() || !(mergeQueue_.front().priority < candidate.priority)) return false;
        std::pop_heap(mergeQueue_.begin(), mergeQueue_.end(), kLowestFirst);
        const Candidate lowest = mergeQueue_.back();
        mergeQueue_.pop_back();
        if (!isAlive(lowest) || !isMergeable(lowest.diamond)) continue;
        // Its own parents must stay.
        const auto& parents = diamonds_[candidate.diamond].parent;
        if (parents[0] == lowest.diamond || parents[1] == lowest.diamond) continue;
        mergeAndQueueParents(lowest.diamond);
    }
    return true;
}

void RoamMesh::refine(const SampleGrid& grid, std::uint32_t limit)
{
    const std::uint32_t budget = settings_.triangleBudget;
    while (budget > 0 && meshTriangles_ > budget && !mergeQueue_.empty()) {
        std::pop_heap(mergeQueue_.begin(), mergeQueue_.end(), kLowestFirst);
        const Candidate lowest = mergeQueue_.back();
        mergeQueue_.pop_back();
        if (isAlive(lowest) && isMergeable(lowest.diamond)) mergeAndQueueParents(lowest.diamond);
    }
    // A quarter of the operations is kept for merges, so that a mesh in flight does not only grow.
    const std::uint32_t splitLimit = limit - std::min(limit / 4, std::uint32_t(mergeQueue_.size()));
    while (!splitQueue_.empty()) {
        const Candidate candidate = splitQueue_.front();
        if (isAlive(candidate) && !isSplit(candidate.diamond)) {
            if (operations_ >= splitLimit) {
                report_.converged = false;
                break;
            }
            if (budget > 0 && !makeRoom(candidate)) break;
        }
        // Making room may have changed the queue, but never its top.
        std::pop_heap(splitQueue_.begin(), splitQueue_.end(), kHighestFirst);
        splitQueue_.pop_back();
        if (!isAlive(candidate) || isSplit(candidate.diamond)) continue;
        split(grid, candidate.diamond);
        if (budget > 0) enqueue(candidate.diamond);
    }
    coarsen(limit);
}

void RoamMesh::coarsen(std::uint32_t limit)
{
    while (!mergeQueue_.empty() && mergeQueue_.front().priority <= splitThreshold()) {
        if (operations_ >= limit) {
            report_.converged = false;
            return;
        }
        std::pop_heap(mergeQueue_.begin(), mergeQueue_.end(), kLowestFirst);
        const Candidate lowest = mergeQueue_.back();
        mergeQueue_.pop_back();
        if (isAlive(lowest) && isMergeable(lowest.diamond)) mergeAndQueueParents(lowest.diamond);
    }
}

}  // namespace terrain
