// SoRayPickAction finds on every terrain node what it finds on Coin's triangles of the same ground.
#include "Actions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <Inventor/SoPickedPoint.h>
#include <Inventor/actions/SoRayPickAction.h>
#include <Inventor/nodes/SoClipPlane.h>
#include <Inventor/nodes/SoComplexity.h>
#include <Inventor/nodes/SoDrawStyle.h>
#include <Inventor/nodes/SoMaterial.h>
#include <Inventor/nodes/SoMaterialBinding.h>
#include <Inventor/nodes/SoMatrixTransform.h>
#include <Inventor/nodes/SoOrthographicCamera.h>
#include <Inventor/nodes/SoPickStyle.h>
#include <Inventor/nodes/SoShapeHints.h>
#include <Inventor/nodes/SoSphere.h>
#include <Inventor/nodes/SoTextureCoordinatePlane.h>
#include <Inventor/nodes/SoTransform.h>

#include <SoTerrain/SoTerrainDetail.h>

using namespace test;

namespace {

/// What a picked point tells.
struct Picked {
    SbVec3f point, normal, objectPoint, objectNormal;
    SbVec4f texture;
    int material;
    bool hasDetail;
};

using Aim = std::function<void(SoRayPickAction&)>;

std::vector<Picked> pick(SoNode* root, const Aim& aim) {
    SoRayPickAction action(kRegion);
    aim(action);
    action.apply(root);
    std::vector<Picked> all;
    for (int i = 0; i < action.getPickedPointList().getLength(); ++i) {
        const SoPickedPoint& p = *action.getPickedPointList()[i];
        all.push_back({p.getPoint(), p.getNormal(), p.getObjectPoint(), p.getObjectNormal(), p.getTextureCoords(), p.getMaterialIndex(),
                       p.getDetail() != nullptr});
    }
    return all;
}

void expectSame(const Picked& expected, const Picked& found, float tolerance) {
    EXPECT_LT((expected.point - found.point).length(), tolerance);
    EXPECT_LT((expected.objectPoint - found.objectPoint).length(), tolerance);
    // Coin does not make them one long after a transform.
    EXPECT_LT((expected.normal - found.normal).length(), 0.01f * expected.normal.length());
    EXPECT_GT(expected.objectNormal.dot(found.objectNormal), 0.9999f);
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(expected.texture[i], found.texture[i], 1e-4f);
    EXPECT_EQ(expected.material, found.material);
    EXPECT_EQ(expected.hasDetail, found.hasDetail);
}

/// Coin's triangles and ours under the same properties.
class Pair {
public:
    explicit Pair(const Where& where, const Dressing& dress = {}, SoCamera* camera = nullptr)
        : reference_(groundScene({}, {.dress = textured(dress), .camera = camera})), ours_(groundScene(where, {.dress = textured(dress), .camera = camera})) {}

    /// Both give the same points in the same order; returns how many.
    std::size_t expectSamePicks(const Aim& aim, float tolerance = 1e-3f) const {
        const auto expected = pick(reference_.get(), aim), found = pick(ours_.get(), aim);
        EXPECT_EQ(found.size(), expected.size());
        for (std::size_t i = 0; i < std::min(found.size(), expected.size()); ++i) expectSame(expected[i], found[i], tolerance);
        return found.size();
    }

private:
    /// Coin's shapes have texture coordinates only where there is a texture.
    static Dressing textured(const Dressing& dress) {
        return [dress](SoSeparator* group) {
            addTexture(group);
            if (dress) dress(group);
        };
    }

    Ref<SoSeparator> reference_, ours_;
};

class Rays {
public:
    float between(float low, float high) { return low + (high - low) * std::uniform_real_distribution<float>()(random_); }
    SbVec3f onGround() { return {between(8.0f, 68.0f), between(16.0f, 51.0f), between(0.0f, 20.0f)}; }
    SbVec3f eye() { return {between(-40.0f, 110.0f), between(-40.0f, 100.0f), between(-20.0f, 50.0f)}; }

private:
    std::mt19937 random_{11};
};

/// Rays from all around; how many points were hit.
std::size_t expectSameOnRandomRays(const Pair& pair, int count, bool all, const SbMatrix& place = SbMatrix::identity()) {
    Rays rays;
    std::size_t hits = 0;
    for (int i = 0; i < count && !testing::Test::HasFailure(); ++i) {
        SbVec3f eye, target;
        place.multVecMatrix(rays.eye(), eye);
        place.multVecMatrix(rays.onGround(), target);
        hits += pair.expectSamePicks([&](SoRayPickAction& action) {
            action.setRay(eye, target - eye);
            action.setPickAll(all);
        });
        if (testing::Test::HasFailure()) ADD_FAILURE() << "in ray " << i;
    }
    return hits;
}

std::size_t expectSameThroughPixels(const Pair& pair, float radius, bool all = false) {
    std::size_t hits = 0;
    for (short x = 7; x < 320; x = short(x + 29))
        for (short y = 4; y < 240; y = short(y + 23))
            hits += pair.expectSamePicks([&](SoRayPickAction& action) {
                action.setPoint(SbVec2s(x, y));
                action.setRadius(radius);
                action.setPickAll(all);
            });
    return hits;
}

void colourVertices(SoSeparator* group) {
    auto* material = new SoMaterial;
    for (int i = 0; i < int(ground().points.size()); ++i) material->diffuseColor.set1Value(i, SbColor(0.5f, float(i % 7) / 7.0f, 0.2f));
    group->addChild(material);
    auto* binding = new SoMaterialBinding;
    binding->value = SoMaterialBinding::PER_VERTEX_INDEXED;
    group->addChild(binding);
}

class ActionPick : public OnEveryNode {};

}  // namespace

