#include "base/View.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace terrain {

ScreenSpace::ScreenSpace(const View& view, const glm::dmat4& localFromFrame, ErrorDirection direction) : direction_(direction)
{
    const glm::dmat4 rows = glm::transpose(view.clipFromLocal * localFromFrame);
    x_ = glm::vec4(rows[0]);
    y_ = glm::vec4(rows[1]);
    w_ = glm::vec4(rows[3]);
    scale_ = glm::vec2(view.viewportPixels * 0.5);
    for (int axis = 0; axis < 3; ++axis) {
        planes_[std::size_t(2 * axis)] = glm::vec4(rows[3] + rows[axis]);
        planes_[std::size_t(2 * axis + 1)] = glm::vec4(rows[3] - rows[axis]);
    }
    largestFactor_ = directionFactor(-1.0f, 1.0f, -1.0f, 1.0f);
}

float ScreenSpace::anyDirectionFactor(float lowX, float highX, float lowY, float highY) const
{
    const auto length = [this](const glm::vec4& row, float t) { return glm::length(glm::vec3(row) - t * glm::vec3(w_)); };
    const float horizontal = std::max(length(x_, lowX), length(x_, highX)) * scale_.x;
    const float vertical = std::max(length(y_, lowY), length(y_, highY)) * scale_.y;
    return std::sqrt(horizontal * horizontal + vertical * vertical);
}

}  // namespace terrain
