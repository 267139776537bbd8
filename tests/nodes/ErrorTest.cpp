// pixelError is a promise: measured sample by sample against the full-resolution data.
#include "Scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <glm/geometric.hpp>

#include <Inventor/nodes/SoLightModel.h>
#include <Inventor/nodes/SoOrthographicCamera.h>
#include <Inventor/nodes/SoScale.h>

#include <SoTerrain/SoChunkedLoDTerrain.h>
#include <SoTerrain/SoGeoMipmapTerrain.h>
#include <SoTerrain/SoGeometryClipmapTerrain.h>
#include <SoTerrain/SoHeightMap.h>
#include <SoTerrain/SoROAMTerrain.h>

#include "lod/DebugColours.h"

using namespace test;

namespace {

constexpr int kSide = 257;

SbVec3d onScreen(const SbViewVolume& volume, const SbVec3f& point) {
    SbVec3f normalized;
    volume.projectToScreen(point, normalized);
    return SbVec3d(normalized[0], normalized[1], normalized[2]);
}

SbViewVolume volumeOf(SoCamera* camera) { return camera->getViewVolume(1.0f); }

/// A view straight down in which each pixel's centre is a sample, and depth is height.
SoCamera* above(float scale, float lowest, float highest) {
    auto* camera = new SoOrthographicCamera;
    camera->position = SbVec3f(0.5f * (kSide - 1), 0.5f * (kSide - 1), scale * highest + 2.0f);
    camera->orientation = SbRotation::identity();
    camera->height = float(kSide);
    camera->nearDistance = 1.0f;
    camera->farDistance = scale * (highest - lowest) + 3.0f;
    return camera;
}

struct Measured {
    double largest = 0.0;
    int samples = 0;
    int missing = 0;
};

/// Freezes the mesh, draws it from above, and takes the heights found there to the screen of the camera that it was chosen for.
Measured measure(Stage& stage, SoSeparator* root, const Surface& surface, float scale = 1.0f) {
    SoTerrainShape* node = terrainIn(root);
    Ref<SoCamera> camera(static_cast<SoCamera*>(root->getChild(0)));
    const SbBox3f box = surface.box();
    Ref<SoCamera> down(above(scale, box.getMin()[2], box.getMax()[2]));
    node->freeze = TRUE;
    root->replaceChild(0, down.get());
    stage.clear();
    stage.draw(root);
    const std::vector<float> depth = stage.depth();
    root->replaceChild(0, camera.get());
    node->freeze = FALSE;

    const SbViewVolume volume = volumeOf(camera.get());
    Measured measured;
    for (int row = 1; row < surface.rows - 1; ++row)
        for (int column = 1; column < surface.columns - 1; ++column) {
            if (surface.isHole(column, row)) continue;
            const SbVec3f& p = surface.at(column, row);
            const SbVec3d there = onScreen(volume, SbVec3f(p[0], p[1], scale * p[2]));
            if (there[0] < 0.0 || there[0] > 1.0 || there[1] < 0.0 || there[1] > 1.0 || there[2] < 0.0 || there[2] > 1.0) continue;
            const float d = depth[std::size_t(row) * kSide + std::size_t(column)];
            if (d >= 1.0f) {
                ++measured.missing;
                continue;
            }
            const float height = down->position.getValue()[2] - (1.0f + d * (down->farDistance.getValue() - 1.0f));
            const SbVec3d drawn = onScreen(volume, SbVec3f(p[0], p[1], height));
            measured.largest = std::max(measured.largest, std::hypot(there[0] - drawn[0], there[1] - drawn[1]) * kSide);
            ++measured.samples;
        }
    return measured;
}

SoCamera* flight(int frame) {
    const float angle = 0.35f * float(frame);
    const SbVec3f eye(128.0f + 80.0f * std::cos(angle), 128.0f + 80.0f * std::sin(angle), 62.0f);
    return cameraAt(eye, SbVec3f(128.0f, 128.0f, 20.0f), 0.5f, 500.0f);
}

void expectPromise(Stage& stage, const Ref<SoSeparator>& root, const Surface& surface, double pixelError, float scale = 1.0f) {
    stage.render(root.get());
    const SoTerrainStatistics statistics = terrainIn(root.get())->getStatistics();
    const Measured measured = measure(stage, root.get(), surface, scale);
    EXPECT_LE(measured.largest, pixelError + 0.1);
    EXPECT_LE(measured.largest, statistics.errorPixels + 0.1) << "the bound that the node tells";
    EXPECT_LE(statistics.errorPixels, pixelError);
    EXPECT_EQ(measured.missing, 0);
    EXPECT_GT(measured.samples, 1000);
}

}  // namespace

