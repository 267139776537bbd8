// Picks hit what the full-resolution triangles hit, whatever is on screen.
#include "Scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include <Inventor/SoPickedPoint.h>
#include <Inventor/actions/SoRayPickAction.h>
#include <Inventor/nodes/SoClipPlane.h>
#include <Inventor/nodes/SoPickStyle.h>
#include <Inventor/nodes/SoTransform.h>

#include <SoTerrain/SoTerrainDetail.h>

using namespace test;

namespace {

constexpr float kHole = std::numeric_limits<float>::quiet_NaN();

Surface hillsWithHoles() {
    auto map = fractalMap(75, 51, 20.0);
    for (int row = 20; row < 30; ++row)
        for (int column = 30; column < 45; ++column) map.heights[std::size_t(row * 75 + column)] = kHole;
    return surfaceOf(map);
}

struct Hit {
    SbVec3f point;
    int row = -1, column = -1, triangle = -1;
    float height = 0.0f;
};

std::vector<Hit> pick(SoNode* root, const SbVec3f& origin, const SbVec3f& direction, bool all = false) {
    SoRayPickAction action(SbViewportRegion(320, 240));
    action.setRay(origin, direction);
    action.setPickAll(all);
    action.apply(root);
    std::vector<Hit> hits;
    for (int i = 0; i < action.getPickedPointList().getLength(); ++i) {
        const SoPickedPoint* picked = action.getPickedPointList()[i];
        Hit hit{picked->getPoint()};
        if (const SoDetail* detail = picked->getDetail(); detail && detail->isOfType(SoTerrainDetail::getClassTypeId())) {
            const auto* terrain = static_cast<const SoTerrainDetail*>(detail);
            hit.row = terrain->getRow();
            hit.column = terrain->getColumn();
            hit.triangle = terrain->getTriangle();
            hit.height = terrain->getHeight();
        }
        hits.push_back(hit);
    }
    return hits;
}

/// Scenes with Coin's triangles and with ours, under the same properties.
struct Pair {
    Ref<SoSeparator> reference, ours;
    Pair(Kind kind, const Surface& surface, const Dressing& dress = {})
        : reference(sceneOf(Kind::Reference, surface, {}, dress)), ours(sceneOf(kind, surface, {}, dress)) {}

    /// Both hit the same points; returns how many.
    std::size_t expectSame(const SbVec3f& origin, const SbVec3f& direction, bool all) const {
        const auto expected = pick(reference.get(), origin, direction, all), found = pick(ours.get(), origin, direction, all);
        // A ray through an edge hits one triangle or both, as rounding has it.
        std::size_t distinct = 0, i = 0;
        for (; i < expected.size(); ++i) distinct += i == 0 || (expected[i].point - expected[i - 1].point).length() > 2e-3f;
        std::size_t foundDistinct = 0;
        for (i = 0; i < found.size(); ++i) foundDistinct += i == 0 || (found[i].point - found[i - 1].point).length() > 2e-3f;
        EXPECT_EQ(foundDistinct, distinct);
        if (expected.empty() || found.empty()) return 0;
        EXPECT_LT((expected.front().point - found.front().point).length(), 2e-3f);
        EXPECT_LT((expected.back().point - found.back().point).length(), 2e-3f);
        return foundDistinct;
    }
};

class Rays {
public:
    explicit Rays(const SbBox3f& box) : box_(box) {}
    SbVec3f inBox() { return {between(box_.getMin()[0], box_.getMax()[0]), between(box_.getMin()[1], box_.getMax()[1]), between(box_.getMin()[2], box_.getMax()[2])}; }
    float between(float low, float high) { return low + (high - low) * std::uniform_real_distribution<float>()(random_); }

private:
    SbBox3f box_;
    std::mt19937 random_{7};
};

class Picks : public testing::TestWithParam<Kind> {};

}  // namespace

TEST_P(Picks, FromAnywhereHitWhatTheTrianglesHit) {
    const Surface surface = hillsWithHoles();
    const Pair pair(GetParam(), surface);
    Rays rays(surface.box());
    std::size_t hits = 0;
    for (int i = 0; i < 400; ++i) {
        const SbVec3f eye(rays.between(-60.0f, 130.0f), rays.between(-60.0f, 110.0f), rays.between(5.0f, 60.0f));
        hits += pair.expectSame(eye, rays.inBox() - eye, i % 2 == 1);
        if (HasFailure()) FAIL() << "ray " << i;
    }
    EXPECT_GT(hits, 200u);
}

TEST_P(Picks, AlongTheGroundHitEverySlopeInTheWay) {
    const Surface surface = surfaceOf(mapOf(65, 65, [](double x, double y) { return 2.0 + std::sin(37.7 * x) + 0.2 * y; }));
    const Pair pair(GetParam(), surface);
    std::size_t most = 0;
    for (float y = 1.3f; y < 60.0f; y += 7.0f) most = std::max(most, pair.expectSame({-10.0f, y, 2.1f}, {1.0f, 0.0f, 0.001f}, true));
    EXPECT_GE(most, 10u);
}

