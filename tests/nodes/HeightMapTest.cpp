// SoHeightMap: fields, files, reading and writing scenes.
#include "Scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <Inventor/SoDB.h>
#include <Inventor/SoInput.h>
#include <Inventor/SoOutput.h>
#include <Inventor/actions/SoGetBoundingBoxAction.h>
#include <Inventor/actions/SoSearchAction.h>
#include <Inventor/actions/SoWriteAction.h>
#include <Inventor/nodes/SoSphere.h>

#include "HeightMapReading.h"

#include <SoTerrain/SoHeightMap.h>
#include <SoTerrain/SoROAMTerrain.h>

using namespace test;

namespace {

void writeBytes(const std::string& path, const std::vector<std::uint8_t>& bytes) {
    std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
}

/// A raw file of bytes whose rows, from north to south, hold 10 * row + column.
std::string numbered(const TemporaryFolder& folder, int columns, int rows, const std::string& name = "map.raw") {
    std::vector<std::uint8_t> bytes;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) bytes.push_back(std::uint8_t(10 * row + column));
    writeBytes(folder.file(name), bytes);
    return folder.file(name);
}

SbBox3f boxOf(SoNode* root) {
    SoGetBoundingBoxAction action(SbViewportRegion(320, 240));
    action.apply(root);
    return action.getBoundingBox();
}

void expectBox(const SbBox3f& box, const SbVec3f& low, const SbVec3f& high) {
    EXPECT_TRUE(box.getMin().equals(low, 1e-4f)) << box.getMin().toString().getString() << " not " << low.toString().getString();
    EXPECT_TRUE(box.getMax().equals(high, 1e-4f)) << box.getMax().toString().getString() << " not " << high.toString().getString();
}

struct MapScene {
    Ref<SoSeparator> root{new SoSeparator};
    SoHeightMap* map = new SoHeightMap;
    SoTerrainShape* terrain;

    explicit MapScene(const std::string& file, Kind kind = Kind::Roam) : terrain(nodeOf(kind, 0, 0)) {
        map->filename = file.c_str();
        root->addChild(map);
        root->addChild(terrain);
    }
    float heightAt(float x, float y) const {
        float height = std::nanf("");
        terrain->heightAt(x, y, height);
        return height;
    }
};

Ref<SoSeparator> read(const std::string& text) {
    SoInput input;
    input.setBuffer(const_cast<char*>(text.data()), text.size());
    return Ref<SoSeparator>(SoDB::readAll(&input));
}

void* reallocate(void* pointer, std::size_t size) {
    return std::realloc(pointer, size);
}

std::string write(SoNode* root, bool binary = false) {
    SoOutput output;
    output.setBinary(binary);
    output.setBuffer(std::malloc(1024), 1024, reallocate);
    SoWriteAction action(&output);
    action.apply(root);
    void* buffer = nullptr;
    std::size_t size = 0;
    output.getBuffer(buffer, size);
    const std::string text(static_cast<char*>(buffer), size);
    std::free(buffer);
    return text;
}

constexpr const char* kScene = R"(#Inventor V2.1 ascii
Separator {
  DEF map SoHeightMap {
    filename "somewhere/terrain.raw" spacing 10 20 heightScale 0.25 heightOffset -3 origin 100 200
    channel 2 rawSize 640 480 rawType UINT16_BIG_ENDIAN noData -9999
  }
  DEF ground SoROAMTerrain {
    verticesPerRow 30 verticesPerColumn 20 startIndex 5 pixelError 3.5 frustumCulling FALSE freeze TRUE
    triangleCount 1234 geomorph FALSE operationCount 77
    alternateRep DEF stand Sphere { radius 7 }
  }
  Separator { USE map USE ground }
  SoBruteForceTerrain { verticesPerRow 9 alternateRep USE stand }
}
)";

template <class T>
T* find(SoNode* root) {
    SoSearchAction search;
    search.setType(T::getClassTypeId(), FALSE);
    search.setSearchingAll(TRUE);
    search.apply(root);
    return search.getPath() ? static_cast<T*>(static_cast<SoFullPath*>(search.getPath())->getTail()) : nullptr;
}

}  // namespace