TEST(PixelError, HoldsForEverySampleInViewOverAFlight) {
    const Surface surface = surfaceOf(fractalMap(kSide, kSide, 60.0));
    Stage stage(kSide, kSide);
    for (const bool morphs : {true, false})
        for (const auto& [kind, pixels] : {std::pair{Kind::Roam, 1.0f}, {Kind::Roam, 2.0f}, {Kind::Roam, 6.0f}, {Kind::GeoMipmap, 1.0f}, {Kind::GeoMipmap, 6.0f},
                                           {Kind::ChunkedLod, 1.0f}, {Kind::ChunkedLod, 2.0f}, {Kind::ChunkedLod, 6.0f}}) {
            const auto root = sceneOf(kind, surface, {.pixelError = pixels}, unlitTexture, flight(0));
            if (auto* roam = dynamic_cast<SoROAMTerrain*>(terrainIn(root.get()))) {
                roam->geomorph = morphs;
                roam->operationCount = 0;
            }
            if (auto* chunkedLod = dynamic_cast<SoChunkedLoDTerrain*>(terrainIn(root.get()))) chunkedLod->morphing = morphs;
            if (auto* geoMipmap = dynamic_cast<SoGeoMipmapTerrain*>(terrainIn(root.get()))) geoMipmap->morphing = morphs;
            for (int frame = 0; frame < 8; ++frame) {
                SCOPED_TRACE(std::string(nameOf(kind)) + ", pixelError " + std::to_string(pixels) + ", morphs " + std::to_string(morphs) + ", frame " + std::to_string(frame));
                root->replaceChild(0, flight(frame));
                expectPromise(stage, root, surface, pixels);
            }
        }
}

TEST(PixelError, IsUsedNotUndercutByFar) {
    // A mesh that is much finer than asked for keeps any promise.
    const Surface surface = surfaceOf(fractalMap(kSide, kSide, 60.0));
    Stage stage(kSide, kSide);
    for (const Kind kind : kLodKinds) {
        const auto root = sceneOf(kind, surface, {.pixelError = 4.0f}, unlitTexture, flight(1));
        stage.render(root.get());
        // Clipmaps come in sizes of which each is twice the last.
        EXPECT_GT(measure(stage, root.get(), surface).largest, kind == Kind::Clipmap ? 0.5 : 1.0) << nameOf(kind);
    }
}

TEST(PixelError, HoldsUnderAnOrthographicCamera) {
    const Surface surface = surfaceOf(fractalMap(kSide, kSide, 60.0));
    Stage stage(kSide, kSide);
    for (const auto& [kind, slant] : {std::pair{Kind::Roam, 0.2f}, {Kind::Roam, 1.0f}, {Kind::Roam, 5.0f}, {Kind::GeoMipmap, 0.2f}, {Kind::GeoMipmap, 5.0f}, {Kind::ChunkedLod, 0.2f}, {Kind::ChunkedLod, 5.0f}}) {
        auto* camera = new SoOrthographicCamera;
        const SbVec3f centre(128.0f, 128.0f, 20.0f);
        camera->position = centre + SbVec3f(60.0f, -100.0f, 100.0f * slant);
        camera->pointAt(centre, SbVec3f(0.0f, 0.0f, 1.0f));
        camera->height = 150.0f;
        camera->nearDistance = 1.0f;
        camera->farDistance = 1000.0f;
        expectPromise(stage, sceneOf(kind, surface, {}, unlitTexture, camera), surface, 2.0);
    }
}

