// Boxes and errors of many diamonds, laid out for evaluating a block of them at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

#include "base/Box.h"
#include "base/View.h"
#include "lod/BoxPyramid.h"
#include "lod/ViewMotion.h"

namespace terrain {

/// What a selection asks of every block in a frame. Without culling, what is outside of the view has half the error that it would
/// have if the camera turned to it, where depth grows with distance as it does straight ahead.
struct EvaluationRequest {
    const ScreenSpace* space = nullptr;
    const ViewMotion* motion = nullptr;
    bool cull = true;
    float threshold = 0.0f;       ///< pixels above which a diamond is to be split
    float full = 0.0f;            ///< pixels above which it is split and stands still
    float depthAtEye = 0.0f;      ///< 0 but for orthographic cameras
    float depthPerLength = 0.0f;  ///< 0 for those
    float assumedFactor = 0.0f;   ///< ScreenSpace::largestFactor() will not exceed it while results are kept
};

/// What evaluating a block of diamonds found; a bit for each, the first one the lowest.
struct BlockEvaluation {
    std::uint16_t above = 0;   ///< priority above the request's threshold
    std::uint16_t inView = 0;  ///< priority above 0
    int frames = 1;            ///< priorities stay on the same side of the request's limits for so long: 1 to ViewMotion::kLongest
};

/// Structure of arrays, by the number of a diamond: 16 bytes each for a regular grid, whose heights and errors
/// are rounded outwards to 16 bits. A place that is not in use has an error of 0.
class RoamBounds {
public:
    static constexpr std::size_t kBlock = 16;

    /// `all`: bounds of the whole grid.
    RoamBounds(bool regular, const BoxPyramid::Bounds& all);

    /// Appends an unused place; the arrays grow in whole blocks.
    std::size_t append();
    std::size_t size() const { return size_; }
    std::size_t blocks() const { return error_.size() / kBlock; }

    /// The samples within `size` of the centre have these bounds, and the diamond this error.
    void set(std::size_t number, glm::ivec2 centre, int size, const BoxPyramid::Bounds& bounds, float error);
    /// Whether set() can hold these bounds: those of the whole grid may have grown since.
    bool holds(const BoxPyramid::Bounds& bounds) const;
    /// Steps for heights of bounds that have grown. All that is in use must be set again.
    void rescale(const BoxPyramid::Bounds& all);
    /// Priority 0 from now on.
    void clear(std::size_t number);

    glm::ivec2 centre(std::size_t number) const { return {column_[number], row_[number]}; }
    /// Bound on the screen error in pixels when last evaluated; 0 outside of the view.
    float priority(std::size_t number) const { return priority_[number]; }
    /// Largest priority among those of a block whose bits are set.
    float largestPriority(std::size_t block, std::uint16_t among) const;

    /// Evaluates the priorities of one block.
    BlockEvaluation evaluateBlock(std::size_t block, const EvaluationRequest& request);
    /// Priority of one diamond.
    void evaluate(std::size_t number, const EvaluationRequest& request);

    std::size_t bytes() const;

private:
    Box box(std::size_t number) const;
    static float turnedError(float error, const Box& box, const EvaluationRequest& request);

    bool regular_;
    std::size_t size_ = 0;
    std::vector<std::uint16_t> column_, row_, reach_;
    std::vector<std::uint16_t> lowest_, highest_;  ///< in steps of heightStep_ above heightBase_
    std::vector<Box> boxes_;                       ///< curved grids
    std::vector<std::uint16_t> error_;             ///< ErrorHierarchy::encode()
    std::vector<float> priority_;
    float heightBase_ = 0.0f, heightStep_ = 0.0f;
};

}  // namespace terrain
