// A map of 4097 x 4097 samples: the full-resolution picture is brute force's, which smaller maps compare with Coin's own shape.
#include "Scenes.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <thread>

#include <SoTerrain/SoChunkedLoDTerrain.h>
#include <SoTerrain/SoHeightMap.h>

using namespace test;

namespace {

constexpr int kSide = 4097;

/// 16-bit heights of a fractal, tiled from a smaller one with slopes that differ from tile to tile.
void writeMap(const std::string& path) {
    constexpr int kTile = 1024;
    const auto tile = fractalMap(kTile + 1, kTile + 1, 20000.0);
    std::vector<std::uint8_t> row(std::size_t(kSide) * 2);
    std::ofstream file(path, std::ios::binary);
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            // Mirrored from tile to tile, so that no step stands at their borders.
            const auto fold = [](int i) { return (i / kTile) % 2 ? kTile - i % kTile : i % kTile; };
            const auto sample = std::uint16_t(tile.at(fold(x), fold(y)) + 3.0f * float(x) + 2.0f * float(y));
            row[std::size_t(x) * 2] = std::uint8_t(sample & 255);
            row[std::size_t(x) * 2 + 1] = std::uint8_t(sample >> 8);
        }
        file.write(reinterpret_cast<const char*>(row.data()), std::streamsize(row.size()));
    }
}

Ref<SoSeparator> largeScene(Kind kind, SoHeightMap* map) {
    Ref<SoSeparator> root(new SoSeparator);
    root->addChild(cameraAt({-300.0f, -600.0f, 1500.0f}, {2000.0f, 2000.0f, 200.0f}, 50.0f, 9000.0f));
    auto* group = new SoSeparator;
    unlitTexture(group);
    group->addChild(map);
    group->addChild(nodeOf(kind, 0, 0));
    root->addChild(group);
    return root;
}

}  // namespace

TEST(LargeMaps, OfSixteenMillionSamplesLookLikeTheyAre) {
    const TemporaryFolder folder;
    writeMap(folder.file("large.raw"));
    Ref<SoHeightMap> map(new SoHeightMap);
    map->filename = folder.file("large.raw").c_str();
    map->rawType = SoHeightMap::UINT16_LITTLE_ENDIAN;
    map->heightScale = 0.03f;
    Stage stage;
    const auto draw = [&](Kind kind) {
        const auto root = largeScene(kind, map.get());
        const auto picture = stage.render(root.get());
        const SoTerrainStatistics statistics = terrainIn(root.get())->getStatistics();
        std::printf("%s: %u triangles, built in %.0f ms, %zu MiB, buffers %zu MiB\n", nameOf(kind), statistics.triangles, statistics.buildMilliseconds,
                    statistics.memoryBytes >> 20, statistics.bufferBytes >> 20);
        return picture;
    };
    const auto roam = draw(Kind::Roam), geoMipmap = draw(Kind::GeoMipmap), chunkedLod = draw(Kind::ChunkedLod), bruteForce = draw(Kind::BruteForce);
    savePicture("size_4097x4097", {bruteForce, roam, geoMipmap, chunkedLod});
    expectAlike(bruteForce, roam, 3.0, "ROAM");
    expectAlike(bruteForce, geoMipmap, 3.0, "Geo Mip-Mapping");
    expectAlike(bruteForce, chunkedLod, 3.0, "Chunked LoD");
}

TEST(LargeMaps, StreamInWithinTheirBudgets) {
    const TemporaryFolder folder;
    writeMap(folder.file("large.raw"));
    Ref<SoHeightMap> map(new SoHeightMap);
    map->filename = folder.file("large.raw").c_str();
    map->rawType = SoHeightMap::UINT16_LITTLE_ENDIAN;
    map->heightScale = 0.03f;
    const auto root = largeScene(Kind::ChunkedLod, map.get());
    auto* node = static_cast<SoChunkedLoDTerrain*>(terrainIn(root.get()));
    node->background = TRUE;
    node->memoryBudget = 8;
    node->uploadBudget = 128;
    Stage stage;
    stage.render(root.get());
    // What is held beside tiles: bounds of the map, and vertices and indices of what is drawn.
    const std::size_t bounds = std::size_t(4097) * 4097 / 5;
    std::uint32_t patches = 0;
    int frames = 0;
    for (; !node->getStatistics().converged; ++frames) {
        ASSERT_LT(frames, 20000) << "never complete";
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        const std::size_t buffers = node->getStatistics().bufferBytes;
        EXPECT_GT(coveredPixels(stage.render(root.get())), 10000);
        const SoTerrainStatistics statistics = node->getStatistics();
        ASSERT_LE(statistics.newVertexBytes, std::size_t(128) << 10) << "frame " << frames;
        ASSERT_LE(statistics.memoryBytes, (std::size_t(8) << 20) + bounds + 3 * std::max(buffers, statistics.bufferBytes) + (1u << 20)) << "frame " << frames;
        patches = std::max(patches, statistics.patches);
    }
    std::printf("complete after %d frames, %u tiles\n", frames, patches);
    EXPECT_GT(frames, 10);
    EXPECT_LE(node->getStatistics().errorPixels, 2.0);
}
