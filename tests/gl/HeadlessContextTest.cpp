#include <gtest/gtest.h>

#include <epoxy/gl.h>

#include "gl/HeadlessContext.h"

using namespace terrain;

namespace {

std::unique_ptr<HeadlessContext> contextOf(int width, int height)
{
    auto context = HeadlessContext::create(width, height);
    EXPECT_TRUE(context) << context.error().message();
    return context ? std::move(context).value() : nullptr;
}

}  // namespace

TEST(HeadlessContext, IsCurrentAndHasItsSize)
{
    const auto context = contextOf(60, 40);
    ASSERT_TRUE(context);
    EXPECT_EQ(context->width(), 60);
    EXPECT_EQ(context->height(), 40);
    EXPECT_FALSE(context->renderer().empty());
    GLint viewport[4] = {};
    glGetIntegerv(GL_VIEWPORT, viewport);
    EXPECT_EQ(viewport[2], 60);
    EXPECT_EQ(viewport[3], 40);
    EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

TEST(HeadlessContext, ColoursComeFromTheTopAndDepthsFromTheBottom)
{
    // An odd width needs rows without padding.
    const auto context = contextOf(33, 20);
    ASSERT_TRUE(context);
    context->bindFramebuffer();
    glClearColor(0.0f, 0.0f, 1.0f, 1.0f);
    glClearDepth(1.0);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_SCISSOR_TEST);
    glScissor(3, 15, 10, 2);
    glClearColor(1.0f, 0.2f, 0.0f, 1.0f);
    glClearDepth(0.25);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glDisable(GL_SCISSOR_TEST);
    glClearDepth(1.0);

    const Image image = context->readColor();
    ASSERT_EQ(image.pixels.size(), 33u * 20 * 3);
    const std::vector<float> depth = context->readDepth();
    ASSERT_EQ(depth.size(), 33u * 20);
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 33; ++x) {
            const bool inside = x >= 3 && x < 13 && y >= 15 && y < 17;
            const std::uint8_t* pixel = image.pixels.data() + (std::size_t(19 - y) * 33 + std::size_t(x)) * 3;
            ASSERT_EQ(pixel[0], inside ? 255 : 0) << x << ", " << y;
            ASSERT_EQ(pixel[1], inside ? 51 : 0);
            ASSERT_EQ(pixel[2], inside ? 0 : 255);
            ASSERT_EQ(depth[std::size_t(y) * 33 + std::size_t(x)], inside ? 0.25f : 1.0f);
        }
}

TEST(HeadlessContext, DepthKeepsMoreThanSixteenBits)
{
    const auto context = contextOf(4, 4);
    ASSERT_TRUE(context);
    context->bindFramebuffer();
    glClearDepth(0.1000001);
    glClear(GL_DEPTH_BUFFER_BIT);
    glClearDepth(1.0);
    EXPECT_NEAR(context->readDepth()[5], 0.1000001f, 2e-8f);
}

TEST(HeadlessContext, ReadingLeavesPixelStateAndBindingsAsTheyWere)
{
    const auto context = contextOf(7, 5);
    ASSERT_TRUE(context);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glPixelStorei(GL_PACK_ALIGNMENT, 8);
    context->readColor();
    context->readDepth();
    GLint alignment = 0, framebuffer = -1;
    glGetIntegerv(GL_PACK_ALIGNMENT, &alignment);
    glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &framebuffer);
    EXPECT_EQ(alignment, 8);
    EXPECT_EQ(framebuffer, 0);
}

TEST(HeadlessContext, TwoOfThemKeepTheirOwnPictures)
{
    const auto red = contextOf(8, 8), green = contextOf(8, 8);
    ASSERT_TRUE(red && green);
    const auto clear = [](HeadlessContext& context, float r, float g) {
        context.makeCurrent();
        context.bindFramebuffer();
        glClearColor(r, g, 0.0f, 1.0f);
        glClear(GL_COLOR_BUFFER_BIT);
    };
    clear(*red, 1.0f, 0.0f);
    clear(*green, 0.0f, 1.0f);
    red->makeCurrent();
    EXPECT_EQ(red->readColor().pixels[0], 255);
    EXPECT_EQ(red->readColor().pixels[1], 0);
    green->makeCurrent();
    EXPECT_EQ(green->readColor().pixels[1], 255);
}

TEST(HeadlessContext, RefusesSizesThatCannotBeDrawn)
{
    for (const auto& [width, height] : {std::pair(0, 5), std::pair(5, -1), std::pair(1 << 30, 4)}) {
        const auto context = HeadlessContext::create(width, height);
        ASSERT_FALSE(context) << width << " x " << height;
        EXPECT_FALSE(context.error().message().empty());
    }
}
