// Live editing: what a change of samples or of a field does, and what it leaves alone.
#include "EditScene.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <thread>

#include <gtest/gtest.h>

#include <Inventor/actions/SoGetBoundingBoxAction.h>
#include <Inventor/nodes/SoCoordinate3.h>
#include <Inventor/nodes/SoDrawStyle.h>
#include <Inventor/nodes/SoPerspectiveCamera.h>

#include <SoTerrain/SoChunkedLoDTerrain.h>
#include <SoTerrain/SoGeometryClipmapTerrain.h>
#include <SoTerrain/SoHeightMap.h>

using namespace test;
using terrain::Image;

namespace {

class Edits : public testing::TestWithParam<Kind> {};

}  // namespace

TEST_P(Edits, AreInPicksHeightsAndBoxesAtOnce)
{
    constexpr int kSide = 129;
    EditScene scene(GetParam(), kSide, Heights(kSide * kSide, 1.0f));
    Stage stage;
    stage.render(scene.root.get());
    EXPECT_FLOAT_EQ(scene.box().getMax()[2], 1.0f);
    Heights hill(9 * 9, 7.0f);
    ASSERT_TRUE(scene.map->setHeights(60, 30, 9, 9, hill.data()));
    EXPECT_FLOAT_EQ(scene.heightAt(64.3f, 33.6f), 7.0f);
    EXPECT_FLOAT_EQ(scene.pickedHeight(64.3f, 33.6f), 7.0f);
    EXPECT_FLOAT_EQ(scene.heightAt(50.0f, 33.6f), 1.0f);
    EXPECT_FLOAT_EQ(scene.box().getMax()[2], 7.0f);
    stage.render(scene.root.get());
    EXPECT_EQ(scene.node->getStatistics().buildMilliseconds, 0.0) << "built anew";
    // Holes, and the box that shrinks again.
    std::fill(hill.begin(), hill.end(), kNaN);
    ASSERT_TRUE(scene.map->setHeights(60, 30, 9, 9, hill.data()));
    EXPECT_TRUE(std::isnan(scene.heightAt(64.3f, 33.6f)));
    EXPECT_TRUE(std::isnan(scene.pickedHeight(64.3f, 33.6f)));
    EXPECT_FLOAT_EQ(scene.box().getMax()[2], 1.0f);
    expectLikeFresh(stage, scene, GetParam(), "hole");
    std::fill(hill.begin(), hill.end(), 1.0f);
    ASSERT_TRUE(scene.map->setHeights(60, 30, 9, 9, hill.data()));
    EXPECT_FLOAT_EQ(scene.pickedHeight(64.3f, 33.6f), 1.0f);
    expectLikeFresh(stage, scene, GetParam(), "filled");
}

TEST_P(Edits, GiveThePictureOfAFreshNode)
{
    constexpr int kSide = 257;
    EditScene scene(GetParam(), kSide, hills(kSide));
    Stage stage;
    std::vector<Image> pictures = {stage.render(scene.root.get())};
    const struct {
        int column, row, size;
        float height;
    } brushes[] = {{60, 60, 33, 25.0f}, {112, 100, 33, -20.0f}, {120, 40, 65, 40.0f}, {0, 0, 17, 12.0f}, {240, 240, 17, 30.0f}, {60, 60, 33, -25.0f}};
    for (const auto& b : brushes) {
        ASSERT_TRUE(scene.map->setHeights(b.column, b.row, b.size, b.size, bumped(scene.map, b.column, b.row, b.size, b.height).data()));
        expectLikeFresh(stage, scene, GetParam(), "brush at " + std::to_string(b.column));
        EXPECT_EQ(scene.node->getStatistics().buildMilliseconds, 0.0);
    }
    pictures.push_back(stage.render(scene.root.get()));
    auto* wires = new SoDrawStyle;
    wires->style = SoDrawStyle::LINES;
    scene.root->insertChild(wires, 1);
    pictures.push_back(stage.render(scene.root.get()));
    savePicture("edits-" + identifierOf(GetParam()), pictures);
}

