// How far drawn triangles are from the samples that they cover, in pixels.
#pragma once

#include <array>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "base/View.h"
#include "height/SampleGrid.h"

namespace terrain {

/// A vertex of a drawn mesh: where it is drawn, in local coordinates, and which place of the grid it stands for.
struct DrawnVertex {
    glm::vec3 position{0.0f};
    glm::vec2 place{0.0f};  ///< column and row
};

/// Sample by sample, as the promise says: for any grid, and slowly.
class TriangleErrors {
public:
    /// Of triangles over more samples than this, so many evenly spread over it are looked at.
    static constexpr int kMostSamples = 1 << 14;

    TriangleErrors(const SampleGrid& grid, const View& view) : grid_(grid), view_(view) {}

    /// Largest distance on screen between a sample in view that the triangle covers and the place at which it draws it; 0 where it
    /// covers none. Infinite where one of the two is behind the eye and the other is not.
    float pixels(const std::array<DrawnVertex, 3>& triangle) const;

private:
    float pixelsOf(glm::ivec2 sample, const glm::dvec3& drawn) const;

    const SampleGrid& grid_;
    const View view_;
};

}  // namespace terrain
