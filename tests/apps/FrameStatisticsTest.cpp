// Means over flights are means of their figures.
#include "FrameStatistics.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace {

using app::FrameStatistics;

app::FrameFigures frame(int number, double ms, std::uint64_t triangles)
{
    app::FrameFigures figures;
    figures.frame = number;
    figures.timeMs = 40.0 * number;
    figures.frameMs = ms;
    figures.cpuMs = 2.0 * ms;
    figures.triangles = triangles;
    figures.terrain.emplace();
    figures.terrain->selectMs = ms / 4.0;
    figures.terrain->errorPixels = ms / 10.0;
    return figures;
}

/// Two flights of three frames: 1, 2, 3 and 5, 10, 15 ms.
FrameStatistics twoFlights()
{
    FrameStatistics statistics;
    for (const double factor : {1.0, 5.0}) {
        statistics.beginRepetition();
        for (int i = 0; i < 3; ++i) statistics.add(frame(i, factor * (i + 1), std::uint64_t(100 * i)));
    }
    return statistics;
}

TEST(FrameStatistics, FramesAreAveragedOverFlights)
{
    const auto means = twoFlights().means();
    ASSERT_EQ(means.size(), 3u);
    for (int i = 0; i < 3; ++i) {
        const app::MeanFrame& mean = means[std::size_t(i)];
        EXPECT_EQ(mean.mean.frame, i);
        EXPECT_DOUBLE_EQ(mean.mean.timeMs, 40.0 * i);
        EXPECT_DOUBLE_EQ(mean.mean.frameMs, 3.0 * (i + 1));
        EXPECT_DOUBLE_EQ(mean.leastMs, i + 1);
        EXPECT_DOUBLE_EQ(mean.mostMs, 5.0 * (i + 1));
        EXPECT_DOUBLE_EQ(mean.mean.cpuMs, 6.0 * (i + 1));
        EXPECT_EQ(mean.mean.triangles, std::uint64_t(100 * i));
        EXPECT_DOUBLE_EQ(mean.mean.terrain->selectMs, 0.75 * (i + 1));
        EXPECT_DOUBLE_EQ(mean.mean.terrain->errorPixels, 0.5 * (i + 1)) << "a bound is that of all flights";
    }
}

TEST(FrameStatistics, SummaryIsTheMeanOfTheFlightsSummaries)
{
    const auto json = nlohmann::json::parse(twoFlights().json({"roam", "software", {64, 48}, {{"pixelError", "2"}}}));
    EXPECT_EQ(json["repetitions"], 2);
    EXPECT_EQ(json["frames"], 3);
    EXPECT_DOUBLE_EQ(json["frame_ms"]["median"], (2.0 + 10.0) / 2.0);
    EXPECT_DOUBLE_EQ(json["frame_ms"]["worst"], (3.0 + 15.0) / 2.0);
    EXPECT_DOUBLE_EQ(json["frame_ms"]["mean"], 6.0);
    EXPECT_NEAR(json["fps"].get<double>(), 1000.0 / 6.0, 1e-3);
    EXPECT_DOUBLE_EQ(json["triangles"]["mean"], 100.0);
    EXPECT_TRUE(json["triangles"]["same_in_all"]);
    EXPECT_EQ(json["settings"]["pixelError"], "2");
    EXPECT_FALSE(json.contains("animation_ms")) << "no animation was told of";
}

TEST(FrameStatistics, OtherTrianglesInOneFlightAreNoticed)
{
    FrameStatistics statistics = twoFlights();
    EXPECT_TRUE(statistics.sameTriangles());
    statistics.beginRepetition();
    for (int i = 0; i < 3; ++i) statistics.add(frame(i, 1.0, std::uint64_t(i == 1 ? 101 : 100 * i)));
    EXPECT_FALSE(statistics.sameTriangles());
}

TEST(FrameStatistics, CsvHasAFigureForEveryName)
{
    const std::string csv = twoFlights().csv({"roam", "a \"renderer\", and more", {64, 48}, {{"pixelError", "2"}, {"tileSize", "8"}}});
    int rows = 0, columns = 1, first = 0;
    bool quoted = false;
    for (const char c : csv) {
        if (c == '"') quoted = !quoted;
        if (c == ',' && !quoted) ++columns;
        if (c != '\n') continue;
        if (rows == 0) first = columns;
        EXPECT_EQ(columns, first);
        columns = 1;
        ++rows;
    }
    EXPECT_EQ(rows, 2);
    EXPECT_NE(csv.find("\"pixelError 2; tileSize 8\""), csv.npos);
}

TEST(FrameStatistics, AnimationTellsHowFarItIsOff)
{
    FrameStatistics statistics = twoFlights();
    statistics.add(app::AnimationTime{1000.0, 1003.5, 7.25});
    const auto json = nlohmann::json::parse(statistics.json({}));
    EXPECT_DOUBLE_EQ(json["animation_ms"]["wanted"], 1000.0);
    EXPECT_DOUBLE_EQ(json["animation_ms"]["lasted"], 1003.5);
    EXPECT_DOUBLE_EQ(json["animation_ms"]["longest_frame"], 7.25);
}

}  // namespace
