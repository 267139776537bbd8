// What a line meets.
#pragma once

#include <algorithm>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace terrain {

/// origin + t direction, with t in [first, last].
struct Line {
    glm::dvec3 origin;
    glm::dvec3 direction;
    double first;
    double last;

    /// Whether it meets the box, which is `slack` larger to every side.
    bool meets(const glm::dvec3& low, const glm::dvec3& high, double slack) const {
        double enter = first, leave = last;
        for (int axis = 0; axis < 3; ++axis) {
            if (direction[axis] == 0.0) {
                if (origin[axis] < low[axis] - slack || origin[axis] > high[axis] + slack) return false;
                continue;
            }
            const double a = (low[axis] - slack - origin[axis]) / direction[axis];
            const double b = (high[axis] + slack - origin[axis]) / direction[axis];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        return enter <= leave;
    }

    struct TriangleHit {
        double distance;         ///< t
        glm::dvec3 barycentric;  ///< weights of the corners
    };
    /// Moeller and Trumbore, "Fast, Minimum Storage Ray-Triangle Intersection", 1997. Borders belong to both neighbours, so that no
    /// line slips through between them.
    std::optional<TriangleHit> meets(const glm::dvec3 (&corner)[3]) const {
        constexpr double kBorder = 1e-9;
        const glm::dvec3 edge1 = corner[1] - corner[0], edge2 = corner[2] - corner[0];
        const glm::dvec3 p = glm::cross(direction, edge2);
        const double determinant = glm::dot(edge1, p);
        if (determinant == 0.0) return std::nullopt;
        const glm::dvec3 toOrigin = origin - corner[0];
        const double u = glm::dot(toOrigin, p) / determinant;
        if (u < -kBorder || u > 1.0 + kBorder) return std::nullopt;
        const glm::dvec3 q = glm::cross(toOrigin, edge1);
        const double v = glm::dot(direction, q) / determinant;
        if (v < -kBorder || u + v > 1.0 + kBorder) return std::nullopt;
        const double t = glm::dot(edge2, q) / determinant;
        if (t < first || t > last) return std::nullopt;
        return TriangleHit{t, {1.0 - u - v, u, v}};
    }
};

}  // namespace terrain
