#include "lod/ViewMotion.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace terrain {

void ViewMotion::read(const View& view, const glm::dmat4& localFromFrame) {
    const glm::dmat4 clip = view.clipFromLocal * localFromFrame, rows = glm::transpose(clip);
    for (int axis = 0; axis < 3; ++axis) {
        forms_[std::size_t(2 * axis)] = rows[3] + rows[axis];
        forms_[std::size_t(2 * axis + 1)] = rows[3] - rows[axis];
        unitLength_[axis] = glm::length(glm::dvec3(localFromFrame[axis]));
    }
    forms_[6] = rows[3];
    // The point where x, y and w vanish; an orthographic camera has none, and any point will do.
    const glm::dvec4 eye = glm::inverse(clip) * glm::dvec4(0.0, 0.0, 1.0, 0.0);
    eye_ = std::fabs(eye.w) > 1e-12 * glm::length(glm::dvec3(eye)) ? glm::dvec3(eye) / eye.w : glm::dvec3(0.0);
}

bool ViewMotion::advance(const View& view, const glm::dmat4& localFromFrame) {
    const ViewMotion before = *this;
    read(view, localFromFrame);
    known_ = true;
    if (!before.known_) return false;
    Bound planes, depth;
    for (std::size_t i = 0; i < forms_.size(); ++i) {
        const glm::dvec4 change = forms_[i] - before.forms_[i];
        Bound& bound = i == 6 ? depth : planes;
        bound.shift = std::max(bound.shift, float(std::fabs(glm::dot(change, glm::dvec4(eye_, 1.0)))));
        bound.turn = std::max(bound.turn, float(glm::length(glm::dvec3(change) / unitLength_)));
    }
    const float travel = float(glm::length((eye_ - before.eye_) * unitLength_));
    const auto within = [](const Bound& now, const Bound& assumed) {
        return now.shift <= assumed.shift && now.turn <= assumed.turn;
    };
    // Once in a while what is assumed follows a camera that has become slower.
    if (within(planes, planes_) && within(depth, depth_) && travel <= travel_ && ++age_ < 2 * kLongest) return true;
    constexpr float kFaster = 1.25f;
    planes_ = {planes.shift * kFaster, planes.turn * kFaster};
    depth_ = {depth.shift * kFaster, depth.turn * kFaster};
    travel_ = travel * kFaster;
    age_ = 0;
    return false;
}

}  // namespace terrain