/// A hill, a hole in it and its filling: textured, plain and as wires.
TEST_P(Edits, LookAsFreshTexturedPlainAndAsWires)
{
    constexpr int kSide = 129;
    for (const bool textured : {true, false})
        for (const bool wires : {false, true}) {
            if (textured && wires) continue;
            EditScene scene(GetParam(), kSide, hills(kSide), 1.0f, textured);
            const auto dress = [&](SoSeparator* root) {
                auto* style = new SoDrawStyle;
                if (wires) style->style = SoDrawStyle::LINES;
                root->insertChild(style, 1);
            };
            dress(scene.root.get());
            Stage stage;
            std::vector<Image> pictures = {stage.render(scene.root.get())};
            const auto look = [&](const std::string& what) {
                const std::string name = what + (textured ? ", textured" : wires ? ", wires" : ", plain");
                pictures.push_back(stage.render(scene.root.get()));
                const EditScene other = fresh(scene, GetParam(), textured);
                dress(other.root.get());
                // Lines of another refinement are elsewhere.
                const double mean = GetParam() == Kind::BruteForce ? 0.0 : wires ? 25.0 : 1.5;
                expectAlike(stage.render(other.root.get()), pictures.back(), mean, name, wires ? 8 : 2);
            };
            ASSERT_TRUE(scene.map->setHeights(40, 30, 33, 33, bumped(scene.map, 40, 30, 33, 14.0f).data()));
            look("hill");
            Heights before(9 * 9);
            ASSERT_TRUE(scene.map->getHeights(52, 38, 9, 9, before.data()));
            ASSERT_TRUE(scene.map->setHeights(52, 38, 9, 9, Heights(9 * 9, kNaN).data()));
            look("hole");
            ASSERT_TRUE(scene.map->setHeights(52, 38, 9, 9, before.data()));
            look("filled");
            const std::string style = textured ? "-textured" : wires ? "-wires" : "-plain";
            savePicture("edits-look-" + identifierOf(GetParam()) + style, pictures);
        }
}

/// Sculpting at 1025 x 1025: a brush that moves, a frame for each edit.
TEST_P(Edits, SendNoMoreThanAMovingFrameAndTheirOwnSamples)
{
    constexpr int kSide = 1025, kBrush = 33;
    EditScene scene(GetParam(), kSide, hills(kSide), 2.0f, true);
    Stage stage;
    stage.render(scene.root.get());
    std::vector<double> plain, edits, setting;
    std::size_t plainBytes = 0, editBytes = 0;
    const auto timed = [&](const std::function<void()>& what) {
        const auto start = std::chrono::steady_clock::now();
        what();
        glFinish();
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    };
    auto* camera = static_cast<SoPerspectiveCamera*>(scene.root->getChild(0));
    const int frames = GetParam() == Kind::BruteForce ? 3 : 12;
    for (int frame = 0; frame < frames; ++frame) {
        camera->position = camera->position.getValue() + SbVec3f(0.7f, 0.5f, 0.0f);
        plain.push_back(timed([&] { stage.render(scene.root.get()); }));
        plainBytes = std::max(plainBytes, scene.node->getStatistics().uploadedBytes);
    }
    for (int frame = 0; frame < frames; ++frame) {
        const int column = 250 + 20 * frame, row = 260 + 13 * frame;
        const Heights brush = bumped(scene.map, column, row, kBrush, 6.0f);
        setting.push_back(timed([&] { ASSERT_TRUE(scene.map->setHeights(column, row, kBrush, kBrush, brush.data())); }));
        // The middle of the brush, in the same frame.
        EXPECT_NEAR(scene.heightAt(float(column + 16), float(row + 16)), brush[16 * kBrush + 16], 1e-3);
        edits.push_back(timed([&] { stage.render(scene.root.get()); }));
        const SoTerrainStatistics statistics = scene.node->getStatistics();
        EXPECT_EQ(statistics.buildMilliseconds, 0.0);
        if (GetParam() != Kind::Clipmap) {
            EXPECT_LE(statistics.errorPixels, 2.0f);
        }
        editBytes = std::max(editBytes, statistics.uploadedBytes);
    }
    const auto median = [](std::vector<double> values) {
        std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2), values.end());
        return values[values.size() / 2];
    };
    std::printf("%s: a frame %.1f ms, %zu KB; with an edit %.1f ms and %.2f ms for setHeights, %zu KB\n", nameOf(GetParam()), median(plain),
                plainBytes >> 10, median(edits), median(setting), editBytes >> 10);
    // 35 x 35 samples with normals and texture coordinates, of as many levels as there are; a tenth for other refinement.
    EXPECT_LE(editBytes, plainBytes + plainBytes / 10 + 200 * 1024);
    expectLikeFresh(stage, scene, GetParam(), "sculpted", true);
}

