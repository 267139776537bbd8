// Bad input gives one message that says what was expected and found, and draws nothing or what is left, but never crashes.
#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include "Scenes.h"

#include <gtest/gtest.h>

#include <climits>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include <Inventor/actions/SoCallbackAction.h>
#include <Inventor/actions/SoGetBoundingBoxAction.h>
#include <Inventor/actions/SoGetPrimitiveCountAction.h>
#include <Inventor/actions/SoRayPickAction.h>
#include <Inventor/nodes/SoCoordinate3.h>
#include <Inventor/nodes/SoDirectionalLight.h>
#include <Inventor/nodes/SoMaterial.h>
#include <Inventor/nodes/SoMaterialBinding.h>
#include <Inventor/nodes/SoNormal.h>
#include <Inventor/nodes/SoTextureCoordinate2.h>

#include <SoTerrain/SoGeoMipmapTerrain.h>
#include <SoTerrain/SoHeightMap.h>
#include <SoTerrain/SoROAMTerrain.h>

#include "ImageFile.h"

using namespace test;

namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

class BadInput : public testing::TestWithParam<Kind> {
protected:
    /// Every action twice. One message, with all of `words` in it.
    void expectOneMessage(SoTerrainShape* node, const std::vector<SoNode*>& properties, const std::vector<std::string>& words) {
        Messages messages;
        applyAll(node, properties);
        EXPECT_EQ(messages.all().size(), 1u) << messages.text();
        for (const std::string& word : words) EXPECT_NE(messages.text().find(word), std::string::npos) << "no '" << word << "' in " << messages.text();
        EXPECT_NE(messages.text().find("expected"), std::string::npos) << messages.text();
        EXPECT_NE(messages.text().find("found"), std::string::npos) << messages.text();
    }

    void expectNoMessage(SoTerrainShape* node, const std::vector<SoNode*>& properties) {
        Messages messages;
        applyAll(node, properties);
        EXPECT_TRUE(messages.all().empty()) << messages.text();
    }

    SoTerrainShape* node(int columns = 4, int rows = 4) { return nodeOf(GetParam(), columns, rows); }

    /// `count` coordinates, as if of rows of four.
    static SoCoordinate3* coordinates(int count) {
        auto* node = new SoCoordinate3;
        node->point.setNum(count);
        for (int i = 0; i < count; ++i) node->point.set1Value(i, float(i % 4), float(i / 4), 0.3f * float(i % 3));
        return node;
    }

    Stage stage_;
    int covered_ = 0;

private:
    void applyAll(SoTerrainShape* node, const std::vector<SoNode*>& properties) {
        Ref<SoSeparator> root(new SoSeparator);
        root->addChild(cameraAt({1.5f, -4.0f, 6.0f}, {1.5f, 1.5f, 0.0f}, 0.5f, 50.0f));
        root->addChild(new SoDirectionalLight);
        for (SoNode* property : properties) root->addChild(property);
        root->addChild(node);
        for (int round = 0; round < 2; ++round) {
            covered_ = coveredPixels(stage_.render(root.get()));
            SoGetBoundingBoxAction(SbViewportRegion(320, 240)).apply(root.get());
            SoRayPickAction pick(SbViewportRegion(320, 240));
            pick.setRay({1.3f, 1.4f, 50.0f}, {0.0f, 0.0f, -1.0f});
            pick.apply(root.get());
            SoGetPrimitiveCountAction().apply(root.get());
            SoCallbackAction primitives;
            primitives.addTriangleCallback(SoTerrainShape::getClassTypeId(), [](void*, SoCallbackAction*, const SoPrimitiveVertex*, const SoPrimitiveVertex*, const SoPrimitiveVertex*) {}, nullptr);
            primitives.apply(root.get());
        }
    }
};

SoHeightMap* mapOfFile(const std::string& path) {
    auto* map = new SoHeightMap;
    map->filename = path.c_str();
    return map;
}

}  // namespace

