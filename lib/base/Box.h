// Axis-aligned box by centre and half size.
#pragma once

#include <glm/vec3.hpp>

namespace terrain {

/// Closed axis-aligned box; a point is inside when |point - centre| <= half on every axis.
struct Box {
    glm::vec3 centre{0.0f};
    glm::vec3 half{0.0f};

    glm::vec3 lowest() const { return centre - half; }
    glm::vec3 highest() const { return centre + half; }
};

/// The smallest box around two corner points.
inline Box boxBetween(const glm::vec3& low, const glm::vec3& high) {
    return {(low + high) * 0.5f, (high - low) * 0.5f};
}

}  // namespace terrain
