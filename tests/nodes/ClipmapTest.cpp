// Geometry clipmaps as a node: GPU and CPU draw the same, whatever is stored, and what is new is all that is sent.
#include "Scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <Inventor/actions/SoSearchAction.h>
#include <Inventor/nodes/SoCoordinate3.h>
#include <Inventor/nodes/SoFragmentShader.h>
#include <Inventor/nodes/SoMaterial.h>
#include <Inventor/nodes/SoMaterialBinding.h>
#include <Inventor/nodes/SoOrthographicCamera.h>
#include <Inventor/nodes/SoShaderProgram.h>
#include <Inventor/nodes/SoTexture2.h>

#include <SoTerrain/SoGeometryClipmapTerrain.h>

using namespace test;
using terrain::Image;

namespace {

constexpr int kSide = 257;

SoGeometryClipmapTerrain* clipmapIn(const Ref<SoSeparator>& root) {
    return static_cast<SoGeometryClipmapTerrain*>(terrainIn(root.get()));
}

Ref<SoSeparator> clipmapOver(const Surface& surface, int size, const Dressing& dress = unlitTexture, SoCamera* camera = nullptr) {
    Ref<SoSeparator> root = sceneOf(Kind::Clipmap, surface, {.pixelError = 0.0f, .normals = false}, dress, camera);
    clipmapIn(root)->clipmapSize = size;
    return root;
}

SoCamera* flight(int frame) {
    const float angle = 0.41f * float(frame);
    const SbVec3f eye(128.0f + 90.0f * std::cos(angle), 128.0f + 90.0f * std::sin(angle), 60.0f);
    return cameraAt(eye, SbVec3f(128.0f + 10.0f * float(frame % 3), 128.0f, 15.0f), 0.5f, 600.0f);
}

/// Heights that the frozen levels have at every sample, seen from above: NaN where nothing is drawn.
std::vector<double> heightsOf(Stage& stage, const Ref<SoSeparator>& root, const Surface& surface) {
    const SbBox3f box = surface.box();
    auto* down = new SoOrthographicCamera;
    down->position = SbVec3f(0.5f * (kSide - 1), 0.5f * (kSide - 1), box.getMax()[2] + 20.0f);
    down->orientation = SbRotation::identity();
    down->height = float(kSide);
    down->nearDistance = 1.0f;
    down->farDistance = box.getMax()[2] - box.getMin()[2] + 40.0f;
    const Ref<SoCamera> camera(static_cast<SoCamera*>(root->getChild(0))), above(down);
    clipmapIn(root)->freeze = TRUE;
    root->replaceChild(0, down);
    stage.clear();
    stage.draw(root.get());
    std::vector<double> heights;
    for (const float d : stage.depth())
        heights.push_back(d < 1.0f ? down->position.getValue()[2] - (1.0 + double(d) * (down->farDistance.getValue() - 1.0)) : std::nan(""));
    root->replaceChild(0, camera.get());
    clipmapIn(root)->freeze = FALSE;
    return heights;
}

}  // namespace

