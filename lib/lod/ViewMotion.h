// How long what was found out about a box stays true while the camera moves.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>

#include "base/View.h"

namespace terrain {

/// Bounds on the change, from one frame to the next, of the linear forms that a view is tested by: the planes of its volume and its
/// depth w. With E the eye and r the distance of a point from it, a form changes by at most `shift + turn r`. A somewhat faster
/// motion than the latest one is assumed; as long as the real one stays below it, what was found with a margin holds for as many
/// frames as the margin lasts (Duchaineau et al. 1997, sect. 6.2 and 6.3: incremental labels, deferred priorities).
class ViewMotion {
public:
    static constexpr int kLongest = 32;  ///< frames

    struct Bound {
        float shift = 0.0f;
        float turn = 0.0f;
    };

    /// Takes the next view of the same frame of reference; false when nothing that was found before may be kept.
    bool advance(const View& view, const glm::dmat4& localFromFrame);

    const Bound& planes() const { return planes_; }
    const Bound& depth() const { return depth_; }
    glm::vec3 eye() const { return glm::vec3(eye_); }                ///< in the frame
    glm::vec3 unitLength() const { return glm::vec3(unitLength_); }  ///< of the frame's axes, in local units
    /// Distance that the eye itself moves in kLongest frames.
    float drift() const { return float(kLongest) * travel_; }

private:
    void read(const View& view, const glm::dmat4& localFromFrame);

    std::array<glm::dvec4, 7> forms_{};  ///< six planes, then w
    glm::dvec3 eye_{0.0};
    glm::dvec3 unitLength_{1.0};
    Bound planes_, depth_;
    float travel_ = 0.0f;
    int age_ = 0;
    bool known_ = false;
};

}  // namespace terrain
