// Which frames an animation shows.
#include "FrameSchedule.h"

#include <gtest/gtest.h>

#include <vector>

namespace {

using app::FrameSchedule;

TEST(FrameSchedule, FrameTimeDividesTheAnimation)
{
    const FrameSchedule schedule = FrameSchedule::make(1000.0, 40.0, std::nullopt, false);
    EXPECT_EQ(schedule.frames, 25);
    EXPECT_EQ(schedule.time(10), 400.0);
}

TEST(FrameSchedule, NumberOfFramesIsSpreadOverTheAnimation)
{
    const FrameSchedule schedule = FrameSchedule::make(1000.0, std::nullopt, 4, false);
    EXPECT_EQ(schedule.frames, 4);
    EXPECT_EQ(schedule.time(3), 750.0);
}

TEST(FrameSchedule, NumberOfFramesWithFrameTimeKeepsTheStep)
{
    const FrameSchedule schedule = FrameSchedule::make(1000.0, 10.0, 7, false);
    EXPECT_EQ(schedule.frames, 7);
    EXPECT_EQ(schedule.time(3), 30.0);
}

TEST(FrameSchedule, WithoutSynchronisationEveryFrameIsShownHoweverLate)
{
    const FrameSchedule schedule = FrameSchedule::make(1000.0, 100.0, std::nullopt, false);
    int shown = 0, last = -1;
    for (double now = 0.0; const auto next = schedule.next(last, now); now += 777.0) {
        EXPECT_EQ(next->frame, last + 1);
        last = next->frame;
        ++shown;
        if (shown > 100) break;
    }
    EXPECT_EQ(shown, 10);
}

TEST(FrameSchedule, SynchronisedFramesFollowTheClock)
{
    const FrameSchedule schedule = FrameSchedule::make(1000.0, 100.0, std::nullopt, true);
    EXPECT_EQ(schedule.next(-1, 0.0)->frame, 0);
    EXPECT_EQ(schedule.next(0, 350.0)->frame, 3) << "two frames are skipped";
    const auto early = schedule.next(3, 350.0);
    EXPECT_EQ(early->frame, 4);
    EXPECT_EQ(early->waitMs, 50.0);
    EXPECT_FALSE(schedule.next(3, 1000.0)) << "the animation is over";
    EXPECT_FALSE(schedule.next(9, 950.0)) << "its last frame has been shown";
}

TEST(FrameSchedule, FlightOfOnePoseHasOneFrame)
{
    EXPECT_EQ(FrameSchedule::make(0.0, std::nullopt, std::nullopt, false).frames, 1);
}

}  // namespace
