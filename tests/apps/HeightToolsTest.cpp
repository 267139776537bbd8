// Heights, slopes and lengths against what can be computed by hand, and against many small steps.
#include "HeightTools.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

#include <Inventor/nodes/SoSeparator.h>
#include <SoTerrain/SoHeightMap.h>
#include <SoTerrain/SoROAMTerrain.h>
#include <SoTerrain/SoTerrain.h>

#include <Inventor/SoDB.h>
#include <glm/geometric.hpp>

#include "NodePtr.h"
#include "ToolsDrawing.h"

namespace {

using app::Ground;
using app::MeasuredLine;
using glm::dvec2;

constexpr double degrees = 180.0 / std::numbers::pi;

/// Samples of a function over a lattice, behind the node that SoTerrainTest asks.
class NodeGround : public Ground {
public:
    NodeGround(const Lattice& lattice, const std::function<double(dvec2)>& height)
        : lattice_(lattice), root_(new SoSeparator), terrain_(new SoROAMTerrain)
    {
        auto* map = new SoHeightMap;
        map->spacing.setValue(float(lattice.spacing.x), float(lattice.spacing.y));
        map->origin.setValue(float(lattice.origin.x), float(lattice.origin.y));
        std::vector<float> heights;
        for (int row = 0; row < lattice.rows; ++row)
            for (int column = 0; column < lattice.columns; ++column)
                heights.push_back(float(height(lattice.origin + lattice.spacing * dvec2(column, row))));
        map->setHeights(lattice.columns, lattice.rows, heights.data());
        root_->addChild(map);
        root_->addChild(terrain_);
    }