TEST(Clipmaps, AreTheSameOnTheGpuAndOnTheCpu) {
    const Surface surface = surfaceOf(fractalMap(kSide, kSide, 50.0));
    Stage stage(kSide, kSide);
    double largest = 0.0;
    int samples = 0;
    for (const auto& [size, detail] : {std::pair{31, 0}, {63, 0}, {31, 2}}) {
        const auto gpu = clipmapOver(surface, size), cpu = clipmapOver(surface, size);
        clipmapIn(gpu)->implementation = SoGeometryClipmapTerrain::GPU;
        clipmapIn(cpu)->implementation = SoGeometryClipmapTerrain::CPU;
        for (const auto& root : {gpu, cpu}) clipmapIn(root)->detailLevels = detail;
        for (int frame = 0; frame < 10; ++frame) {
            std::vector<std::vector<double>> heights;
            std::vector<Image> pictures;
            for (const auto& root : {gpu, cpu}) {
                root->replaceChild(0, flight(frame));
                pictures.push_back(stage.render(root.get()));
                heights.push_back(heightsOf(stage, root, surface));
            }
            EXPECT_EQ(clipmapIn(gpu)->getStatistics().errorPixels, clipmapIn(cpu)->getStatistics().errorPixels);
            EXPECT_EQ(clipmapIn(gpu)->getStatistics().levels, clipmapIn(cpu)->getStatistics().levels);
            expectAlike(pictures[0], pictures[1], 1.0, "frame " + std::to_string(frame));
            if (frame == 4) savePicture("clipmap_gpu_cpu_" + std::to_string(size) + "_" + std::to_string(detail), pictures);
            const SbViewVolume volume = static_cast<SoCamera*>(gpu->getChild(0))->getViewVolume(1.0f);
            for (int row = 1; row + 1 < kSide; ++row)
                for (int column = 1; column + 1 < kSide; ++column) {
                    const std::size_t at = std::size_t(row * kSide + column);
                    ASSERT_EQ(std::isnan(heights[0][at]), std::isnan(heights[1][at])) << column << ", " << row;
                    if (std::isnan(heights[0][at])) continue;
                    SbVec3f there[2];
                    for (std::size_t i = 0; i < 2; ++i)
                        volume.projectToScreen(SbVec3f(float(column), float(row), float(heights[i][at])), there[i]);
                    if (there[0][0] < 0.0f || there[0][0] > 1.0f || there[0][1] < 0.0f || there[0][1] > 1.0f || there[0][2] < 0.0f) continue;
                    largest = std::max(largest, double((there[0] - there[1]).length()) * kSide);
                    ++samples;
                }
        }
    }
    std::printf("largest difference %.4f px over %d samples\n", largest, samples);
    EXPECT_LE(largest, 0.1);
    EXPECT_GT(samples, 100000);
}

TEST(Clipmaps, LookTheSameWithoutStore) {
    const Surface surface = surfaceOf(fractalMap(kSide, kSide, 50.0));
    Stage stage;
    for (const int detail : {0, 3}) {
        const auto stored = clipmapOver(surface, 31, {}), made = clipmapOver(surface, 31, {});
        clipmapIn(made)->storage = SoGeometryClipmapTerrain::MEMORY_FREE;
        for (const auto& root : {stored, made}) clipmapIn(root)->detailLevels = detail;
        for (int frame = 0; frame < 4; ++frame) {
            std::vector<Image> pictures;
            for (const auto& root : {stored, made}) {
                root->replaceChild(0, flight(frame));
                pictures.push_back(stage.render(root.get()));
            }
            expectAlike(pictures[0], pictures[1], 0.1, "frame " + std::to_string(frame), 0);
        }
        EXPECT_LT(clipmapIn(made)->getStatistics().bufferBytes, clipmapIn(stored)->getStatistics().bufferBytes);
    }
}

TEST(Clipmaps, SendOnlyWhatIsNewInAtMostFourDraws) {
    const Surface surface = surfaceOf(fractalMap(kSide, kSide, 50.0));
    Stage stage;
    const auto root = clipmapOver(surface, 63);
    clipmapIn(root)->activeLevels = 16;
    root->replaceChild(0, cameraAt({60.0f, 100.0f, 60.0f}, {120.0f, 130.0f, 10.0f}, 0.5f, 600.0f));
    stage.render(root.get());
    const std::size_t whole = clipmapIn(root)->getStatistics().uploadedBytes;
    for (int frame = 1; frame < 40; ++frame) {
        const float x = 60.0f + 2.0f * float(frame);
        root->replaceChild(0, cameraAt({x, 100.0f, 60.0f}, {x + 60.0f, 130.0f, 10.0f}, 0.5f, 600.0f));
        stage.render(root.get());
        const SoTerrainStatistics statistics = clipmapIn(root)->getStatistics();
        EXPECT_LE(statistics.drawCalls, 4u);
        // Two columns of each of five levels at the most; of coarser ones not in every frame.
        EXPECT_GT(statistics.uploadedBytes, 0u);
        EXPECT_LE(statistics.uploadedBytes, std::size_t(63 * 8 * 2 * 5)) << "frame " << frame;
        stage.render(root.get());
        EXPECT_EQ(clipmapIn(root)->getStatistics().uploadedBytes, 0u) << "at rest";
    }
    EXPECT_GT(whole, std::size_t(63 * 8 * 2 * 5 * 4));
}

