// Names with a frame number never reach printf.
#include "FrameName.h"

#include <gtest/gtest.h>

namespace {

TEST(FrameName, PutsTheNumberInItsPlace)
{
    EXPECT_EQ(app::frameName("f-%04d.png", 7), "f-0007.png");
    EXPECT_EQ(app::frameName("f-%d.png", 123), "f-123.png");
    EXPECT_EQ(app::frameName("f-%3d.png", 5), "f-  5.png");
    EXPECT_EQ(app::frameName("f-%02d.png", 12345), "f-12345.png");
    EXPECT_EQ(app::frameName("100%%-%d", 1), "100%-1");
    EXPECT_EQ(app::frameName("plain.png", 1), "plain.png");
}

TEST(FrameName, RefusesEveryOtherConversion)
{
    for (const char* bad : {"%s", "%n", "%", "%d%d", "%ld", "%-4d", "%999999999999999999999d", "%04"}) {
        EXPECT_TRUE(app::checkFrameName(bad)) << bad;
    }
    for (const char* good : {"%d", "%04d", "a%%b", "none", ""}) EXPECT_FALSE(app::checkFrameName(good)) << good;
}

TEST(FrameName, KnowsWhetherThereIsANumber)
{
    EXPECT_TRUE(app::hasFrameNumber("a%03d"));
    EXPECT_FALSE(app::hasFrameNumber("a%%d"));
    EXPECT_FALSE(app::hasFrameNumber("a"));
}

}  // namespace