TEST_P(Picks, TellColumnRowTriangleAndHeight) {
    const Surface surface = hillsWithHoles();
    const auto root = sceneOf(GetParam(), surface);
    Rays rays(surface.box());
    for (int i = 0; i < 200; ++i) {
        const float x = rays.between(0.0f, 74.0f), y = rays.between(0.0f, 50.0f);
        const int column = int(x), row = int(y);
        const auto hits = pick(root.get(), {x, y, 100.0f}, {0.0f, 0.0f, -1.0f});
        if (surface.isCellHole(column, row)) {
            EXPECT_TRUE(hits.empty()) << "a hole at " << x << ", " << y;
            continue;
        }
        ASSERT_EQ(hits.size(), 1u) << x << ", " << y;
        EXPECT_EQ(hits[0].column, column);
        EXPECT_EQ(hits[0].row, row);
        EXPECT_EQ(hits[0].triangle, (x - float(column)) + (y - float(row)) <= 1.0f ? 0 : 1);
        EXPECT_FLOAT_EQ(hits[0].height, hits[0].point[2]);
    }
}

TEST_P(Picks, GiveTheCornersOfTheTriangleAsAFaceDetail) {
    const Surface surface = hillsWithHoles();
    const auto root = sceneOf(GetParam(), surface);
    SoRayPickAction action(SbViewportRegion(320, 240));
    action.setRay({10.7f, 5.8f, 100.0f}, {0.0f, 0.0f, -1.0f});
    action.apply(root.get());
    ASSERT_NE(action.getPickedPoint(), nullptr);
    const auto* detail = static_cast<const SoTerrainDetail*>(action.getPickedPoint()->getDetail());
    ASSERT_NE(detail, nullptr);
    ASSERT_EQ(detail->getNumPoints(), 3);
    EXPECT_EQ(detail->getFaceIndex(), 5 * 74 + 10);
    SbBox3f corners;
    for (int i = 0; i < 3; ++i) corners.extendBy(surface.points[std::size_t(detail->getPoint(i)->getCoordinateIndex())]);
    EXPECT_TRUE(corners.getMin()[0] == 10.0f && corners.getMax()[0] == 11.0f && corners.getMin()[1] == 5.0f && corners.getMax()[1] == 6.0f);
    const SbVec3f normal = action.getPickedPoint()->getNormal();
    EXPECT_GT(normal[2], 0.2f);
    EXPECT_NEAR(normal.length(), 1.0f, 1e-4f);
    EXPECT_EQ(action.getPickedPoint()->getPath()->getTail(), terrainIn(root.get()));
}

TEST_P(Picks, ThroughTransformsHitTheSamePoint) {
    const Surface surface = hillsWithHoles();
    const Pair pair(GetParam(), surface, [](SoSeparator* group) {
        auto* transform = new SoTransform;
        transform->translation = SbVec3f(5.0f, -20.0f, 3.0f);
        transform->rotation = SbRotation(SbVec3f(0.2f, 0.5f, 1.0f), 0.7f);
        transform->scaleFactor = SbVec3f(1.5f, 0.8f, 0.6f);
        group->addChild(transform);
    });
    Rays rays(SbBox3f(-20.0f, -20.0f, -20.0f, 80.0f, 80.0f, 20.0f));
    std::size_t hits = 0;
    for (int i = 0; i < 200; ++i) {
        const SbVec3f eye = rays.inBox() + SbVec3f(0.0f, 0.0f, 90.0f);
        hits += pair.expectSame(eye, rays.inBox() - eye, true);
    }
    EXPECT_GT(hits, 50u);
}

TEST_P(Picks, OfCurvedGridsHitWhatTheTrianglesHit) {
    const Surface roll = surfaceOf(mapOf(65, 65, [](double, double) { return 0.0; }), [](int column, int row, float) {
        const float turn = float(column) * 0.15f, radius = 6.0f + 0.1f * float(column);
        return SbVec3f(radius * std::cos(turn), float(row) * 0.4f, radius * std::sin(turn));
    });
    const Pair pair(GetParam(), roll);
    Rays rays(roll.box());
    std::size_t hits = 0;
    for (int i = 0; i < 200; ++i) {
        const SbVec3f eye = rays.inBox() * 3.0f;
        hits += pair.expectSame(eye, rays.inBox() - eye, true);
    }
    EXPECT_GT(hits, 200u);
}

TEST_P(Picks, LookThroughWhatIsUnpickable) {
    const auto root = sceneOf(GetParam(), hillsWithHoles(), {}, [](SoSeparator* group) {
        auto* style = new SoPickStyle;
        style->style = SoPickStyle::UNPICKABLE;
        group->addChild(style);
    });
    EXPECT_TRUE(pick(root.get(), {10.3f, 10.3f, 100.0f}, {0.0f, 0.0f, -1.0f}).empty());
}

