// The fly camera keeps above ground and moves the same at any frame rate.
#include "FlyCamera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

using app::FlyAxis;
using app::FlyCamera;
using app::Pose;

std::optional<float> flat(const SbVec3f&)
{
    return 0.0f;
}

// A slope that rises by one in y.
std::optional<float> slope(const SbVec3f& point)
{
    return point[1];
}

void fly(FlyCamera& camera, float seconds, float frame)
{
    for (float t = 0.0f; t < seconds - 1e-4f; t += frame) camera.step(frame);
}

TEST(FlyCamera, KeepsThePoseThatItIsGiven)
{
    for (const float roll : {0.0f, 0.4f, -2.0f}) {
        const SbRotation turn = SbRotation(SbVec3f(0, 0, 1), roll) * SbRotation(SbVec3f(1, 0, 0), 1.2f) * SbRotation(SbVec3f(0, 0, 1), 2.5f);
        FlyCamera camera(flat, 1.0f);
        camera.setPose({SbVec3f(1, 2, 3), turn});
        EXPECT_TRUE(camera.pose().orientation.equals(turn, 1e-5f)) << roll;
        EXPECT_EQ(camera.pose().position, SbVec3f(1, 2, 3));
    }
}

TEST(FlyCamera, MovesAsFarAtEveryFrameRate)
{
    const auto distance = [](float frame) {
        FlyCamera camera(flat, 1.0f);
        camera.setPose(app::lookAlong(SbVec3f(0, 0, 0.5f), SbVec3f(0, 1, 0)));
        camera.push(FlyAxis::Forward, 1.0f);
        fly(camera, 1.0f, frame);
        return camera.pose().position[1];
    };
    EXPECT_GT(distance(0.02f), 0.2f);
    EXPECT_NEAR(distance(0.005f), distance(0.02f), 0.02f * distance(0.02f));
    EXPECT_NEAR(distance(0.1f), distance(0.02f), 0.02f * distance(0.02f));
}

TEST(FlyCamera, IsFasterHighAboveTheGround)
{
    const auto distance = [](float height) {
        FlyCamera camera(flat, 1.0f);
        camera.setPose(app::lookAlong(SbVec3f(0, 0, height), SbVec3f(0, 1, 0)));
        camera.push(FlyAxis::Forward, 1.0f);
        fly(camera, 0.5f, 0.01f);
        return camera.pose().position[1];
    };
    EXPECT_GT(distance(0.5f), 4.0f * distance(0.05f));
}

TEST(FlyCamera, NeverGoesBelowTheGround)
{
    FlyCamera camera(slope, 1.0f);
    camera.setPose(app::lookAlong(SbVec3f(0, 0, 0.1f), SbVec3f(0, 1, -0.2f)));
    camera.push(FlyAxis::Forward, 1.0f);
    camera.push(FlyAxis::Up, -1.0f);
    for (int i = 0; i < 300; ++i) {
        camera.step(0.03f);
        const SbVec3f p = camera.pose().position;
        ASSERT_GE(p[2], p[1] + 0.99f * camera.clearance()) << i;
    }
}

TEST(FlyCamera, ConstantHeightFollowsTheGround)
{
    FlyCamera camera(slope, 1.0f);
    camera.setPose(app::lookAlong(SbVec3f(0, 0, 0.3f), SbVec3f(0, 1, 0)));
    camera.setConstantHeight(true);
    camera.push(FlyAxis::Forward, 1.0f);
    fly(camera, 1.0f, 0.02f);
    const SbVec3f p = camera.pose().position;
    EXPECT_GT(p[1], 0.1f);
    EXPECT_NEAR(p[2] - p[1], 0.3f, 1e-4f);
}

TEST(FlyCamera, ComesToRestAfterTheKeyIsReleased)
{
    FlyCamera camera(flat, 1.0f);
    camera.setPose(app::lookAlong(SbVec3f(0, 0, 0.5f), SbVec3f(0, 1, 0)));
    camera.push(FlyAxis::Turn, 1.0f);
    EXPECT_TRUE(camera.step(0.1f));
    camera.push(FlyAxis::Turn, -1.0f);
    fly(camera, 3.0f, 0.02f);
    EXPECT_FALSE(camera.step(0.02f));
    const Pose rest = camera.pose();
    camera.step(0.5f);
    EXPECT_EQ(camera.pose().position, rest.position);
    EXPECT_TRUE(camera.pose().orientation.equals(rest.orientation, 0.0f));
}

TEST(FlyCamera, LookingUpStopsAtTheZenith)
{
    FlyCamera camera(flat, 1.0f);
    camera.setPose(app::lookAlong(SbVec3f(0, 0, 0.5f), SbVec3f(0, 1, 0)));
    camera.look(0.0f, 10.0f);
    SbVec3f up;
    camera.pose().orientation.multVec(SbVec3f(0, 1, 0), up);
    EXPECT_GE(up[2], 0.0f) << "not upside down";
}

}  // namespace
