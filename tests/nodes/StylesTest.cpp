// Grids that are not flat maps, other cameras, and draw styles.
#include "Scenes.h"

#include <gtest/gtest.h>

#include <cmath>

#include <Inventor/nodes/SoComplexity.h>
#include <Inventor/nodes/SoDirectionalLight.h>
#include <Inventor/nodes/SoDrawStyle.h>
#include <Inventor/nodes/SoOrthographicCamera.h>

#include <SoTerrain/SoROAMTerrain.h>

using namespace test;

namespace {

Surface hills() { return surfaceOf(fractalMap(97, 65, 30.0)); }

SoCamera* orthographic(const Surface& surface, const SbVec3f& direction) {
    auto* camera = new SoOrthographicCamera;
    const SbVec3f centre = surface.box().getCenter();
    camera->position = centre - direction * 200.0f;
    camera->pointAt(centre, std::fabs(direction[2]) > 0.99f ? SbVec3f(0.0f, 1.0f, 0.0f) : SbVec3f(0.0f, 0.0f, 1.0f));
    camera->height = 50.0f;
    camera->nearDistance = 1.0f;
    camera->farDistance = 400.0f;
    return camera;
}

void addStyle(SoGroup* group, SoDrawStyle::Style style) {
    auto* node = new SoDrawStyle;
    node->style = style;
    node->pointSize = 1.0f;
    group->addChild(node);
}

void lightFromAbove(SoSeparator* group) {
    auto* light = new SoDirectionalLight;
    light->direction = SbVec3f(-0.3f, -1.0f, 0.2f);
    group->addChild(light);
}

std::uint32_t trianglesAt(float complexity) {
    Stage stage;
    const auto root = sceneOf(Kind::Roam, hills(), {}, [&](SoSeparator* group) {
        auto* node = new SoComplexity;
        node->value = complexity;
        group->addChild(node);
    });
    stage.render(root.get());
    return terrainIn(root.get())->getStatistics().triangles;
}

}  // namespace

TEST(CurvedGrids, LookLikeCoinsOwnShape) {
    const auto map = fractalMap(129, 97, 3.0);
    const Surface dome = surfaceOf(map, [](int column, int row, float height) {
        const float azimuth = float(column) * 0.02f, elevation = 0.1f + float(row) * 0.012f, radius = 40.0f + height;
        return SbVec3f(std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation), std::sin(elevation)) * radius;
    });
    const auto camera = [] { return cameraAt(SbVec3f(35.0f, 75.0f, 45.0f), SbVec3f(-5.0f, 25.0f, 22.0f), 1.0f, 200.0f); };
    expectLikeReference("curved", dome, {}, unlitTexture, 0.3, 3.0, camera);
    expectLikeReference("curved_lit", dome, {.pixelError = 0.0f, .normals = false}, lightFromAbove, 1.0, 4.0, camera);
}

TEST(CurvedGrids, ThatFoldOverThemselvesLookLikeCoinsOwnShape) {
    const auto map = mapOf(65, 65, [](double, double) { return 0.0; });
    const Surface roll = surfaceOf(map, [](int column, int row, float) {
        const float turn = float(column) * 0.15f, radius = 6.0f + 0.1f * float(column);
        return SbVec3f(radius * std::cos(turn), float(row) * 0.4f, radius * std::sin(turn));
    });
    const auto camera = [] { return cameraAt(SbVec3f(8.0f, -25.0f, 15.0f), SbVec3f(0.0f, 8.0f, 0.0f), 1.0f, 100.0f); };
    expectLikeReference("curved_roll", roll, {}, unlitTexture, 0.3, 4.0, camera);
}

TEST(RegularGrids, WithHeightsAlongYLookLikeCoinsOwnShape) {
    const Surface surface = surfaceOf(fractalMap(97, 65, 30.0), [](int column, int row, float height) { return SbVec3f(float(column), height, -float(row)); });
    expectLikeReference("y_up", surface, {}, unlitTexture, 0.3, 3.0, [&] { return cameraFor(surface.box(), true); });
    expectLikeReference("y_up_normals", surface, {.pixelError = 0.0f, .normals = false}, lightFromAbove, 0.5, 4.0, [&] { return cameraFor(surface.box(), true); });
}

TEST(RegularGrids, WithHeightsAlongXLookLikeCoinsOwnShape) {
    const Surface surface = surfaceOf(fractalMap(97, 65, 30.0), [](int column, int row, float height) { return SbVec3f(height, float(column), float(row)); });
    const auto camera = [] { return cameraAt(SbVec3f(60.0f, 20.0f, 80.0f), SbVec3f(5.0f, 48.0f, 32.0f), 1.0f, 300.0f); };
    expectLikeReference("x_up", surface, {}, unlitTexture, 0.3, 3.0, camera);
}

