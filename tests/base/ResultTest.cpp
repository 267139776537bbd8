#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "base/Box.h"
#include "base/Result.h"

using namespace terrain;

TEST(Error, SaysWhatItIsAboutWhatWasExpectedAndWhatWasFound)
{
    EXPECT_EQ((Error{"map.png", "one channel", "three"}.message()), "map.png: expected one channel, found three");
    EXPECT_EQ((Error{"map.png", "", "no such file"}.message()), "map.png: no such file");
    EXPECT_EQ((Error{"map.png", "a file", ""}.message()), "map.png: expected a file");
}

TEST(Result, HoldsAValueOrAnError)
{
    const Result<int> value(7), error(Error{"a", "b", "c"});
    ASSERT_TRUE(value);
    EXPECT_EQ(value.value(), 7);
    ASSERT_FALSE(error);
    EXPECT_EQ(error.error().subject, "a");
}

TEST(Result, GivesAwayWhatCanOnlyBeMoved)
{
    Result<std::unique_ptr<int>> result(std::make_unique<int>(3));
    const std::unique_ptr<int> taken = std::move(result).value();
    EXPECT_EQ(*taken, 3);
}

TEST(Box, BetweenTwoCornersReachesBoth)
{
    const Box box = boxBetween({-1.0f, 2.0f, 3.0f}, {5.0f, 2.5f, 3.0f});
    EXPECT_EQ(box.lowest(), glm::vec3(-1.0f, 2.0f, 3.0f));
    EXPECT_EQ(box.highest(), glm::vec3(5.0f, 2.5f, 3.0f));
}