    std::optional<Surface> at(dvec2 place) const override
    {
        float height = 0.0f;
        SbVec3f normal;
        if (!terrain_->heightAt(float(place.x), float(place.y), height, &normal)) return std::nullopt;
        return Surface{height, glm::normalize(glm::dvec3(normal[0], normal[1], normal[2]))};
    }
    Lattice lattice() const override { return lattice_; }

private:
    Lattice lattice_;
    app::NodePtr<SoSeparator> root_;
    SoROAMTerrain* terrain_;
};

class HeightTools : public testing::Test {
protected:
    static void SetUpTestSuite()
    {
        SoDB::init();
        SoTerrain::init();
    }
};

/// What the surface gives in steps so small that its edges hardly matter.
struct Walk {
    double ground = 0.0, climb = 0.0, descent = 0.0, steepest = 0.0;
};
Walk walk(const Ground& ground, dvec2 from, dvec2 to, int steps)
{
    Walk result;
    std::optional<double> last;
    for (int i = 0; i <= steps; ++i) {
        const auto here = ground.at(glm::mix(from, to, double(i) / steps));
        if (here && last) {
            const double rise = here->height - *last, length = glm::length(to - from) / steps;
            result.ground += std::hypot(rise, length);
            (rise > 0.0 ? result.climb : result.descent) += std::fabs(rise);
        }
        last = here ? std::optional(here->height) : std::nullopt;
    }
    return result;
}

TEST_F(HeightTools, RampHasItsSlopeAspectAndLengths)
{
    // Rises 3 in 4 to the east.
    const NodeGround ramp({65, 33, {10.0, 20.0}, {2.0, 5.0}}, [](dvec2 p) { return 0.75 * p.x; });
    const auto spot = app::spotAt(ramp, {31.3, 77.7});
    ASSERT_TRUE(spot);
    EXPECT_NEAR(spot->at.z, 0.75 * 31.3, 1e-4);
    EXPECT_NEAR(spot->slopeDegrees, std::atan(0.75) * degrees, 1e-3);
    EXPECT_NEAR(*spot->aspectDegrees, 270.0, 1e-3) << "it falls to the west";

    const MeasuredLine east = app::measureLine(ramp, {{20.0, 50.0}, {60.0, 50.0}});
    EXPECT_NEAR(east.horizontal, 40.0, 1e-9);
    EXPECT_NEAR(east.ground, 50.0, 1e-3) << "3, 4, 5";
    EXPECT_NEAR(east.climb, 30.0, 1e-3);
    EXPECT_NEAR(east.descent, 0.0, 1e-9);
    EXPECT_NEAR(east.steepestDegrees, std::atan(0.75) * degrees, 1e-3);
    EXPECT_NEAR(*east.lowest, 15.0, 1e-4);
    EXPECT_NEAR(*east.highest, 45.0, 1e-4);

    const MeasuredLine there = app::measureLine(ramp, {{20.0, 50.0}, {60.0, 50.0}, {20.0, 50.0}, {20.0, 90.0}});
    EXPECT_NEAR(there.horizontal, 120.0, 1e-9);
    EXPECT_NEAR(there.climb, 30.0, 1e-3);
    EXPECT_NEAR(there.descent, 30.0, 1e-3);
    EXPECT_NEAR(there.ground, 140.0, 1e-3) << "along a contour nothing is added";
    EXPECT_NEAR(*there.heightAt(20.0), 30.0, 1e-3);
    EXPECT_NEAR(there.placeAt(100.0).y, 70.0, 1e-6);
}

TEST_F(HeightTools, AspectIsTheCompassDirectionOfTheFall)
{
    const struct {
        dvec2 rise;
        double aspect;
    } cases[] = {{{0.0, -1.0}, 0.0}, {{-1.0, 0.0}, 90.0}, {{0.0, 1.0}, 180.0}, {{1.0, 1.0}, 225.0}};
    for (const auto& c : cases) {
        const NodeGround plane({9, 9, {0.0, 0.0}, {1.0, 1.0}}, [&](dvec2 p) { return glm::dot(c.rise, p); });
        const auto spot = app::spotAt(plane, {3.3, 4.1});
        ASSERT_TRUE(spot);
        EXPECT_NEAR(*spot->aspectDegrees, c.aspect, 1e-3);
    }
    const NodeGround level({9, 9, {0.0, 0.0}, {1.0, 1.0}}, [](dvec2) { return 7.0; });
    EXPECT_FALSE(app::spotAt(level, {3.3, 4.1})->aspectDegrees);
    EXPECT_EQ(app::spotAt(level, {3.3, 4.1})->slopeDegrees, 0.0);
}

TEST_F(HeightTools, LineOverASphereCapIsAsLongAsItsArc)
{
    // A cap of radius 100 whose foot is a circle of radius 60.
    const double radius = 100.0;
    const NodeGround cap({601, 601, {-60.0, -60.0}, {0.2, 0.2}},
                         [radius](dvec2 p) { return std::sqrt(std::max(0.0, radius * radius - glm::dot(p, p))); });
    const dvec2 direction = glm::normalize(dvec2(2.0, 1.0));
    const MeasuredLine line = app::measureLine(cap, {-50.0 * direction, 50.0 * direction});
    const double angle = std::asin(50.0 / radius), rise = radius * (1.0 - std::cos(angle));
    EXPECT_NEAR(line.ground, 2.0 * radius * angle, 0.01);
    EXPECT_NEAR(line.climb, rise, 0.002);
    EXPECT_NEAR(line.descent, rise, 0.002);
    EXPECT_NEAR(line.steepestDegrees, angle * degrees, 0.2);
    const auto spot = app::spotAt(cap, 30.0 * direction);
    EXPECT_NEAR(spot->slopeDegrees, std::asin(0.3) * degrees, 0.2);
    EXPECT_NEAR(*spot->aspectDegrees, std::atan2(direction.x, direction.y) * degrees, 0.5);
}

TEST_F(HeightTools, LinesOverRoughGroundAreThoseOfManySmallSteps)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> height(0.0, 3.0), place(-3.0, 19.0);
    const NodeGround rough({17, 13, {0.0, 0.0}, {1.0, 1.25}}, [&](dvec2) { return height(random); });
    for (int i = 0; i < 6; ++i) {
        const dvec2 from(place(random), place(random)), to(place(random), place(random));
        const MeasuredLine line = app::measureLine(rough, {from, to});
        constexpr int steps = 8000;
        const Walk steppy = walk(rough, from, to, steps);
        // What the steps miss: at most one of them at each edge, and at the border of the map.
        const double missed = 200.0 * glm::length(to - from) / steps;
        EXPECT_NEAR(line.ground, steppy.ground, missed);
        EXPECT_NEAR(line.climb, steppy.climb, missed);
        EXPECT_NEAR(line.descent, steppy.descent, missed);
        EXPECT_NEAR(line.horizontal, glm::length(to - from), 1e-9);
        for (int step = 0; step < 50; ++step) {
            const double distance = line.horizontal * (step + 0.5) / 50.0;
            const auto exact = rough.at(line.placeAt(distance));
            const auto found = line.heightAt(distance);
            if (!exact || !found) continue;
            EXPECT_NEAR(*found, exact->height, 1e-4);
        }
    }
}