TEST_P(Picks, LookThroughWhatAClipPlaneCutsAway) {
    const Surface surface = hillsWithHoles();
    const auto root = sceneOf(GetParam(), surface, {}, [](SoSeparator* group) {
        auto* plane = new SoClipPlane;
        plane->plane = SbPlane(SbVec3f(1.0f, 0.0f, 0.0f), 40.0f);
        group->addChild(plane);
    });
    EXPECT_TRUE(pick(root.get(), {20.3f, 10.3f, 100.0f}, {0.0f, 0.0f, -1.0f}, true).empty());
    EXPECT_EQ(pick(root.get(), {60.3f, 10.3f, 100.0f}, {0.0f, 0.0f, -1.0f}, true).size(), 1u);
}

TEST_P(Picks, ThroughThePixelsOfAViewHitWhatTheTrianglesHit) {
    const Surface surface = hillsWithHoles();
    const Pair pair(GetParam(), surface);
    Stage stage;
    stage.render(pair.ours.get());
    int hits = 0;
    for (short x = 5; x < 320; x = short(x + 21))
        for (short y = 5; y < 240; y = short(y + 21)) {
            SbVec3f points[2];
            int found = 0;
            for (const auto& root : {pair.reference, pair.ours}) {
                SoRayPickAction action(SbViewportRegion(320, 240));
                action.setPoint(SbVec2s(x, y));
                action.setRadius(0.0f);
                action.apply(root.get());
                if (action.getPickedPoint()) points[root.get() == pair.ours.get()] = action.getPickedPoint()->getPoint(), ++found;
            }
            ASSERT_NE(found, 1) << x << ", " << y;
            EXPECT_LT(found == 2 ? (points[0] - points[1]).length() : 0.0f, 2e-3f) << x << ", " << y;
            hits += found / 2;
        }
    EXPECT_GT(hits, 30);
}

TEST_P(Picks, FromAboveAgreeWithHeightAt) {
    const Surface surface = hillsWithHoles();
    const auto root = sceneOf(GetParam(), surface);
    SoTerrainShape* node = terrainIn(root.get());
    Rays rays(surface.box());
    for (int i = 0; i < 100; ++i) {
        const float x = rays.between(-2.0f, 76.0f), y = rays.between(-2.0f, 52.0f);
        float height = -99.0f;
        SbVec3f normal;
        const SbBool found = node->heightAt(x, y, height, &normal);
        const auto hits = pick(root.get(), {x, y, 100.0f}, {0.0f, 0.0f, -1.0f});
        ASSERT_EQ(found, !hits.empty()) << x << ", " << y;
        if (!found) {
            EXPECT_EQ(height, -99.0f);
            continue;
        }
        EXPECT_NEAR(height, hits[0].point[2], 1e-3f);
        EXPECT_GT(normal[2], 0.0f);
        EXPECT_NEAR(normal.length(), 1.0f, 1e-4f);
    }
}

TEST_P(Picks, OfASampleGiveItsHeight) {
    const Surface surface = hillsWithHoles();
    const auto root = sceneOf(GetParam(), surface);
    for (const auto& [column, row] : {std::pair{0, 0}, {74, 0}, {0, 50}, {74, 50}, {12, 33}}) {
        float height = 0.0f;
        EXPECT_TRUE(terrainIn(root.get())->heightAt(float(column), float(row), height));
        EXPECT_EQ(height, surface.at(column, row)[2]) << column << ", " << row;
    }
}

TEST(HeightAt, OfYUpGridsTakesTheTwoOtherAxes) {
    const Surface surface = surfaceOf(fractalMap(33, 33, 5.0), [](int column, int row, float height) { return SbVec3f(float(column), height, -float(row)); });
    const auto root = sceneOf(Kind::Roam, surface);
    float height = 0.0f;
    SbVec3f normal;
    ASSERT_TRUE(terrainIn(root.get())->heightAt(7.0f, -9.0f, height, &normal));
    EXPECT_EQ(height, surface.at(7, 9)[1]);
    EXPECT_GT(normal[1], 0.0f);
}

TEST(HeightAt, WithoutDataFindsNothing) {
    Messages messages;
    Ref<SoTerrainShape> node(nodeOf(Kind::Roam, 0, 0));
    float height = 3.0f;
    EXPECT_FALSE(node->heightAt(0.0f, 0.0f, height));
    EXPECT_EQ(height, 3.0f);
    EXPECT_LE(messages.all().size(), 1u) << messages.text();
}

TEST(HeightAt, LeavesANodeThatNobodyOwnsAlive) {
    auto* group = shapeOf(Kind::BruteForce, surfaceOf(mapOf(5, 5, [](double x, double) { return x; })));
    auto* node = static_cast<SoTerrainShape*>(group->getChild(group->getNumChildren() - 1));
    float height = 0.0f;
    EXPECT_TRUE(node->heightAt(2.0f, 2.0f, height));
    EXPECT_FLOAT_EQ(height, 0.5f);
    EXPECT_TRUE(node->heightAt(1.0f, 2.0f, height));
    group->ref();
    group->unref();
}

INSTANTIATE_TEST_SUITE_P(, Picks, testing::ValuesIn(kOurKinds),
                         [](const auto& info) { return "On" + identifierOf(info.param); });
