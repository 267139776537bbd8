// Pictures of the mesh itself: each colour is compared with what a mesh of our own, chosen for the same view, has there.
#include <epoxy/gl.h>

#include "DebugScene.h"

#include <gtest/gtest.h>

#include <set>

using namespace test;
using namespace test::debug;

namespace {

class DebugViews : public testing::TestWithParam<Kind> {};

}  // namespace

TEST_P(DebugViews, ChangeNothingOnceTheyAreOff) {
    const Surface surface = hills();
    Stage stage(kWidth, kHeight), other(kWidth, kHeight);
    const auto untouched = sceneFor(GetParam(), surface, slanted(), {}), root = sceneFor(GetParam(), surface, slanted(), {});
    SoTerrainShape* node = terrainIn(root.get());
    const Image before = other.render(untouched.get());
    const SoTerrainStatistics plain = terrainIn(untouched.get())->getStatistics();
    for (const int view : {SoTerrainShape::TILES, SoTerrainShape::LEVELS, SoTerrainShape::ERRORS, SoTerrainShape::LOADING}) {
        node->debugView = view;
        node->wireframeOverlay = view == SoTerrainShape::LEVELS;
        EXPECT_NE(stage.render(root.get()).pixels, before.pixels);
        EXPECT_EQ(node->getStatistics().errorPixels, plain.errorPixels);
    }
    node->debugView = SoTerrainShape::NONE;
    node->wireframeOverlay = FALSE;
    EXPECT_EQ(stage.render(root.get()).pixels, before.pixels);
    EXPECT_EQ(node->getStatistics().triangles, plain.triangles);
    EXPECT_EQ(node->getStatistics().drawCalls, plain.drawCalls);
    EXPECT_EQ(node->getStatistics().patches, plain.patches);
    EXPECT_EQ(node->getStatistics().bufferBytes > 0, true);
}

TEST_P(DebugViews, ShowTheLevelOfEachTriangle) {
    const Surface surface = hills();
    Stage stage(kWidth, kHeight);
    std::vector<Image> pictures;
    std::set<int> levels;
    for (SoCamera* (*camera)() : {slanted, near, grazing}) {
        const auto root = sceneFor(GetParam(), surface, camera());
        terrainIn(root.get())->debugView = SoTerrainShape::LEVELS;
        pictures.push_back(stage.render(root.get()));
        const Mesh mesh(GetParam(), surface, static_cast<SoCamera*>(root->getChild(0)));
        int looked = 0, wrong = 0;
        mesh.eachPixel(stage.depth(), [&](const Triangle& triangle, int x, int y, const glm::dvec3&) {
            if (triangle.closesGaps) return;
            const glm::dvec2 ab = triangle.corner[1].place - triangle.corner[0].place,
                             ac = triangle.corner[2].place - triangle.corner[0].place;
            const int level = int(std::floor(std::log2(std::sqrt(std::fabs(ab.x * ac.y - ab.y * ac.x)) * 1.0001)));
            levels.insert(level);
            ++looked;
            wrong += distanceOf(pixelOf(pictures.back(), x, y), terrain::levelColour(level)) > kSame;
        });
        EXPECT_GT(looked, 10000);
        EXPECT_LE(wrong, looked / 500);
    }
    EXPECT_GE(levels.size(), GetParam() == Kind::BruteForce ? 1u : 2u);
    savePicture("debug_levels_" + identifierOf(GetParam()), pictures);
}

TEST_P(DebugViews, ShowTilesInColoursOfTheirOwn) {
    const Surface surface = hills();
    Stage stage(kWidth, kHeight);
    const auto root = sceneFor(GetParam(), surface, slanted());
    terrainIn(root.get())->debugView = SoTerrainShape::TILES;
    const Image picture = stage.render(root.get());
    savePicture("debug_tiles_" + identifierOf(GetParam()), {picture});
    const Mesh mesh(GetParam(), surface, static_cast<SoCamera*>(root->getChild(0)));
    int looked = 0, wrong = 0;
    mesh.eachPixel(stage.depth(), [&](const Triangle& triangle, int x, int y, const glm::dvec3&) {
        ++looked;
        wrong += distanceOf(pixelOf(picture, x, y), triangle.patch) > kSame;
    });
    EXPECT_GT(looked, 10000);
    EXPECT_LE(wrong, looked / 500);
}