TEST(HeightMapFields, PlaceTheSamples) {
    const TemporaryFolder folder;
    MapScene scene(numbered(folder, 5, 5));
    expectBox(boxOf(scene.root.get()), {0, 0, 0}, {4, 4, 44});
    scene.map->spacing = SbVec2f(2.0f, 3.0f);
    expectBox(boxOf(scene.root.get()), {0, 0, 0}, {8, 12, 44});
    scene.map->origin = SbVec2f(-10.0f, 5.0f);
    expectBox(boxOf(scene.root.get()), {-10, 5, 0}, {-2, 17, 44});
    scene.map->heightScale = 0.5f;
    expectBox(boxOf(scene.root.get()), {-10, 5, 0}, {-2, 17, 22});
    scene.map->heightOffset = 100.0f;
    expectBox(boxOf(scene.root.get()), {-10, 5, 100}, {-2, 17, 122});
}

TEST(HeightMapFields, TopRowOfTheFileLiesAtTheLargestY) {
    const TemporaryFolder folder;
    const MapScene scene(numbered(folder, 5, 5));
    EXPECT_EQ(scene.heightAt(0, 4), 0.0f);
    EXPECT_EQ(scene.heightAt(4, 4), 4.0f);
    EXPECT_EQ(scene.heightAt(0, 0), 40.0f);
}

TEST(HeightMapFields, NameAnotherFileAtAnyTime) {
    const TemporaryFolder folder;
    MapScene scene(numbered(folder, 5, 5));
    Stage stage;
    scene.root->insertChild(cameraAt({2, -8, 60}, {2, 2, 20}, 1, 200), 0);
    const auto before = stage.render(scene.root.get());
    scene.map->filename = numbered(folder, 9, 9, "other.raw").c_str();
    expectBox(boxOf(scene.root.get()), {0, 0, 0}, {8, 8, 88});
    EXPECT_NE(stage.render(scene.root.get()).pixels, before.pixels);
    scene.map->filename = "";
    Messages messages;
    EXPECT_EQ(coveredPixels(stage.render(scene.root.get())), 0);
}

TEST(HeightMapFields, OfRawFilesSayHowToReadThem) {
    const TemporaryFolder folder;
    MapScene scene(numbered(folder, 8, 2));
    scene.map->rawSize = SbVec2i32(8, 2);
    expectBox(boxOf(scene.root.get()), {0, 0, 0}, {7, 1, 17});
    scene.map->rawSize = SbVec2i32(4, 2);
    scene.map->rawType = SoHeightMap::UINT16_BIG_ENDIAN;
    EXPECT_EQ(scene.heightAt(0, 1), 1.0f);
    EXPECT_EQ(scene.heightAt(3, 0), 16.0f * 256 + 17);
    scene.map->rawType = SoHeightMap::UINT16_LITTLE_ENDIAN;
    EXPECT_EQ(scene.heightAt(3, 0), 17.0f * 256 + 16);
}

TEST(HeightMapFields, NoDataMakesHoles) {
    const TemporaryFolder folder;
    MapScene scene(numbered(folder, 9, 9));
    scene.map->noData = 44.0f;
    scene.map->heightScale = 0.05f;
    EXPECT_TRUE(std::isnan(scene.heightAt(4.2f, 4.2f)));
    EXPECT_FALSE(std::isnan(scene.heightAt(5.5f, 5.5f)));
    scene.root->insertChild(cameraAt({4, -4, 12}, {4, 4, 2}, 1, 300), 0);
    Stage stage;
    const auto holed = stage.render(scene.root.get());
    scene.map->noData = 200.0f;
    const auto whole = stage.render(scene.root.get());
    savePicture("no_data", {holed, whole});
    EXPECT_GT(compare(whole, holed).onlyFirst, 20);
}

TEST(HeightMapFields, WithAPartOfTheMapDrawThatPart) {
    const TemporaryFolder folder;
    MapScene scene(numbered(folder, 9, 9));
    scene.terrain->startIndex = 2 * 9 + 3;
    scene.terrain->verticesPerRow = 4;
    scene.terrain->verticesPerColumn = 5;
    expectBox(boxOf(scene.root.get()), {3, 2, 23}, {6, 6, 66});
}

