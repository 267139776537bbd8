// Live editing: what a change of samples or of a field does, and what it leaves alone.
#include "Scenes.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <thread>

#include <gtest/gtest.h>

#include <Inventor/SoPickedPoint.h>
#include <Inventor/actions/SoGetBoundingBoxAction.h>
#include <Inventor/actions/SoRayPickAction.h>
#include <Inventor/nodes/SoCoordinate3.h>
#include <Inventor/nodes/SoDirectionalLight.h>
#include <Inventor/nodes/SoDrawStyle.h>
#include <Inventor/nodes/SoPerspectiveCamera.h>

#include <SoTerrain/SoChunkedLoDTerrain.h>
#include <SoTerrain/SoGeometryClipmapTerrain.h>
#include <SoTerrain/SoHeightMap.h>

using namespace test;
using terrain::Image;

namespace {

using Heights = std::vector<float>;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

Heights hills(int side) {
    const terrain::HeightMap map = fractalMap(side, side, 0.12 * side);
    return Heights(map.heights.begin(), map.heights.end());
}

/// A round hill on top of what is there, or a hollow.
Heights bumped(SoHeightMap* map, int column, int row, int size, float height) {
    Heights heights(std::size_t(size) * std::size_t(size));
    EXPECT_TRUE(map->getHeights(column, row, size, size, heights.data()));
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const double r = std::hypot(2.0 * x / (size - 1) - 1.0, 2.0 * y / (size - 1) - 1.0);
            if (r < 1.0) heights[std::size_t(y * size + x)] += height * float(0.5 + 0.5 * std::cos(3.14159265 * r));
        }
    return heights;
}

SoCamera* overhead(int side) {
    const float s = float(side);
    return cameraAt(SbVec3f(0.15f * s, 0.1f * s, 0.35f * s), SbVec3f(0.5f * s, 0.5f * s, 0.05f * s), 0.01f * s, 3.0f * s);
}

/// A terrain over a map of the program's making.
struct EditScene {
    Ref<SoSeparator> root = new SoSeparator;
    SoHeightMap* map = new SoHeightMap;
    SoTerrainShape* node;

    EditScene(Kind kind, int side, const Heights& heights, float pixelError = 1.0f, bool textured = false) : node(nodeOf(kind, 0, 0, pixelError)) {
        root->addChild(overhead(side));
        auto* light = new SoDirectionalLight;
        light->direction = SbVec3f(0.6f, -0.3f, -0.7f);
        root->addChild(light);
        if (textured) addTexture(root.get(), 32);
        root->addChild(map);
        root->addChild(node);
        EXPECT_TRUE(map->setHeights(side, side, heights.data()));
        if (auto* tiles = dynamic_cast<SoChunkedLoDTerrain*>(node)) tiles->background = FALSE;
    }

    SbBox3f box() const {
        SoGetBoundingBoxAction action(SbViewportRegion(100, 100));
        action.apply(root.get());
        return action.getBoundingBox();
    }
    float heightAt(float x, float y) const {
        float height = kNaN;
        node->heightAt(x, y, height);
        return height;
    }
    float pickedHeight(float x, float y) const {
        SoRayPickAction action(SbViewportRegion(100, 100));
        action.setRay(SbVec3f(x, y, 5000.0f), SbVec3f(0.0f, 0.0f, -1.0f));
        action.apply(root.get());
        const SoPickedPoint* point = action.getPickedPoint();
        return point ? point->getPoint()[2] : kNaN;
    }
};

/// The same scene with nodes that have seen nothing of what was before.
EditScene fresh(const EditScene& scene, Kind kind, bool textured = false) {
    int columns = 0, rows = 0;
    EXPECT_TRUE(scene.map->getSize(columns, rows));
    Heights heights(std::size_t(columns) * std::size_t(rows));
    EXPECT_TRUE(scene.map->getHeights(0, 0, columns, rows, heights.data()));
    EditScene made(kind, columns, heights, scene.node->pixelError.getValue(), textured);
    made.root->replaceChild(0, scene.root->getChild(0));
    made.map->spacing = scene.map->spacing.getValue();
    made.map->origin = scene.map->origin.getValue();
    return made;
}

