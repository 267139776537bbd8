// Undersides of triangles: left out only where nothing of them could be seen.
#include "Scenes.h"

#include <gtest/gtest.h>

#include <cmath>

#include <Inventor/nodes/SoClipPlane.h>
#include <Inventor/nodes/SoDirectionalLight.h>
#include <Inventor/nodes/SoMaterial.h>
#include <Inventor/nodes/SoScale.h>
#include <Inventor/nodes/SoShapeHints.h>

using namespace test;
using terrain::Image;

namespace {

/// Steep enough for one triangle in five to be turned away from any camera.
Surface peaks() { return surfaceOf(fractalMap(97, 65, 60.0)); }

void clip(SoGroup* group, const SbPlane& plane) {
    auto* node = new SoClipPlane;
    node->plane = plane;
    group->addChild(node);
}

SoCamera* above() { return cameraAt(SbVec3f(20.0f, 15.0f, 62.0f), SbVec3f(80.0f, 50.0f, 30.0f), 0.5f, 200.0f); }

std::size_t differentPixels(const Image& a, const Image& b) {
    std::size_t different = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) different += a.pixels[i] != b.pixels[i];
    return different;
}

}  // namespace

TEST(Undersides, LeavingThemOutChangesNoPixel) {
    // A plane beyond the terrain cuts nothing, but with one all triangles are drawn.
    const auto far = [](SoSeparator* group) { clip(group, SbPlane(SbVec3f(0.0f, 0.0f, 1.0f), -1000.0f)); };
    for (const Kind kind : kOurKinds) {
        Stage stage;
        const Image without = stage.render(sceneOf(kind, peaks(), {}, unlitTexture, above()).get());
        const Image with = stage.render(sceneOf(kind, peaks(), {}, [&](SoSeparator* group) { unlitTexture(group); far(group); }, above()).get());
        EXPECT_EQ(differentPixels(without, with), 0u) << nameOf(kind);
    }
}

TEST(Undersides, AreSeenFromBelowAndFromBeside) {
    expectLikeReference("underside_below", peaks(), {}, unlitTexture, 0.3, 4.0,
                        [] { return cameraAt(SbVec3f(48.0f, 32.0f, -30.0f), SbVec3f(60.0f, 40.0f, 20.0f), 0.5f, 200.0f); });
    expectLikeReference("underside_beside", peaks(), {}, unlitTexture, 0.3, 4.0,
                        [] { return cameraAt(SbVec3f(-60.0f, 30.0f, 5.0f), SbVec3f(40.0f, 32.0f, 25.0f), 0.5f, 300.0f); });
}

TEST(Undersides, AreSeenWhereAPlaneCutsTheGround) {
    expectLikeReference("underside_clipped", peaks(), {}, [](SoSeparator* group) {
        unlitTexture(group);
        clip(group, SbPlane(SbVec3f(1.0f, 0.3f, 0.0f), 55.0f));
    }, 0.3, 4.0, above);
}

TEST(Undersides, AreSeenThroughTransparentGround) {
    expectLikeReference("underside_transparent", peaks(), {}, [](SoSeparator* group) {
        auto* material = new SoMaterial;
        material->diffuseColor = SbColor(0.9f, 0.7f, 0.2f);
        material->transparency = 0.5f;
        group->addChild(material);
    }, 0.5, 6.0, above);
}

TEST(Undersides, StayWhereAMirrorTurnsTheGroundInsideOut) {
    expectLikeReference("underside_mirrored", peaks(), {}, [](SoSeparator* group) {
        unlitTexture(group);
        auto* mirror = new SoScale;
        mirror->scaleFactor = SbVec3f(-1.0f, 1.0f, 1.0f);
        group->addChild(mirror);
    }, 0.3, 4.0, [] { return cameraAt(SbVec3f(-20.0f, 15.0f, 62.0f), SbVec3f(-80.0f, 50.0f, 30.0f), 0.5f, 200.0f); });
}

TEST(Undersides, AreToldFromUpperSidesWhateverTheHintsSay) {
    for (const auto ordering : {SoShapeHints::CLOCKWISE, SoShapeHints::COUNTERCLOCKWISE, SoShapeHints::UNKNOWN_ORDERING})
        expectLikeReference("underside_hints" + std::to_string(int(ordering)), peaks(), {}, [&](SoSeparator* group) {
            unlitTexture(group);
            auto* hints = new SoShapeHints;
            hints->vertexOrdering = ordering;
            group->addChild(hints);
        }, 0.3, 4.0, above);
}
