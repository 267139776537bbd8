#include "TerrainGrid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Inventor/nodes/SoCoordinate3.h>
#include <Inventor/nodes/SoIndexedFaceSet.h>
#include <Inventor/nodes/SoNormal.h>
#include <Inventor/nodes/SoQuadMesh.h>
#include <Inventor/nodes/SoTextureCoordinate2.h>

#include <glm/geometric.hpp>

namespace app {

using terrain::HeightMap;
using terrain::HeightSource;
using terrain::Result;

namespace {

// Samples that are all whole numbers came from an integer format.
bool isWhole(const HeightMap& map) {
    constexpr int band = 64;
    for (int row = 0; row < map.rows; ++row) {
        const float* first = &map.heights[std::size_t(row) * std::size_t(map.columns)];
        if (!std::all_of(first, first + map.columns, [](float h) { return std::isnan(h) || h == std::floor(h); })) return false;
        if (row % band == band - 1) map.releaseRows(row + 1 - band, band);
    }
    return true;
}

// Scale and offset that bring the source's range to 0..standardHeight.
void fitHeights(const HeightSource& source, TerrainGrid& grid, double lowest, double highest) {
    const HeightMap* map = source.map();
    if (lowest >= 0.0 && highest <= 65535.0 && (!map || isWhole(*map))) {
        grid.heightScale = standardHeight / (highest <= 255.0 ? 255.0 : 65535.0);
        return;
    }
    grid.heightScale = highest > lowest ? standardHeight / (highest - lowest) : 1.0;
    grid.heightOffset = -lowest * grid.heightScale;
}

// The source's own distance between samples, in metres when it is in degrees; nothing when it has none.
std::optional<glm::dvec2> ownSpacing(const HeightSource& source) {
    const terrain::HeightExtent extent = source.extent();
    const HeightMap* map = source.map();
    const std::string projection = map ? map->projection : std::string();
    if (projection.empty() && extent.spacing == glm::dvec2(1.0, 1.0)) return std::nullopt;
    if (!projection.starts_with("GEOGCS") && !projection.starts_with("GEOGCRS")) return extent.spacing;
    const double metresPerDegree = 111320.0;
    const double latitude = (extent.origin.y + 0.5 * extent.rows * extent.spacing.y) * std::numbers::pi / 180.0;
    return extent.spacing * glm::dvec2(metresPerDegree * std::max(0.01, std::cos(latitude)), metresPerDegree);
}

// Lengths have the file's unit only where they are the file's.
std::optional<Georeference> georeferenceOf(const HeightSource& source, const TerrainGrid& grid) {
    const terrain::HeightExtent extent = source.extent();
    const std::string wkt = source.map() ? source.map()->projection : std::string();
    if (wkt.empty() && extent.origin == glm::dvec2(0.0, 0.0)) return std::nullopt;
    const auto unit = [&]() -> std::string {
        if (grid.heightScale != 1.0) return {};
        if (isGeographic(wkt)) return grid.spacing == ownSpacing(source) ? std::string(1, 'm') : std::string();
        return grid.spacing == extent.spacing ? lengthUnit(wkt) : std::string();
    };
    return Georeference{extent.origin, extent.spacing, systemName(wkt), isGeographic(wkt), unit()};
}

}  // namespace

std::optional<Ground::Surface> TerrainGrid::surfaceAt(double x, double y) const {
    const HeightMap* map = source ? source->map() : nullptr;
    const double column = x / spacing.x, row = y / spacing.y;
    if (!map || !(column >= 0.0 && row >= 0.0 && column <= columns - 1.0 && row <= rows - 1.0)) return std::nullopt;
    const int c = std::min(int(column), columns - 2), r = std::min(int(row), rows - 2);
    const double u = column - c, v = row - r;
    const double h00 = map->at(c, r), h10 = map->at(c + 1, r), h01 = map->at(c, r + 1), h11 = map->at(c + 1, r + 1);
    const bool isLower = u + v <= 1.0;
    const double h = isLower ? h00 + u * (h10 - h00) + v * (h01 - h00) : h11 + (1.0 - u) * (h01 - h11) + (1.0 - v) * (h10 - h11);
    if (std::isnan(h)) return std::nullopt;
    const glm::dvec2 rise = heightScale * (isLower ? glm::dvec2(h10 - h00, h01 - h00) : glm::dvec2(h11 - h01, h11 - h10)) / spacing;
    return Ground::Surface{h * heightScale + heightOffset, glm::normalize(glm::dvec3(-rise, 1.0))};
}

std::optional<float> TerrainGrid::heightAt(float x, float y) const {
    const auto surface = surfaceAt(x, y);
    return surface ? std::optional(float(surface->height)) : std::nullopt;
}

Result<TerrainGrid> placeGrid(std::shared_ptr<const HeightSource> source, std::optional<glm::dvec2> spacing,
                              std::optional<double> heightScale) {
    const terrain::HeightExtent extent = source->extent();
    TerrainGrid grid{source, extent.columns, extent.rows, {}, heightScale.value_or(1.0), 0.0, 0.0, 0.0, std::nullopt};
    // The coarsest tile knows the extremes of everything below it.
    const auto root = source->load({source->levelCount() - 1, 0, 0, 1});
    if (!root) return root.error();
    const double lowest = root.value().minimum, highest = root.value().maximum;
    if (!std::isfinite(lowest) || !std::isfinite(highest))
        return terrain::Error{"height map", "at least one finite height", "holes only"};
    if (!spacing) spacing = ownSpacing(*source);
    if (!spacing && !heightScale) fitHeights(*source, grid, lowest, highest);
    grid.spacing = spacing.value_or(glm::dvec2(1.0 / extent.columns, 1.0 / extent.rows));
    grid.minimum = lowest * grid.heightScale + grid.heightOffset;
    grid.maximum = highest * grid.heightScale + grid.heightOffset;
    grid.georeference = georeferenceOf(*source, grid);
    return grid;
}

SoCoordinate3* makeCoordinates(const TerrainGrid& grid) {
    const HeightMap& map = *grid.source->map();
    const float lowest = float((grid.minimum - grid.heightOffset) / grid.heightScale);
    auto* node = new SoCoordinate3;
    node->point.setNum(grid.columns * grid.rows);
    SbVec3f* point = node->point.startEditing();
    for (int row = 0; row < grid.rows; ++row) {
        for (int column = 0; column < grid.columns; ++column) {
            const float height = map.at(column, row);
            *point++ = grid.point(column, row, std::isnan(height) ? lowest : height);
        }
    }
    node->point.finishEditing();
    return node;
}

SoNormal* makeNormals(const SoCoordinate3& coordinates, int columns, int rows) {
    const SbVec3f* point = coordinates.point.getValues(0);
    auto* node = new SoNormal;
    node->vector.setNum(columns * rows);
    SbVec3f* normal = node->vector.startEditing();
    const auto at = [&](int column, int row) { return point[row * columns + column]; };
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            const SbVec3f east = at(std::min(column + 1, columns - 1), row) - at(std::max(column - 1, 0), row);
            const SbVec3f north = at(column, std::min(row + 1, rows - 1)) - at(column, std::max(row - 1, 0));
            *normal = east.cross(north);
            (normal++)->normalize();
        }
    }
    node->vector.finishEditing();
    return node;
}

