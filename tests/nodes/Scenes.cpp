#include "Scenes.h"

#include <cmath>

#include <gtest/gtest.h>

#include <Inventor/actions/SoSearchAction.h>
#include <Inventor/nodes/SoCoordinate3.h>
#include <Inventor/nodes/SoDirectionalLight.h>
#include <Inventor/nodes/SoIndexedFaceSet.h>
#include <Inventor/nodes/SoLightModel.h>
#include <Inventor/nodes/SoNormal.h>
#include <Inventor/nodes/SoPerspectiveCamera.h>
#include <Inventor/nodes/SoQuadMesh.h>
#include <Inventor/nodes/SoTexture2.h>
#include <Inventor/nodes/SoTextureCoordinate2.h>
#include <Inventor/nodes/SoTextureUnit.h>

#include <SoTerrain/SoBruteForceTerrain.h>
#include <SoTerrain/SoChunkedLoDTerrain.h>
#include <SoTerrain/SoGeoMipmapTerrain.h>
#include <SoTerrain/SoGeometryClipmapTerrain.h>
#include <SoTerrain/SoROAMTerrain.h>

#include "height/FractalSource.h"

using terrain::HeightMap;

namespace test {

const char* nameOf(Kind kind) {
    switch (kind) {
    case Kind::Reference: return "reference";
    case Kind::QuadMesh: return "quad mesh";
    case Kind::BruteForce: return "brute force";
    case Kind::Roam: return "ROAM";
    case Kind::GeoMipmap: return "Geo Mip-Mapping";
    case Kind::ChunkedLod: return "Chunked LoD";
    case Kind::Clipmap: return "geometry clipmap";
    }
    return "";
}

std::string identifierOf(Kind kind) {
    switch (kind) {
    case Kind::Roam: return "Roam";
    case Kind::GeoMipmap: return "GeoMipmap";
    case Kind::ChunkedLod: return "ChunkedLod";
    case Kind::Clipmap: return "Clipmap";
    default: return "BruteForce";
    }
}

bool Surface::isHole(int column, int row) const {
    const SbVec3f& p = at(column, row);
    return !std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2]);
}

bool Surface::isCellHole(int column, int row) const {
    return isHole(column, row) || isHole(column + 1, row) || isHole(column, row + 1) || isHole(column + 1, row + 1);
}

SbBox3f Surface::box() const {
    SbBox3f box;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            if (!isHole(column, row)) box.extendBy(at(column, row));
    return box;
}

HeightMap fractalMap(int columns, int rows, double amplitude, std::uint32_t seed) {
    terrain::FractalParameters parameters;
    parameters.columns = columns;
    parameters.rows = rows;
    parameters.amplitude = amplitude;
    parameters.seed = seed;
    parameters.filterPasses = 1;
    parameters.filterCoefficient = 0.6;
    auto made = terrain::makeFractalMap(parameters);
    EXPECT_TRUE(made) << made.error().message();
    return std::move(made).value();
}

HeightMap mapOf(int columns, int rows, const std::function<double(double, double)>& height) {
    HeightMap map;
    map.columns = columns;
    map.rows = rows;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            map.heights.push_back(float(height(double(column) / (columns - 1), double(row) / (rows - 1))));
    return map;
}

Surface surfaceOf(const HeightMap& map) {
    return surfaceOf(map, [&](int column, int row, float height) {
        return SbVec3f(float(map.origin.x + column * map.spacing.x), float(map.origin.y + row * map.spacing.y), height);
    });
}

Surface surfaceOf(const HeightMap& map, const std::function<SbVec3f(int, int, float)>& place) {
    Surface surface{map.columns, map.rows, {}, {}};
    for (int row = 0; row < map.rows; ++row)
        for (int column = 0; column < map.columns; ++column) surface.points.push_back(place(column, row, map.at(column, row)));
    const auto neighbour = [&](int column, int row, int dc, int dr) {
        const int c = std::clamp(column + dc, 0, map.columns - 1), r = std::clamp(row + dr, 0, map.rows - 1);
        return surface.isHole(c, r) ? surface.at(column, row) : surface.at(c, r);
    };
    for (int row = 0; row < map.rows; ++row)
        for (int column = 0; column < map.columns; ++column) {
            SbVec3f normal(0.0f, 0.0f, 1.0f);
            if (!surface.isHole(column, row)) {
                const SbVec3f across = neighbour(column, row, 1, 0) - neighbour(column, row, -1, 0);
                const SbVec3f along = neighbour(column, row, 0, 1) - neighbour(column, row, 0, -1);
                const SbVec3f cross = across.cross(along);
                if (cross.length() > 0.0f) normal = cross / cross.length();
            }
            surface.normals.push_back(normal);
        }
    return surface;
}