TEST(Clipmaps, TakeTheSmallestSizeThatKeepsPixelError) {
    const Surface surface = surfaceOf(fractalMap(kSide, kSide, 50.0));
    Stage stage;
    std::uint32_t before = std::numeric_limits<std::uint32_t>::max();
    for (const float pixels : {0.5f, 2.0f, 8.0f}) {
        const auto root = clipmapOver(surface, 0, unlitTexture, flight(2));
        clipmapIn(root)->pixelError = pixels;
        stage.render(root.get());
        const SoTerrainStatistics statistics = clipmapIn(root)->getStatistics();
        EXPECT_LE(statistics.errorPixels, pixels);
        EXPECT_LT(statistics.triangles, before) << pixels;
        before = statistics.triangles;
    }
}

TEST(Clipmaps, ArriveAtTheSamePictureHoweverSmallTheBudget) {
    const Surface surface = surfaceOf(fractalMap(kSide, kSide, 50.0));
    Stage stage;
    for (const auto implementation : {SoGeometryClipmapTerrain::GPU, SoGeometryClipmapTerrain::CPU}) {
        const auto all = clipmapOver(surface, 63), little = clipmapOver(surface, 63);
        for (const auto& root : {all, little}) {
            clipmapIn(root)->implementation = implementation;
            clipmapIn(root)->activeLevels = 16;
            root->replaceChild(0, flight(0));
            stage.render(root.get());
            EXPECT_TRUE(clipmapIn(root)->getStatistics().converged) << "the first frame is complete";
        }
        clipmapIn(little)->updateBudget = 700;
        stage.render(little.get());
        for (const auto& root : {all, little}) root->replaceChild(0, flight(5));
        Image complete = stage.render(all.get());
        for (int i = 0; !clipmapIn(all)->getStatistics().converged && i < 20; ++i) complete = stage.render(all.get());
        Image picture = stage.render(little.get());
        EXPECT_FALSE(clipmapIn(little)->getStatistics().converged);
        int frames = 0;
        for (; !clipmapIn(little)->getStatistics().converged && frames < 200; ++frames) picture = stage.render(little.get());
        EXPECT_GT(frames, 4);
        EXPECT_TRUE(clipmapIn(little)->getStatistics().converged);
        expectAlike(complete, picture, 0.05, "after " + std::to_string(frames) + " frames", 0);
    }
}

TEST(Clipmaps, DrawEightLevelsOfTheLargestSize) {
    // 1025 samples a side with five levels of detail: 32769 vertices.
    const Surface surface = surfaceOf(fractalMap(1025, 1025, 200.0));
    Stage stage;
    const auto reference = sceneOf(Kind::BruteForce, surface, {.normals = false}, unlitTexture);
    const Image expected = stage.render(reference.get());
    const auto root = clipmapOver(surface, 1023);
    clipmapIn(root)->detailLevels = 5;
    clipmapIn(root)->detailAmplitude = -1.0f;
    clipmapIn(root)->activeLevels = 8;
    clipmapIn(root)->implementation = SoGeometryClipmapTerrain::GPU;
    const Image picture = stage.render(root.get());
    const SoTerrainStatistics statistics = clipmapIn(root)->getStatistics();
    EXPECT_EQ(statistics.levels, 8u);
    EXPECT_LE(statistics.drawCalls, 4u);
    EXPECT_GT(statistics.triangles, 500000u);
    savePicture("clipmap_1023_8_levels", {expected, picture});
    expectAlike(expected, picture, 3.0, "1023 x 8", 4);
}

TEST(Clipmaps, FollowHeightsThatAreEdited) {
    Surface surface = surfaceOf(fractalMap(kSide, kSide, 50.0));
    Stage stage;
    const auto root = clipmapOver(surface, 63, unlitTexture, flight(1));
    stage.render(root.get());
    for (SbVec3f& point : surface.points) point[2] = 50.0f - point[2];
    SoSearchAction search;
    search.setType(SoCoordinate3::getClassTypeId());
    search.apply(root.get());
    ASSERT_NE(search.getPath(), nullptr);
    static_cast<SoCoordinate3*>(static_cast<SoFullPath*>(search.getPath())->getTail())->point.setValues(0, int(surface.points.size()), surface.points.data());
    const Image edited = stage.render(root.get());
    savePicture("clipmap_edited", {edited});
    const Image fresh = stage.render(clipmapOver(surface, 63, unlitTexture, flight(1)).get());
    EXPECT_TRUE(edited.pixels == fresh.pixels);
}