TEST_P(BadInput, MissingFileIsNamed) {
    expectOneMessage(node(0, 0), {mapOfFile("/nowhere/terrain.png")}, {"/nowhere/terrain.png"});
    EXPECT_EQ(covered_, 0);
}

#ifdef HAVE_OPENIMAGEIO
TEST_P(BadInput, TruncatedImageIsNamed) {
    const TemporaryFolder folder;
    terrain::Image image{64, 64, 1, {}};
    for (int i = 0; i < 64 * 64; ++i) image.pixels.push_back(std::uint8_t((i * 7919) >> 3));
    ASSERT_FALSE(app::writeImage(folder.file("map.png"), image));
    std::filesystem::resize_file(folder.file("map.png"), std::filesystem::file_size(folder.file("map.png")) / 2);
    expectOneMessage(node(0, 0), {mapOfFile(folder.file("map.png"))}, {"map.png"});
    EXPECT_EQ(covered_, 0);
}

TEST_P(BadInput, ImageOfThreeChannelsAsksForAChannel) {
    const TemporaryFolder folder;
    terrain::Image image{8, 8, 3, std::vector<std::uint8_t>(8 * 8 * 3, 7)};
    ASSERT_FALSE(app::writeImage(folder.file("map.png"), image));
    expectOneMessage(node(0, 0), {mapOfFile(folder.file("map.png"))}, {"map.png", "channel", "3"});
    auto* chosen = mapOfFile(folder.file("map.png"));
    chosen->channel = 1;
    chosen->heightScale = 0.0f;
    expectNoMessage(node(0, 0), {chosen});
    EXPECT_GT(covered_, 0);
}
#endif

TEST_P(BadInput, NoCoordinatesAreMissed) {
    expectOneMessage(node(), {}, {"SoHeightMap", "SoCoordinate3"});
    EXPECT_EQ(covered_, 0);
}

TEST_P(BadInput, TooFewCoordinatesAreCounted) {
    expectOneMessage(node(4, 4), {coordinates(15)}, {"4 x 4", "15"});
    EXPECT_EQ(covered_, 0);
}

TEST_P(BadInput, NoCoordinatesFromTheStartOnAreCounted) {
    for (const int start : {16, 17, INT_MAX}) {
        SoTerrainShape* shape = node(0, 0);
        shape->startIndex = start;
        expectOneMessage(shape, {coordinates(16)}, {"0 coordinates"});
        EXPECT_EQ(covered_, 0);
    }
}

TEST_P(BadInput, NoSquareOfCoordinatesIsCounted) {
    expectOneMessage(node(0, 0), {coordinates(15)}, {"15"});
    EXPECT_EQ(covered_, 0);
}

TEST_P(BadInput, SizesThatMakeNoGridAreTold) {
    expectOneMessage(node(1, 4), {coordinates(16)}, {"1 x 4", "2"});
    expectOneMessage(node(4, 1), {coordinates(16)}, {"4 x 1"});
    expectOneMessage(node(-4, 4), {coordinates(16)}, {"-4"});
    expectOneMessage(node(4, -1), {coordinates(16)}, {"-1"});
    expectOneMessage(node(0, 17), {coordinates(16)}, {"17"});
    EXPECT_EQ(covered_, 0);
}

TEST_P(BadInput, SizesThatOverflowAreTold) {
    expectOneMessage(node(100000, 100000), {coordinates(16)}, {"100000", "16"});
    expectOneMessage(node(INT_MAX, INT_MAX), {coordinates(16)}, {"2147483647", "16"});
    expectOneMessage(node(INT_MAX, 2), {coordinates(16)}, {"2147483647"});
    expectOneMessage(node(INT_MIN, INT_MIN), {coordinates(16)}, {"-2147483648"});
    // 65536 * 65537 is 65536 in 32 bits.
    expectOneMessage(node(65536, 65537), {coordinates(16)}, {"65536 x 65537"});
    EXPECT_EQ(covered_, 0);
}