TEST(PixelError, HoldsUnderAScale) {
    const Surface surface = surfaceOf(fractalMap(kSide, kSide, 60.0));
    Stage stage(kSide, kSide);
    for (const auto& [kind, scale] : {std::pair{Kind::Roam, 0.25f}, {Kind::Roam, 2.0f}, {Kind::GeoMipmap, 0.25f}, {Kind::GeoMipmap, 2.0f}, {Kind::ChunkedLod, 0.25f}, {Kind::ChunkedLod, 2.0f}}) {
        const auto root = sceneOf(kind, surface, {}, [&, scale = scale](SoSeparator* group) {
            unlitTexture(group);
            auto* node = new SoScale;
            node->scaleFactor = SbVec3f(1.0f, 1.0f, scale);
            group->addChild(node);
        }, cameraAt(SbVec3f(200.0f, 60.0f, 60.0f * scale + 10.0f), SbVec3f(128.0f, 128.0f, 20.0f * scale), 0.5f, 500.0f));
        expectPromise(stage, root, surface, 2.0, scale);
    }
}

TEST(PixelError, HoldsWithHolesAndOddSizes) {
    auto map = fractalMap(200, 139, 50.0);
    for (int row = 60; row < 80; ++row)
        for (int column = 90; column < 130; ++column) map.heights[std::size_t(row * 200 + column)] = std::numeric_limits<float>::quiet_NaN();
    const Surface surface = surfaceOf(map);
    Stage stage(kSide, kSide);
    // Samples at the rim of the hole may be covered by the hole's own cells.
    Surface apart = surface;
    for (int row = 58; row < 82; ++row)
        for (int column = 88; column < 132; ++column) apart.points[apart.index(column, row)][2] = std::numeric_limits<float>::quiet_NaN();
    for (const Kind kind : kLodKinds) {
        const auto root = sceneOf(kind, surface, {}, unlitTexture, cameraAt(SbVec3f(-20.0f, 20.0f, 70.0f), SbVec3f(100.0f, 70.0f, 20.0f), 0.5f, 500.0f));
        stage.render(root.get());
        const Measured measured = measure(stage, root.get(), apart);
        EXPECT_LE(measured.largest, 2.1) << nameOf(kind);
        EXPECT_EQ(measured.missing, 0) << nameOf(kind);
        EXPECT_GT(measured.samples, 1000) << nameOf(kind);
    }
}

TEST(PixelError, ThatABudgetPreventsIsToldAsItIs) {
    const Surface surface = surfaceOf(fractalMap(kSide, kSide, 60.0));
    Stage stage(kSide, kSide);
    const auto root = sceneOf(Kind::Roam, surface, {.pixelError = 0.5f}, unlitTexture, flight(0));
    static_cast<SoROAMTerrain*>(terrainIn(root.get()))->triangleCount = 500;
    stage.render(root.get());
    const double told = terrainIn(root.get())->getStatistics().errorPixels;
    const Measured measured = measure(stage, root.get(), surface);
    EXPECT_GT(told, 0.5);
    EXPECT_LE(measured.largest, told + 0.1);
}

/// Also where the clipmap's size is fixed and its bound only told.
TEST(PixelError, HoldsAfterEdits) {
    const struct {
        int column, row, size;
        float height;
    } brushes[] = {{90, 90, 33, 25.0f}, {128, 128, 17, -30.0f}, {100, 60, 65, 18.0f}, {60, 128, 5, 12.0f}, {90, 90, 33, -25.0f}};
    const terrain::HeightMap heights = fractalMap(kSide, kSide, 60.0);
    Stage stage(kSide, kSide);
    for (const Kind kind : kLodKinds) {
        const Ref<SoSeparator> root(new SoSeparator);
        root->addChild(flight(0));
        unlitTexture(root.get());
        auto* map = new SoHeightMap;
        root->addChild(map);
        SoTerrainShape* node = nodeOf(kind, 0, 0, 2.0f);
        root->addChild(node);
        ASSERT_TRUE(map->setHeights(kSide, kSide, heights.heights.data()));
        if (auto* tiles = dynamic_cast<SoChunkedLoDTerrain*>(node)) tiles->background = FALSE;
        if (auto* clipmap = dynamic_cast<SoGeometryClipmapTerrain*>(node)) clipmap->clipmapSize = 63;
        stage.render(root.get());
        for (int i = 0; i < int(std::size(brushes)); ++i) {
            SCOPED_TRACE(std::string(nameOf(kind)) + ", edit " + std::to_string(i));
            const auto& brush = brushes[i];
            std::vector<float> edit(std::size_t(brush.size * brush.size));
            ASSERT_TRUE(map->getHeights(brush.column, brush.row, brush.size, brush.size, edit.data()));
            for (int j = 0; j < brush.size * brush.size; ++j)
                edit[std::size_t(j)] += brush.height * std::sin(0.4f * float(j % brush.size)) * std::sin(0.3f * float(j / brush.size));
            ASSERT_TRUE(map->setHeights(brush.column, brush.row, brush.size, brush.size, edit.data()));
            root->replaceChild(0, flight(i));
            for (int frame = 0; frame < 50; ++frame) {
                stage.render(root.get());
                if (node->getStatistics().converged) break;
            }
            const double told = node->getStatistics().errorPixels;
            terrain::HeightMap now = heights;
            ASSERT_TRUE(map->getHeights(0, 0, kSide, kSide, now.heights.data()));
            const Measured measured = measure(stage, root.get(), surfaceOf(now));
            EXPECT_LE(measured.largest, told + 0.1);
            EXPECT_EQ(measured.missing, 0);
            EXPECT_GT(measured.samples, 1000);
            if (kind != Kind::Clipmap) {
                EXPECT_LE(told, 2.0);
            }
            std::printf("%s, edit %d: %.2f of %.2f pixels\n", nameOf(kind), i, measured.largest, told);
        }
    }
}