TEST_P(ActionPick, NearestIsThatOfTheTriangles) {
    EXPECT_GT(expectSameOnRandomRays(Pair(GetParam(), colourVertices), 150, false), 80u);
}

TEST_P(ActionPick, AllAreThoseOfTheTrianglesInTheirOrder) {
    EXPECT_GT(expectSameOnRandomRays(Pair(GetParam(), colourVertices), 150, true), 100u);
}

TEST_P(ActionPick, ThroughAPixelMeetsThePointOnScreen) {
    EXPECT_GT(expectSameThroughPixels(Pair(GetParam()), 5.0f), 25u);
    auto* camera = new SoOrthographicCamera;
    camera->position = SbVec3f(20.0f, -30.0f, 60.0f);
    camera->pointAt(SbVec3f(38.0f, 32.0f, 8.0f), SbVec3f(0.0f, 0.0f, 1.0f));
    camera->height = 50.0f;
    camera->farDistance = 300.0f;
    Ref<SoCamera> kept(camera);
    EXPECT_GT(expectSameThroughPixels(Pair(GetParam(), {}, camera), 5.0f), 25u);
    EXPECT_EQ(Pair(GetParam()).expectSamePicks([](SoRayPickAction& action) { action.setNormalizedPoint(SbVec2f(0.52f, 0.47f)); }), 1u);
}

TEST_P(ActionPick, WithARadiusMeetsNoMoreThanTheRay) {
    const Pair pair(GetParam());
    const std::size_t thin = expectSameThroughPixels(pair, 0.0f, true);
    EXPECT_EQ(expectSameThroughPixels(pair, 60.0f, true), thin);
    EXPECT_GT(thin, 25u);
}

TEST_P(ActionPick, KeepsToTheNearAndFarEndOfARay) {
    const Pair pair(GetParam());
    std::size_t hits = 0;
    for (float near = 0.0f; near < 60.0f; near += 4.0f)
        hits += pair.expectSamePicks([&](SoRayPickAction& action) {
            action.setRay(SbVec3f(9.3f, 30.1f, 30.0f), SbVec3f(1.0f, 0.13f, -0.45f), near, near + 25.0f);
            action.setPickAll(TRUE);
        });
    EXPECT_GT(hits, 2u);
}

TEST_P(ActionPick, GoesThroughAnyTransform) {
    SbMatrix shear(1.0f, 0.2f, 0.0f, 0.0f, -0.3f, 1.1f, 0.1f, 0.0f, 0.0f, 0.4f, 0.9f, 0.0f, 5.0f, -7.0f, 3.0f, 1.0f);
    SbMatrix stretched, mirrored;
    stretched.setTransform(SbVec3f(-4.0f, 9.0f, 2.0f), SbRotation(SbVec3f(0.3f, 1.0f, 0.4f), 0.9f), SbVec3f(0.3f, 2.0f, 4.0f));
    mirrored.setTransform(SbVec3f(1.0f, 2.0f, 3.0f), SbRotation(SbVec3f(1.0f, 0.2f, 0.1f), 0.4f), SbVec3f(1.0f, -1.0f, 1.5f));
    for (const SbMatrix& place : {shear, stretched, mirrored}) {
        const auto dress = [&](SoSeparator* group) {
            auto* transform = new SoMatrixTransform;
            transform->matrix = place;
            group->addChild(transform);
        };
        EXPECT_GT(expectSameOnRandomRays(Pair(GetParam(), dress), 60, true, place), 30u);
    }
}

