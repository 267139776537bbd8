// Holes are holes for every action, and a terrain far from zero or under Coin's geographic nodes is met where it is.
#include "Actions.h"

#include <gtest/gtest.h>

#include <cmath>

#include <Inventor/SoPickedPoint.h>
#include <Inventor/actions/SoGetMatrixAction.h>
#include <Inventor/actions/SoRayPickAction.h>
#include <Inventor/actions/SoSearchAction.h>
#include <Inventor/nodes/SoCoordinate3.h>
#include <Inventor/nodes/SoGeoOrigin.h>
#include <Inventor/nodes/SoGeoSeparator.h>
#include <Inventor/nodes/SoOrthographicCamera.h>

#include <SoTerrain/SoHeightMap.h>
#include <SoTerrain/SoTerrainDetail.h>

using namespace test;

namespace {

/// Places in the ground's frame, (column, row).
SbVec3f placeOf(float column, float row, float height) { return {8.0f + 1.5f * column, 16.0f + 1.25f * row, height}; }

struct Geo {
    const char* system;
    const char* zone;
    SbVec3d origin, place;
};
const Geo kGeos[] = {
    {"UTM", "Z33", {500000.0, 5000000.0, 0.0}, {500000.0, 5000000.0, 0.0}},
    {"UTM", "Z33", {500000.0, 5000000.0, 0.0}, {500040.0, 5000020.0, 3.0}},
    {"GD", "", {45.15, 15.0, 0.0}, {45.1502, 15.0003, 2.0}},
};

/// The ground under a SoGeoSeparator.
Ref<SoSeparator> geoScene(std::optional<Where> where, const Geo& geo) {
    const auto scene = groundScene(where, {.dress = unlitTexture});
    auto* origin = new SoGeoOrigin;
    auto* separator = new SoGeoSeparator;
    origin->geoSystem.set1Value(0, geo.system);
    separator->geoSystem.set1Value(0, geo.system);
    if (*geo.zone) {
        origin->geoSystem.set1Value(1, geo.zone);
        separator->geoSystem.set1Value(1, geo.zone);
    } else {
        origin->geoSystem.deleteValues(1);
        separator->geoSystem.deleteValues(1);
    }
    origin->geoCoords = geo.origin;
    separator->geoCoords = geo.place;
    separator->addChild(scene->getChild(2));
    scene->replaceChild(2, origin);
    scene->addChild(separator);
    return scene;
}

/// The ground so far away that single precision knows steps of half a unit there: 2^19 east, 5 * 2^20 north.
constexpr float kFarX = 524288.0f, kFarY = 5242880.0f;
Ref<SoSeparator> farScene(const Where& where) {
    auto root = groundShape(where, {.normals = false});
    if (where.overMap) {
        auto* map = findIn<SoHeightMap>(root.get());
        map->origin = map->origin.getValue() + SbVec2f(kFarX, kFarY);
        // Rows a whole unit apart stay where they are.
        map->spacing = SbVec2f(1.5f, 1.0f);
    } else {
        auto* coordinates = findIn<SoCoordinate3>(root.get());
        SbVec3f* points = coordinates->point.startEditing();
        for (int i = 0; i < coordinates->point.getNum(); ++i) points[i].setValue(points[i][0] + kFarX, kFarY + 16.0f + float(i / 41), points[i][2]);
        coordinates->point.finishEditing();
    }
    return root;
}

class ActionHole : public OnEveryNode {};
class ActionPlace : public OnEveryNode {};

}  // namespace

TEST_P(ActionHole, IsOpenToPicksAndHeightsAndTellsNoHeight) {
    const auto root = groundScene(GetParam());
    SoTerrainShape* node = terrainIn(root.get());
    int open = 0;
    for (int row = 0; row < ground().rows - 1; ++row)
        for (int column = 0; column < ground().columns - 1; column += 2) {
            const SbVec3f place = placeOf(float(column) + 0.3f, float(row) + 0.4f, 90.0f);
            SoRayPickAction action(kRegion);
            action.setRay(place, SbVec3f(0.0f, 0.0f, -1.0f));
            action.setPickAll(TRUE);
            action.apply(root.get());
            float height = -1.0f;
            const bool hole = ground().isCellHole(column, row);
            EXPECT_EQ(action.getPickedPointList().getLength(), hole ? 0 : 1) << column << ", " << row;
            EXPECT_EQ(node->heightAt(place[0], place[1], height), !hole) << column << ", " << row;
            if (hole) {
                EXPECT_EQ(height, -1.0f);
            }
            open += hole;
        }
    EXPECT_GT(open, 30);
}