INSTANTIATE_TEST_SUITE_P(Nodes, Edits, testing::ValuesIn(kOurKinds), [](const auto& info) { return identifierOf(info.param); });

namespace {

/// Coordinates of the scene, which shapeOf() puts there.
SoCoordinate3* coordinatesIn(SoSeparator* root) {
    for (int i = 0; i < root->getNumChildren(); ++i) {
        if (root->getChild(i)->isOfType(SoCoordinate3::getClassTypeId())) return static_cast<SoCoordinate3*>(root->getChild(i));
        if (root->getChild(i)->isOfType(SoSeparator::getClassTypeId()))
            if (SoCoordinate3* found = coordinatesIn(static_cast<SoSeparator*>(root->getChild(i)))) return found;
    }
    return nullptr;
}

void expectCoordinatesFollow(Kind kind, const Surface& surface, const std::string& what) {
    const ShapeOptions options{.pixelError = 1.0f, .normals = false};
    const auto complete = [](SoSeparator* root) {
        if (auto* tiles = dynamic_cast<SoChunkedLoDTerrain*>(terrainIn(root))) tiles->background = FALSE;
    };
    const auto root = sceneOf(kind, surface, options, {}, cameraFor(surface.box()));
    complete(root.get());
    Stage stage;
    stage.render(root.get());
    SoCoordinate3* coordinates = coordinatesIn(root.get());
    ASSERT_TRUE(coordinates);
    Surface changed = surface;
    for (const int sample : {int(surface.index(30, 40)), int(surface.index(31, 40)), int(surface.index(64, 10))}) {
        changed.points[std::size_t(sample)][2] += 9.0f;
        coordinates->point.set1Value(sample, changed.points[std::size_t(sample)]);
        const Image edited = stage.render(root.get());
        EXPECT_EQ(terrainIn(root.get())->getStatistics().buildMilliseconds, 0.0) << what << ": all was built anew";
        const auto other = sceneOf(kind, changed, options, {}, cameraFor(surface.box()));
        complete(other.get());
        expectAlike(stage.render(other.get()), edited, kind == Kind::BruteForce ? 0.0 : 1.5, what);
    }
}

}  // namespace

TEST_P(Edits, OfOneCoordinateLeaveTheRestAlone)
{
    const Surface regular = surfaceOf(fractalMap(129, 129, 20.0));
    expectCoordinatesFollow(GetParam(), regular, "regular");
    const Surface curved = surfaceOf(fractalMap(129, 129, 20.0), [](int column, int row, float height) {
        return SbVec3f(float(column) + 0.4f * std::sin(0.3f * float(row)), float(row), height);
    });
    expectCoordinatesFollow(GetParam(), curved, "curved");
}

TEST_P(Edits, ThatMakeARegularGridCurvedBuildItAnew)
{
    const Surface surface = surfaceOf(fractalMap(65, 65, 10.0));
    const auto root = sceneOf(GetParam(), surface, {.normals = false}, {}, cameraFor(surface.box()));
    Stage stage;
    stage.render(root.get());
    Surface changed = surface;
    changed.points[changed.index(20, 20)] += SbVec3f(0.5f, 0.5f, 3.0f);
    coordinatesIn(root.get())->point.set1Value(int(changed.index(20, 20)), changed.points[changed.index(20, 20)]);
    const Image edited = stage.render(root.get());
    const auto other = sceneOf(GetParam(), changed, {.normals = false}, {}, cameraFor(surface.box()));
    expectAlike(stage.render(other.get()), edited, 1.5);
}