TEST_P(ActionPick, LeavesOutWhatClipPlanesCutAway) {
    const auto dress = [](SoSeparator* group) {
        for (const SbPlane& cut : {SbPlane(SbVec3f(1.0f, 0.0f, 0.0f), 30.0f), SbPlane(SbVec3f(0.0f, -0.5f, 0.3f), -15.0f)}) {
            auto* plane = new SoClipPlane;
            plane->plane = cut;
            group->addChild(plane);
        }
    };
    const std::size_t cut = expectSameOnRandomRays(Pair(GetParam(), dress), 150, true);
    EXPECT_GT(cut, 5u);
    EXPECT_LT(cut, expectSameOnRandomRays(Pair(GetParam()), 150, true));
}

namespace {

/// A ball in front of the ground, and the ground with a pick style.
Dressing styledBehindABall(SoPickStyle::Style style, bool withBall = true) {
    return [=](SoSeparator* group) {
        if (withBall) {
            auto* ball = new SoSeparator;
            auto* place = new SoTransform;
            place->translation = SbVec3f(38.0f, 33.0f, 15.0f);
            ball->addChild(place);
            auto* sphere = new SoSphere;
            sphere->radius = 8.0f;
            ball->addChild(sphere);
            group->addChild(ball);
        }
        auto* pickStyle = new SoPickStyle;
        pickStyle->style = style;
        group->addChild(pickStyle);
    };
}

}  // namespace

TEST_P(ActionPick, FollowsEveryPickStyle) {
    for (const auto style : {SoPickStyle::SHAPE, SoPickStyle::BOUNDING_BOX, SoPickStyle::UNPICKABLE, SoPickStyle::BOUNDING_BOX_ON_TOP, SoPickStyle::SHAPE_FRONTFACES}) {
        const Pair pair(GetParam(), styledBehindABall(style));
        SCOPED_TRACE(std::string("style ") + std::to_string(style));
        EXPECT_GT(expectSameOnRandomRays(pair, 60, false), 10u);
        EXPECT_GT(expectSameOnRandomRays(pair, 60, true), 10u);
    }
}

TEST_P(ActionPick, OnTopMeetsTheNearestOfTheGround) {
    // Coin's own shapes give the first of their triangles on the ray, near or far.
    const auto alone = groundScene({}, {.dress = styledBehindABall(SoPickStyle::SHAPE, false)});
    const auto onTop = groundScene(GetParam(), {.dress = styledBehindABall(SoPickStyle::SHAPE_ON_TOP)});
    Rays rays;
    std::size_t hits = 0;
    for (int i = 0; i < 60; ++i) {
        const SbVec3f eye = rays.eye(), target = rays.onGround();
        const auto aim = [&](SoRayPickAction& action) { action.setRay(eye, target - eye); };
        const auto expected = pick(alone.get(), aim), found = pick(onTop.get(), aim);
        if (expected.empty()) continue;
        ASSERT_EQ(found.size(), 1u);
        EXPECT_LT((found[0].point - expected[0].point).length(), 1e-3f);
        ++hits;
    }
    EXPECT_GT(hits, 20u);
}

TEST_P(ActionPick, OfFrontFacesIsFromAboveWhateverTheHints) {
    for (const auto ordering : {SoShapeHints::COUNTERCLOCKWISE, SoShapeHints::CLOCKWISE}) {
        const auto dress = [&](SoSeparator* group) {
            auto* hints = new SoShapeHints;
            hints->vertexOrdering = ordering;
            hints->shapeType = SoShapeHints::SOLID;
            group->addChild(hints);
            auto* style = new SoPickStyle;
            style->style = SoPickStyle::SHAPE_FRONTFACES;
            group->addChild(style);
        };
        // The upper side is that of counter-clockwise triangles here.
        if (ordering == SoShapeHints::COUNTERCLOCKWISE) {
            EXPECT_GT(expectSameOnRandomRays(Pair(GetParam(), dress), 150, true), 50u);
        }
        const auto root = groundScene(GetParam(), {.dress = dress});
        const auto vertical = [](float from, float to) {
            return [=](SoRayPickAction& action) { action.setRay(SbVec3f(50.3f, 30.2f, from), SbVec3f(0.0f, 0.0f, to)); };
        };
        EXPECT_EQ(pick(root.get(), vertical(100.0f, -1.0f)).size(), 1u) << ordering;
        EXPECT_TRUE(pick(root.get(), vertical(-100.0f, 1.0f)).empty()) << ordering;
    }
}