TEST_P(ActionHole, CoversThePixelsThatItCoversInCoinsShape) {
    // From straight above heights move nothing: what is covered is a matter of holes alone.
    auto* camera = new SoOrthographicCamera;
    Ref<SoCamera> kept(camera);
    camera->position = SbVec3f(38.0f, 33.5f, 60.0f);
    camera->height = 44.0f;
    camera->farDistance = 100.0f;
    Stage stage;
    const auto expected = stage.render(groundScene({}, {.dress = unlitTexture, .camera = camera}).get());
    const auto found = stage.render(groundScene(GetParam(), {.dress = unlitTexture, .camera = camera}).get());
    savePicture("action_holes_" + nameOfWhere({GetParam(), 0}), {expected, found});
    int differ = 0;
    for (std::size_t i = 0; i < expected.pixels.size(); i += 3) {
        const auto isCovered = [&](const terrain::Image& image) { return image.pixels[i] != kBackground[0] || image.pixels[i + 1] != kBackground[1] || image.pixels[i + 2] != kBackground[2]; };
        differ += isCovered(expected) != isCovered(found);
    }
    EXPECT_LE(differ, 4);
    EXPECT_GT(coveredPixels(expected), 30000);
}

TEST_P(ActionPlace, UnderGeographicNodesLooksAndPicksAsCoinsShape) {
    Stage stage(160, 120);
    for (const Geo& geo : kGeos) {
        SCOPED_TRACE(std::string(geo.system) + " " + std::to_string(geo.place[0]));
        const auto reference = geoScene({}, geo), ours = geoScene(GetParam(), geo);
        const auto expected = stage.render(reference.get()), found = stage.render(ours.get());
        savePicture("action_geo_" + nameOfWhere({GetParam(), 0}), {expected, found});
        expectAlike(expected, found, GetParam().kind == Kind::BruteForce ? 0.5 : 4.0, geo.system);
        int hits = 0;
        for (short x = 10; x < 320; x = short(x + 60))
            for (short y = 10; y < 240; y = short(y + 50)) {
                SbVec3f points[2] = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
                int met = 0;
                for (SoNode* root : {static_cast<SoNode*>(reference.get()), static_cast<SoNode*>(ours.get())}) {
                    SoRayPickAction action(kRegion);
                    action.setPoint(SbVec2s(x, y));
                    action.apply(root);
                    if (!action.getPickedPoint()) continue;
                    points[root == ours.get()] = action.getPickedPoint()->getPoint();
                    ++met;
                }
                EXPECT_NE(met, 1);
                EXPECT_LT((points[0] - points[1]).length(), 2e-3f);
                hits += met == 2;
            }
        EXPECT_GT(hits, 2);
    }
}

TEST_P(ActionPlace, OverGeographicOriginIsThatAtZero) {
    // Coin places it relative to the origin in double precision: nothing is lost.
    Stage stage(160, 120);
    const auto expected = stage.render(groundScene(GetParam(), {.dress = unlitTexture}).get()), found = stage.render(geoScene(GetParam(), kGeos[0]).get());
    expectAlike(expected, found, 0.2, "at the origin", 1);
}

TEST_P(ActionPlace, FarFromZeroIsPickedToSinglePrecision) {
    const auto root = farScene(GetParam());
    SoTerrainShape* node = terrainIn(root.get());
    int hits = 0;
    for (int row = 0; row < ground().rows - 1; row += 3)
        for (int column = 0; column < ground().columns - 1; ++column) {
            // Half a row: a float there.
            const float x = kFarX + 8.0f + 1.5f * float(column) + 0.5f, y = kFarY + 16.0f + float(row) + 0.5f;
            for (const SbVec3f& direction : {SbVec3f(0.0f, 0.0f, -1.0f), SbVec3f(0.3f, -0.2f, -1.0f)}) {
                const bool straight = direction[0] == 0.0f;
                SoRayPickAction action(kRegion);
                const SbVec3f start = straight ? SbVec3f(x, y, 64.0f) : SbVec3f(x - 16.0f, y + 11.0f, 64.0f);
                action.setRay(start, direction);
                action.apply(root.get());
                const SoPickedPoint* picked = action.getPickedPoint();
                EXPECT_FALSE(straight && ground().isCellHole(column, row) && picked);
                if (!picked) continue;
                ++hits;
                const auto* detail = static_cast<const SoTerrainDetail*>(picked->getDetail());
                if (straight) {
                    EXPECT_EQ(detail->getColumn(), column);
                    EXPECT_EQ(detail->getRow(), row);
                    float height = 0.0f;
                    ASSERT_TRUE(node->heightAt(x, y, height));
                    EXPECT_NEAR(picked->getObjectPoint()[2], height, 1e-3f);
                }
                // On the ray, as well as floats tell: 0.03 in x and 0.5 in y.
                const SbVec3f along = direction * ((picked->getObjectPoint()[2] - start[2]) / direction[2]) + start;
                EXPECT_NEAR(picked->getObjectPoint()[0], along[0], 0.04f);
                EXPECT_NEAR(picked->getObjectPoint()[1], along[1], 0.51f);
            }
        }
    EXPECT_GT(hits, 300);
}

INSTANTIATE_TEST_SUITE_P(, ActionHole, testing::ValuesIn(everywhere()), nameOfWhere);
INSTANTIATE_TEST_SUITE_P(, ActionPlace, testing::ValuesIn(everywhere()), nameOfWhere);