TEST(HeightMapEdits, TellWhatIsWrongWithThem)
{
    Ref<SoHeightMap> map(new SoHeightMap);
    const Heights heights(100, 0.0f);
    const auto refused = [&](const std::string& expected, const std::string& found, const std::function<SbBool()>& call) {
        Messages messages;
        EXPECT_FALSE(call());
        EXPECT_EQ(messages.all().size(), 1u) << messages.text();
        EXPECT_NE(messages.text().find(expected), std::string::npos) << messages.text();
        EXPECT_NE(messages.text().find(found), std::string::npos) << messages.text();
    };
    refused("a map", "none", [&] { return map->setHeights(0, 0, 2, 2, heights.data()); });
    refused("2 x 2", "1 x 9", [&] { return map->setHeights(1, 9, heights.data()); });
    refused("100 floats", "NULL", [&] { return map->setHeights(10, 10, nullptr); });
    ASSERT_TRUE(map->setHeights(10, 10, heights.data()));
    refused("10 x 10", "3 x 2 from column 8, row 1", [&] { return map->setHeights(8, 1, 3, 2, heights.data()); });
    refused("10 x 10", "column -1", [&] { return map->setHeights(-1, 0, 2, 2, heights.data()); });
    refused("10 x 10", "0 x 2", [&] { return map->setHeights(1, 1, 0, 2, heights.data()); });
    refused("10 x 10", "2147483647", [&] { return map->setHeights(5, 5, 2147483647, 2147483647, heights.data()); });
    refused("4 floats", "NULL", [&] { return map->setHeights(1, 1, 2, 2, nullptr); });
    refused("4 floats", "NULL", [&] { return map->getHeights(1, 1, 2, 2, nullptr); });
    Messages ignored;
    map->filename = "nowhere.png";
    EXPECT_FALSE(map->setHeights(10, 10, heights.data()));
    EXPECT_NE(ignored.text().find("no filename"), std::string::npos) << ignored.text();
}

TEST(HeightMapEdits, OfACopyLeaveTheOriginalAlone)
{
    const Heights flat(81, 2.0f), high(4, 9.0f);
    Ref<SoHeightMap> map(new SoHeightMap);
    ASSERT_TRUE(map->setHeights(9, 9, flat.data()));
    Ref<SoHeightMap> copy(static_cast<SoHeightMap*>(map->copy()));
    const auto at = [](SoHeightMap* of, int column, int row) {
        float height = kNaN;
        EXPECT_TRUE(of->getHeights(column, row, 1, 1, &height));
        return height;
    };
    EXPECT_EQ(at(copy.get(), 3, 3), 2.0f);
    ASSERT_TRUE(copy->setHeights(3, 3, 2, 2, high.data()));
    EXPECT_EQ(at(copy.get(), 3, 3), 9.0f);
    EXPECT_EQ(at(map.get(), 3, 3), 2.0f);
    ASSERT_TRUE(map->setHeights(6, 6, 2, 2, high.data()));
    EXPECT_EQ(at(copy.get(), 6, 6), 2.0f);
    // Moving one is not moving the other.
    EditScene one(Kind::BruteForce, 9, flat);
    Ref<SoSeparator> other(new SoSeparator);
    Ref<SoHeightMap> moved(static_cast<SoHeightMap*>(one.map->copy()));
    moved->origin = SbVec2f(100.0f, 0.0f);
    other->addChild(moved.get());
    other->addChild(nodeOf(Kind::BruteForce, 0, 0));
    SoGetBoundingBoxAction action(SbViewportRegion(100, 100));
    action.apply(other.get());
    EXPECT_FLOAT_EQ(action.getBoundingBox().getMin()[0], 100.0f);
    EXPECT_FLOAT_EQ(one.box().getMin()[0], 0.0f);
}

TEST(HeightMapEdits, AreNaNWhereNotFinite)
{
    Ref<SoHeightMap> map(new SoHeightMap);
    ASSERT_TRUE(map->setHeights(3, 3, Heights{0, 1, 2, 3, kNaN, 5, 6, -std::numeric_limits<float>::infinity(), 8}.data()));
    Heights read(9);
    ASSERT_TRUE(map->getHeights(0, 0, 3, 3, read.data()));
    EXPECT_TRUE(std::isnan(read[4]) && std::isnan(read[7]));
    EXPECT_EQ(read[8], 8.0f);
}