TEST(Clipmaps, TakeVertexArraysUnderAShaderProgramAndWithColoursPerVertex) {
    const Surface surface = surfaceOf(fractalMap(129, 129, 25.0));
    Stage stage;
    const auto plain = clipmapOver(surface, 63);
    const Image expected = stage.render(plain.get());
    EXPECT_EQ(clipmapIn(plain)->getStatistics().drawCalls, 4u);
    const auto shaded = clipmapOver(surface, 63, [](SoSeparator* group) {
        auto* program = new SoShaderProgram;
        auto* fragment = new SoFragmentShader;
        fragment->sourceType = SoShaderObject::GLSL_PROGRAM;
        fragment->sourceProgram = "void main() { gl_FragColor = vec4(0.0, 1.0, 0.0, 1.0); }";
        program->shaderObject.set1Value(0, fragment);
        group->addChild(program);
    });
    const Image green = stage.render(shaded.get());
    EXPECT_EQ(clipmapIn(shaded)->getStatistics().drawCalls, 2u) << "vertex arrays, and seams";
    EXPECT_EQ(meanColor(green)[0], 0.0);
    EXPECT_NEAR(meanColor(green)[1], 255.0, 1.0);
    const Difference difference = compare(expected, green);
    EXPECT_EQ(difference.onlyFirst + difference.onlySecond, 0);
    const auto coloured = clipmapOver(surface, 63, [&](SoSeparator* group) {
        auto* material = new SoMaterial;
        for (int i = 0; i < 129 * 129; ++i) material->diffuseColor.set1Value(i, SbColor(i % 129 < 64 ? 1.0f : 0.0f, 0.5f, 0.2f));
        auto* binding = new SoMaterialBinding;
        binding->value = SoMaterialBinding::PER_VERTEX;
        group->addChild(material);
        group->addChild(binding);
    });
    stage.render(coloured.get());
    EXPECT_EQ(clipmapIn(coloured)->getStatistics().drawCalls, 2u);
    Messages messages;
    clipmapIn(coloured)->implementation = SoGeometryClipmapTerrain::GPU;
    stage.render(coloured.get());
    stage.render(coloured.get());
    EXPECT_EQ(messages.all().size(), 1u) << messages.text();
    EXPECT_NE(messages.text().find("there is a material for each vertex"), std::string::npos) << messages.text();
}

TEST(Clipmaps, SayOnceWhatIsWrongWithTheirFields) {
    const Surface surface = surfaceOf(fractalMap(65, 65, 12.0));
    Stage stage;
    const auto expectMessage = [&](const char* text, const std::function<void(SoGeometryClipmapTerrain*)>& change) {
        const auto root = clipmapOver(surface, 31);
        stage.render(root.get());
        Messages messages;
        change(clipmapIn(root));
        EXPECT_GT(coveredPixels(stage.render(root.get())), 1000) << text;
        stage.render(root.get());
        EXPECT_EQ(messages.all().size(), 1u) << text << ": " << messages.text();
        EXPECT_NE(messages.text().find(text), std::string::npos) << messages.text();
    };
    expectMessage("found 100; 127 is taken", [](auto* node) { node->clipmapSize = 100; });
    expectMessage("found -7; 15 is taken", [](auto* node) { node->clipmapSize = -7; });
    expectMessage("levels: expected 0 to 31, found -1; 0 is taken", [](auto* node) { node->levels = -1; });
    expectMessage("transitionWidth: expected 0 to 1023, found 5000; 1023 is taken", [](auto* node) { node->transitionWidth = 5000; });
    expectMessage("updateBudget: expected 0 to", [](auto* node) { node->updateBudget = -5; });
    expectMessage("activeLevels: expected 0 to", [](auto* node) { node->activeLevels = -2; });
    expectMessage("detailLevels: expected 0 to 8, found 99; 8 is taken", [](auto* node) { node->detailLevels = 99; });
    expectMessage("detailAmplitude: expected a number", [](auto* node) {
        node->detailLevels = 1;
        node->detailAmplitude = std::numeric_limits<float>::quiet_NaN();
    });
}

