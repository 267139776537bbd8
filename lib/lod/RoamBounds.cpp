#include "lod/RoamBounds.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "base/VectorClones.h"
#include "lod/ErrorHierarchy.h"

namespace terrain {

namespace {

/// Less slack than doubling leaves: these arrays are most of what a mesh holds.
template <class T>
void growTo(std::vector<T>& items, std::size_t size) {
    if (size > items.capacity()) items.reserve(size + size / 8 + 256);
    items.resize(size);
}

// Without contraction what the wider clones compute is the same.
constexpr std::size_t kLanes = RoamBounds::kBlock;
constexpr float kInfinity = std::numeric_limits<float>::infinity();
/// Priority of what is in view though nothing of its error shows: 0 means outside.
constexpr float kLeast = std::numeric_limits<float>::min();

struct Lanes {
    float x[kLanes], y[kLanes], z[kLanes], halfX[kLanes], halfY[kLanes], halfZ[kLanes];
};

struct HeightSteps {
    float base, step;
};

SOTERRAIN_VECTOR_CLONES
void loadRegular(const std::uint16_t* column, const std::uint16_t* row, const std::uint16_t* reach, const std::uint16_t* lowest,
                 const std::uint16_t* highest, const HeightSteps& height, Lanes& lanes) {
    const float base = height.base, half = 0.5f * height.step;
#pragma omp simd
    for (std::size_t i = 0; i < kLanes; ++i) {
        lanes.x[i] = float(int(column[i]));
        lanes.y[i] = float(int(row[i]));
        lanes.z[i] = base + float(int(lowest[i]) + int(highest[i])) * half;
        lanes.halfX[i] = lanes.halfY[i] = float(int(reach[i]));
        lanes.halfZ[i] = float(int(highest[i]) - int(lowest[i])) * half;
    }
}

void loadBox(const Box& box, std::size_t i, Lanes& lanes) {
    lanes.x[i] = box.centre.x;
    lanes.y[i] = box.centre.y;
    lanes.z[i] = box.centre.z;
    lanes.halfX[i] = box.half.x;
    lanes.halfY[i] = box.half.y;
    lanes.halfZ[i] = box.half.z;
}

/// ScreenSpace::screenError() and isOutside() for all lanes, and for how many frames what they say lasts.
SOTERRAIN_VECTOR_CLONES
void evaluateLanes(const Lanes& b, const std::uint16_t* code, const EvaluationRequest& request, float* priority, float* frames) {
    float error[kLanes];
#pragma omp simd
    for (std::size_t i = 0; i < kLanes; ++i) error[i] = std::bit_cast<float>(std::uint32_t(code[i]) << 15);
    const ScreenSpace& space = *request.space;
    // The largest value of a form over a box is form(centre) + |form| . half; outside by -that where it is negative.
    float outside[kLanes];
    for (float& value : outside) value = -kInfinity;
    for (const glm::vec4& plane : space.planes()) {
        const float px = plane.x, py = plane.y, pz = plane.z, pw = plane.w;
        const float reachX = std::fabs(px), reachY = std::fabs(py), reachZ = std::fabs(pz);
#pragma omp simd
        for (std::size_t i = 0; i < kLanes; ++i) {
            const float largest =
                px * b.x[i] + py * b.y[i] + pz * b.z[i] + pw + reachX * b.halfX[i] + reachY * b.halfY[i] + reachZ * b.halfZ[i];
            outside[i] = outside[i] > -largest ? outside[i] : -largest;
        }
    }
    if (space.direction() == ErrorDirection::Vertical)
#pragma omp simd
        for (std::size_t i = 0; i < kLanes; ++i)
            priority[i] = space.verticalScreenError(error[i], b.x[i], b.y[i], b.z[i], b.halfX[i], b.halfY[i], b.halfZ[i]);
    else
        for (std::size_t i = 0; i < kLanes; ++i)
            priority[i] = space.screenError(error[i], {{b.x[i], b.y[i], b.z[i]}, {b.halfX[i], b.halfY[i], b.halfZ[i]}});

    const glm::vec4 w = space.depth();
    const float reachWx = std::fabs(w.x), reachWy = std::fabs(w.y), reachWz = std::fabs(w.z);
    const glm::vec3 eye = request.motion->eye(), length = request.motion->unitLength();
    const ViewMotion::Bound planes = request.motion->planes(), depth = request.motion->depth();
    const float drift = request.motion->drift(), full = request.full;
    const float needed = request.assumedFactor / request.threshold, resting = 0.7f * request.assumedFactor / request.full;
#pragma omp simd
    for (std::size_t i = 0; i < kLanes; ++i) {
        const float nearest =
            w.x * b.x[i] + w.y * b.y[i] + w.z * b.z[i] + w.w - reachWx * b.halfX[i] - reachWy * b.halfY[i] - reachWz * b.halfZ[i];
        const float inView = priority[i] > kLeast ? priority[i] : kLeast;
        priority[i] = outside[i] > 0.0f || error[i] == 0.0f ? 0.0f : inView;
        const float distance = (std::fabs(b.x[i] - eye.x) + b.halfX[i]) * length.x +
                               (std::fabs(b.y[i] - eye.y) + b.halfY[i]) * length.y +
                               (std::fabs(b.z[i] - eye.z) + b.halfZ[i]) * length.z + drift;
        // Rates can be 0: then only what has no margin does not last.
        const float slack = std::fabs(outside[i]);
        const float labelFrames = slack > 0.0f ? slack / (planes.shift + planes.turn * distance) : 0.0f;
        // Not yet to be split: until w falls to `needed` error. Split and standing still: until it rises to `resting` error. In
        // between, where only the finer bound tells, nothing lasts.
        const float toSplit = nearest - error[i] * needed, toMove = error[i] * resting - nearest;
        const float margin = toSplit > 0.0f ? toSplit : toMove > 0.0f && priority[i] > full ? toMove : 0.0f;
        const float lasting = margin > 0.0f ? margin / (depth.shift + depth.turn * distance) : 0.0f;
        const float priorityFrames = outside[i] > 0.0f ? kInfinity : lasting;
        const float fewer = labelFrames < priorityFrames ? labelFrames : priorityFrames;
        // What is no number, because coordinates or the camera are beyond floats, does not last either.
        frames[i] = error[i] == 0.0f ? kInfinity : fewer > 0.0f ? fewer : 0.0f;
    }
}

SOTERRAIN_VECTOR_CLONES
BlockEvaluation summarize(const float* priority, const float* frames, float threshold) {
    float soonest = float(ViewMotion::kLongest);
    std::uint32_t above = 0, inView = 0;
#pragma omp simd reduction(min : soonest) reduction(| : above, inView)
    for (std::size_t i = 0; i < kLanes; ++i) {
        soonest = soonest < frames[i] ? soonest : frames[i];
        above |= priority[i] > threshold ? 1u << i : 0u;
        inView |= priority[i] > 0.0f ? 1u << i : 0u;
    }
    return {std::uint16_t(above), std::uint16_t(inView), std::max(1, int(soonest))};
}

SOTERRAIN_VECTOR_CLONES
float largestAmong(const float* priority, std::uint32_t among) {
    float largest = 0.0f;
#pragma omp simd reduction(max : largest)
    for (std::size_t i = 0; i < kLanes; ++i) {
        const float value = (among & 1u << i) != 0 ? priority[i] : 0.0f;
        largest = largest > value ? largest : value;
    }
    return largest;
}

}  // namespace

std::size_t RoamBounds::append() {
    if (size_ == error_.size()) {
        const std::size_t size = size_ + kBlock;
        growTo(column_, size);
        growTo(row_, size);
        growTo(error_, size);
        growTo(priority_, size);
        if (regular_) {
            growTo(reach_, size);
            growTo(lowest_, size);
            growTo(highest_, size);
        } else {
            growTo(boxes_, size);
        }
    }
    return size_++;
}

RoamBounds::RoamBounds(bool regular, const BoxPyramid::Bounds& all) : regular_(regular) {
    rescale(all);
}

bool RoamBounds::holds(const BoxPyramid::Bounds& bounds) const {
    if (!regular_ || bounds.isEmpty()) return true;
    return heightStep_ > 0.0f && bounds.low.z >= heightBase_ && bounds.high.z <= heightBase_ + 65535.0f * heightStep_;
}

void RoamBounds::rescale(const BoxPyramid::Bounds& all) {
    if (all.isEmpty()) return;
    heightBase_ = all.low.z;
    heightStep_ = float((double(all.high.z) - double(all.low.z)) / 65535.0);
}

void RoamBounds::set(std::size_t number, glm::ivec2 centre, int size, const BoxPyramid::Bounds& bounds, float error) {
    column_[number] = std::uint16_t(centre.x);
    row_[number] = std::uint16_t(centre.y);
    // What covers no valid sample is never seen.
    error_[number] = bounds.isEmpty() ? std::uint16_t(0) : ErrorHierarchy::encode(error);
    if (!regular_) {
        boxes_[number] = bounds.isEmpty() ? Box{} : boxOf(bounds);
        return;
    }
    reach_[number] = std::uint16_t(size);
    lowest_[number] = highest_[number] = 0;
    if (bounds.isEmpty() || !(heightStep_ > 0.0f)) return;
    // In doubles, because heights may span more than a float holds.
    const auto steps = [this](float height) { return (double(height) - double(heightBase_)) / double(heightStep_); };
    lowest_[number] = std::uint16_t(std::clamp(std::floor(steps(bounds.low.z)), 0.0, 65535.0));
    highest_[number] = std::uint16_t(std::clamp(std::ceil(steps(bounds.high.z)), 0.0, 65535.0));
}

void RoamBounds::clear(std::size_t number) {
    error_[number] = 0;
    priority_[number] = 0.0f;
}

Box RoamBounds::box(std::size_t number) const {
    if (!regular_) return boxes_[number];
    const float reach = float(int(reach_[number]));
    const float half = 0.5f * heightStep_;
    return {{float(int(column_[number])), float(int(row_[number])),
             heightBase_ + float(int(lowest_[number]) + int(highest_[number])) * half},
            {reach, reach, float(int(highest_[number]) - int(lowest_[number])) * half}};
}

void RoamBounds::evaluate(std::size_t number, const EvaluationRequest& request) {
    const Box b = box(number);
    const float error = ErrorHierarchy::decode(error_[number]);
    if (error == 0.0f)
        priority_[number] = 0.0f;
    else if (!request.space->isOutside(b))
        priority_[number] = std::max(kLeast, request.space->screenError(error, b));
    else
        priority_[number] = request.cull ? 0.0f : turnedError(error, b, request);
}

float RoamBounds::turnedError(float error, const Box& box, const EvaluationRequest& request) {
    const glm::vec3 gap = glm::max(glm::abs(box.centre - request.motion->eye()) - box.half, glm::vec3(0.0f));
    const float distance = glm::length(gap * request.motion->unitLength());
    // Half as fine as what is in view, which so comes first where work is limited.
    return 0.5f * error * request.space->largestFactor() / (request.depthAtEye + request.depthPerLength * distance);
}

BlockEvaluation RoamBounds::evaluateBlock(std::size_t block, const EvaluationRequest& request) {
    const std::size_t first = block * kBlock;
    Lanes lanes;
    if (regular_)
        loadRegular(&column_[first], &row_[first], &reach_[first], &lowest_[first], &highest_[first], {heightBase_, heightStep_},
                    lanes);
    else
        for (std::size_t i = 0; i < kBlock; ++i) loadBox(boxes_[first + i], i, lanes);
    float frames[kBlock];
    evaluateLanes(lanes, &error_[first], request, &priority_[first], frames);
    if (!request.cull)
        for (std::size_t number = first; number < first + kBlock; ++number)
            if (priority_[number] == 0.0f && error_[number] != 0)
                priority_[number] = turnedError(ErrorHierarchy::decode(error_[number]), box(number), request);
    return summarize(&priority_[first], frames, request.threshold);
}

float RoamBounds::largestPriority(std::size_t block, std::uint16_t among) const {
    return largestAmong(&priority_[block * kBlock], among);
}

std::size_t RoamBounds::bytes() const {
    const auto held = [](const auto& items) { return items.capacity() * sizeof(items[0]); };
    return held(column_) + held(row_) + held(reach_) + held(lowest_) + held(highest_) + held(boxes_) + held(error_) +
           held(priority_);
}

}  // namespace terrain