TEST_F(HeightTools, HolesAndWhatLiesOutsideAreLeftOut)
{
    const double hole = std::numeric_limits<double>::quiet_NaN();
    const NodeGround ground({11, 11, {0.0, 0.0}, {1.0, 1.0}}, [hole](dvec2 p) { return p == dvec2(5.0, 5.0) ? hole : 2.0; });
    EXPECT_FALSE(app::spotAt(ground, {5.2, 5.2}));
    EXPECT_FALSE(app::spotAt(ground, {-0.1, 5.0}));
    const app::GroundText text(ground, std::nullopt);
    EXPECT_NE(text.nothing({5.2, 5.2}).find("hole"), std::string::npos);
    EXPECT_NE(text.nothing({-0.1, 5.0}).find("outside"), std::string::npos);

    const MeasuredLine line = app::measureLine(ground, {{-2.0, 5.5}, {12.0, 5.5}});
    EXPECT_NEAR(line.horizontal, 14.0, 1e-9);
    EXPECT_NEAR(line.ground, 8.0, 1e-5) << "ten cells less the two beside the hole";
    EXPECT_NEAR(line.withoutGround, 6.0, 1e-5);
    EXPECT_FALSE(line.heightAt(1.0));
    EXPECT_FALSE(line.heightAt(7.0));
    EXPECT_NEAR(*line.heightAt(3.0), 2.0, 1e-6);
    const MeasuredLine beside = app::measureLine(ground, {{-2.0, 20.0}, {12.0, 20.0}});
    EXPECT_FALSE(beside.hasGround());
    EXPECT_NE(text.line(beside).find("no ground"), std::string::npos);
    EXPECT_NE(text.line(line).find("without ground"), std::string::npos);
}

TEST_F(HeightTools, LineOfNoLengthHasNone)
{
    const NodeGround ground({5, 5, {0.0, 0.0}, {1.0, 1.0}}, [](dvec2 p) { return p.x; });
    const MeasuredLine line = app::measureLine(ground, {{2.0, 2.0}, {2.0, 2.0}});
    EXPECT_EQ(line.horizontal, 0.0);
    EXPECT_FALSE(line.hasGround());
    EXPECT_EQ(line.placeAt(0.0), dvec2(2.0, 2.0));
}

TEST_F(HeightTools, GeoreferencedPlacesHaveTheFilesCoordinates)
{
    const NodeGround ground({101, 101, {0.0, 0.0}, {10.0, 10.0}}, [](dvec2) { return 5.0; });
    const app::Georeference utm{{500000.0, 4649000.0}, {10.0, 10.0}, "WGS 84 / UTM zone 33N (EPSG:32633)", false, "m"};
    const app::GroundText text(ground, utm);
    const auto world = text.worldAt({25.0, 40.0});
    ASSERT_TRUE(world);
    EXPECT_NEAR(world->x, 500025.0, 1e-6);
    EXPECT_NEAR(world->y, 4649040.0, 1e-6);
    const std::string words = text.spot(*app::spotAt(ground, {25.0, 40.0}));
    EXPECT_NE(words.find("E 500025.00, N 4649040.00, WGS 84 / UTM zone 33N (EPSG:32633)"), std::string::npos) << words;
    EXPECT_NE(words.find("height 5.0 m, slope 0.0\u00b0"), std::string::npos) << words;
    EXPECT_EQ(app::GroundText(ground, std::nullopt).spot(*app::spotAt(ground, {25.0, 40.0})).find("E "), std::string::npos);
}

TEST(HeightText, CoordinateSystemsAreNamed)
{
    const std::string utm = R"(PROJCS["WGS 84 / UTM zone 33N",GEOGCS["WGS 84",DATUM["WGS_1984",AUTHORITY["EPSG","6326"]],AUTHORITY["EPSG","4326"]],)"
                            R"(UNIT["metre",1,AUTHORITY["EPSG","9001"]],AUTHORITY["EPSG","32633"]])";
    EXPECT_EQ(app::systemName(utm), "WGS 84 / UTM zone 33N (EPSG:32633)");
    EXPECT_FALSE(app::isGeographic(utm));
    EXPECT_EQ(app::lengthUnit(utm), "m");
    const std::string wgs = R"(GEOGCS["WGS 84",DATUM["WGS_1984",AUTHORITY["EPSG","6326"]],UNIT["degree",0.0174532925199433],AUTHORITY["EPSG","4326"]])";
    EXPECT_EQ(app::systemName(wgs), "WGS 84 (EPSG:4326)");
    EXPECT_TRUE(app::isGeographic(wgs));
    EXPECT_EQ(app::lengthUnit(wgs), "");
    EXPECT_EQ(app::systemName(R"(PROJCS["Local",UNIT["US survey foot",0.3048,AUTHORITY["EPSG","9003"]],AXIS["X",EAST],AXIS["Y",NORTH]])"), "Local");
    EXPECT_EQ(app::lengthUnit(R"(PROJCS["Local",UNIT["US survey foot",0.3048]])"), "ft");
    EXPECT_EQ(app::systemName(""), "");
}