/// Both drawn, and looked at: alike to the last bit where the mesh is the samples, else within what the promise leaves.
void expectLikeFresh(Stage& stage, const EditScene& scene, Kind kind, const std::string& what, bool textured = false) {
    const Image edited = stage.render(scene.root.get());
    const EditScene other = fresh(scene, kind, textured);
    const Image expected = stage.render(other.root.get());
    expectAlike(expected, edited, kind == Kind::BruteForce ? 0.0 : kind == Kind::Clipmap ? 0.2 : 1.5, what);
    if (kind != Kind::Clipmap) {
        EXPECT_LE(scene.node->getStatistics().errorPixels, scene.node->pixelError.getValue()) << what;
    }
}

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

namespace {

struct FieldChange {
    const char* what;
    std::function<void(SoHeightMap*, SoTerrainShape*)> apply;
    bool moves = false;  ///< which takes new meshes
};

const FieldChange kFieldChanges[] = {
    {"spacing", [](SoHeightMap* map, SoTerrainShape*) { map->spacing = SbVec2f(1.5f, 0.8f); }, true},
    {"origin", [](SoHeightMap* map, SoTerrainShape*) { map->origin = SbVec2f(7.0f, -3.0f); }, true},
    {"spacing and origin as before", [](SoHeightMap* map, SoTerrainShape*) { map->spacing = SbVec2f(0.0f, 0.0f), map->origin = SbVec2f(0.0f, 0.0f); }, true},
    {"the same scale", [](SoHeightMap* map, SoTerrainShape*) { map->heightScale = 0.5f; }},
    {"pixelError", [](SoHeightMap*, SoTerrainShape* node) { node->pixelError = 4.0f; }},
    {"frustumCulling", [](SoHeightMap*, SoTerrainShape* node) { node->frustumCulling = FALSE; }},
    {"frustumCulling as before", [](SoHeightMap*, SoTerrainShape* node) { node->frustumCulling = TRUE; }},
    {"alternateRep", [](SoHeightMap*, SoTerrainShape* node) { node->alternateRep = new SoSeparator; }},
};

}  // namespace

TEST_P(Edits, OfFieldsReadNoFileAndMeasureNothingThatStays)
{
    constexpr int kSide = 129;
    const TemporaryFolder folder;
    const auto write = [](const std::string& path) {
        std::ofstream file(path, std::ios::binary);
        for (const float height : hills(kSide)) file.put(char(int(5.0f * height)));
    };
    const auto sceneFor = [&](SbVec2f spacing, SbVec2f origin) {
        EditScene scene(GetParam(), kSide, Heights(kSide * kSide, 0.0f));
        scene.map->heightScale = 0.5f;
        scene.map->spacing = spacing;
        scene.map->origin = origin;
        scene.map->filename = folder.file("hills.raw").c_str();
        return scene;
    };
    write(folder.file("hills.raw"));
    EditScene scene = sceneFor({0.0f, 0.0f}, {0.0f, 0.0f});
    Stage stage;
    stage.render(scene.root.get());
    for (const FieldChange& change : kFieldChanges) {
        SCOPED_TRACE(change.what);
        std::filesystem::remove(folder.file("hills.raw"));
        change.apply(scene.map, scene.node);
        // A message that the file is gone would fail here.
        const Image picture = stage.render(scene.root.get());
        if (!change.moves) {
            EXPECT_EQ(scene.node->getStatistics().buildMilliseconds, 0.0);
        }
        EXPECT_TRUE(scene.map->isLoaded());
        write(folder.file("hills.raw"));
        EditScene other = sceneFor(scene.map->spacing.getValue(), scene.map->origin.getValue());
        other.root->replaceChild(0, scene.root->getChild(0));
        other.node->pixelError = scene.node->pixelError.getValue();
        other.node->frustumCulling = scene.node->frustumCulling.getValue();
        expectAlike(stage.render(other.root.get()), picture, GetParam() == Kind::BruteForce ? 0.0 : 3.0, change.what);
    }
    // What changes the samples reads them again.
    std::filesystem::remove(folder.file("hills.raw"));
    scene.map->heightScale = 0.25f;
    Messages messages;
    stage.render(scene.root.get());
    EXPECT_EQ(messages.all().size(), 1u) << messages.text();
}
