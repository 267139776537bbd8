// A camera that flies over ground.
#pragma once

#include <array>
#include <functional>
#include <optional>

#include "Flight.h"

namespace app {

/// What moves or turns. Positive: forward, right, up; to the left, upwards, roll to the left.
enum class FlyAxis { Forward, Right, Up, Turn, Pitch, Roll };

/// Turns held keys and mouse motion into poses. Speed grows with the height over the ground; motion eases in and out, and comes out
/// the same at any frame rate. The camera stays above the ground.
class FlyCamera {
public:
    using Ground = std::function<std::optional<float>(const SbVec3f&)>;

    /// `size`: length of the terrain's side, from which speeds and clearance follow.
    FlyCamera(Ground ground, float size);

    void setPose(const Pose& pose);
    Pose pose() const;

    /// Adds to what the keys ask for on an axis: +1 or -1 on press, the reverse on release.
    void push(FlyAxis axis, float amount) { wish_[std::size_t(axis)] += amount; }
    void releaseAll() { wish_ = {}; }
    /// Turns at once, in radians.
    void look(float turn, float pitch);
    /// Makes it faster by this factor, within limits.
    void changeSpeed(float factor);
    /// Keeps the height over the ground that it has now, or lets go of it.
    void setConstantHeight(bool on);
    bool constantHeight() const { return keptHeight_.has_value(); }

    /// Moves on. Returns whether the camera moves, now or in the next step.
    bool step(float seconds);

    float clearance() const { return 0.002f * size_; }

private:
    float heightOverGround() const;
    void stayAboveGround();

    Ground ground_;
    float size_;
    SbVec3f position_{0.0f, 0.0f, 0.0f};
    float yaw_ = 0.0f;    ///< 0 looks along +y, positive to the left
    float pitch_ = 0.0f;  ///< positive upwards
    float roll_ = 0.0f;
    std::array<float, 6> wish_{};
    std::array<float, 6> rate_{};  ///< eased wish
    float speed_ = 1.0f;
    std::optional<float> keptHeight_;
};

}  // namespace app
