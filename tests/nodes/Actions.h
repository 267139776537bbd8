// Every terrain node over coordinates and over a height map, beside Coin's triangles of the same ground: what the tests of actions share.
#pragma once

#include "Scenes.h"

#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include <Inventor/SbViewportRegion.h>

#include <gtest/gtest.h>

namespace test {

/// A terrain node and where its samples come from.
struct Where {
    Kind kind;
    bool overMap;
};
std::vector<Where> everywhere();
std::string nameOfWhere(const testing::TestParamInfo<Where>& info);
std::ostream& operator<<(std::ostream& out, const Where& where);

/// Base of the suites whose tests docs/actions.md lists.
class OnEveryNode : public testing::TestWithParam<Where> {};

/// Hills of 41 x 29 samples with holes inside, at a corner and along a border, away from zero; heights are exact as 16-bit samples.
const Surface& ground();
/// The same without holes.
const Surface& wholeGround();
/// A headerless file of them, for an SoHeightMap of groundMap().
std::string groundFile(bool holes = true);
/// An SoHeightMap that reads the file: the ground, sample for sample.
SoNode* groundMap(bool holes = true);

struct GroundOptions {
    ShapeOptions shape = {};
    Dressing dress = {};
    SoCamera* camera = nullptr;
    bool holes = true;
};
/// Camera, light and the ground by a node of ours, or by Coin's triangles where there is none.
Ref<SoSeparator> groundScene(std::optional<Where> where, const GroundOptions& options = {});
/// The ground's separator alone.
Ref<SoSeparator> groundShape(std::optional<Where> where, const ShapeOptions& options = {}, bool holes = true);

inline const SbViewportRegion kRegion{320, 240};

/// The first node of a type below, also where it is switched off.
template <class T>
T* findIn(SoNode* root);
SoNode* findIn(SoNode* root, SoType type);
template <class T>
T* findIn(SoNode* root) {
    return static_cast<T*>(findIn(root, T::getClassTypeId()));
}

SbBox3f boxOf(SoNode* root);
/// The scene as a file's text, and what reading it gives.
std::string written(SoNode* root, bool binary = false);
Ref<SoSeparator> readBack(const std::string& text);

}  // namespace test
