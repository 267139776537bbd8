#include "lod/UpperSide.h"

#include <cmath>

#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

namespace terrain {

bool showsUpperSideOnly(const SampleGrid& grid, const BoxPyramid& boxes, const View& view) {
    if (!grid.isRegular() || boxes.hasHoles()) return false;
    // OpenGL's eye and clip coordinates differ in handedness. Where this is not so something mirrors, and front faces look like
    // back faces.
    if (!(glm::determinant(view.clipFromLocal) < 0.0)) return false;
    const glm::dmat4 frameFromClip = glm::inverse(view.clipFromLocal * grid.localFromFrame());
    constexpr double kFar = 1e30;
    glm::dvec3 low(kFar), high(-kFar);
    for (int corner = 0; corner < 4; ++corner) {
        const glm::dvec4 p = frameFromClip * glm::dvec4(corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, -1.0, 1.0);
        const glm::dvec3 point = glm::dvec3(p) / p.w;
        // Also false for what is no number.
        if (!(point.x >= 0.0 && point.x <= grid.columns() - 1 && point.y >= 0.0 && point.y <= grid.rows() - 1)) return false;
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    const BoxPyramid::Bounds ground = boxes.bounds(int(low.x), int(low.y), int(std::ceil(high.x)), int(std::ceil(high.y)));
    return low.z > double(ground.high.z);
}

}  // namespace terrain