TEST_P(DebugViews, ShowTheErrorOfEachPixel) {
    const Surface surface = hills();
    Stage stage(kWidth, kHeight);
    std::vector<Image> pictures;
    for (SoCamera* (*camera)() : {slanted, near, grazing}) {
        const auto root = sceneFor(GetParam(), surface, camera());
        terrainIn(root.get())->debugView = SoTerrainShape::ERRORS;
        pictures.push_back(stage.render(root.get()));
        const Mesh mesh(GetParam(), surface, static_cast<SoCamera*>(root->getChild(0)));
        int looked = 0;
        double off = 0.0, shown = 0.0, expected = 0.0;
        mesh.eachPixel(stage.depth(), [&](const Triangle& triangle, int x, int y, const glm::dvec3& weights) {
            const double part = partOf(pixelOf(pictures.back(), x, y)), error = mesh.errorAt(triangle, weights) / 2.0;
            ++looked;
            shown = std::max(shown, part);
            expected = std::max(expected, error);
            if (!triangle.closesGaps) off = std::max(off, error > 1.01 ? 2.0 - part : std::fabs(std::min(part, 1.0) - error));
        });
        EXPECT_GT(looked, 10000);
        EXPECT_LE(off, 0.02) << "of pixelError";
        if (GetParam() == Kind::BruteForce)
            EXPECT_EQ(shown, 0.0);
        else
            EXPECT_GT(shown, 0.4);
        if (GetParam() != Kind::Clipmap) {
            EXPECT_LE(shown, 1.0) << "magenta though the promise is kept";
        }
        std::printf("%s: at most %.3f of pixelError shown, %.3f expected, off by %.4f\n", nameOf(GetParam()), shown, expected, off);
    }
    savePicture("debug_errors_" + identifierOf(GetParam()), pictures);
}

TEST_P(DebugViews, ShowABrokenPromiseOfAFrozenMeshInMagenta) {
    const Surface surface = hills();
    Stage stage(kWidth, kHeight);
    const auto root = sceneFor(GetParam(), surface, far());
    SoTerrainShape* node = terrainIn(root.get());
    node->debugView = SoTerrainShape::ERRORS;
    const Image before = stage.render(root.get());
    node->freeze = TRUE;
    const SbVec3f ground = surface.at(96, 60);
    root->replaceChild(0, cameraAt(ground + SbVec3f(0.0f, 0.0f, 7.0f), ground + SbVec3f(0.0f, 20.0f, -3.0f), 0.2f, 400.0f));
    const Image after = stage.render(root.get());
    const std::vector<float> depth = stage.depth();
    int broken = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            broken += depth[std::size_t(y * kWidth + x)] < 1.0f && pixelOf(after, x, y) == terrain::kBrokenColour;
    savePicture("debug_broken_" + identifierOf(GetParam()), {before, after});
    if (GetParam() == Kind::BruteForce)
        EXPECT_EQ(broken, 0);
    else
        EXPECT_GT(broken, 2000);
}

TEST_P(DebugViews, DrawEdgesOverTheSurfaceAndNothingElse) {
    const Surface surface = hills();
    Stage stage(kWidth, kHeight);
    std::vector<Image> pictures;
    for (SoCamera* (*camera)() : {slanted, near, grazing, far}) {
        const auto root = sceneFor(GetParam(), surface, camera(), unlitTexture);
        SoTerrainShape* node = terrainIn(root.get());
        if (auto* clipmap = dynamic_cast<SoGeometryClipmapTerrain*>(node)) clipmap->implementation = SoGeometryClipmapTerrain::CPU;
        const Image plain = stage.render(root.get());
        node->wireframeOverlay = TRUE;
        const Image picture = stage.render(root.get());
        pictures.push_back(picture);
        const Mesh mesh(GetParam(), surface, static_cast<SoCamera*>(root->getChild(0)));
        int inside = 0, changed = 0, along = 0, missing = 0;
        mesh.eachPixel(stage.depth(), [&](const Triangle& triangle, int x, int y, const glm::dvec3& weights) {
            if (triangle.closesGaps) return;
            const glm::dvec2 a(triangle.corner[0].window), b(triangle.corner[1].window), c(triangle.corner[2].window);
            const double area = std::fabs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
            const glm::dvec3 away = weights * area / glm::dvec3(glm::length(c - b), glm::length(c - a), glm::length(b - a));
            const double nearest = std::min({away.x, away.y, away.z});
            const bool differs = pixelOf(picture, x, y) != pixelOf(plain, x, y);
            if (nearest > 1.3) ++inside, changed += differs;
            if (nearest < 0.5 && pixelOf(plain, x, y) != Colour(0.0f)) ++along, missing += !differs;
        });
        EXPECT_EQ(changed, 0) << "of " << inside << " pixels within triangles";
        EXPECT_GT(along, 200);
        EXPECT_LE(missing, along / 200) << "of " << along << " pixels along edges";
    }
    savePicture("debug_overlay_" + identifierOf(GetParam()), pictures);
}

INSTANTIATE_TEST_SUITE_P(Nodes, DebugViews, testing::ValuesIn(kOurKinds),
                         [](const auto& info) { return identifierOf(info.param); });