TEST(HeightText, MarkersAreReadAsTheyWereWritten)
{
    const std::vector<app::Marker> markers{{{1.5, -2.25}, "hut"}, {{0.1, 1e6}, "a \"name\", with all"}, {{3.0, 4.0}, ""}};
    const auto read = app::readMarkersCsv(app::markersCsv(markers), "m.csv");
    ASSERT_TRUE(read) << read.error().message();
    ASSERT_EQ(read.value().size(), markers.size());
    for (std::size_t i = 0; i < markers.size(); ++i) {
        EXPECT_EQ(read.value()[i].at, markers[i].at);
        EXPECT_EQ(read.value()[i].name, markers[i].name);
    }
    const auto wrong = app::readMarkersCsv("x,y,name\n1,2,a\n1;2\n", "m.csv");
    ASSERT_FALSE(wrong);
    EXPECT_NE(wrong.error().message().find("m.csv:3"), std::string::npos);
}

TEST_F(HeightTools, MarkersAreReadFromTheSceneThatTheyWereWrittenTo)
{
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("markers-" + std::to_string(getpid()));
    std::filesystem::create_directory(folder);
    const std::vector<app::Marker> markers{{{1.5, -2.25}, "hut"}, {{4.0, 5.0}, "a \"name\", with all"}, {{3.0, 4.0}, ""}};
    for (const char* name : {"m.iv", "m.csv"}) {
        const std::string path = (folder / name).string();
        ASSERT_FALSE(app::writeMarkers(path, markers, 100.0f)) << name;
        const auto read = app::readMarkers(path);
        ASSERT_TRUE(read) << read.error().message();
        ASSERT_EQ(read.value().size(), markers.size()) << name;
        for (std::size_t i = 0; i < markers.size(); ++i) {
            EXPECT_EQ(read.value()[i].at, markers[i].at) << name;
            EXPECT_EQ(read.value()[i].name, markers[i].name) << name;
        }
        EXPECT_FALSE(app::readMarkers((folder / "none" / name).string()));
        EXPECT_TRUE(app::writeMarkers((folder / "none" / name).string(), markers, 100.0f));
    }
    std::filesystem::remove_all(folder);
}

TEST(HeightText, PlacesAreReadInPairs)
{
    EXPECT_EQ(app::readPlaces("1,2.5,-3,4e2"), (std::vector<dvec2>{{1.0, 2.5}, {-3.0, 400.0}}));
    for (const char* wrong : {"", "1", "1,2,3", "1,2,x,4", "1,,2,3", "nan,1", "1,2,"}) EXPECT_FALSE(app::readPlaces(wrong)) << wrong;
    EXPECT_EQ(app::readMarker("1,2,the hut, old")->name, "the hut, old");
    EXPECT_EQ(app::readMarker("1,2")->name, "");
    EXPECT_FALSE(app::readMarker("1"));
    EXPECT_FALSE(app::readMarker("a,b,c"));
}

TEST_F(HeightTools, ProfileHasARowForEveryEdge)
{
    const NodeGround ground({5, 5, {0.0, 0.0}, {1.0, 1.0}}, [](dvec2 p) { return p.x * p.x; });
    const MeasuredLine line = app::measureLine(ground, {{0.0, 2.5}, {4.0, 2.5}});
    // Columns at 1, 2, 3 and diagonals at every half, of either direction.
    EXPECT_EQ(line.points.size(), 9u);
    const std::string csv = app::profileCsv(line, app::GroundText(ground, std::nullopt));
    EXPECT_EQ(csv.substr(0, csv.find('\n')), "distance,x,y,height");
    EXPECT_NE(csv.find("\n2,2,2.5,4\n"), std::string::npos) << csv;
}

}  // namespace
