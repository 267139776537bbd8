// What pictures of the mesh show while it loads, and that nothing else than the mesh has a say in them.
#include <epoxy/gl.h>

#include "DebugScene.h"

#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <thread>

#include <Inventor/nodes/SoMaterial.h>

#include <SoTerrain/SoChunkedLoDTerrain.h>

using namespace test;
using namespace test::debug;

namespace {

class DebugProperties : public testing::TestWithParam<Kind> {};

}  // namespace

TEST_P(DebugProperties, DoNotDependOnWhatTheTerrainLooksLike) {
    const Surface surface = hills();
    Stage stage(kWidth, kHeight);
    for (const int view : {SoTerrainShape::TILES, SoTerrainShape::LEVELS, SoTerrainShape::ERRORS}) {
        std::vector<Image> pictures;
        for (const bool dressed : {false, true}) {
            const auto root = sceneFor(GetParam(), surface, slanted(), [&](SoSeparator* group) {
                if (!dressed) return;
                addTexture(group);
                auto* material = new SoMaterial;
                material->transparency = 0.5f;
                material->diffuseColor = SbColor(1.0f, 0.0f, 0.0f);
                group->addChild(material);
            });
            terrainIn(root.get())->debugView = view;
            pictures.push_back(stage.render(root.get()));
        }
        EXPECT_EQ(pictures[0].pixels, pictures[1].pixels) << view;
    }
}

TEST_P(DebugProperties, AreOpaqueWhateverTheTransparencyType) {
    const Surface surface = hills();
    Stage stage(kWidth, kHeight);
    for (const int view : {SoTerrainShape::LEVELS, SoTerrainShape::ERRORS}) {
        std::vector<Image> pictures;
        for (const auto type : {SoGLRenderAction::NONE, SoGLRenderAction::SCREEN_DOOR, SoGLRenderAction::ADD,
                                SoGLRenderAction::DELAYED_ADD, SoGLRenderAction::BLEND, SoGLRenderAction::DELAYED_BLEND,
                                SoGLRenderAction::SORTED_OBJECT_BLEND, SoGLRenderAction::SORTED_LAYERS_BLEND}) {
            const auto root = sceneFor(GetParam(), surface, slanted(), [](SoSeparator* group) {
                auto* material = new SoMaterial;
                material->transparency = 0.5f;
                group->addChild(material);
            });
            terrainIn(root.get())->debugView = view;
            terrainIn(root.get())->wireframeOverlay = TRUE;
            stage.action().setTransparencyType(type);
            pictures.push_back(stage.render(root.get()));
            if (pictures.size() == 1) continue;
            const Difference off = compare(pictures[0], pictures.back());
            EXPECT_LE(off.mean, 1.0) << "debugView " << view << ", transparency type " << int(type);
            EXPECT_EQ(off.onlyFirst + off.onlySecond, 0) << "debugView " << view << ", transparency type " << int(type);
        }
        savePicture("debug_transparent_" + identifierOf(GetParam()) + std::to_string(view), pictures);
    }
}

TEST_P(DebugProperties, KeepAFrozenMeshThatWasChosenWithoutThem) {
    const Surface surface = hills();
    Stage stage(kWidth, kHeight);
    std::vector<Image> pictures;
    for (const bool early : {true, false}) {
        const auto root = sceneFor(GetParam(), surface, near());
        SoTerrainShape* node = terrainIn(root.get());
        if (early) node->debugView = SoTerrainShape::LEVELS;
        stage.render(root.get());
        node->freeze = TRUE;
        root->replaceChild(0, slanted());
        node->debugView = SoTerrainShape::LEVELS;
        node->frozenFrustum = TRUE;
        pictures.push_back(stage.render(root.get()));
        const std::vector<float> depth = stage.depth();
        node->frozenFrustum = FALSE;
        EXPECT_NE(stage.render(root.get()).pixels, pictures.back().pixels) << "no view volume";
        EXPECT_EQ(stage.depth(), depth) << "lines are no ground";
    }
    EXPECT_EQ(pictures[0].pixels, pictures[1].pixels);
    savePicture("debug_frozen_" + identifierOf(GetParam()), pictures);
}

