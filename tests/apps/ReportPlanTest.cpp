// What a report measures.
#include "Report.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "BenchScene.h"
#include "Numbers.h"

namespace {

using app::BenchRequest;
using app::Chapter;
using app::ReportOptions;
using app::ReportPlan;

ReportOptions optionsOf(int columns, int rows, bool quick) {
    ReportOptions options;
    options.request.map = "map.png";
    options.columns = columns;
    options.rows = rows;
    options.quick = quick;
    return options;
}

TEST(ReportPlan, MeasuresEveryNodeAndCoinsShapesFirst) {
    const ReportPlan plan = app::planReport(optionsOf(1025, 1025, false));
    std::set<std::string> classes;
    for (const app::Subject& subject : plan.subjects) {
        classes.insert(subject.className);
        EXPECT_EQ(plan.of(subject).request.className, subject.className);
        EXPECT_EQ(plan.of(subject).request.fields, subject.fields);
        EXPECT_EQ(plan.of(subject).rank, 0);
        EXPECT_FALSE(plan.of(subject).request.framesOnly) << subject.label;
    }
    for (const char* name : {"SoIndexedFaceSet", "SoQuadMesh", "SoBruteForceTerrain", "SoROAMTerrain", "SoChunkedLoDTerrain",
                             "SoGeoMipmapTerrain", "SoGeometryClipmapTerrain"})
        EXPECT_TRUE(classes.count(name)) << name;
}

TEST(ReportPlan, MeasuresNothingTwice) {
    for (const bool quick : {false, true}) {
        const ReportPlan plan = app::planReport(optionsOf(1025, 513, quick));
        std::set<std::tuple<std::string, std::string, double, int>> requests;
        for (const app::Measurement& m : plan.measurements)
            EXPECT_TRUE(requests.emplace(m.request.className, m.request.fields, m.request.pixelError, m.request.decimate).second)
                << m.label;
    }
}

TEST(ReportPlan, GivesEveryPlotItsPoints) {
    const ReportPlan plan = app::planReport(optionsOf(1025, 1025, false));
    std::map<std::pair<Chapter, std::string>, std::set<double>> curves;
    for (const app::Use& use : plan.uses) {
        ASSERT_LT(use.measurement, plan.measurements.size());
        EXPECT_TRUE(curves[std::pair(use.chapter, use.curve)].insert(use.x).second) << use.curve << ' ' << use.x;
        const BenchRequest& request = plan.measurements[use.measurement].request;
        EXPECT_FALSE(use.chapter == Chapter::Error && request.framesOnly);
        const bool isOfErrors = use.chapter == Chapter::Error && use.curve != "SoGeometryClipmapTerrain";
        EXPECT_EQ(request.pixelError, isOfErrors ? use.x : request.pixelError);
    }
    EXPECT_EQ(curves.at({Chapter::Error, "SoROAMTerrain"}), (std::set<double>{0.5, 1, 2, 4, 8}));
    EXPECT_EQ(curves.at({Chapter::Error, "SoGeometryClipmapTerrain"}), (std::set<double>{63, 127, 255, 511}));
    EXPECT_EQ(curves.at({Chapter::Size, "SoQuadMesh"}), (std::set<double>{65, 129, 257, 513, 1025}));
    EXPECT_EQ(curves.at({Chapter::Clipmap, "clipmapSize 511"}), (std::set<double>{1, 2, 3}));
}

TEST(ReportPlan, SmallAndNarrowMapsAreMeasured) {
    for (const auto& [columns, rows] : {std::pair(2, 2), std::pair(3, 2000), std::pair(20, 20)}) {
        const ReportPlan plan = app::planReport(optionsOf(columns, rows, false));
        EXPECT_EQ(plan.subjects.size(), 8u);
        for (const app::Measurement& m : plan.measurements)
            EXPECT_GE((std::min(columns, rows) - 1) / m.request.decimate, 1) << m.label;
    }
}

TEST(ReportPlan, TakesThePixelErrorThatIsAskedForAsOneOfTheCurve) {
    ReportOptions options = optionsOf(1025, 1025, true);
    options.request.pixelError = 3.0;
    options.nodes = {"SoROAMTerrain", "SoNoSuchNode"};
    const ReportPlan plan = app::planReport(options);
    ASSERT_EQ(plan.subjects.size(), 2u);
    EXPECT_EQ(plan.of(plan.subjects[0]).request.pixelError, 3.0);
    EXPECT_EQ(std::count_if(plan.uses.begin(), plan.uses.end(), [](const app::Use& use) { return use.chapter == Chapter::Error; }),
              3);
}

TEST(BenchRequest, IsTheSameAfterItsWayThroughJson) {
    BenchRequest request;
    request.className = "SoROAMTerrain";
    request.fields = "triangleCount 5 geomorph \"x\"";
    request.map = "a map.png";
    request.spacing = glm::dvec2(0.1, 30.0);
    request.heightScale = -2.5;
    request.framesOnly = true;
    request.seconds = 1.5;
    EXPECT_EQ(toJson(app::benchRequest(toJson(request))), toJson(request));
    EXPECT_EQ(toJson(app::benchRequest(toJson(BenchRequest{}))), toJson(BenchRequest{}));
}

TEST(BenchScene, FliesOverMapsOfTheirOwnSizeAsOverTheUnitSquare) {
    app::TerrainGrid grid;
    grid.columns = grid.rows = 101;
    grid.spacing = {1.0 / 101, 1.0 / 101};
    grid.maximum = app::standardHeight;
    EXPECT_FLOAT_EQ(app::flightAreaOf(grid).altitude, 0.07f);
    grid.spacing = {30.0, 20.0};
    grid.maximum = 2600.0;
    const app::FlightArea area = app::flightAreaOf(grid);
    EXPECT_FLOAT_EQ(area.width, 3030.0f);
    EXPECT_FLOAT_EQ(area.depth, 2020.0f);
    EXPECT_FLOAT_EQ(area.altitude, 2600.0f + 0.019f * 3000.0f);
}

TEST(Numbers, AreReadWholeOrNotAtAll) {
    std::optional<glm::dvec2> spacing;
    EXPECT_TRUE(app::readSpacing("10", spacing));
    EXPECT_EQ(*spacing, glm::dvec2(10.0, 10.0));
    EXPECT_TRUE(app::readSpacing("10,20.5", spacing));
    for (const char* text : {"", ",", "1,", ",1", "0", "-1", "1,2,3", "1 ", "nan", "inf", "x"})
        EXPECT_FALSE(app::readSpacing(text, spacing)) << text;
    EXPECT_EQ(*spacing, glm::dvec2(10.0, 20.5));
    std::optional<double> factor;
    EXPECT_TRUE(app::readFactor("-0.5", factor));
    for (const char* text : {"", "0", "nan", "1e99", "2x"}) EXPECT_FALSE(app::readFactor(text, factor)) << text;
    EXPECT_EQ(app::splitList(",a,,b,"), (std::vector<std::string>{"a", "b"}));
}

}  // namespace
