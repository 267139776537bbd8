// Flights: the circle, CSV, interpolation.
#include "Flight.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <sstream>
#include <string>

namespace {

using app::Flight;
using app::Pose;

const std::string header = "time_ms,x,y,z,qx,qy,qz,qw\n";

terrain::Result<Flight> read(const std::string& text)
{
    std::istringstream stream(text);
    return app::readFlight(stream, "flight.csv");
}

SbVec3f viewOf(const Pose& pose)
{
    SbVec3f view;
    pose.orientation.multVec(SbVec3f(0.0f, 0.0f, -1.0f), view);
    return view;
}

TEST(StandardFlight, FollowsTheCircleAlongItsTangent)
{
    const Flight flight = app::standardFlight({}, 1000.0);
    const double pitch = 15.0 * std::numbers::pi / 180.0;
    for (int i = 0; i < 12; ++i) {
        const double t = 2.0 * std::numbers::pi * i / 12.0;
        const Pose pose = flight.at(1000.0 * i / 12.0);
        EXPECT_TRUE(pose.position.equals(SbVec3f(float(0.5 + 0.3 * std::cos(t)), float(0.5 + 0.3 * std::sin(t)), 0.07f), 1e-10f)) << i;
        const SbVec3f tangent(float(-std::sin(t) * std::cos(pitch)), float(std::cos(t) * std::cos(pitch)), float(-std::sin(pitch)));
        EXPECT_TRUE(viewOf(pose).equals(tangent, 1e-10f)) << i;
        SbVec3f right;
        pose.orientation.multVec(SbVec3f(1.0f, 0.0f, 0.0f), right);
        EXPECT_NEAR(right[2], 0.0f, 1e-6f) << "level horizon";
    }
}

TEST(StandardFlight, ScalesWithItsArea)
{
    const Flight flight = app::standardFlight({SbVec3f(100.0f, 200.0f, 0.0f), 1000.0f, 500.0f, 77.0f}, 1.0);
    EXPECT_TRUE(flight.at(0.0).position.equals(SbVec3f(900.0f, 450.0f, 77.0f), 1e-3f));
    EXPECT_TRUE(flight.at(0.25).position.equals(SbVec3f(600.0f, 600.0f, 77.0f), 1e-3f));
}

TEST(FlightFile, PositionsAreLinearAndOrientationsSpherical)
{
    const float half = std::sqrt(0.5f);
    const auto flight = read(header + "100,0,0,0,0,0,0,1\n300,2,4,6,0,0," + std::to_string(half) + "," + std::to_string(half) + "\n");
    ASSERT_TRUE(flight) << flight.error().message();
    EXPECT_EQ(flight.value().duration(), 200.0);
    const Pose middle = flight.value().at(50.0);
    EXPECT_TRUE(middle.position.equals(SbVec3f(0.5f, 1.0f, 1.5f), 1e-10f));
    SbVec3f axis;
    float angle = 0.0f;
    middle.orientation.getValue(axis, angle);
    EXPECT_NEAR(angle * axis[2], std::numbers::pi / 8.0, 1e-5) << "a quarter of a right angle at constant speed";
}

TEST(FlightFile, TimesOutsideShowTheEnds)
{
    const auto flight = read(header + "0,1,0,0,0,0,0,1\n10,2,0,0,0,0,0,1\n");
    ASSERT_TRUE(flight);
    EXPECT_EQ(flight.value().at(-5.0).position[0], 1.0f);
    EXPECT_EQ(flight.value().at(99.0).position[0], 2.0f);
}

TEST(FlightFile, StretchedFlightKeepsItsPath)
{
    const auto flight = read(header + "0,0,0,0,0,0,0,1\n10,2,0,0,0,0,0,1\n");
    ASSERT_TRUE(flight);
    const Flight slow = flight.value().lasting(1000.0);
    EXPECT_EQ(slow.duration(), 1000.0);
    EXPECT_FLOAT_EQ(slow.at(250.0).position[0], 0.5f);
}

TEST(FlightFile, ErrorsNameTheLine)
{
    const auto line = [](const std::string& text) {
        const auto result = read(text);
        return result ? std::string("accepted") : result.error().subject;
    };
    const std::string good = "0,0,0,0,0,0,0,1\n";
    EXPECT_EQ(line("x,y\n"), "flight.csv:1");
    EXPECT_EQ(line(header + "0,0,0,0,0,0,1\n"), "flight.csv:2");
    EXPECT_EQ(line(header + good + "1,0,0,0,0,0,0,1,9\n"), "flight.csv:3");
    EXPECT_EQ(line(header + good + "1,a,0,0,0,0,0,1\n"), "flight.csv:3");
    EXPECT_EQ(line(header + good + "1,nan,0,0,0,0,0,1\n"), "flight.csv:3");
    EXPECT_EQ(line(header + good + good), "flight.csv:3") << "time stands still";
    EXPECT_EQ(line(header + good + "\n1,0,0,0,0,0,0,0\n"), "flight.csv:4") << "zero quaternion";
    EXPECT_EQ(line(header), "flight.csv");
    EXPECT_EQ(line(""), "flight.csv");
}

TEST(FlightFile, ReadsBackWhatWasWritten)
{
    const std::string path = testing::TempDir() + "soterrain-flight-test.csv";
    const Flight circle = app::standardFlight({}, 1000.0);
    auto writer = app::FlightWriter::open(path);
    ASSERT_TRUE(writer) << writer.error().message();
    for (int i = 0; i < 5; ++i) writer.value().write(i * 33.3, circle.at(i * 33.3));
    ASSERT_TRUE(writer.value().close());
    const auto flight = app::readFlightFile(path);
    std::remove(path.c_str());
    ASSERT_TRUE(flight) << flight.error().message();
    for (int i = 0; i < 5; ++i) {
        EXPECT_TRUE(flight.value().at(i * 33.3).position.equals(circle.at(i * 33.3).position, 1e-12f));
        EXPECT_TRUE(flight.value().at(i * 33.3).orientation.equals(circle.at(i * 33.3).orientation, 1e-6f));
    }
}

TEST(FlightFile, MissingFileIsAnError)
{
    const auto flight = app::readFlightFile("/nonexistent/flight.csv");
    ASSERT_FALSE(flight);
    EXPECT_EQ(flight.error().subject, "/nonexistent/flight.csv");
}

}  // namespace
