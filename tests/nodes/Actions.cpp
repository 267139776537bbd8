#include "Actions.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>

#include <Inventor/SoDB.h>
#include <Inventor/SoInput.h>
#include <Inventor/SoOutput.h>
#include <Inventor/actions/SoGetBoundingBoxAction.h>
#include <Inventor/actions/SoSearchAction.h>
#include <Inventor/actions/SoWriteAction.h>
#include <Inventor/nodes/SoCoordinate3.h>

#include <SoTerrain/SoHeightMap.h>

namespace test {

namespace {

constexpr int kColumns = 41, kRows = 29;
constexpr std::uint16_t kNothing = 65535;
// Powers of two: heights and places are exact in single precision.
constexpr float kScale = 1.0f / 2048.0f;
constexpr float kSpacingX = 1.5f, kSpacingY = 1.25f, kOriginX = 8.0f, kOriginY = 16.0f;

bool isHole(int column, int row) {
    return std::hypot(column - 14, row - 11) < 4.0 || (column > 37 && row > 26) || (row == 0 && column > 20 && column < 26) ||
           (column == 30 && row == 20);
}

/// From south to north.
std::vector<std::uint16_t> samples(bool holes) {
    const auto map = fractalMap(kColumns, kRows, 20.0, 5);
    std::vector<std::uint16_t> all;
    for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < kColumns; ++column)
            all.push_back(holes && isHole(column, row) ? kNothing : std::uint16_t(map.at(column, row) / kScale));
    return all;
}

Surface makeGround(bool holes) {
    terrain::HeightMap map;
    map.columns = kColumns;
    map.rows = kRows;
    map.spacing = {kSpacingX, kSpacingY};
    map.origin = {kOriginX, kOriginY};
    for (const std::uint16_t sample : samples(holes))
        map.heights.push_back(sample == kNothing ? std::numeric_limits<float>::quiet_NaN() : float(sample) * kScale);
    return surfaceOf(map);
}

void* reallocate(void* pointer, std::size_t size) { return std::realloc(pointer, size); }

/// Puts a height map in the place of the coordinates.
void useMap(SoNode* root, bool holes) {
    SoSearchAction search;
    search.setType(SoCoordinate3::getClassTypeId());
    search.apply(root);
    auto* path = static_cast<SoFullPath*>(search.getPath());
    static_cast<SoGroup*>(path->getNodeFromTail(1))->replaceChild(path->getIndexFromTail(0), groundMap(holes));
}

}  // namespace

std::vector<Where> everywhere() {
    std::vector<Where> all;
    for (const Kind kind : kOurKinds)
        for (const bool overMap : {false, true}) all.push_back({kind, overMap});
    return all;
}

std::string nameOfWhere(const testing::TestParamInfo<Where>& info) {
    return identifierOf(info.param.kind) + (info.param.overMap ? "OverHeightMap" : "OverCoordinates");
}

std::ostream& operator<<(std::ostream& out, const Where& where) {
    return out << nameOf(where.kind) << (where.overMap ? " over a height map" : " over coordinates");
}

const Surface& ground() {
    static const Surface surface = makeGround(true);
    return surface;
}

const Surface& wholeGround() {
    static const Surface surface = makeGround(false);
    return surface;
}

std::string groundFile(bool holes) {
    static const TemporaryFolder folder;
    const std::string path = folder.file(holes ? "ground.raw" : "whole.raw");
    if (std::ifstream(path)) return path;
    const auto all = samples(holes);
    std::ofstream file(path, std::ios::binary);
    for (int row = kRows - 1; row >= 0; --row)
        for (int column = 0; column < kColumns; ++column) {
            const std::uint16_t sample = all[std::size_t(row * kColumns + column)];
            file.put(char(sample & 0xff)).put(char(sample >> 8));
        }
    return path;
}

SoNode* groundMap(bool holes) {
    auto* map = new SoHeightMap;
    map->filename = groundFile(holes).c_str();
    map->rawSize = SbVec2i32(kColumns, kRows);
    map->rawType = SoHeightMap::UINT16_LITTLE_ENDIAN;
    map->heightScale = kScale;
    map->spacing = SbVec2f(kSpacingX, kSpacingY);
    map->origin = SbVec2f(kOriginX, kOriginY);
    map->noData = kNothing;
    return map;
}

Ref<SoSeparator> groundScene(std::optional<Where> where, const GroundOptions& options) {
    auto root = sceneOf(where ? where->kind : Kind::Reference, options.holes ? ground() : wholeGround(), options.shape, options.dress, options.camera);
    if (where && where->overMap) useMap(root.get(), options.holes);
    return root;
}

Ref<SoSeparator> groundShape(std::optional<Where> where, const ShapeOptions& options, bool holes) {
    Ref<SoSeparator> root(shapeOf(where ? where->kind : Kind::Reference, holes ? ground() : wholeGround(), options));
    if (where && where->overMap) useMap(root.get(), holes);
    return root;
}

SoNode* findIn(SoNode* root, SoType type) {
    SoSearchAction search;
    search.setType(type);
    search.setSearchingAll(TRUE);
    search.apply(root);
    return search.getPath() ? static_cast<SoFullPath*>(search.getPath())->getTail() : nullptr;
}

SbBox3f boxOf(SoNode* root) {
    SoGetBoundingBoxAction action(kRegion);
    action.apply(root);
    return action.getBoundingBox();
}

std::string written(SoNode* root, bool binary) {
    SoOutput output;
    output.setBinary(binary);
    output.setBuffer(std::malloc(1024), 1024, reallocate);
    SoWriteAction action(&output);
    action.apply(root);
    void* buffer = nullptr;
    std::size_t size = 0;
    output.getBuffer(buffer, size);
    std::string text(static_cast<char*>(buffer), size);
    std::free(buffer);
    return text;
}

Ref<SoSeparator> readBack(const std::string& text) {
    SoInput input;
    input.setBuffer(const_cast<char*>(text.data()), text.size());
    return Ref<SoSeparator>(SoDB::readAll(&input));
}

}  // namespace test
