#include "FlyCamera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace app {

namespace {

constexpr float easeSeconds = 0.12f;  // time constant of easing in and out
constexpr float turnRate = 1.2f;      // radians a second
constexpr float longestStep = 0.02f;  // seconds; longer ones are divided, so that speed follows the ground closely
constexpr float pitchLimit = std::numbers::pi_v<float> / 2.0f - 0.01f;

const SbVec3f xAxis(1.0f, 0.0f, 0.0f);
const SbVec3f zAxis(0.0f, 0.0f, 1.0f);

SbRotation levelRotation(float yaw, float pitch) {
    return SbRotation(xAxis, std::numbers::pi_v<float> / 2.0f + pitch) * SbRotation(zAxis, yaw);
}

SbVec3f rotated(const SbRotation& rotation, const SbVec3f& vector) {
    SbVec3f result;
    rotation.multVec(vector, result);
    return result;
}

}  // namespace

FlyCamera::FlyCamera(Ground ground, float size) : ground_(std::move(ground)), size_(size) {}

void FlyCamera::setPose(const Pose& pose) {
    position_ = pose.position;
    const SbVec3f view = rotated(pose.orientation, SbVec3f(0.0f, 0.0f, -1.0f)),
                  up = rotated(pose.orientation, SbVec3f(0.0f, 1.0f, 0.0f));
    pitch_ = std::asin(std::clamp(view[2], -1.0f, 1.0f));
    // Looking straight up or down, the direction is that of the upper edge of the picture.
    const bool steep = std::hypot(view[0], view[1]) < 1e-4f;
    const SbVec3f heading = steep ? up * (view[2] < 0.0f ? 1.0f : -1.0f) : view;
    yaw_ = std::atan2(-heading[0], heading[1]);
    const SbRotation level = levelRotation(yaw_, pitch_);
    roll_ = std::atan2(-up.dot(rotated(level, xAxis)), up.dot(rotated(level, SbVec3f(0.0f, 1.0f, 0.0f))));
    pitch_ = std::clamp(pitch_, -pitchLimit, pitchLimit);
    rate_ = {};
    if (keptHeight_) keptHeight_ = heightOverGround();
}

Pose FlyCamera::pose() const {
    return {position_, SbRotation(zAxis, roll_) * levelRotation(yaw_, pitch_)};
}

void FlyCamera::look(float turn, float pitch) {
    yaw_ = std::remainder(yaw_ + turn, 2.0f * std::numbers::pi_v<float>);
    pitch_ = std::clamp(pitch_ + pitch, -pitchLimit, pitchLimit);
}

void FlyCamera::changeSpeed(float factor) {
    speed_ = std::clamp(speed_ * factor, 1.0f / 64.0f, 64.0f);
}

float FlyCamera::heightOverGround() const {
    const std::optional<float> ground = ground_(position_);
    return ground ? position_[2] - *ground : position_[2];
}

void FlyCamera::setConstantHeight(bool on) {
    keptHeight_.reset();
    if (on && ground_(position_)) keptHeight_ = std::max(clearance(), heightOverGround());
}

void FlyCamera::stayAboveGround() {
    const std::optional<float> ground = ground_(position_);
    if (!ground) return;
    position_[2] = keptHeight_ ? *ground + *keptHeight_ : std::max(position_[2], *ground + clearance());
}

bool FlyCamera::step(float seconds) {
    bool moves = false;
    for (float left = std::min(seconds, 0.5f); left > 0.0f; left -= longestStep) {
        const float dt = std::min(left, longestStep);
        for (std::size_t i = 0; i < rate_.size(); ++i) {
            rate_[i] += (wish_[i] - rate_[i]) * (1.0f - std::exp(-dt / easeSeconds));
            if (wish_[i] == 0.0f && std::abs(rate_[i]) < 1e-3f) rate_[i] = 0.0f;
            moves = moves || rate_[i] != 0.0f;
        }
        if (!moves) break;
        const auto rate = [this](FlyAxis axis) { return rate_[std::size_t(axis)]; };
        look(rate(FlyAxis::Turn) * turnRate * dt, rate(FlyAxis::Pitch) * turnRate * dt);
        roll_ = std::remainder(roll_ + rate(FlyAxis::Roll) * turnRate * dt, 2.0f * std::numbers::pi_v<float>);

        const float distance = speed_ * dt * std::clamp(std::abs(heightOverGround()) + 0.02f * size_, 0.02f * size_, 2.0f * size_);
        const SbRotation orientation = pose().orientation;
        position_ += rotated(orientation, SbVec3f(rate(FlyAxis::Right), 0.0f, -rate(FlyAxis::Forward))) * distance;
        const float rise = rate(FlyAxis::Up) * distance;
        if (keptHeight_) keptHeight_ = std::max(clearance(), *keptHeight_ + rise);
        position_[2] += rise;
        stayAboveGround();
    }
    return moves;
}

}  // namespace app