TEST_P(ActionPick, DoesNotDependOnHowItIsDrawn) {
    for (const auto style : {SoDrawStyle::LINES, SoDrawStyle::POINTS, SoDrawStyle::INVISIBLE}) {
        const auto dress = [&](SoSeparator* group) {
            auto* draw = new SoDrawStyle;
            draw->style = style;
            group->addChild(draw);
            auto* complexity = new SoComplexity;
            complexity->value = 0.1f;
            complexity->type = SoComplexity::SCREEN_SPACE;
            group->addChild(complexity);
        };
        EXPECT_GT(expectSameOnRandomRays(Pair(GetParam(), dress), 50, true), 20u);
    }
}

TEST_P(ActionPick, GivesTextureCoordinatesOfAFunction) {
    const auto withPlane = [](std::optional<Where> where) {
        const auto root = groundScene(where, {.dress = [](SoSeparator* group) { addTexture(group); }});
        auto* dressed = static_cast<SoSeparator*>(root->getChild(2));
        auto* group = static_cast<SoSeparator*>(dressed->getChild(dressed->getNumChildren() - 1));
        auto* plane = new SoTextureCoordinatePlane;
        plane->directionS = SbVec3f(0.01f, 0.0f, 0.03f);
        plane->directionT = SbVec3f(0.0f, 0.02f, 0.0f);
        group->insertChild(plane, group->getNumChildren() - 1);
        return root;
    };
    const auto reference = withPlane({}), ours = withPlane(GetParam());
    Rays rays;
    for (int i = 0; i < 40; ++i) {
        const SbVec3f target = rays.onGround();
        const auto aim = [&](SoRayPickAction& action) { action.setRay(target + SbVec3f(1.0f, 2.0f, 60.0f), SbVec3f(-1.0f, -2.0f, -60.0f)); };
        const auto expected = pick(reference.get(), aim), found = pick(ours.get(), aim);
        ASSERT_EQ(expected.size(), found.size());
        if (!found.empty()) expectSame(expected[0], found[0], 1e-3f);
    }
}

TEST_P(ActionPick, WithoutNormalsGivesThatOfTheTriangle) {
    const auto root = groundScene(GetParam(), {.shape = {.normals = false}});
    const auto found = pick(root.get(), [](SoRayPickAction& action) { action.setRay(SbVec3f(50.3f, 30.2f, 100.0f), SbVec3f(0.0f, 0.0f, -1.0f)); });
    ASSERT_EQ(found.size(), 1u);
    const int column = int((50.3f - 8.0f) / 1.5f), row = int((30.2f - 16.0f) / 1.25f);
    const bool first = (50.3f - 8.0f) / 1.5f - float(column) + (30.2f - 16.0f) / 1.25f - float(row) <= 1.0f;
    const SbVec3f a = ground().at(column + (first ? 0 : 1), row + (first ? 0 : 1));
    SbVec3f expected = (ground().at(column + 1, row) - a).cross(ground().at(column, row + 1) - a);
    expected.normalize();
    EXPECT_GT(std::fabs(found[0].normal.dot(expected)), 0.99999f);
    EXPECT_GT(found[0].normal[2], 0.0f);
}

TEST_P(ActionPick, TellsTheCornersOfTheTriangle) {
    const auto dress = [](SoSeparator* group) {
        addTexture(group);
        colourVertices(group);
    };
    const auto reference = groundScene({}, {.dress = dress}), ours = groundScene(GetParam(), {.dress = dress});
    Rays rays;
    for (int i = 0; i < 60; ++i) {
        const SbVec3f target = rays.onGround();
        std::vector<std::vector<int>> corners[2];
        for (SoNode* root : {reference.get(), ours.get()}) {
            SoRayPickAction action(kRegion);
            action.setRay(target + SbVec3f(0.0f, 0.0f, 60.0f), SbVec3f(0.0f, 0.0f, -1.0f));
            action.apply(root);
            const SoPickedPoint* picked = action.getPickedPoint();
            if (!picked) continue;
            const auto* detail = static_cast<const SoFaceDetail*>(picked->getDetail());
            ASSERT_TRUE(detail && detail->isOfType(SoFaceDetail::getClassTypeId()));
            EXPECT_EQ(detail->isOfType(SoTerrainDetail::getClassTypeId()), root == ours.get());
            for (int k = 0; k < detail->getNumPoints(); ++k) {
                const SoPointDetail* point = detail->getPoint(k);
                corners[root == ours.get()].push_back({point->getCoordinateIndex(), point->getNormalIndex(), point->getTextureCoordIndex(), point->getMaterialIndex()});
            }
            std::sort(corners[root == ours.get()].begin(), corners[root == ours.get()].end());
        }
        EXPECT_EQ(corners[0], corners[1]) << target.toString().getString();
    }
}

INSTANTIATE_TEST_SUITE_P(, ActionPick, testing::ValuesIn(everywhere()), nameOfWhere);