TEST(DebugView, LoadingTellsWhatStandsInAndWhatIsNew) {
    const Surface surface = surfaceOf(fractalMap(513, 513, 60.0));
    Stage stage(kWidth, kHeight);
    const auto root = sceneFor(Kind::ChunkedLod, surface, near(), unlit, 0.5f);
    auto* node = static_cast<SoChunkedLoDTerrain*>(terrainIn(root.get()));
    node->background = TRUE;
    node->uploadBudget = 16;
    node->debugView = SoTerrainShape::LOADING;
    // Pixels of the four colours, and all that there are.
    const auto count = [&](const Image& picture) {
        std::array<int, 5> found{};
        const std::vector<float> depth = stage.depth();
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                if (depth[std::size_t(y * kWidth + x)] == 1.0f) continue;
                const Colour colour = pixelOf(picture, x, y);
                ++found[4];
                found[0] += distanceOf(colour, terrain::kSettledColour) < kSame;
                found[1] += distanceOf(colour, terrain::kStandInColour) < kSame;
                found[2] += distanceOf(colour, terrain::kNewColour) < kSame;
                found[3] += distanceOf(colour, terrain::kNewStandInColour) < kSame;
            }
        EXPECT_GT(found[4], 10000);
        EXPECT_EQ(found[0] + found[1] + found[2] + found[3], found[4]);
        return found;
    };
    std::vector<Image> pictures{stage.render(root.get())};
    const auto first = count(pictures[0]);
    EXPECT_EQ(first[3], first[4]) << "the first tile comes in the first frame, and finer ones are wanted";
    bool cameLater = false;
    int stoodIn = 0;
    for (int frame = 0; !node->getStatistics().converged; ++frame) {
        ASSERT_LT(frame, 5000) << "never complete";
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        const Image picture = stage.render(root.get());
        const auto now = count(picture);
        if (now[1] > stoodIn) pictures.push_back(picture);
        stoodIn = std::max(stoodIn, now[1]);
        cameLater = cameLater || (now[2] > 0 && now[0] > 0);
    }
    EXPECT_GT(stoodIn, 100);
    EXPECT_TRUE(cameLater);
    pictures.push_back(stage.render(root.get()));
    const auto last = count(pictures.back());
    EXPECT_EQ(last[0], last[4]) << "at rest";
    savePicture("debug_loading", pictures);
}

TEST(DebugView, LoadingIsNeutralWhereNothingIsLoaded) {
    const Surface surface = hills();
    Stage stage(kWidth, kHeight);
    for (const Kind kind : {Kind::BruteForce, Kind::Roam, Kind::GeoMipmap}) {
        const auto root = sceneFor(kind, surface, slanted());
        terrainIn(root.get())->debugView = SoTerrainShape::LOADING;
        const Image picture = stage.render(root.get());
        const std::vector<float> depth = stage.depth();
        for (int i = 0; i < kWidth * kHeight; ++i)
            if (depth[std::size_t(i)] < 1.0f) {
                ASSERT_LT(distanceOf(pixelOf(picture, i % kWidth, i / kWidth), terrain::kSettledColour), kSame) << nameOf(kind);
            }
    }
}

/// A clipmap whose updates have a budget falls behind a jump.
TEST(DebugView, LoadingTellsWhereLevelsOfAClipmapFellBehind) {
    const Surface surface = hills();
    Stage stage(kWidth, kHeight);
    const auto root = sceneFor(Kind::Clipmap, surface, slanted());
    auto* node = static_cast<SoGeometryClipmapTerrain*>(terrainIn(root.get()));
    node->updateBudget = 200;
    node->pixelError = 0.5f;
    node->debugView = SoTerrainShape::LOADING;
    stage.render(root.get());
    root->replaceChild(0, cameraAt(SbVec3f(96.0f, 190.0f, 90.0f), SbVec3f(96.0f, 80.0f, 20.0f), 2.0f, 400.0f));
    std::vector<Image> pictures;
    int most = 0;
    for (int frame = 0; frame < 100; ++frame) {
        const Image picture = stage.render(root.get());
        int standIns = 0;
        for (int i = 0; i < kWidth * kHeight; ++i)
            standIns += distanceOf(pixelOf(picture, i % kWidth, i / kWidth), terrain::kStandInColour) < kSame;
        if (standIns > most) pictures = {picture};
        most = std::max(most, standIns);
        if (!node->getStatistics().converged) continue;
        EXPECT_EQ(standIns, 0);
        break;
    }
    EXPECT_TRUE(node->getStatistics().converged);
    EXPECT_GT(most, 5000);
    pictures.push_back(stage.render(root.get()));
    savePicture("debug_loading_clipmap", pictures);
}

