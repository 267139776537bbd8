// The bound on the screen error against direct projection, in double, of random points in random boxes under random cameras.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include <glm/ext/matrix_transform.hpp>

#include "base/View.h"

#include "../lod/Views.h"

using namespace terrain;
using namespace terrain::test;

namespace {

constexpr int kCases = 20000;
/// Relative, for what is computed in floats.
constexpr double kRounding = 1e-3;

/// A view, the frame of a grid under it, and a box in that frame somewhere near what the view looks at.
struct Case {
    glm::dmat4 localFromFrame;
    View view;
    Box box;
    ErrorDirection direction;

    explicit Case(std::mt19937& random)
    {
        localFromFrame = uniformInt(random, 0, 1) ? glm::scale(glm::dmat4(1.0), uniformIn(random, glm::dvec3(0.5), glm::dvec3(2.0))) : glm::dmat4(1.0);
        // A column may run along any axis, either way.
        if (uniformInt(random, 0, 1)) localFromFrame = glm::rotate(localFromFrame, 1.5707963267948966 * uniformInt(random, 0, 3), glm::dvec3(1.0, 0.0, 0.0));
        const Box world{glm::vec3(0.0f), glm::vec3(60.0f, 60.0f, 15.0f)};
        view = randomView(random, world);
        const glm::dvec3 centre = glm::dvec3(glm::inverse(localFromFrame) * glm::dvec4(uniformIn(random, glm::dvec3(-60.0), glm::dvec3(60.0)), 1.0));
        box = {glm::vec3(centre), glm::vec3(uniformIn(random, glm::dvec3(0.1), glm::dvec3(std::pow(10.0, uniform(random, -1.0, 1.5)))))};
        direction = uniformInt(random, 0, 1) ? ErrorDirection::Vertical : ErrorDirection::Any;
    }
    glm::dvec3 pointInBox(std::mt19937& random) const { return uniformIn(random, glm::dvec3(box.lowest()), glm::dvec3(box.highest())); }
    Projected projected(const glm::dvec3& frame, double margin = 1e-5) const
    {
        return project(view, glm::dvec3(localFromFrame * glm::dvec4(frame, 1.0)), margin);
    }
};

}  // namespace

TEST(ScreenSpace, BoundsTheProjectedDisplacementOfEveryPointInView)
{
    std::mt19937 random(1);
    int checked = 0;
    for (int i = 0; i < kCases; ++i) {
        const Case c(random);
        const ScreenSpace space(c.view, c.localFromFrame, c.direction);
        const double error = uniform(random, 0.0, 2.0) * c.box.half.z;
        const double bound = space.screenError(float(error), c.box);
        for (int k = 0; k < 8; ++k) {
            const glm::dvec3 sample = c.pointInBox(random);
            const glm::dvec3 along = c.direction == ErrorDirection::Vertical ? glm::dvec3(0.0, 0.0, k % 2 ? 1.0 : -1.0) : randomDirection(random);
            const glm::dvec3 drawn = sample + along * error * uniform(random, 0.9, 1.0);
            if (glm::any(glm::greaterThan(glm::abs(drawn - glm::dvec3(c.box.centre)), glm::dvec3(c.box.half)))) continue;
            const Projected at = c.projected(sample), shown = c.projected(drawn);
            if (!at.inView) continue;
            ++checked;
            if (!std::isinf(bound)) {
                ASSERT_GT(shown.w, 0.0) << "case " << i;
                ASSERT_LE(glm::distance(at.pixel, shown.pixel), bound * (1.0 + kRounding) + 1e-3) << "case " << i;
            }
        }
    }
    EXPECT_GT(checked, kCases);
}

TEST(ScreenSpace, BoundIsTightForASmallBox)
{
    std::mt19937 random(2);
    int checked = 0;
    for (int i = 0; i < kCases; ++i) {
        Case c(random);
        c.box.half = glm::vec3(1e-3f);
        const ScreenSpace space(c.view, c.localFromFrame, ErrorDirection::Vertical);
        const glm::dvec3 centre(c.box.centre);
        const Projected at = c.projected(centre);
        // Near the eye even a small box is large.
        const glm::dvec4 clip = c.view.clipFromLocal * (c.localFromFrame * glm::dvec4(centre, 1.0));
        if (!at.inView || clip.w < 0.5) continue;
        const auto moved = [&](const glm::dvec3& by) { return glm::distance(at.pixel, c.projected(centre + by).pixel); };
        // Seen from straight above the displacement vanishes, the bound only almost.
        const double largest = std::max(moved({1e-3, 0.0, 0.0}), moved({0.0, 1e-3, 0.0}));
        ++checked;
        ASSERT_LE(space.screenError(1e-3f, c.box), moved({0.0, 0.0, 1e-3}) * 1.05 + largest * 0.02) << "case " << i;
    }
    EXPECT_GT(checked, 500);
}

