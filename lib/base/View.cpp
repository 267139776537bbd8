#include "base/View.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace terrain {

ScreenSpace::ScreenSpace(const View& view, const glm::dmat4& localFromFrame, ErrorDirection direction) : direction_(direction) {
    const glm::dmat4 rows = glm::transpose(view.clipFromLocal * localFromFrame);
    x_ = glm::vec4(rows[0]);
    y_ = glm::vec4(rows[1]);
    w_ = glm::vec4(rows[3]);
    scale_ = glm::vec2(view.viewportPixels * 0.5);
    for (int axis = 0; axis < 3; ++axis) {
        planes_[std::size_t(2 * axis)] = glm::vec4(rows[3] + rows[axis]);
        planes_[std::size_t(2 * axis + 1)] = glm::vec4(rows[3] - rows[axis]);
    }
    const auto length = [&](const glm::vec4& row, float t) {
        const glm::vec3 form = glm::vec3(row) - t * glm::vec3(w_);
        return direction == ErrorDirection::Vertical ? std::fabs(form.z) : glm::length(form);
    };
    largestFactor_ = glm::length(
        scale_ * glm::vec2(std::max(length(x_, -1.0f), length(x_, 1.0f)), std::max(length(y_, -1.0f), length(y_, 1.0f))));
}

float ScreenSpace::anyScreenError(float error, const Box& box) const {
    const float centreW = along(w_, box.centre), nearestW = centreW - reach(w_, box.half);
    if (!(nearestW > 0.0f)) return std::numeric_limits<float>::infinity();
    const auto largest = [&](const glm::vec4& row) {
        const float t = along(row, box.centre) / centreW, spread = reach(row - t * w_, box.half) / nearestW;
        const float low = std::clamp(t - spread, -1.0f, 1.0f), high = std::clamp(t + spread, -1.0f, 1.0f);
        return std::max(glm::length(glm::vec3(row) - low * glm::vec3(w_)), glm::length(glm::vec3(row) - high * glm::vec3(w_)));
    };
    const float pixels = error * glm::length(scale_ * glm::vec2(largest(x_), largest(y_))) / nearestW;
    return pixels == pixels ? pixels : std::numeric_limits<float>::infinity();
}

}  // namespace terrain