SoTextureCoordinate2* makeTextureCoordinates(int columns, int rows, glm::dvec2 step) {
    auto* node = new SoTextureCoordinate2;
    node->point.setNum(columns * rows);
    SbVec2f* point = node->point.startEditing();
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) (point++)->setValue(float(column * step.x), float(row * step.y));
    }
    node->point.finishEditing();
    return node;
}

SoIndexedFaceSet* makeFaceSet(const TerrainGrid& grid) {
    const HeightMap& map = *grid.source->map();
    auto* node = new SoIndexedFaceSet;
    node->coordIndex.setNum((grid.columns - 1) * (grid.rows - 1) * 8);
    int32_t* const first = node->coordIndex.startEditing();
    int32_t* index = first;
    const auto triangle = [&](int a, int b, int c) {
        const std::size_t corners[3] = {std::size_t(a), std::size_t(b), std::size_t(c)};
        if (std::any_of(corners, corners + 3, [&](std::size_t corner) { return std::isnan(map.heights[corner]); })) return;
        for (const int corner : {a, b, c, SO_END_FACE_INDEX}) *index++ = corner;
    };
    for (int row = 0; row + 1 < grid.rows; ++row) {
        for (int column = 0; column + 1 < grid.columns; ++column) {
            const int here = row * grid.columns + column, above = here + grid.columns;
            triangle(here, here + 1, above);
            triangle(here + 1, above + 1, above);
        }
    }
    const int used = int(index - first);
    node->coordIndex.finishEditing();
    node->coordIndex.setNum(used);
    return node;
}

SoQuadMesh* makeQuadMesh(const TerrainGrid& grid) {
    auto* node = new SoQuadMesh;
    node->verticesPerRow = grid.columns;
    node->verticesPerColumn = grid.rows;
    return node;
}

}  // namespace app
