// A terrain over heights that a program makes and changes.
#pragma once

#include "Scenes.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <Inventor/SoPickedPoint.h>
#include <Inventor/actions/SoGetBoundingBoxAction.h>
#include <Inventor/actions/SoRayPickAction.h>
#include <Inventor/nodes/SoDirectionalLight.h>

#include <SoTerrain/SoChunkedLoDTerrain.h>
#include <SoTerrain/SoHeightMap.h>

namespace test {

using Heights = std::vector<float>;
inline constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

inline Heights hills(int side) {
    const terrain::HeightMap map = fractalMap(side, side, 0.12 * side);
    return Heights(map.heights.begin(), map.heights.end());
}

/// A round hill on top of what is there, or a hollow.
inline Heights bumped(SoHeightMap* map, int column, int row, int size, float height) {
    Heights heights(std::size_t(size) * std::size_t(size));
    EXPECT_TRUE(map->getHeights(column, row, size, size, heights.data()));
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const double r = std::hypot(2.0 * x / (size - 1) - 1.0, 2.0 * y / (size - 1) - 1.0);
            if (r < 1.0) heights[std::size_t(y * size + x)] += height * float(0.5 + 0.5 * std::cos(3.14159265 * r));
        }
    return heights;
}

inline SoCamera* overhead(int side) {
    const float s = float(side);
    return cameraAt(SbVec3f(0.15f * s, 0.1f * s, 0.35f * s), SbVec3f(0.5f * s, 0.5f * s, 0.05f * s), 0.01f * s, 3.0f * s);
}

/// A terrain over a map of the program's making.
struct EditScene {
    Ref<SoSeparator> root = new SoSeparator;
    SoHeightMap* map = new SoHeightMap;
    SoTerrainShape* node;

    EditScene(Kind kind, int side, const Heights& heights, float pixelError = 1.0f, bool textured = false) : node(nodeOf(kind, 0, 0, pixelError)) {
        root->addChild(overhead(side));
        auto* light = new SoDirectionalLight;
        light->direction = SbVec3f(0.6f, -0.3f, -0.7f);
        root->addChild(light);
        if (textured) addTexture(root.get(), 32);
        root->addChild(map);
        root->addChild(node);
        EXPECT_TRUE(map->setHeights(side, side, heights.data()));
        if (auto* tiles = dynamic_cast<SoChunkedLoDTerrain*>(node)) tiles->background = FALSE;
    }

    SbBox3f box() const {
        SoGetBoundingBoxAction action(SbViewportRegion(100, 100));
        action.apply(root.get());
        return action.getBoundingBox();
    }
    float heightAt(float x, float y) const {
        float height = kNaN;
        node->heightAt(x, y, height);
        return height;
    }
    float pickedHeight(float x, float y) const {
        SoRayPickAction action(SbViewportRegion(100, 100));
        action.setRay(SbVec3f(x, y, 5000.0f), SbVec3f(0.0f, 0.0f, -1.0f));
        action.apply(root.get());
        const SoPickedPoint* point = action.getPickedPoint();
        return point ? point->getPoint()[2] : kNaN;
    }
};

/// The same scene with nodes that have seen nothing of what was before.
inline EditScene fresh(const EditScene& scene, Kind kind, bool textured = false) {
    int columns = 0, rows = 0;
    EXPECT_TRUE(scene.map->getSize(columns, rows));
    Heights heights(std::size_t(columns) * std::size_t(rows));
    EXPECT_TRUE(scene.map->getHeights(0, 0, columns, rows, heights.data()));
    EditScene made(kind, columns, heights, scene.node->pixelError.getValue(), textured);
    made.root->replaceChild(0, scene.root->getChild(0));
    made.map->spacing = scene.map->spacing.getValue();
    made.map->origin = scene.map->origin.getValue();
    return made;
}

/// Both drawn, and looked at: alike to the last bit where the mesh is the samples, else within what the promise leaves.
inline void expectLikeFresh(Stage& stage, const EditScene& scene, Kind kind, const std::string& what, bool textured = false) {
    const terrain::Image edited = stage.render(scene.root.get());
    const EditScene other = fresh(scene, kind, textured);
    const terrain::Image expected = stage.render(other.root.get());
    expectAlike(expected, edited, kind == Kind::BruteForce ? 0.0 : kind == Kind::Clipmap ? 0.2 : 1.5, what);
    if (kind != Kind::Clipmap) {
        EXPECT_LE(scene.node->getStatistics().errorPixels, scene.node->pixelError.getValue()) << what;
    }
}

}  // namespace test