TEST_P(BadInput, StartIndexOutsideIsTold) {
    for (const int start : {-1, INT_MIN, 1, 16, INT_MAX}) {
        auto* shape = node();
        shape->startIndex = start;
        expectOneMessage(shape, {coordinates(16)}, {std::to_string(start)});
        EXPECT_EQ(covered_, 0);
    }
}

TEST_P(BadInput, SizesLargerThanTheMapAreTold) {
    const TemporaryFolder folder;
    std::ofstream(folder.file("map.raw"), std::ios::binary).write("0123456789abcdef", 16);
    expectOneMessage(node(5, 4), {mapOfFile(folder.file("map.raw"))}, {"5 x 4", "16"});
    expectOneMessage(node(5, 2), {mapOfFile(folder.file("map.raw"))}, {"5 x 2", "4 x 4"});
    auto* shape = node(2, 2);
    shape->startIndex = 3;
    expectOneMessage(shape, {mapOfFile(folder.file("map.raw"))}, {"4 x 4", "column 3"});
    auto* last = node(2, 2);
    last->startIndex = INT_MAX;
    expectOneMessage(last, {mapOfFile(folder.file("map.raw"))}, {"2147483647"});
}

TEST_P(BadInput, PixelErrorThatIsNoNumberIsTold) {
    for (const float pixels : {kNaN, -1.0f, -std::numeric_limits<float>::infinity()}) {
        auto* shape = node();
        shape->pixelError = pixels;
        expectOneMessage(shape, {coordinates(16)}, {"pixelError"});
        EXPECT_GT(covered_, 100);
    }
}

TEST_P(BadInput, InfinitePixelErrorDrawsSomething) {
    Ref<SoSeparator> root = sceneOf(GetParam(), surfaceOf(fractalMap(20, 20, 3.0)), {.pixelError = std::numeric_limits<float>::infinity()});
    Messages messages;
    EXPECT_GT(coveredPixels(stage_.render(root.get())), 100);
    EXPECT_LE(messages.all().size(), 1u);
}

TEST_P(BadInput, CoordinatesThatAreNowhereDrawNothing) {
    auto* points = coordinates(16);
    for (int i = 0; i < 16; ++i) points->point.set1Value(i, kNaN, kNaN, kNaN);
    expectNoMessage(node(), {points});
    EXPECT_EQ(covered_, 0);
}

TEST_P(BadInput, InfiniteCoordinatesAreHoles) {
    auto* points = coordinates(16);
    points->point.set1Value(0, 0.0f, 0.0f, std::numeric_limits<float>::infinity());
    points->point.set1Value(15, -std::numeric_limits<float>::infinity(), 3.0f, 0.0f);
    auto* whole = node();
    expectNoMessage(node(), {points});
    const int withHoles = covered_;
    EXPECT_GT(withHoles, 100);
    expectNoMessage(whole, {coordinates(16)});
    EXPECT_LT(withHoles, covered_);
}

TEST_P(BadInput, HugeCoordinatesDoNotCrash) {
    auto* points = coordinates(16);
    for (int i = 0; i < 16; ++i) points->point.set1Value(i, points->point[i] * 1e38f);
    expectNoMessage(node(), {points});
}

TEST_P(BadInput, TooFewNormalsAreCounted) {
    auto* normals = new SoNormal;
    normals->vector.setNum(7);
    for (int i = 0; i < 7; ++i) normals->vector.set1Value(i, 0.0f, 0.0f, 1.0f);
    expectOneMessage(node(), {coordinates(16), normals}, {"normal", "16", "7"});
    EXPECT_GT(covered_, 100);
}

TEST_P(BadInput, TooFewTextureCoordinatesAreCounted) {
    auto* texture = new SoTextureCoordinate2;
    for (int i = 0; i < 7; ++i) texture->point.set1Value(i, 0.1f * float(i), 0.5f);
    auto* group = new SoGroup;
    addTexture(group);
    expectOneMessage(node(), {coordinates(16), texture, group}, {"texture coordinate", "16", "7"});
    EXPECT_GT(covered_, 100);
}