namespace {

SoTerrainShape* newNode(Kind kind) {
    switch (kind) {
    case Kind::Roam: return new SoROAMTerrain;
    case Kind::GeoMipmap: return new SoGeoMipmapTerrain;
    case Kind::ChunkedLod: {
        // Complete in every picture.
        auto* node = new SoChunkedLoDTerrain;
        node->background = FALSE;
        return node;
    }
    case Kind::Clipmap: {
        // As large as pixelError needs.
        auto* node = new SoGeometryClipmapTerrain;
        node->clipmapSize = 0;
        return node;
    }
    default: return new SoBruteForceTerrain;
    }
}

}  // namespace

SoTerrainShape* nodeOf(Kind kind, int columns, int rows, float pixelError) {
    SoTerrainShape* node = newNode(kind);
    node->verticesPerRow = columns;
    node->verticesPerColumn = rows;
    node->pixelError = pixelError;
    return node;
}

namespace {

SoNode* faceSetOf(const Surface& surface) {
    auto* shape = new SoIndexedFaceSet;
    std::vector<std::int32_t> indices;
    indices.reserve(std::size_t(surface.columns) * std::size_t(surface.rows) * 8);
    for (int row = 0; row < surface.rows - 1; ++row)
        for (int column = 0; column < surface.columns - 1; ++column) {
            if (surface.isCellHole(column, row)) continue;
            const auto corner = [&](int dc, int dr) { return std::int32_t(surface.index(column + dc, row + dr)); };
            for (const std::int32_t index : {corner(0, 0), corner(1, 0), corner(0, 1), -1, corner(1, 0), corner(1, 1), corner(0, 1), -1})
                indices.push_back(index);
        }
    shape->coordIndex.setValues(0, int(indices.size()), indices.data());
    return shape;
}

void addTextureCoordinates(SoGroup* group, const Surface& surface, int unit, bool turned) {
    std::vector<SbVec2f> st;
    for (int row = 0; row < surface.rows; ++row)
        for (int column = 0; column < surface.columns; ++column) {
            const float s = float(column) / float(surface.columns - 1), t = float(row) / float(surface.rows - 1);
            st.push_back(turned ? SbVec2f(1.0f - t, s) : SbVec2f(s, t));
        }
    auto* where = new SoTextureUnit;
    where->unit = unit;
    group->addChild(where);
    auto* texture = new SoTextureCoordinate2;
    texture->point.setValues(0, int(st.size()), st.data());
    group->addChild(texture);
    group->addChild(new SoTextureUnit);
}

}  // namespace

SoSeparator* shapeOf(Kind kind, const Surface& surface, const ShapeOptions& options) {
    auto* group = new SoSeparator;
    auto* coordinates = new SoCoordinate3;
    coordinates->point.setValues(0, int(surface.points.size()), surface.points.data());
    if (kind == Kind::Reference) {
        // No triangle uses them, but a bounding box would.
        SbVec3f* points = coordinates->point.startEditing();
        for (std::size_t i = 0; i < surface.points.size(); ++i)
            if (surface.isHole(int(i % std::size_t(surface.columns)), int(i / std::size_t(surface.columns)))) points[i] = surface.box().getCenter();
        coordinates->point.finishEditing();
    }
    group->addChild(coordinates);
    const bool isOurs = kind != Kind::Reference && kind != Kind::QuadMesh;
    if (options.normals || !isOurs) {
        auto* normals = new SoNormal;
        normals->vector.setValues(0, int(surface.normals.size()), surface.normals.data());
        group->addChild(normals);
    }
    for (int unit = 0; unit < 2; ++unit)
        if (options.coordinatesOnUnit == unit || !isOurs) addTextureCoordinates(group, surface, unit, options.coordinatesOnUnit == unit);
    if (kind == Kind::Reference) {
        group->addChild(faceSetOf(surface));
    } else if (kind == Kind::QuadMesh) {
        auto* mesh = new SoQuadMesh;
        mesh->verticesPerRow = surface.columns;
        mesh->verticesPerColumn = surface.rows;
        group->addChild(mesh);
    } else {
        group->addChild(nodeOf(kind, surface.columns, surface.rows, options.pixelError));
    }
    return group;
}

