// A camera as the algorithms see it, and the one place where errors in units of the terrain become errors in pixels.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
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

/// A view prepared for testing many boxes of one frame of reference (local coordinates, or grid coordinates).
///
/// Screen error. A point P of the box that is in view is drawn displaced by d (vertical: d = e u, u the third axis). With clip rows
/// X, Y, W the displacement on screen is exactly
///     | (sx (X - tx W) . d, sy (Y - ty W) . d) | / W(P + d),   tx = X(P) / W(P), ty = Y(P) / W(P) in [-1, 1],
/// with sx, sy half the viewport's size. W is bounded below over the box, which contains the drawn point too; tx and ty are bounded
/// by their interval over the box, cut to the window. An error seen from above therefore counts for less, one near the window's
/// corners, where a perspective image is stretched, for more. Where the box reaches behind the eye the bound is infinite.
class ScreenSpace {
public:
    ScreenSpace(const View& view, const glm::dmat4& localFromFrame, ErrorDirection direction);

    /// Bound, in pixels, on the screen error of any point of `box` that is in view, when it is drawn at most `error` units off and
    /// within the box. 0 for an error of 0.
    float screenError(float error, const Box& box) const;

    /// The same for errors along the third axis, in a form that a compiler can do for many boxes at once. `error` must not be 0.
    float verticalScreenError(float error, float x, float y, float z, float halfX, float halfY, float halfZ) const;
    ErrorDirection direction() const { return direction_; }

    /// Forms that are not negative for points in view: the six planes of the view volume, and w itself.
    const std::array<glm::vec4, 6>& planes() const { return planes_; }
    const glm::vec4& depth() const { return w_; }
    /// Whether nothing of the box is in view, as far as one plane tells.
    bool isOutside(const Box& box) const;

    /// Pixels that a unit of error takes at most at w = 1, anywhere in the window.
    float largestFactor() const { return largestFactor_; }

private:
    static float along(const glm::vec4& form, const glm::vec3& p) { return form.x * p.x + form.y * p.y + form.z * p.z + form.w; }
    static float reach(const glm::vec4& form, const glm::vec3& half) {
        return std::fabs(form.x) * half.x + std::fabs(form.y) * half.y + std::fabs(form.z) * half.z;
    }
    float anyScreenError(float error, const Box& box) const;

    glm::vec4 x_, y_, w_;
    float largestFactor_ = 0.0f;
    glm::vec2 scale_;  ///< half the viewport, in pixels
    std::array<glm::vec4, 6> planes_;
    ErrorDirection direction_;
};

// Defined here because a selection calls them tens of thousands of times a frame.

__attribute__((always_inline)) inline float ScreenSpace::verticalScreenError(float error, float x, float y, float z, float halfX,
                                                                             float halfY, float halfZ) const {
    const auto reach3 = [&](float fx, float fy, float fz) {
        return std::fabs(fx) * halfX + std::fabs(fy) * halfY + std::fabs(fz) * halfZ;
    };
    const auto larger = [](float a, float b) { return a > b ? a : b; };
    const auto window = [](float t) { return t < -1.0f ? -1.0f : t > 1.0f ? 1.0f : t; };
    const float centreW = w_.x * x + w_.y * y + w_.z * z + w_.w, nearestW = centreW - reach3(w_.x, w_.y, w_.z);
    const float inverse = 1.0f / centreW, inverseNearest = 1.0f / nearestW;
    const float tx = (x_.x * x + x_.y * y + x_.z * z + x_.w) * inverse, ty = (y_.x * x + y_.y * y + y_.z * z + y_.w) * inverse;
    const float spreadX = reach3(x_.x - tx * w_.x, x_.y - tx * w_.y, x_.z - tx * w_.z) * inverseNearest;
    const float spreadY = reach3(y_.x - ty * w_.x, y_.y - ty * w_.y, y_.z - ty * w_.z) * inverseNearest;
    // Both terms are convex in tx and ty, so that the ends of the intervals bound them.
    const float horizontal =
        scale_.x * larger(std::fabs(x_.z - window(tx - spreadX) * w_.z), std::fabs(x_.z - window(tx + spreadX) * w_.z));
    const float vertical =
        scale_.y * larger(std::fabs(y_.z - window(ty - spreadY) * w_.z), std::fabs(y_.z - window(ty + spreadY) * w_.z));
    const float pixels = error * std::sqrt(horizontal * horizontal + vertical * vertical) * inverseNearest;
    // An infinite error times a direction that shows none of it is no number.
    return nearestW > 0.0f && pixels == pixels ? pixels : std::numeric_limits<float>::infinity();
}

inline float ScreenSpace::screenError(float error, const Box& box) const {
    if (!(error > 0.0f)) return 0.0f;
    if (direction_ == ErrorDirection::Any) return anyScreenError(error, box);
    return verticalScreenError(error, box.centre.x, box.centre.y, box.centre.z, box.half.x, box.half.y, box.half.z);
}

inline bool ScreenSpace::isOutside(const Box& box) const {
    return std::any_of(planes_.begin(), planes_.end(),
                       [&box](const glm::vec4& plane) { return along(plane, box.centre) + reach(plane, box.half) < 0.0f; });
}

}  // namespace terrain
