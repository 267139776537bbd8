// A height map placed in a scene, and the Coin nodes that hold it in full.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <Inventor/SbVec3f.h>
#include <glm/vec2.hpp>

#include "HeightTools.h"
#include "base/Result.h"
#include "height/HeightSource.h"

class SoCoordinate3;
class SoIndexedFaceSet;
class SoNormal;
class SoQuadMesh;
class SoTextureCoordinate2;

namespace app {

/// Sample (column, row) with height h of the source stands at (column * spacing.x, row * spacing.y, h * heightScale +
/// heightOffset).
struct TerrainGrid {
    std::shared_ptr<const terrain::HeightSource> source;
    int columns = 0;
    int rows = 0;
    glm::dvec2 spacing{1.0, 1.0};
    double heightScale = 1.0;
    double heightOffset = 0.0;
    double minimum = 0.0;  ///< of the placed heights
    double maximum = 0.0;
    std::optional<Georeference> georeference;  ///< where the file says so

    SbVec3f point(int column, int row, float height) const {
        return SbVec3f(float(column * spacing.x), float(row * spacing.y), float(height * heightScale + heightOffset));
    }
    /// Height over (x, y) on the full-resolution triangles; nothing outside, in a hole, or when the map is not in memory.
    std::optional<float> heightAt(float x, float y) const;
    /// The triangle there.
    std::optional<Ground::Surface> surfaceAt(double x, double y) const;
};

/// Greatest height of the standard placement: 255 * 0.0002.
constexpr double standardHeight = 0.051;

/// Places a source. Without spacing and scale, a source without a spacing of its own spans the unit square (sample (c, r) at
/// (c / columns, r / rows)) with heights up to standardHeight; one that has its own spacing keeps its real units, degrees turned
/// into metres. Error: a source without any valid sample.
terrain::Result<TerrainGrid> placeGrid(std::shared_ptr<const terrain::HeightSource> source, std::optional<glm::dvec2> spacing,
                                       std::optional<double> heightScale);

/// Nodes for Coin's own shapes, over the coordinates row by row (index row * columns + column). The grid's map is in memory and has
/// at most maxCoinSamples samples. A hole stands at the lowest height; face sets leave it out.
constexpr double maxCoinSamples = 2.5e8;
SoCoordinate3* makeCoordinates(const TerrainGrid& grid);
/// Normals of the grid from the differences of neighbouring points.
SoNormal* makeNormals(const SoCoordinate3& coordinates, int columns, int rows);
/// (column * step.x, row * step.y)
SoTextureCoordinate2* makeTextureCoordinates(int columns, int rows, glm::dvec2 step);
SoIndexedFaceSet* makeFaceSet(const TerrainGrid& grid);
SoQuadMesh* makeQuadMesh(const TerrainGrid& grid);

}  // namespace app