TEST_P(BadInput, TooFewMaterialsAreCounted) {
    auto* material = new SoMaterial;
    for (int i = 0; i < 7; ++i) material->diffuseColor.set1Value(i, 1.0f, 0.1f * float(i), 0.0f);
    auto* binding = new SoMaterialBinding;
    binding->value = SoMaterialBinding::PER_VERTEX;
    expectOneMessage(node(), {coordinates(16), material, binding}, {"material", "16", "7"});
    EXPECT_GT(covered_, 100);
}

TEST_P(BadInput, IsToldAgainOnceAFieldHasChanged) {
    Ref<SoSeparator> root(new SoSeparator);
    root->addChild(coordinates(15));
    auto* shape = node();
    root->addChild(shape);
    Messages messages;
    stage_.render(root.get());
    stage_.render(root.get());
    EXPECT_EQ(messages.all().size(), 1u);
    shape->verticesPerRow = 5;
    stage_.render(root.get());
    EXPECT_EQ(messages.all().size(), 2u);
    shape->verticesPerRow = 3;
    stage_.render(root.get());
    EXPECT_EQ(messages.all().size(), 2u) << messages.text();
}

TEST(BadRoamInput, NegativeCountsAreTold) {
    Ref<SoSeparator> root = sceneOf(Kind::Roam, surfaceOf(fractalMap(17, 17, 3.0)));
    auto* node = static_cast<SoROAMTerrain*>(terrainIn(root.get()));
    Stage stage;
    for (SoSFInt32* field : {&node->triangleCount, &node->operationCount})
        for (const int value : {-1, INT_MIN}) {
            Messages messages;
            *field = value;
            EXPECT_GT(coveredPixels(stage.render(root.get())), 100);
            stage.render(root.get());
            EXPECT_EQ(messages.all().size(), 1u) << messages.text();
            *field = 0;
        }
}

TEST(BadGeoMipmapInput, AnImpossibleTileSizeIsToldOnceAndTheNearestIsTaken) {
    const Surface surface = surfaceOf(fractalMap(300, 300, 3.0));
    Ref<SoSeparator> root = sceneOf(Kind::GeoMipmap, surface);
    auto* node = static_cast<SoGeoMipmapTerrain*>(terrainIn(root.get()));
    Stage stage;
    for (const auto& [wanted, taken] : {std::pair{0, 2}, {-7, 2}, {INT_MIN, 2}, {3, 4}, {24, 32}, {1000, 128}, {INT_MAX, 128}}) {
        node->tileSize = taken;
        stage.render(root.get());
        const std::uint32_t triangles = node->getStatistics().triangles;
        Messages messages;
        node->tileSize = wanted;
        stage.render(root.get());
        stage.render(root.get());
        ASSERT_EQ(messages.all().size(), 1u) << wanted << ": " << messages.text();
        EXPECT_NE(messages.text().find(std::to_string(wanted)), std::string::npos) << messages.text();
        EXPECT_EQ(node->getStatistics().triangles, triangles) << wanted;
    }
}

TEST(GeoMipmapTiles, OfEachSizeAreDrawnAtOnceWhenTheFieldChanges) {
    Ref<SoSeparator> root = sceneOf(Kind::GeoMipmap, surfaceOf(fractalMap(257, 257, 20.0)), {}, unlitTexture);
    auto* node = static_cast<SoGeoMipmapTerrain*>(terrainIn(root.get()));
    Stage stage;
    std::uint32_t before = 0;
    for (const int size : {4, 16, 64}) {
        node->tileSize = size;
        stage.render(root.get());
        EXPECT_NE(node->getStatistics().triangles, before);
        EXPECT_LE(node->getStatistics().errorPixels, 2.0);
        before = node->getStatistics().triangles;
    }
}

INSTANTIATE_TEST_SUITE_P(, BadInput, testing::ValuesIn(kOurKinds),
                         [](const auto& info) { return "On" + identifierOf(info.param); });