/// The heat map of debugView ERRORS against the depth method: nothing is shown that is more than what is measured, and what is in sight is shown.
TEST(PixelError, IsWhatTheHeatMapShows) {
    const Surface surface = surfaceOf(fractalMap(kSide, kSide, 60.0));
    Stage stage(kSide, kSide);
    for (const Kind kind : kLodKinds)
        for (const float pixels : {1.0f, 4.0f}) {
            SCOPED_TRACE(std::string(nameOf(kind)) + ", pixelError " + std::to_string(pixels));
            // From so high up that no hill hides another.
            const auto root = sceneOf(kind, surface, {.pixelError = pixels}, [](SoSeparator* group) {
                auto* model = new SoLightModel;
                model->model = SoLightModel::BASE_COLOR;
                group->addChild(model);
            }, cameraAt(SbVec3f(128.0f, -10.0f, 190.0f), SbVec3f(128.0f, 100.0f, 20.0f), 1.0f, 600.0f));
            SoTerrainShape* node = terrainIn(root.get());
            stage.render(root.get());
            const Measured measured = measure(stage, root.get(), surface);
            node->debugView = SoTerrainShape::ERRORS;
            const terrain::Image picture = stage.render(root.get());
            const std::vector<float> depth = stage.depth();
            const std::span<const terrain::Colour> ramp = terrain::errorRamp();
            double shown = 0.0;
            for (int y = 0; y < kSide; ++y)
                for (int x = 0; x < kSide; ++x) {
                    if (depth[std::size_t((kSide - 1 - y) * kSide + x)] == 1.0f) continue;
                    const std::uint8_t* p = &picture.pixels[std::size_t(y * kSide + x) * 3];
                    const terrain::Colour colour = terrain::Colour(p[0], p[1], p[2]) / 255.0f;
                    ASSERT_GT(glm::length(colour - terrain::kBrokenColour), 0.1f) << "magenta at " << x << ' ' << y;
                    for (std::size_t i = 0; i + 1 < ramp.size(); ++i) {
                        const terrain::Colour step = ramp[i + 1] - ramp[i];
                        const float at = std::clamp(glm::dot(colour - ramp[i], step) / glm::dot(step, step), 0.0f, 1.0f);
                        if (glm::length(colour - ramp[i] - step * at) < 0.01f) shown = std::max(shown, double(pixels) * (double(i) + double(at)) / double(ramp.size() - 1));
                    }
                }
            std::printf("%s: %.3f of %.0f pixels shown, %.3f measured\n", nameOf(kind), shown, pixels, measured.largest);
            EXPECT_LE(shown, measured.largest + 0.02 * pixels);
            EXPECT_GE(shown, 0.9 * measured.largest - 0.02 * pixels);
        }
}

TEST(PixelError, OfBruteForceIsNone) {
    const Surface surface = surfaceOf(fractalMap(kSide, kSide, 60.0));
    Stage stage(kSide, kSide);
    const auto root = sceneOf(Kind::BruteForce, surface, {}, unlitTexture, flight(0));
    stage.render(root.get());
    const Measured measured = measure(stage, root.get(), surface);
    EXPECT_LE(measured.largest, 0.1);
    EXPECT_EQ(measured.missing, 0);
}
