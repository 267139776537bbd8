// Terrain scenes for tests, each with our nodes or with Coin's own shape for reference.
#pragma once

#include "Harness.h"

#include <functional>
#include <string>
#include <vector>

#include <Inventor/SbBox3f.h>
#include <Inventor/SbVec3f.h>
#include <Inventor/nodes/SoCamera.h>
#include <Inventor/nodes/SoSeparator.h>

#include <SoTerrain/SoTerrainShape.h>

#include "height/HeightMap.h"

namespace test {

/// What draws a grid: Coin's SoIndexedFaceSet of all its triangles, Coin's SoQuadMesh, or one of our nodes.
enum class Kind { Reference, QuadMesh, BruteForce, Roam, GeoMipmap, ChunkedLod, Clipmap };
inline constexpr Kind kOurKinds[] = {Kind::BruteForce, Kind::Roam, Kind::GeoMipmap, Kind::ChunkedLod, Kind::Clipmap};
/// Those of ours with level of detail.
inline constexpr Kind kLodKinds[] = {Kind::Roam, Kind::GeoMipmap, Kind::ChunkedLod, Kind::Clipmap};
const char* nameOf(Kind kind);
/// The same for names of tests and pictures.
std::string identifierOf(Kind kind);

/// A grid of points, row after row, with a normal each. A point that is not finite is a hole.
struct Surface {
    int columns = 0;
    int rows = 0;
    std::vector<SbVec3f> points;
    std::vector<SbVec3f> normals;

    std::size_t index(int column, int row) const { return std::size_t(row) * std::size_t(columns) + std::size_t(column); }
    const SbVec3f& at(int column, int row) const { return points[index(column, row)]; }
    bool isHole(int column, int row) const;
    bool isCellHole(int column, int row) const;
    SbBox3f box() const;
};

/// Fractal heights from 0 to `amplitude`, spacing 1.
terrain::HeightMap fractalMap(int columns, int rows, double amplitude, std::uint32_t seed = 1);
/// A smooth map by a formula of (column, row) / (columns - 1).
terrain::HeightMap mapOf(int columns, int rows, const std::function<double(double, double)>& height);
Surface surfaceOf(const terrain::HeightMap& map);
/// Where each sample stands is up to `place`: (column, row, height).
Surface surfaceOf(const terrain::HeightMap& map, const std::function<SbVec3f(int, int, float)>& place);

struct ShapeOptions {
    float pixelError = 2.0f;
    bool normals = true;        ///< explicit ones for our nodes; Coin's shapes always have them
    int coordinatesOnUnit = -1;  ///< explicit texture coordinates, a quarter turn off, on this texture unit
};

/// Coordinates, normals and shape under a separator. The shape is its last child.
SoSeparator* shapeOf(Kind kind, const Surface& surface, const ShapeOptions& options = {});
/// The node alone, its sizes set.
SoTerrainShape* nodeOf(Kind kind, int columns, int rows, float pixelError = 2.0f);
/// The terrain node below, wherever it is.
SoTerrainShape* terrainIn(SoNode* root);

/// A perspective camera over a corner of the box, near enough to the ground for levels of detail to differ. z is up, or y.
SoCamera* cameraFor(const SbBox3f& box, bool yUp = false);
/// A camera at `eye` that looks at `target`, its clipping planes around a sphere.
SoCamera* cameraAt(const SbVec3f& eye, const SbVec3f& target, float nearDistance, float farDistance, bool yUp = false);

/// Puts properties before the shape.
using Dressing = std::function<void(SoSeparator*)>;
/// A texture of soft coloured checks on `unit`, unlit or modulated by light.
void addTexture(SoGroup* group, int checks = 8, int unit = 0);
/// That texture without light: colours then show nothing but where the ground is.
void unlitTexture(SoSeparator* group);

/// Camera, light and shape: what most tests draw.
Ref<SoSeparator> sceneOf(Kind kind, const Surface& surface, const ShapeOptions& options = {}, const Dressing& dress = {}, SoCamera* camera = nullptr);

/// Draws the scene with Coin's shape (`reference`) and with ours, compares, and saves the pictures under `name`. `lodMean` is for nodes with level
/// of detail at the option's pixelError.
void expectLikeReference(const std::string& name, const Surface& surface, const ShapeOptions& options, const Dressing& dress,
                         double bruteForceMean, double lodMean, const std::function<SoCamera*()>& camera = {}, Kind reference = Kind::Reference);

}  // namespace test