TEST(RegularGrids, WithRowsThatRunBackwardsLookLikeCoinsOwnShape) {
    const Surface surface = surfaceOf(fractalMap(97, 65, 30.0), [](int column, int row, float height) { return SbVec3f(float(column), 64.0f - float(row), height); });
    expectLikeReference("backwards", surface, {}, unlitTexture, 0.3, 3.0);
}

TEST(Orthographic, CamerasShowTheSameAsCoinsOwnShape) {
    const Surface surface = hills();
    SbVec3f slanted(0.4f, 0.7f, -0.5f);
    slanted.normalize();
    expectLikeReference("orthographic", surface, {}, unlitTexture, 0.3, 3.0, [&] { return orthographic(surface, slanted); });
    expectLikeReference("orthographic_above", surface, {}, unlitTexture, 0.3, 3.0, [&] { return orthographic(surface, SbVec3f(0.0f, 0.0f, -1.0f)); });
}

TEST(DrawStyles, LinesAreTheEdgesOfTheTriangles) {
    const Surface surface = hills();
    Stage stage;
    const auto draw = [&](Kind kind) { return stage.render(sceneOf(kind, surface, {.pixelError = 4.0f}, [](SoSeparator* group) { addStyle(group, SoDrawStyle::LINES); }).get()); };
    const auto reference = draw(Kind::Reference), bruteForce = draw(Kind::BruteForce), roam = draw(Kind::Roam), geoMipmap = draw(Kind::GeoMipmap);
    savePicture("style_lines", {reference, bruteForce, roam, geoMipmap});
    EXPECT_NEAR(coveredPixels(bruteForce), coveredPixels(reference), 0.01 * coveredPixels(reference));
    EXPECT_LT(compare(reference, bruteForce).mean, 2.0);
    // Fewer triangles leave the background open between their edges.
    for (const terrain::Image& picture : {roam, geoMipmap}) {
        EXPECT_LT(coveredPixels(picture), coveredPixels(reference) / 2);
        EXPECT_GT(coveredPixels(picture), 1000);
    }
}

TEST(DrawStyles, PointsAreTheSamples) {
    const Surface surface = hills();
    Stage stage;
    const auto draw = [&](Kind kind) { return stage.render(sceneOf(kind, surface, {.pixelError = 0.0f}, [](SoSeparator* group) { addStyle(group, SoDrawStyle::POINTS); }).get()); };
    const auto reference = draw(Kind::Reference), bruteForce = draw(Kind::BruteForce), roam = draw(Kind::Roam), geoMipmap = draw(Kind::GeoMipmap);
    savePicture("style_points", {reference, bruteForce, roam, geoMipmap});
    for (const auto& [picture, name] : {std::pair{bruteForce, "brute force"}, {roam, "ROAM"}, {geoMipmap, "Geo Mip-Mapping"}}) {
        const Difference found = compare(reference, picture, 0);
        EXPECT_LE(found.onlyFirst + found.onlySecond, coveredPixels(reference) / 100) << name;
        EXPECT_LT(found.mean, 2.0) << name;
    }
}

TEST(DrawStyles, InvisibleDrawsNothing) {
    Stage stage;
    for (const Kind kind : kOurKinds)
        EXPECT_EQ(coveredPixels(stage.render(sceneOf(kind, hills(), {}, [](SoSeparator* group) { addStyle(group, SoDrawStyle::INVISIBLE); }).get())), 0);
}

TEST(Complexity, HalvesAndDoublesThePixelError) {
    const std::uint32_t coarse = trianglesAt(0.25f), middle = trianglesAt(0.5f), fine = trianglesAt(0.75f);
    EXPECT_LT(coarse, middle);
    EXPECT_LT(middle, fine);
    Stage stage;
    const auto plain = sceneOf(Kind::Roam, hills());
    stage.render(plain.get());
    EXPECT_EQ(terrainIn(plain.get())->getStatistics().triangles, middle);
    const auto halved = sceneOf(Kind::Roam, hills(), {.pixelError = 1.0f});
    stage.render(halved.get());
    EXPECT_EQ(terrainIn(halved.get())->getStatistics().triangles, fine);
}

TEST(Complexity, OfTypeBoundingBoxDrawsTheBox) {
    expectLikeReference("bounding_box", hills(), {}, [](SoSeparator* group) {
        auto* node = new SoComplexity;
        node->type = SoComplexity::BOUNDING_BOX;
        group->addChild(node);
    }, 0.3, 0.3);
}
