// Far from zero the ground is lit as it is at zero, though single precision knows no places between its samples there.
#include "Scenes.h"

#include <gtest/gtest.h>

#include <Inventor/nodes/SoDirectionalLight.h>
#include <Inventor/nodes/SoOrthographicCamera.h>

#include <SoTerrain/SoHeightMap.h>

using namespace test;

namespace {

constexpr float kFarX = 500000.0f, kFarY = 5000000.0f;
constexpr int kSide = 129;

SoHeightMap* hills(const SbVec2f& spacing, bool isFar) {
    const terrain::HeightMap map = mapOf(kSide, kSide, [](double u, double v) { return std::sin(9.0 * u) * std::cos(7.0 * v); });
    auto* node = new SoHeightMap;
    node->setHeights(kSide, kSide, map.heights.data());
    node->spacing = spacing;
    if (isFar) node->origin.setValue(kFarX, kFarY);
    return node;
}

/// Lit from aside, seen from above, where no error in height shows: in full detail.
Ref<SoSeparator> litScene(Kind kind, bool isFar) {
    constexpr float kSpacing = 0.25f, kMiddle = 16.0f;
    Ref<SoSeparator> root = new SoSeparator;
    auto* camera = new SoOrthographicCamera;
    camera->position.setValue(kMiddle + (isFar ? kFarX : 0.0f), kMiddle + (isFar ? kFarY : 0.0f), 32.0f);
    camera->height = 24.0f;
    camera->nearDistance = 1.0f;
    camera->farDistance = 64.0f;
    auto* light = new SoDirectionalLight;
    light->direction.setValue(1.0f, 0.5f, -0.7f);
    for (SoNode* node : std::initializer_list<SoNode*>{camera, light, hills({kSpacing, kSpacing}, isFar), nodeOf(kind, 0, 0, 0.0f)}) root->addChild(node);
    return root;
}

class FarNormals : public testing::TestWithParam<Kind> {};

}  // namespace

TEST_P(FarNormals, LightTheGroundAsAtZero) {
    Stage stage;
    const Ref<SoSeparator> near = litScene(GetParam(), false), far = litScene(GetParam(), true);
    terrain::Image atZero, farAway;
    for (int frame = 0; frame < 12; ++frame) {
        atZero = stage.render(near.get());
        farAway = stage.render(far.get());
    }
    savePicture("far_normals_" + identifierOf(GetParam()), {atZero, farAway});
    const std::vector<double> expected = meanColor(atZero), found = meanColor(farAway);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], 3.0);
    // Samples stand up to a quarter of a unit aside; normals do not.
    EXPECT_LE(compare(atZero, farAway).mean, 2.0);
}

TEST_P(FarNormals, OfPicksAndHeightsAreThoseAtZero) {
    // Rows fall on floats that are half or a whole unit apart, but within every second row there is one.
    const Ref<SoSeparator> near = new SoSeparator, far = new SoSeparator;
    near->addChild(hills({0.25f, 0.75f}, false));
    far->addChild(hills({0.25f, 0.75f}, true));
    for (const auto& root : {near, far}) root->addChild(nodeOf(GetParam(), 0, 0));
    for (int row = 4; row < kSide - 2; row += 10)
        for (int column = 2; column < kSide - 2; column += 7) {
            const float x = 0.25f * float(column) + 0.0625f, y = 0.75f * float(row) + 0.5f;
            float height = 0.0f, farHeight = 0.0f;
            SbVec3f normal, farNormal;
            ASSERT_TRUE(terrainIn(near.get())->heightAt(x, y, height, &normal));
            ASSERT_TRUE(terrainIn(far.get())->heightAt(kFarX + x, kFarY + y, farHeight, &farNormal));
            EXPECT_NEAR(farHeight, height, 1e-5f);
            EXPECT_LT((farNormal - normal).length(), 1e-5f) << column << ", " << row;
        }
}

INSTANTIATE_TEST_SUITE_P(, FarNormals, testing::ValuesIn(kOurKinds), [](const auto& info) { return identifierOf(info.param); });
