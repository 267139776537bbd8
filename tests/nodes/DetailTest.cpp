// Picks, heights and boxes of a node that adds detail to its data.
#include "Harness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include <Inventor/SoPickedPoint.h>
#include <Inventor/actions/SoGetBoundingBoxAction.h>
#include <Inventor/actions/SoRayPickAction.h>
#include <Inventor/nodes/SoCoordinate3.h>
#include <Inventor/nodes/SoSeparator.h>

#include <SoTerrain/SoBruteForceTerrain.h>
#include <SoTerrain/SoTerrainDetail.h>

#include "GridCache.h"
#include "lod/SynthesisedDetail.h"

using namespace test;

namespace {

constexpr int kColumns = 20, kRows = 14;
constexpr float kSpacing = 2.5f;

/// Needs no class of its own in Coin: it is made here alone.
class DetailedTerrain : public SoBruteForceTerrain {
public:
    std::optional<terrain::SynthesisedDetail> detail;
    terrain::DetailShape shape{3, 0.8f, 42};
    float heightInSamples(double column, double row) const { return detail->height(grid_, column, row); }

protected:
    virtual const terrain::SynthesisedDetail* detailOf(const TerrainGrid& data) {
        grid_ = data.grid;
        detail.emplace(data.grid, shape);
        return &*detail;
    }

private:
    terrain::SampleGrid grid_;
};

/// Waves of heights along y, as VRML has them: rows run along z.
struct Scene {
    Ref<SoSeparator> root{new SoSeparator};
    DetailedTerrain* terrain;
    Scene() {
        SoCoordinate3* points = new SoCoordinate3;
        for (int row = 0; row < kRows; ++row)
            for (int column = 0; column < kColumns; ++column) {
                const float height = 4.0f * std::sin(0.6f * float(column)) * std::cos(0.5f * float(row));
                points->point.set1Value(row * kColumns + column, kSpacing * float(column), height, kSpacing * float(row));
            }
        terrain = new DetailedTerrain;
        terrain->verticesPerRow = kColumns;
        terrain->verticesPerColumn = kRows;
        root->addChild(points);
        root->addChild(terrain);
    }
};

float uniform(std::mt19937& random, float low, float high) {
    return low + (high - low) * std::uniform_real_distribution<float>()(random);
}

}  // namespace

TEST(Detail, IsInHeightsAndPicks) {
    Scene scene;
    std::mt19937 random{3};
    double differences = 0.0;
    for (int i = 0; i < 200; ++i) {
        const float x = uniform(random, 0.0f, kSpacing * (kColumns - 1)), z = uniform(random, 0.0f, kSpacing * (kRows - 1));
        float height = 0.0f, plain = 0.0f;
        ASSERT_TRUE(scene.terrain->heightAt(x, z, height));
        EXPECT_NEAR(height, scene.terrain->heightInSamples(x / kSpacing, z / kSpacing), 1e-4f);

        SoRayPickAction action(SbViewportRegion(320, 240));
        action.setRay({x, 100.0f, z}, {0.0f, -1.0f, 0.0f});
        action.apply(scene.root.get());
        const SoPickedPoint* picked = action.getPickedPoint();
        ASSERT_TRUE(picked);
        EXPECT_NEAR(picked->getPoint()[1], height, 1e-3f);
        const auto* detail = static_cast<const SoTerrainDetail*>(picked->getDetail());
        EXPECT_EQ(detail->getColumn(), int(x / kSpacing));
        EXPECT_EQ(detail->getRow(), int(z / kSpacing));

        scene.terrain->shape.levels = 0;
        ASSERT_TRUE(scene.terrain->heightAt(x, z, plain));
        scene.terrain->shape.levels = 3;
        differences += std::fabs(height - plain) / 200.0;
    }
    EXPECT_GT(differences, 0.2);
}

TEST(Detail, HasTheNormalOfItsFinestTriangles) {
    Scene scene;
    // In the midst of a triangle of the finest level, an eighth of a sample wide.
    for (int i = 0; i < 40; ++i) {
        const float finest = kSpacing / 8.0f, x = (3.0f * float(i) + 0.3f) * finest, z = (2.0f * float(i) + 0.3f) * finest;
        float height = 0.0f, right = 0.0f, up = 0.0f;
        SbVec3f normal;
        ASSERT_TRUE(scene.terrain->heightAt(x, z, height, &normal));
        ASSERT_TRUE(scene.terrain->heightAt(x + 0.2f * finest, z, right));
        ASSERT_TRUE(scene.terrain->heightAt(x, z + 0.2f * finest, up));
        SbVec3f expected(-(right - height) / (0.2f * finest), 1.0f, -(up - height) / (0.2f * finest));
        expected.normalize();
        EXPECT_GT(normal.dot(expected), 0.9999f) << i;
    }
}

TEST(Detail, IsInTheBoundingBox) {
    Scene scene;
    SoGetBoundingBoxAction action(SbViewportRegion(320, 240));
    action.apply(scene.root.get());
    const SbBox3f box = action.getBoundingBox();
    float lowest = 1e9f, highest = -1e9f;
    for (int row = 0; row <= (kRows - 1) * 8; ++row)
        for (int column = 0; column <= (kColumns - 1) * 8; ++column) {
            const float height = scene.terrain->heightInSamples(column / 8.0, row / 8.0);
            lowest = std::min(lowest, height);
            highest = std::max(highest, height);
        }
    EXPECT_LE(box.getMin()[1], lowest);
    EXPECT_GE(box.getMax()[1], highest);
    EXPECT_GT(highest, 4.0f) << "which the samples do not reach";
    EXPECT_NEAR(box.getMax()[0], kSpacing * (kColumns - 1), 1e-3f);
}