TEST(HeightMaps, LookLikeTheirSamples) {
    const TemporaryFolder folder;
    const auto map =
        mapOf(129, 97, [](double x, double y) { return std::floor(40.0 + 30.0 * std::sin(7.0 * x) * std::cos(5.0 * y)); });
    std::vector<std::uint8_t> bytes;
    for (int row = 96; row >= 0; --row)
        for (int column = 0; column < 129; ++column) bytes.push_back(std::uint8_t(map.at(column, row)));
    writeBytes(folder.file("map.raw"), bytes);
    const Surface surface = surfaceOf(map);
    Stage stage;
    const auto reference = stage.render(sceneOf(Kind::Reference, surface, {}, unlitTexture).get());
    for (const Kind kind : kOurKinds) {
        const auto root = sceneOf(kind, surface, {.pixelError = 0.5f}, unlitTexture);
        auto* group = static_cast<SoSeparator*>(static_cast<SoSeparator*>(root->getChild(2))->getChild(4));
        group->removeAllChildren();
        MapScene source(folder.file("map.raw"), kind);
        source.map->rawSize = SbVec2i32(129, 97);
        group->addChild(source.map);
        group->addChild(source.terrain);
        const auto picture = stage.render(root.get());
        expectAlike(reference, picture, 2.0, nameOf(kind));
        savePicture("height_map_" + identifierOf(kind), {reference, picture});
    }
}

TEST(HeightMaps, OfRelativeNameAreFoundBesideTheSceneFile) {
    const TemporaryFolder folder;
    numbered(folder, 5, 5);
    std::ofstream(folder.file("scene.iv"))
        << "#Inventor V2.1 ascii\nSeparator { SoHeightMap { filename \"map.raw\" } SoROAMTerrain {} }\n";
    SoInput input;
    ASSERT_TRUE(input.openFile(folder.file("scene.iv").c_str()));
    const Ref<SoSeparator> root(SoDB::readAll(&input));
    ASSERT_NE(root.get(), nullptr);
    input.closeFile();
    expectBox(boxOf(root.get()), {0, 0, 0}, {4, 4, 44});
}

TEST(HeightMaps, ThatBreakKeepTheLastGoodHeights) {
    const TemporaryFolder folder;
    MapScene scene(numbered(folder, 5, 5));
    expectBox(boxOf(scene.root.get()), {0, 0, 0}, {4, 4, 44});
    Messages messages;
    scene.map->filename = folder.file("nothing.raw").c_str();
    expectBox(boxOf(scene.root.get()), {0, 0, 0}, {4, 4, 44});
    expectBox(boxOf(scene.root.get()), {0, 0, 0}, {4, 4, 44});
    EXPECT_EQ(messages.all().size(), 1u) << messages.text();
    EXPECT_NE(messages.text().find("nothing.raw"), std::string::npos);
}

