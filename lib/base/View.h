// A camera as the algorithms see it, and the one place where errors in units of the terrain become errors in pixels.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "base/Box.h"

namespace terrain {

/// Projection of terrain-local points onto a viewport: any combination of model transform, perspective or orthographic camera.
/// `clipFromLocal` maps local points to clip space as OpenGL has it: in view where |x|, |y|, |z| <= w.
struct View {
    glm::dmat4 clipFromLocal{1.0};
    glm::dvec2 viewportPixels{0.0, 0.0};

    bool operator==(const View&) const = default;
};

/// Which way a drawn point can lie off its sample.
enum class ErrorDirection {
    Vertical,  ///< along the third axis of the frame only (height fields)
    Any        ///< anywhere (curved grids)
};

/// Planes of the view volume that a box is known to lie inside of, one bit each; `kOutside` when it is outside of one.
using FrustumLabel = std::uint8_t;
inline constexpr FrustumLabel kInsideAll = 0x3f;
inline constexpr FrustumLabel kOutside = 0x80;

/// A view prepared for testing many boxes of one frame of reference (local coordinates, or grid coordinates).
///
/// Screen error. A point P of the box that is in view is drawn displaced by d (vertical: d = e u, u the third axis). With clip rows
/// X, Y, W the displacement on screen is exactly
///     | (sx (X - tx W) . d, sy (Y - ty W) . d) | / W(P + d),   tx = X(P) / W(P), ty = Y(P) / W(P) in [-1, 1],
/// with sx, sy half the viewport's size. W is bounded below over the box, which contains the drawn point too; tx and ty are bounded by
/// their interval over the box, cut to the window. An error seen from above therefore counts for less, one near the window's corners,
/// where a perspective image is stretched, for more. Where the box reaches behind the eye the bound is infinite.
class ScreenSpace {
public:
    ScreenSpace(const View& view, const glm::dmat4& localFromFrame, ErrorDirection direction);

    /// Bound, in pixels, on the screen error of any point of `box` that is in view, when it is drawn at most `error` units off and
    /// within the box. 0 for an error of 0. Where a coarser bound is at most `enough` already, that one is returned: what only needs
    /// to know on which side of a threshold the error lies costs a third then.
    float screenError(float error, const Box& box, float enough = -1.0f) const;

    /// Tests the box against those planes that `known` does not name as inside already.
    FrustumLabel classify(const Box& box, FrustumLabel known) const;

private:
    static float along(const glm::vec4& form, const glm::vec3& p) { return form.x * p.x + form.y * p.y + form.z * p.z + form.w; }
    static float reach(const glm::vec4& form, const glm::vec3& half)
    {
        return std::fabs(form.x) * half.x + std::fabs(form.y) * half.y + std::fabs(form.z) * half.z;
    }
    float directionFactor(float lowX, float highX, float lowY, float highY) const;
    float anyDirectionFactor(float lowX, float highX, float lowY, float highY) const;

    glm::vec4 x_, y_, w_;
    float largestFactor_ = 0.0f;  ///< directionFactor() over the whole window
    glm::vec2 scale_;  ///< half the viewport, in pixels
    std::array<glm::vec4, 6> planes_;
    ErrorDirection direction_;
};

// Defined here because a selection calls them tens of thousands of times a frame.

inline float ScreenSpace::directionFactor(float lowX, float highX, float lowY, float highY) const
{
    if (direction_ == ErrorDirection::Any) return anyDirectionFactor(lowX, highX, lowY, highY);
    // Both terms are convex in tx and ty, so that the ends of the intervals bound them.
    const float horizontal = std::max(std::fabs(x_.z - lowX * w_.z), std::fabs(x_.z - highX * w_.z)) * scale_.x;
    const float vertical = std::max(std::fabs(y_.z - lowY * w_.z), std::fabs(y_.z - highY * w_.z)) * scale_.y;
    return std::sqrt(horizontal * horizontal + vertical * vertical);
}

inline float ScreenSpace::screenError(float error, const Box& box, float enough) const
{
    if (!(error > 0.0f)) return 0.0f;
    const float centreW = along(w_, box.centre);
    const float nearestW = centreW - reach(w_, box.half);
    if (!(nearestW > 0.0f)) return std::numeric_limits<float>::infinity();
    const float inverseNearest = 1.0f / nearestW, coarse = error * largestFactor_ * inverseNearest;
    if (coarse <= enough) return coarse;
    const float inverse = 1.0f / centreW;
    const float tx = along(x_, box.centre) * inverse, ty = along(y_, box.centre) * inverse;
    const float spreadX = reach(x_ - tx * w_, box.half) * inverseNearest;
    const float spreadY = reach(y_ - ty * w_, box.half) * inverseNearest;
    const auto window = [](float t) { return std::clamp(t, -1.0f, 1.0f); };
    const float factor = directionFactor(window(tx - spreadX), window(tx + spreadX), window(ty - spreadY), window(ty + spreadY));
    return error * factor * inverseNearest;
}

inline FrustumLabel ScreenSpace::classify(const Box& box, FrustumLabel known) const
{
    for (unsigned plane = 0; plane < 6; ++plane) {
        const FrustumLabel bit = FrustumLabel(1u << plane);
        if (known & bit) continue;
        const float distance = along(planes_[plane], box.centre), extent = reach(planes_[plane], box.half);
        if (distance < -extent) return kOutside;
        if (distance >= extent) known = FrustumLabel(known | bit);
    }
    return known;
}

}  // namespace terrain
