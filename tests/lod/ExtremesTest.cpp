// Bounds whose numbers are at the ends of what floats hold. The fuzzer of tests/fuzz found what is held here.
#include <limits>

#include <gtest/gtest.h>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>

#include "base/View.h"
#include "lod/RoamBounds.h"
#include "lod/ViewMotion.h"

using namespace terrain;

namespace {

constexpr float kLargest = std::numeric_limits<float>::max();

/// A camera at (20, 20, 5) that looks along y: planes that are in front of it and behind have no part of z at all.
View alongY(double forward = 0.0) {
    const glm::dvec3 eye(20.0, 20.0 + forward, 5.0);
    const glm::dmat4 camera = glm::lookAt(eye, eye + glm::dvec3(0.0, 1.0, 0.0), glm::dvec3(0.0, 0.0, 1.0));
    return {glm::infinitePerspective(0.8, 4.0 / 3.0, 0.1) * camera, {640.0, 480.0}};
}

/// What RoamMesh asks of its bounds when the camera moves on a little.
struct Request {
    ScreenSpace space;
    ViewMotion motion;
    EvaluationRequest request;

    Request(ErrorDirection direction, const glm::dmat4& localFromFrame = glm::dmat4(1.0))
        : space(alongY(0.001), localFromFrame, direction) {
        motion.advance(alongY(), localFromFrame);
        motion.advance(alongY(0.001), localFromFrame);
        request.space = &space;
        request.motion = &motion;
        request.threshold = 1.0f;
        request.full = 2.0f;
        request.depthPerLength = 1.0f;
        request.assumedFactor = 1.05f * space.largestFactor();
    }
};

BoxPyramid::Bounds between(const glm::vec3& low, const glm::vec3& high) {
    return {low, high};
}

}  // namespace

TEST(RoamOfExtremes, CullsWhatIsBehindTheCameraWhereHeightsSpanMoreThanAFloat) {
    constexpr float far = 0.75f * kLargest;
    RoamBounds bounds(true, between({0.0f, 0.0f, -far}, {40.0f, 40.0f, far}));
    for (std::size_t i = 0; i < RoamBounds::kBlock; ++i) bounds.append();
    bounds.set(0, {20, 30}, 2, between({18.0f, 28.0f, 0.0f}, {22.0f, 32.0f, 1.0f}), 0.5f);
    bounds.set(1, {20, 5}, 2, between({18.0f, 3.0f, 0.0f}, {22.0f, 7.0f, 1.0f}), 0.5f);
    const Request asked(ErrorDirection::Vertical);
    EXPECT_EQ(bounds.evaluateBlock(0, asked.request).inView, 1u) << "the one ahead alone";
    bounds.evaluate(1, asked.request);
    EXPECT_EQ(bounds.priority(1), 0.0f);
}

TEST(RoamOfExtremes, AsksAgainInTheNextFrameBesideWhatIsFurtherAwayThanAFloatHolds) {
    RoamBounds bounds(false, between({0.0f, 0.0f, 0.0f}, {40.0f, 40.0f, 1.0f}));
    for (std::size_t i = 0; i < RoamBounds::kBlock; ++i) bounds.append();
    // Far to the side and far ahead: neither comes into view, or near, for hundreds of frames.
    for (std::size_t i = 0; i < RoamBounds::kBlock; ++i)
        bounds.set(i, {20, 30}, 2, between({518.0f, 28.0f, 0.0f}, {522.0f, 32.0f, 1.0f}), 0.5f);
    const Request asked(ErrorDirection::Any);
    EXPECT_EQ(bounds.evaluateBlock(0, asked.request).frames, ViewMotion::kLongest) << "else the test shows nothing";
    // In view, further away than a float holds.
    const glm::vec3 beyond(0.4f * kLargest, kLargest, 0.0f);
    for (std::size_t broken = 0; broken < RoamBounds::kBlock; ++broken) {
        RoamBounds with = bounds;
        with.set(broken, {20, 30}, 2, between(beyond, beyond), 0.5f);
        EXPECT_EQ(with.evaluateBlock(0, asked.request).frames, 1) << broken;
    }
}