TEST(SceneFiles, SurviveReadingWritingAndReading) {
    for (const bool binary : {false, true}) {
        const Ref<SoSeparator> first = read(kScene);
        ASSERT_NE(first.get(), nullptr);
        const std::string written = write(first.get(), binary);
        const Ref<SoSeparator> second = read(written);
        ASSERT_NE(second.get(), nullptr) << written;
        for (const auto& root : {first, second}) {
            const auto* map = find<SoHeightMap>(root.get());
            const auto* ground = find<SoROAMTerrain>(root.get());
            ASSERT_TRUE(map && ground);
            EXPECT_EQ(map->filename.getValue(), SbString("somewhere/terrain.raw"));
            EXPECT_EQ(map->spacing.getValue(), SbVec2f(10, 20));
            EXPECT_EQ(map->heightScale.getValue(), 0.25f);
            EXPECT_EQ(map->heightOffset.getValue(), -3.0f);
            EXPECT_EQ(map->origin.getValue(), SbVec2f(100, 200));
            EXPECT_EQ(map->channel.getValue(), 2);
            EXPECT_EQ(map->rawSize.getValue(), SbVec2i32(640, 480));
            EXPECT_EQ(map->rawType.getValue(), int(SoHeightMap::UINT16_BIG_ENDIAN));
            EXPECT_EQ(map->noData.getValue(), -9999.0f);
            EXPECT_EQ(ground->verticesPerRow.getValue(), 30);
            EXPECT_EQ(ground->verticesPerColumn.getValue(), 20);
            EXPECT_EQ(ground->startIndex.getValue(), 5);
            EXPECT_EQ(ground->pixelError.getValue(), 3.5f);
            EXPECT_FALSE(ground->frustumCulling.getValue());
            EXPECT_TRUE(ground->freeze.getValue());
            EXPECT_EQ(ground->triangleCount.getValue(), 1234);
            EXPECT_FALSE(ground->geomorph.getValue());
            EXPECT_EQ(ground->operationCount.getValue(), 77);
            const auto* stand = static_cast<const SoSphere*>(ground->alternateRep.getValue());
            ASSERT_TRUE(stand && stand->isOfType(SoSphere::getClassTypeId()));
            EXPECT_EQ(stand->radius.getValue(), 7.0f);
            const auto* inner = static_cast<const SoSeparator*>(root->getChild(2));
            EXPECT_EQ(inner->getChild(0), root->getChild(0)) << "USE map";
            EXPECT_EQ(inner->getChild(1), root->getChild(1)) << "USE ground";
            EXPECT_EQ(static_cast<const SoTerrainShape*>(root->getChild(3))->alternateRep.getValue(), stand) << "USE stand";
        }
        // Coin's binary format writes fields that are default, with a flag that reading them clears.
        if (!binary) {
            EXPECT_EQ(write(second.get()), written);
        }
    }
}

TEST(SceneFiles, WithNoDataSetToNotANumberAreReadAgain) {
    Ref<SoSeparator> root(new SoSeparator);
    auto* map = new SoHeightMap;
    map->noData = std::nanf("");
    root->addChild(map);
    Messages messages;
    const Ref<SoSeparator> again = read(write(root.get()));
    EXPECT_TRUE(messages.all().empty()) << messages.text();
    ASSERT_NE(again.get(), nullptr);
    ASSERT_NE(find<SoHeightMap>(again.get()), nullptr);
    EXPECT_TRUE(std::isnan(find<SoHeightMap>(again.get())->noData.getValue()));
}

TEST(SceneFiles, CopiedNodesKeepTheirFields) {
    const Ref<SoSeparator> first = read(kScene);
    const Ref<SoSeparator> copy(static_cast<SoSeparator*>(first->copy()));
    EXPECT_EQ(find<SoHeightMap>(copy.get())->filename.getValue(), SbString("somewhere/terrain.raw"));
    EXPECT_EQ(find<SoROAMTerrain>(copy.get())->triangleCount.getValue(), 1234);
}

// A file that is gone can't be read a second time.
TEST(HeightMap, WhatWasReadAlreadyTakesThePlaceOfTheFile) {
    const TemporaryFolder folder;
    const std::string file = numbered(folder, 9, 7);
    const MapScene expected(file);
    expected.map->heightScale = 0.3f;
    expected.map->heightOffset = -4.0f;
    expected.map->rawSize.setValue(9, 7);
    const MapScene scene(file);
    scene.map->rawSize.setValue(9, 7);
    scene.map->heightScale = 0.3f;
    scene.map->heightOffset = -4.0f;
    const HeightMapReading::File named = HeightMapReading::file(scene.map);
    EXPECT_EQ(named.path, file);
    auto source = terrain::openHeightFile(named.path, named.options);
    ASSERT_TRUE(source) << source.error().message();
    std::vector<float> wanted(63), found(63);
    ASSERT_TRUE(expected.map->getHeights(0, 0, 9, 7, wanted.data()));
    std::filesystem::remove(file);
    HeightMapReading::give(scene.map, std::move(source).value());
    ASSERT_TRUE(scene.map->isLoaded());
    ASSERT_TRUE(scene.map->getHeights(0, 0, 9, 7, found.data()));
    EXPECT_EQ(found, wanted) << "bit for bit as the file gives them";
    // Only once: the file may have changed after that.
    const Messages messages;
    scene.map->touch();
    EXPECT_FALSE(scene.map->isLoaded());
    EXPECT_EQ(messages.all().size(), 1u) << messages.text();
}