TEST(Clipmaps, ReportNoBoundWhereTooFewLevelsLeaveGroundOut) {
    const Surface surface = surfaceOf(fractalMap(kSide, kSide, 50.0));
    Stage stage;
    const auto root = clipmapOver(surface, 31);
    const Image all = stage.render(root.get());
    EXPECT_TRUE(std::isfinite(clipmapIn(root)->getStatistics().errorPixels));
    clipmapIn(root)->levels = 2;
    const Image part = stage.render(root.get());
    EXPECT_LT(coveredPixels(part), coveredPixels(all));
    EXPECT_FALSE(std::isfinite(clipmapIn(root)->getStatistics().errorPixels));
}

TEST(Clipmaps, ReportNoBoundWhereTheCoarsestLevelIsStillMissing) {
    const Surface surface = surfaceOf(fractalMap(kSide, kSide, 50.0));
    Stage stage;
    for (const auto implementation : {SoGeometryClipmapTerrain::GPU, SoGeometryClipmapTerrain::CPU}) {
        const auto root = clipmapOver(surface, 15, unlitTexture, cameraAt({20.0f, 20.0f, 60.0f}, {60.0f, 60.0f, 10.0f}, 0.5f, 600.0f));
        clipmapIn(root)->implementation = implementation;
        clipmapIn(root)->levels = 2;
        clipmapIn(root)->updateBudget = 1;
        stage.render(root.get());
        root->replaceChild(0, cameraAt({220.0f, 200.0f, 60.0f}, {150.0f, 150.0f, 10.0f}, 0.5f, 600.0f));
        stage.render(root.get());
        EXPECT_FALSE(std::isfinite(clipmapIn(root)->getStatistics().errorPixels));
    }
}

TEST(Clipmaps, TakeTheSameSizeOnTheGpuAndOnTheCpu) {
    const Surface surface = surfaceOf(fractalMap(kSide, kSide, 50.0));
    Stage stage;
    for (int frame = 0; frame < 6; ++frame) {
        SoTerrainStatistics statistics[2];
        for (const int i : {0, 1}) {
            const auto root = clipmapOver(surface, 0, unlitTexture, flight(frame));
            clipmapIn(root)->pixelError = 6.0f;
            clipmapIn(root)->implementation = i == 0 ? SoGeometryClipmapTerrain::GPU : SoGeometryClipmapTerrain::CPU;
            stage.render(root.get());
            statistics[i] = clipmapIn(root)->getStatistics();
        }
        EXPECT_EQ(statistics[0].errorPixels, statistics[1].errorPixels) << "frame " << frame;
        EXPECT_EQ(statistics[0].levels, statistics[1].levels) << "frame " << frame;
    }
}

TEST(Clipmaps, TakeTexturesAsTheirModelsSay) {
    const Surface surface = surfaceOf(fractalMap(129, 129, 25.0));
    Stage stage;
    for (const auto model : {SoTexture2::MODULATE, SoTexture2::DECAL, SoTexture2::BLEND, SoTexture2::REPLACE})
        for (const int components : {1, 2, 3, 4}) {
            // GL leaves open what a decal without three colours does.
            if (model == SoTexture2::DECAL && components < 3) continue;
            const auto dress = [&](SoSeparator* group) {
                std::vector<unsigned char> pixels;
                for (int i = 0; i < 16 * 16 * components; ++i) pixels.push_back(static_cast<unsigned char>(40 + (i * 37) % 200));
                auto* texture = new SoTexture2;
                texture->image.setValue(SbVec2s(16, 16), components, pixels.data());
                texture->model = model;
                texture->blendColor = SbColor(0.9f, 0.2f, 0.4f);
                group->addChild(texture);
            };
            std::vector<Image> pictures;
            for (const auto implementation : {SoGeometryClipmapTerrain::CPU, SoGeometryClipmapTerrain::GPU}) {
                const auto root = clipmapOver(surface, 255, dress);
                clipmapIn(root)->implementation = implementation;
                pictures.push_back(stage.render(root.get()));
            }
            expectAlike(pictures[0], pictures[1], 4.0, "model " + std::to_string(model) + ", components " + std::to_string(components));
        }
}