/// What no texture of heights serves, triangle by triangle: at least what each pixel has, and still within the promise.
TEST(DebugView, ErrorsOfCurvedGridsAreThoseOfTheWorstSample) {
    const terrain::HeightMap map = fractalMap(129, 129, 30.0);
    const Surface flat = surfaceOf(map);
    const Surface curved = surfaceOf(map, [](int column, int row, float height) {
        return SbVec3f(float(column), float(row),
                       height - 1e-3f * float((column - 64) * (column - 64)) + 0.02f * std::sin(float(row)));
    });
    // One sample aside makes a grid that is no regular one of almost the same surface.
    Surface nearlyFlat = flat;
    nearlyFlat.points[nearlyFlat.index(64, 64)] += SbVec3f(0.05f, 0.0f, 0.0f);
    Stage stage(kWidth, kHeight);
    SoCamera* (*camera)() = [] { return cameraAt(SbVec3f(64.0f, -30.0f, 60.0f), SbVec3f(64.0f, 64.0f, 10.0f), 1.0f, 300.0f); };
    std::vector<Image> pictures;
    for (const Kind kind : kLodKinds) {
        std::array<double, 3> largest{};
        int i = 0;
        for (const Surface* surface : {&flat, const_cast<const Surface*>(&nearlyFlat), &curved}) {
            const auto root = sceneFor(kind, *surface, camera());
            terrainIn(root.get())->debugView = SoTerrainShape::ERRORS;
            pictures.push_back(stage.render(root.get()));
            const std::vector<float> depth = stage.depth();
            for (int pixel = 0; pixel < kWidth * kHeight; ++pixel)
                if (depth[std::size_t(pixel)] < 1.0f)
                    largest[std::size_t(i)] =
                        std::max(largest[std::size_t(i)], partOf(pixelOf(pictures.back(), pixel % kWidth, pixel / kWidth)));
            ++i;
        }
        std::printf("%s: flat %.3f, by triangle %.3f, curved %.3f\n", nameOf(kind), largest[0], largest[1], largest[2]);
        if (kind == Kind::Clipmap) continue;
        EXPECT_LE(largest[1], 1.0) << nameOf(kind);
        EXPECT_LE(largest[2], 1.0) << nameOf(kind);
        EXPECT_GT(largest[2], 0.4) << nameOf(kind);
    }
    savePicture("debug_errors_curved", pictures);
}

TEST_P(DebugProperties, LeaveHolesOpen) {
    auto map = fractalMap(129, 97, 30.0);
    for (int row = 30; row < 55; ++row)
        for (int column = 40; column < 90; ++column)
            map.heights[std::size_t(row * 129 + column)] = std::numeric_limits<float>::quiet_NaN();
    const Surface surface = surfaceOf(map);
    Stage stage(kWidth, kHeight);
    const auto root = sceneFor(GetParam(), surface,
                               cameraAt(SbVec3f(64.0f, -20.0f, 70.0f), SbVec3f(64.0f, 45.0f, 10.0f), 1.0f, 300.0f), unlitTexture);
    SoTerrainShape* node = terrainIn(root.get());
    if (auto* clipmap = dynamic_cast<SoGeometryClipmapTerrain*>(node)) clipmap->implementation = SoGeometryClipmapTerrain::CPU;
    const Image plain = stage.render(root.get());
    const std::vector<float> depth = stage.depth();
    std::vector<Image> pictures{plain};
    for (const int view : {SoTerrainShape::TILES, SoTerrainShape::LEVELS, SoTerrainShape::ERRORS, SoTerrainShape::LOADING}) {
        node->debugView = view;
        pictures.push_back(stage.render(root.get()));
        EXPECT_EQ(stage.depth(), depth) << "the same mesh at the same depth";
        if (view != SoTerrainShape::ERRORS || GetParam() == Kind::Clipmap) continue;
        for (int i = 0; i < kWidth * kHeight; ++i) {
            if (depth[std::size_t(i)] < 1.0f) {
                ASSERT_LE(partOf(pixelOf(pictures.back(), i % kWidth, i / kWidth)), 1.0) << i % kWidth << ' ' << i / kWidth;
            }
        }
    }
    savePicture("debug_holes_" + identifierOf(GetParam()), pictures);
}

/// Two cameras on one node: each has the errors of its own mesh, on its own screen.
TEST_P(DebugProperties, OfTwoViewsAreThoseOfEach) {
    const Surface surface = hills();
    Stage stage(kWidth, kHeight);
    const auto one = sceneFor(GetParam(), surface, slanted()), other = sceneFor(GetParam(), surface, near());
    // The second scene draws the first one's node.
    auto* shape = static_cast<SoSeparator*>(static_cast<SoSeparator*>(other->getChild(2))->getChild(1));
    SoTerrainShape* node = terrainIn(one.get());
    const Ref<SoSeparator> alone = sceneFor(GetParam(), surface, near());
    terrainIn(alone.get())->debugView = node->debugView = SoTerrainShape::ERRORS;
    const Image expected = stage.render(alone.get());
    shape->replaceChild(shape->getNumChildren() - 1, node);
    const Image first = stage.render(one.get());
    EXPECT_EQ(stage.render(other.get()).pixels, expected.pixels);
    EXPECT_EQ(stage.render(one.get()).pixels, first.pixels);
    EXPECT_EQ(stage.render(other.get()).pixels, expected.pixels);
}

INSTANTIATE_TEST_SUITE_P(Nodes, DebugProperties, testing::ValuesIn(kOurKinds),
                         [](const auto& info) { return identifierOf(info.param); });