SoTerrainShape* terrainIn(SoNode* root) {
    SoSearchAction search;
    search.setType(SoTerrainShape::getClassTypeId());
    search.setSearchingAll(TRUE);
    search.apply(root);
    if (!search.getPath()) return nullptr;
    return static_cast<SoTerrainShape*>(static_cast<SoFullPath*>(search.getPath())->getTail());
}

SoCamera* cameraAt(const SbVec3f& eye, const SbVec3f& target, float nearDistance, float farDistance, bool yUp) {
    auto* camera = new SoPerspectiveCamera;
    camera->position = eye;
    camera->pointAt(target, yUp ? SbVec3f(0.0f, 1.0f, 0.0f) : SbVec3f(0.0f, 0.0f, 1.0f));
    camera->nearDistance = nearDistance;
    camera->farDistance = farDistance;
    return camera;
}

SoCamera* cameraFor(const SbBox3f& box, bool yUp) {
    const SbVec3f size = box.getMax() - box.getMin(), centre = box.getCenter();
    const float reach = size.length();
    const float wide = std::max(size[0], yUp ? size[2] : size[1]);
    SbVec3f eye = yUp ? SbVec3f(-0.35f * size[0], 0.35f * wide + size[1], 0.55f * size[2]) : SbVec3f(-0.35f * size[0], -0.55f * size[1], 0.35f * wide + size[2]);
    eye += centre;
    return cameraAt(eye, centre, 0.02f * reach, 3.0f * reach, yUp);
}

void addTexture(SoGroup* group, int checks, int unit) {
    constexpr int kSide = 128;
    std::vector<std::uint8_t> texels;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const double wave = std::sin(checks * M_PI * x / kSide) * std::sin(checks * M_PI * y / kSide);
            texels.push_back(std::uint8_t(255.0 * x / kSide));
            texels.push_back(std::uint8_t(128.0 + 120.0 * wave));
            texels.push_back(std::uint8_t(255.0 * (kSide - 1 - y) / kSide));
        }
    auto* texture = new SoTexture2;
    texture->image.setValue(SbVec2s(kSide, kSide), 3, texels.data());
    texture->wrapS = texture->wrapT = SoTexture2::CLAMP;
    auto* where = new SoTextureUnit;
    where->unit = unit;
    group->addChild(where);
    group->addChild(texture);
    group->addChild(new SoTextureUnit);
}

void unlitTexture(SoSeparator* group) {
    addTexture(group);
    auto* unlit = new SoLightModel;
    unlit->model = SoLightModel::BASE_COLOR;
    group->addChild(unlit);
}

Ref<SoSeparator> sceneOf(Kind kind, const Surface& surface, const ShapeOptions& options, const Dressing& dress, SoCamera* camera) {
    Ref<SoSeparator> root(new SoSeparator);
    root->addChild(camera ? camera : cameraFor(surface.box()));
    auto* light = new SoDirectionalLight;
    light->direction = SbVec3f(0.5f, 0.5f, -1.0f);
    root->addChild(light);
    auto* dressed = new SoSeparator;
    root->addChild(dressed);
    if (dress) dress(dressed);
    dressed->addChild(shapeOf(kind, surface, options));
    return root;
}

void expectLikeReference(const std::string& name, const Surface& surface, const ShapeOptions& options, const Dressing& dress,
                         double bruteForceMean, double lodMean, const std::function<SoCamera*()>& camera, Kind reference) {
    Stage stage;
    const auto draw = [&](Kind kind) { return stage.render(sceneOf(kind, surface, options, dress, camera ? camera() : nullptr).get()); };
    std::vector<terrain::Image> pictures{draw(reference)};
    for (const Kind kind : kOurKinds) pictures.push_back(draw(kind));
    savePicture(name, pictures);
    for (std::size_t i = 0; i < std::size(kOurKinds); ++i)
        expectAlike(pictures[0], pictures[i + 1], kOurKinds[i] == Kind::BruteForce ? bruteForceMean : lodMean, nameOf(kOurKinds[i]));
}

}  // namespace test