TEST(ScreenSpace, CallsNoBoxOutsideThatHoldsAPointInView)
{
    std::mt19937 random(3);
    int outside = 0, inView = 0;
    for (int i = 0; i < kCases; ++i) {
        const Case c(random);
        const bool isOutside = ScreenSpace(c.view, c.localFromFrame, c.direction).isOutside(c.box);
        outside += isOutside;
        for (int k = 0; k < 8; ++k) {
            if (!c.projected(c.pointInBox(random)).inView) continue;
            ++inView;
            ASSERT_FALSE(isOutside) << "case " << i;
        }
    }
    EXPECT_GT(outside, kCases / 10);
    EXPECT_GT(inView, kCases / 10);
}

TEST(ScreenSpace, CallsEveryBoxOutsideWhoseCornersAllLieBeyondOnePlane)
{
    std::mt19937 random(5);
    int outside = 0;
    for (int i = 0; i < kCases; ++i) {
        const Case c(random);
        int beyond[6] = {};
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 sign(corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, corner & 4 ? 1.0 : -1.0);
            const glm::dvec3 p = glm::dvec3(c.box.centre) + sign * glm::dvec3(c.box.half);
            const glm::dvec4 clip = c.view.clipFromLocal * (c.localFromFrame * glm::dvec4(p, 1.0));
            for (int axis = 0; axis < 3; ++axis) {
                beyond[2 * axis] += clip[axis] < -clip.w - 1e-3;
                beyond[2 * axis + 1] += clip[axis] > clip.w + 1e-3;
            }
        }
        if (*std::max_element(beyond, beyond + 6) < 8) continue;
        ++outside;
        ASSERT_TRUE(ScreenSpace(c.view, c.localFromFrame, c.direction).isOutside(c.box)) << "case " << i;
    }
    EXPECT_GT(outside, kCases / 10);
}

TEST(ScreenSpace, ErrorIsInfiniteWhereTheBoxReachesBehindTheEye)
{
    std::mt19937 random(4);
    int behind = 0;
    for (int i = 0; i < kCases; ++i) {
        const Case c(random);
        const ScreenSpace space(c.view, c.localFromFrame, c.direction);
        double lowest = std::numeric_limits<double>::infinity();
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 sign(corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, corner & 4 ? 1.0 : -1.0);
            lowest = std::min(lowest, c.projected(glm::dvec3(c.box.centre) + sign * glm::dvec3(c.box.half)).w);
        }
        if (std::fabs(lowest) < 0.01) continue;
        behind += lowest < 0.0;
        ASSERT_EQ(std::isinf(space.screenError(0.1f, c.box)), lowest < 0.0) << "case " << i;
        ASSERT_EQ(space.screenError(0.0f, c.box), 0.0f) << "no error is no error, wherever it is";
    }
    EXPECT_GT(behind, 100);
}

TEST(ScreenSpace, InfiniteErrorIsInfiniteFromEverywhere)
{
    // Also from where no displacement shows: an infinite error means that there is nothing to draw as it is.
    const glm::dmat4 projection = glm::ortho(-10.0, 10.0, -10.0, 10.0, 0.0, 1000.0);
    const View above{projection * glm::lookAt(glm::dvec3(0.0, 0.0, 100.0), glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 0.0)), {400.0, 400.0}};
    const Box box{glm::vec3(0.0f), glm::vec3(1.0f)};
    const float infinity = std::numeric_limits<float>::infinity();
    EXPECT_EQ(ScreenSpace(above, glm::dmat4(1.0), ErrorDirection::Vertical).screenError(infinity, box), infinity);
    std::mt19937 random(6);
    for (int i = 0; i < 1000; ++i) {
        const Case c(random);
        ASSERT_EQ(ScreenSpace(c.view, c.localFromFrame, c.direction).screenError(infinity, c.box), infinity);
    }
}

TEST(ScreenSpace, OrthographicErrorDoesNotDependOnDistance)
{
    const glm::dmat4 projection = glm::ortho(-10.0, 10.0, -10.0, 10.0, 0.0, 1000.0);
    const View view{projection * glm::lookAt(glm::dvec3(0.0, -100.0, 0.0), glm::dvec3(0.0), glm::dvec3(0.0, 0.0, 1.0)), {400.0, 400.0}};
    const ScreenSpace space(view, glm::dmat4(1.0), ErrorDirection::Vertical);
    for (const float distance : {0.0f, 50.0f, 700.0f})
        EXPECT_NEAR(space.screenError(0.5f, {glm::vec3(0.0f, distance, 0.0f), glm::vec3(1.0f)}), 10.0f, 1e-3f);
}

TEST(ScreenSpace, VerticalErrorSeenFromStraightAboveIsHardlySeen)
{
    const glm::dmat4 projection = glm::ortho(-10.0, 10.0, -10.0, 10.0, 0.0, 1000.0);
    const View view{projection * glm::lookAt(glm::dvec3(0.0, 0.0, 100.0), glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 0.0)), {400.0, 400.0}};
    const Box box{glm::vec3(0.0f), glm::vec3(1.0f)};
    EXPECT_LT(ScreenSpace(view, glm::dmat4(1.0), ErrorDirection::Vertical).screenError(0.5f, box), 1e-3f);
    EXPECT_GT(ScreenSpace(view, glm::dmat4(1.0), ErrorDirection::Any).screenError(0.5f, box), 9.9f);
}
