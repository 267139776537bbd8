// Pictures of the mesh itself: each colour is compared with what a mesh of our own, chosen for the same view, has there.
#include <epoxy/gl.h>

#include "Scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <set>
#include <thread>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include <Inventor/nodes/SoLightModel.h>
#include <Inventor/nodes/SoMaterial.h>

#include <SoTerrain/SoChunkedLoDTerrain.h>
#include <SoTerrain/SoGeometryClipmapTerrain.h>

#include "lod/BruteForceMesh.h"
#include "lod/ChunkedLod.h"
#include "lod/ClipmapMesh.h"
#include "lod/DebugColours.h"
#include "lod/GeoMipmapMesh.h"
#include "lod/RoamMesh.h"

using namespace test;
using terrain::Colour;
using terrain::Image;

namespace {

constexpr int kWidth = 320, kHeight = 240;

terrain::View viewOf(SoCamera* camera) {
    SbMatrix affine, projection;
    camera->getViewVolume(float(kWidth) / float(kHeight)).getMatrices(affine, projection);
    const SbMatrix both = affine * projection;
    terrain::View view;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) view.clipFromLocal[i][j] = both[i][j];
    view.viewportPixels = {kWidth, kHeight};
    return view;
}

struct Corner {
    glm::dvec3 position{0.0};
    glm::dvec2 place{0.0};
    glm::dvec3 window{0.0};  ///< pixels and depth
    double w = 0.0;
};

struct Triangle {
    std::array<Corner, 3> corner;
    Colour patch{0.0f};  ///< of its tile
    int tile = 0;
    bool closesGaps = false;
};

/// The mesh that a node of this kind has for a view, and where it lies on the screen.
class Mesh {
public:
    Mesh(Kind kind, const Surface& surface, SoCamera* camera, float pixelError = 2.0f) : surface_(surface), view_(viewOf(camera)) {
        const terrain::SampleGrid grid =
            terrain::SampleGrid::overPoints(surface.points[0].getValue(), surface.columns, surface.rows).value();
        const terrain::TerrainModel model{std::make_shared<terrain::BoxPyramid>(grid),
                                          std::make_shared<terrain::ErrorHierarchy>(grid)};
        const auto mesh = algorithmOf(kind, grid, model);
        terrain::LodSettings settings;
        settings.pixelError = pixelError;
        settings.geomorph = kind != Kind::Roam;
        settings.complete = true;
        mesh->select(grid, view_, settings);
        mesh->eachPatch(grid, [&](const terrain::DrawnPatch& patch) { add(patch); });
    }

    const std::vector<Triangle>& triangles() const { return triangles_; }
    const terrain::View& view() const { return view_; }

    /// Calls visit(triangle, x, y, weights) for the pixels whose centres lie in a triangle that is seen there. `weights` of the
    /// corners on the screen.
    template <class Visit>
    void eachPixel(const std::vector<float>& depth, const Visit& visit) const {
        for (const Triangle& triangle : triangles_) {
            const auto& [a, b, c] = triangle.corner;
            if (std::min({a.w, b.w, c.w}) <= 0.0) continue;
            const glm::dvec2 ab(b.window - a.window), ac(c.window - a.window);
            const double area = ab.x * ac.y - ab.y * ac.x;
            if (std::fabs(area) < 1e-3) continue;
            const auto low = glm::max(
                glm::dvec2(0.0), glm::floor(glm::min(glm::min(glm::dvec2(a.window), glm::dvec2(b.window)), glm::dvec2(c.window))));
            const auto high = glm::min(glm::dvec2(kWidth - 1, kHeight - 1),
                                       glm::max(glm::max(glm::dvec2(a.window), glm::dvec2(b.window)), glm::dvec2(c.window)));
            for (int y = int(low.y); y <= int(high.y); ++y)
                for (int x = int(low.x); x <= int(high.x); ++x) {
                    const glm::dvec2 at = glm::dvec2(x + 0.5, y + 0.5) - glm::dvec2(a.window);
                    const double v = (at.x * ac.y - at.y * ac.x) / area, w = (ab.x * at.y - ab.y * at.x) / area, u = 1.0 - v - w;
                    if (std::min({u, v, w}) <= 0.01) continue;
                    const double z = u * a.window.z + v * b.window.z + w * c.window.z;
                    if (std::fabs(z - double(depth[std::size_t(y * kWidth + x)])) < 2e-6)
                        visit(triangle, x, y, glm::dvec3(u, v, w));
                }
        }
    }

    /// Pixels between what is drawn at such a place of a triangle and the full-resolution cell there, cut along either diagonal.
    double errorAt(const Triangle& triangle, const glm::dvec3& onScreen) const {
        const auto& [a, b, c] = triangle.corner;
        glm::dvec3 share = onScreen / glm::dvec3(a.w, b.w, c.w);
        share /= share.x + share.y + share.z;
        const glm::dvec2 place = a.place * share.x + b.place * share.y + c.place * share.z;
        const glm::dvec3 drawn = a.position * share.x + b.position * share.y + c.position * share.z;
        const int column = std::clamp(int(place.x), 0, surface_.columns - 2), row = std::clamp(int(place.y), 0, surface_.rows - 2);
        const glm::dvec2 at = place - glm::dvec2(column, row);
        const auto height = [&](int i, int j) { return double(surface_.at(column + i, row + j)[2]); };
        const double one = at.x + at.y <= 1.0
                               ? height(0, 0) * (1.0 - at.x - at.y) + height(1, 0) * at.x + height(0, 1) * at.y
                               : height(1, 1) * (at.x + at.y - 1.0) + height(0, 1) * (1.0 - at.x) + height(1, 0) * (1.0 - at.y);
        const double other = at.x >= at.y ? height(0, 0) * (1.0 - at.x) + height(1, 0) * (at.x - at.y) + height(1, 1) * at.y
                                          : height(0, 0) * (1.0 - at.y) + height(0, 1) * (at.y - at.x) + height(1, 1) * at.x;
        const glm::dvec3 there(drawn.x, drawn.y, std::clamp(drawn.z, std::min(one, other), std::max(one, other)));
        return glm::length(glm::dvec2(windowOf(there) - windowOf(drawn)));
    }

    glm::dvec3 windowOf(const glm::dvec3& point) const {
        const glm::dvec4 clip = view_.clipFromLocal * glm::dvec4(point, 1.0);
        return (glm::dvec3(clip) / clip.w * 0.5 + 0.5) * glm::dvec3(kWidth, kHeight, 1.0);
    }

private:
    static std::unique_ptr<terrain::LodAlgorithm> algorithmOf(Kind kind, const terrain::SampleGrid& grid,
                                                              const terrain::TerrainModel& model) {
        switch (kind) {
        case Kind::Roam:
            return std::make_unique<terrain::RoamMesh>(model, grid);
        case Kind::GeoMipmap:
            return std::make_unique<terrain::GeoMipmapMesh>(std::make_shared<terrain::GeoMipmapErrors>(grid, 8));
        case Kind::ChunkedLod:
            return std::make_unique<terrain::ChunkedLod>(model, grid, 64, nullptr);
        case Kind::Clipmap: {
            terrain::ClipmapShape shape;
            shape.size = 31;
            const auto errors = std::make_shared<const terrain::ClipmapErrors>(grid, 10);
            return std::make_unique<terrain::ClipmapMesh>(
                grid.columns(), grid.rows(), shape, terrain::ClipmapSettings{}, model.boxes,
                [errors](const terrain::SampleGrid&) { return errors; }, nullptr);
        }
        default:
            return std::make_unique<terrain::BruteForceMesh>();
        }
    }

    void add(const terrain::DrawnPatch& patch) {
        ++tiles_;
        for (std::size_t i = 0; i + 2 < patch.indices.size(); i += 3) {
            Triangle triangle{{}, terrain::patchColour(patch), tiles_, patch.closesGaps};
            for (std::size_t j = 0; j < 3; ++j) {
                const std::uint32_t index = patch.indices[i + j], sample = patch.wholeGrid ? index : patch.samples[index];
                Corner& corner = triangle.corner[j];
                corner.place = {sample % std::uint32_t(surface_.columns), sample / std::uint32_t(surface_.columns)};
                const SbVec3f& p = surface_.points[sample];
                corner.position = patch.wholeGrid ? glm::dvec3(p[0], p[1], p[2]) : glm::dvec3(patch.positions[index]);
                corner.window = windowOf(corner.position);
                corner.w = (view_.clipFromLocal * glm::dvec4(corner.position, 1.0)).w;
            }
            triangles_.push_back(triangle);
        }
    }

    const Surface& surface_;
    terrain::View view_;
    std::vector<Triangle> triangles_;
    int tiles_ = 0;
};

Surface hills() {
    return surfaceOf(fractalMap(193, 161, 50.0));
}

SoCamera* slanted() {
    return cameraAt(SbVec3f(96.0f, -30.0f, 90.0f), SbVec3f(96.0f, 80.0f, 20.0f), 2.0f, 400.0f);
}
SoCamera* near() {
    return cameraAt(SbVec3f(90.0f, 20.0f, 62.0f), SbVec3f(100.0f, 80.0f, 25.0f), 0.5f, 400.0f);
}
SoCamera* grazing() {
    return cameraAt(SbVec3f(-60.0f, 81.3f, 48.0f), SbVec3f(100.0f, 80.0f, 22.0f), 1.0f, 400.0f);
}
SoCamera* far() {
    return cameraAt(SbVec3f(96.0f, -900.0f, 500.0f), SbVec3f(96.0f, 80.0f, 20.0f), 100.0f, 2000.0f);
}

void unlit(SoSeparator* group) {
    auto* model = new SoLightModel;
    model->model = SoLightModel::BASE_COLOR;
    group->addChild(model);
}

Ref<SoSeparator> sceneFor(Kind kind, const Surface& surface, SoCamera* camera, const Dressing& dress = unlit,
                          float pixelError = 2.0f) {
    Ref<SoSeparator> root = sceneOf(kind, surface, {.pixelError = pixelError}, dress, camera);
    if (auto* clipmap = dynamic_cast<SoGeometryClipmapTerrain*>(terrainIn(root.get()))) clipmap->clipmapSize = 31;
    return root;
}

/// Pixels are counted from the bottom, as GL counts them.
Colour pixelOf(const Image& image, int x, int y) {
    const std::uint8_t* p = &image.pixels[std::size_t((kHeight - 1 - y) * kWidth + x) * std::size_t(image.channels)];
    return Colour(p[0], p[1], p[2]) / 255.0f;
}

float distanceOf(const Colour& a, const Colour& b) {
    const Colour off = glm::abs(a - b);
    return std::max({off.x, off.y, off.z});
}

/// The part of the allowed error that a colour says.
double partOf(const Colour& colour) {
    double best = 2.0;
    float nearest = distanceOf(colour, terrain::kBrokenColour);
    const std::span<const Colour> ramp = terrain::errorRamp();
    for (std::size_t i = 0; i + 1 < ramp.size(); ++i) {
        const Colour step = ramp[i + 1] - ramp[i];
        const float at = std::clamp(glm::dot(colour - ramp[i], step) / glm::dot(step, step), 0.0f, 1.0f);
        const float off = distanceOf(colour, ramp[i] + step * at);
        if (off < nearest) nearest = off, best = (double(i) + double(at)) / double(ramp.size() - 1);
    }
    return best;
}

constexpr float kSame = 1.5f / 255.0f;

class DebugViews : public testing::TestWithParam<Kind> {};

}  // namespace

TEST_P(DebugViews, ChangeNothingOnceTheyAreOff) {
    const Surface surface = hills();
    Stage stage(kWidth, kHeight), other(kWidth, kHeight);
    const auto untouched = sceneFor(GetParam(), surface, slanted(), {}), root = sceneFor(GetParam(), surface, slanted(), {});
    SoTerrainShape* node = terrainIn(root.get());
    const Image before = other.render(untouched.get());
    const SoTerrainStatistics plain = terrainIn(untouched.get())->getStatistics();
    for (const int view : {SoTerrainShape::TILES, SoTerrainShape::LEVELS, SoTerrainShape::ERRORS, SoTerrainShape::LOADING}) {
        node->debugView = view;
        node->wireframeOverlay = view == SoTerrainShape::LEVELS;
        EXPECT_NE(stage.render(root.get()).pixels, before.pixels);
        EXPECT_EQ(node->getStatistics().errorPixels, plain.errorPixels);
    }
    node->debugView = SoTerrainShape::NONE;
    node->wireframeOverlay = FALSE;
    EXPECT_EQ(stage.render(root.get()).pixels, before.pixels);
    EXPECT_EQ(node->getStatistics().triangles, plain.triangles);
    EXPECT_EQ(node->getStatistics().drawCalls, plain.drawCalls);
    EXPECT_EQ(node->getStatistics().patches, plain.patches);
    EXPECT_EQ(node->getStatistics().bufferBytes > 0, true);
}

TEST_P(DebugViews, ShowTheLevelOfEachTriangle) {
    const Surface surface = hills();
    Stage stage(kWidth, kHeight);
    std::vector<Image> pictures;
    std::set<int> levels;
    for (SoCamera* (*camera)() : {slanted, near, grazing}) {
        const auto root = sceneFor(GetParam(), surface, camera());
        terrainIn(root.get())->debugView = SoTerrainShape::LEVELS;
        pictures.push_back(stage.render(root.get()));
        const Mesh mesh(GetParam(), surface, static_cast<SoCamera*>(root->getChild(0)));
        int looked = 0, wrong = 0;
        mesh.eachPixel(stage.depth(), [&](const Triangle& triangle, int x, int y, const glm::dvec3&) {
            if (triangle.closesGaps) return;
            const glm::dvec2 ab = triangle.corner[1].place - triangle.corner[0].place,
                             ac = triangle.corner[2].place - triangle.corner[0].place;
            const int level = int(std::floor(std::log2(std::sqrt(std::fabs(ab.x * ac.y - ab.y * ac.x)) * 1.0001)));
            levels.insert(level);
            ++looked;
            wrong += distanceOf(pixelOf(pictures.back(), x, y), terrain::levelColour(level)) > kSame;
        });
        EXPECT_GT(looked, 10000);
        EXPECT_LE(wrong, looked / 500);
    }
    EXPECT_GE(levels.size(), GetParam() == Kind::BruteForce ? 1u : 2u);
    savePicture("debug_levels_" + identifierOf(GetParam()), pictures);
}

TEST_P(DebugViews, ShowTilesInColoursOfTheirOwn) {
    const Surface surface = hills();
    Stage stage(kWidth, kHeight);
    const auto root = sceneFor(GetParam(), surface, slanted());
    terrainIn(root.get())->debugView = SoTerrainShape::TILES;
    const Image picture = stage.render(root.get());
    savePicture("debug_tiles_" + identifierOf(GetParam()), {picture});
    const Mesh mesh(GetParam(), surface, static_cast<SoCamera*>(root->getChild(0)));
    int looked = 0, wrong = 0;
    mesh.eachPixel(stage.depth(), [&](const Triangle& triangle, int x, int y, const glm::dvec3&) {
        ++looked;
        wrong += distanceOf(pixelOf(picture, x, y), triangle.patch) > kSame;
    });
    EXPECT_GT(looked, 10000);
    EXPECT_LE(wrong, looked / 500);
}

TEST_P(DebugViews, ShowTheErrorOfEachPixel) {
    const Surface surface = hills();
    Stage stage(kWidth, kHeight);
    std::vector<Image> pictures;
    for (SoCamera* (*camera)() : {slanted, near, grazing}) {
        const auto root = sceneFor(GetParam(), surface, camera());
        terrainIn(root.get())->debugView = SoTerrainShape::ERRORS;
        pictures.push_back(stage.render(root.get()));
        const Mesh mesh(GetParam(), surface, static_cast<SoCamera*>(root->getChild(0)));
        int looked = 0;
        double off = 0.0, shown = 0.0, expected = 0.0;
        mesh.eachPixel(stage.depth(), [&](const Triangle& triangle, int x, int y, const glm::dvec3& weights) {
            const double part = partOf(pixelOf(pictures.back(), x, y)), error = mesh.errorAt(triangle, weights) / 2.0;
            ++looked;
            shown = std::max(shown, part);
            expected = std::max(expected, error);
            if (!triangle.closesGaps) off = std::max(off, error > 1.01 ? 2.0 - part : std::fabs(std::min(part, 1.0) - error));
        });
        EXPECT_GT(looked, 10000);
        EXPECT_LE(off, 0.02) << "of pixelError";
        if (GetParam() == Kind::BruteForce)
            EXPECT_EQ(shown, 0.0);
        else
            EXPECT_GT(shown, 0.4);
        if (GetParam() != Kind::Clipmap) {
            EXPECT_LE(shown, 1.0) << "magenta though the promise is kept";
        }
        std::printf("%s: at most %.3f of pixelError shown, %.3f expected, off by %.4f\n", nameOf(GetParam()), shown, expected, off);
    }
    savePicture("debug_errors_" + identifierOf(GetParam()), pictures);
}

TEST_P(DebugViews, ShowABrokenPromiseOfAFrozenMeshInMagenta) {
    const Surface surface = hills();
    Stage stage(kWidth, kHeight);
    const auto root = sceneFor(GetParam(), surface, far());
    SoTerrainShape* node = terrainIn(root.get());
    node->debugView = SoTerrainShape::ERRORS;
    const Image before = stage.render(root.get());
    node->freeze = TRUE;
    const SbVec3f ground = surface.at(96, 60);
    root->replaceChild(0, cameraAt(ground + SbVec3f(0.0f, 0.0f, 7.0f), ground + SbVec3f(0.0f, 20.0f, -3.0f), 0.2f, 400.0f));
    const Image after = stage.render(root.get());
    const std::vector<float> depth = stage.depth();
    int broken = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            broken += depth[std::size_t(y * kWidth + x)] < 1.0f && pixelOf(after, x, y) == terrain::kBrokenColour;
    savePicture("debug_broken_" + identifierOf(GetParam()), {before, after});
    if (GetParam() == Kind::BruteForce)
        EXPECT_EQ(broken, 0);
    else
        EXPECT_GT(broken, 2000);
}

TEST_P(DebugViews, DrawEdgesOverTheSurfaceAndNothingElse) {
    const Surface surface = hills();
    Stage stage(kWidth, kHeight);
    std::vector<Image> pictures;
    for (SoCamera* (*camera)() : {slanted, near, grazing, far}) {
        const auto root = sceneFor(GetParam(), surface, camera(), unlitTexture);
        SoTerrainShape* node = terrainIn(root.get());
        if (auto* clipmap = dynamic_cast<SoGeometryClipmapTerrain*>(node)) clipmap->implementation = SoGeometryClipmapTerrain::CPU;
        const Image plain = stage.render(root.get());
        node->wireframeOverlay = TRUE;
        const Image picture = stage.render(root.get());
        pictures.push_back(picture);
        const Mesh mesh(GetParam(), surface, static_cast<SoCamera*>(root->getChild(0)));
        int inside = 0, changed = 0, along = 0, missing = 0;
        mesh.eachPixel(stage.depth(), [&](const Triangle& triangle, int x, int y, const glm::dvec3& weights) {
            if (triangle.closesGaps) return;
            const glm::dvec2 a(triangle.corner[0].window), b(triangle.corner[1].window), c(triangle.corner[2].window);
            const double area = std::fabs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
            const glm::dvec3 away = weights * area / glm::dvec3(glm::length(c - b), glm::length(c - a), glm::length(b - a));
            const double nearest = std::min({away.x, away.y, away.z});
            const bool differs = pixelOf(picture, x, y) != pixelOf(plain, x, y);
            if (nearest > 1.3) ++inside, changed += differs;
            if (nearest < 0.5 && pixelOf(plain, x, y) != Colour(0.0f)) ++along, missing += !differs;
        });
        EXPECT_EQ(changed, 0) << "of " << inside << " pixels within triangles";
        EXPECT_GT(along, 200);
        EXPECT_LE(missing, along / 200) << "of " << along << " pixels along edges";
    }
    savePicture("debug_overlay_" + identifierOf(GetParam()), pictures);
}

TEST_P(DebugViews, DoNotDependOnWhatTheTerrainLooksLike) {
    const Surface surface = hills();
    Stage stage(kWidth, kHeight);
    for (const int view : {SoTerrainShape::TILES, SoTerrainShape::LEVELS, SoTerrainShape::ERRORS}) {
        std::vector<Image> pictures;
        for (const bool dressed : {false, true}) {
            const auto root = sceneFor(GetParam(), surface, slanted(), [&](SoSeparator* group) {
                if (!dressed) return;
                addTexture(group);
                auto* material = new SoMaterial;
                material->transparency = 0.5f;
                material->diffuseColor = SbColor(1.0f, 0.0f, 0.0f);
                group->addChild(material);
            });
            terrainIn(root.get())->debugView = view;
            pictures.push_back(stage.render(root.get()));
        }
        EXPECT_EQ(pictures[0].pixels, pictures[1].pixels) << view;
    }
}

TEST_P(DebugViews, AreOpaqueWhateverTheTransparencyType) {
    const Surface surface = hills();
    Stage stage(kWidth, kHeight);
    for (const int view : {SoTerrainShape::LEVELS, SoTerrainShape::ERRORS}) {
        std::vector<Image> pictures;
        for (const auto type : {SoGLRenderAction::NONE, SoGLRenderAction::SCREEN_DOOR, SoGLRenderAction::ADD, SoGLRenderAction::DELAYED_ADD,
                                SoGLRenderAction::BLEND, SoGLRenderAction::DELAYED_BLEND, SoGLRenderAction::SORTED_OBJECT_BLEND,
                                SoGLRenderAction::SORTED_LAYERS_BLEND}) {
            const auto root = sceneFor(GetParam(), surface, slanted(), [](SoSeparator* group) {
                auto* material = new SoMaterial;
                material->transparency = 0.5f;
                group->addChild(material);
            });
            terrainIn(root.get())->debugView = view;
            terrainIn(root.get())->wireframeOverlay = TRUE;
            stage.action().setTransparencyType(type);
            pictures.push_back(stage.render(root.get()));
            if (pictures.size() == 1) continue;
            const Difference off = compare(pictures[0], pictures.back());
            EXPECT_LE(off.mean, 1.0) << "debugView " << view << ", transparency type " << int(type);
            EXPECT_EQ(off.onlyFirst + off.onlySecond, 0) << "debugView " << view << ", transparency type " << int(type);
        }
        savePicture("debug_transparent_" + identifierOf(GetParam()) + std::to_string(view), pictures);
    }
}

TEST_P(DebugViews, KeepAFrozenMeshThatWasChosenWithoutThem) {
    const Surface surface = hills();
    Stage stage(kWidth, kHeight);
    std::vector<Image> pictures;
    for (const bool early : {true, false}) {
        const auto root = sceneFor(GetParam(), surface, near());
        SoTerrainShape* node = terrainIn(root.get());
        if (early) node->debugView = SoTerrainShape::LEVELS;
        stage.render(root.get());
        node->freeze = TRUE;
        root->replaceChild(0, slanted());
        node->debugView = SoTerrainShape::LEVELS;
        node->frozenFrustum = TRUE;
        pictures.push_back(stage.render(root.get()));
        node->frozenFrustum = FALSE;
        EXPECT_NE(stage.render(root.get()).pixels, pictures.back().pixels) << "no view volume";
    }
    EXPECT_EQ(pictures[0].pixels, pictures[1].pixels);
    savePicture("debug_frozen_" + identifierOf(GetParam()), pictures);
}

TEST(DebugView, LoadingTellsWhatStandsInAndWhatIsNew) {
    const Surface surface = surfaceOf(fractalMap(513, 513, 60.0));
    Stage stage(kWidth, kHeight);
    const auto root = sceneFor(Kind::ChunkedLod, surface, near(), unlit, 0.5f);
    auto* node = static_cast<SoChunkedLoDTerrain*>(terrainIn(root.get()));
    node->background = TRUE;
    node->uploadBudget = 16;
    node->debugView = SoTerrainShape::LOADING;
    // Pixels of the four colours, and all that there are.
    const auto count = [&](const Image& picture) {
        std::array<int, 5> found{};
        const std::vector<float> depth = stage.depth();
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                if (depth[std::size_t(y * kWidth + x)] == 1.0f) continue;
                const Colour colour = pixelOf(picture, x, y);
                ++found[4];
                found[0] += distanceOf(colour, terrain::kSettledColour) < kSame;
                found[1] += distanceOf(colour, terrain::kStandInColour) < kSame;
                found[2] += distanceOf(colour, terrain::kNewColour) < kSame;
                found[3] += distanceOf(colour, terrain::kNewStandInColour) < kSame;
            }
        EXPECT_GT(found[4], 10000);
        EXPECT_EQ(found[0] + found[1] + found[2] + found[3], found[4]);
        return found;
    };
    std::vector<Image> pictures{stage.render(root.get())};
    const auto first = count(pictures[0]);
    EXPECT_EQ(first[3], first[4]) << "the first tile comes in the first frame, and finer ones are wanted";
    bool cameLater = false;
    int stoodIn = 0;
    for (int frame = 0; !node->getStatistics().converged; ++frame) {
        ASSERT_LT(frame, 5000) << "never complete";
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        const Image picture = stage.render(root.get());
        const auto now = count(picture);
        if (now[1] > stoodIn) pictures.push_back(picture);
        stoodIn = std::max(stoodIn, now[1]);
        cameLater = cameLater || (now[2] > 0 && now[0] > 0);
    }
    EXPECT_GT(stoodIn, 100);
    EXPECT_TRUE(cameLater);
    pictures.push_back(stage.render(root.get()));
    const auto last = count(pictures.back());
    EXPECT_EQ(last[0], last[4]) << "at rest";
    savePicture("debug_loading", pictures);
}

TEST(DebugView, LoadingIsNeutralWhereNothingIsLoaded) {
    const Surface surface = hills();
    Stage stage(kWidth, kHeight);
    for (const Kind kind : {Kind::BruteForce, Kind::Roam, Kind::GeoMipmap}) {
        const auto root = sceneFor(kind, surface, slanted());
        terrainIn(root.get())->debugView = SoTerrainShape::LOADING;
        const Image picture = stage.render(root.get());
        const std::vector<float> depth = stage.depth();
        for (int i = 0; i < kWidth * kHeight; ++i)
            if (depth[std::size_t(i)] < 1.0f) {
                ASSERT_LT(distanceOf(pixelOf(picture, i % kWidth, i / kWidth), terrain::kSettledColour), kSame) << nameOf(kind);
            }
    }
}

/// A clipmap whose updates have a budget falls behind a jump.
TEST(DebugView, LoadingTellsWhereLevelsOfAClipmapFellBehind) {
    const Surface surface = hills();
    Stage stage(kWidth, kHeight);
    const auto root = sceneFor(Kind::Clipmap, surface, slanted());
    auto* node = static_cast<SoGeometryClipmapTerrain*>(terrainIn(root.get()));
    node->updateBudget = 200;
    node->pixelError = 0.5f;
    node->debugView = SoTerrainShape::LOADING;
    stage.render(root.get());
    root->replaceChild(0, cameraAt(SbVec3f(96.0f, 190.0f, 90.0f), SbVec3f(96.0f, 80.0f, 20.0f), 2.0f, 400.0f));
    std::vector<Image> pictures;
    int most = 0;
    for (int frame = 0; frame < 100; ++frame) {
        const Image picture = stage.render(root.get());
        int standIns = 0;
        for (int i = 0; i < kWidth * kHeight; ++i)
            standIns += distanceOf(pixelOf(picture, i % kWidth, i / kWidth), terrain::kStandInColour) < kSame;
        if (standIns > most) pictures = {picture};
        most = std::max(most, standIns);
        if (!node->getStatistics().converged) continue;
        EXPECT_EQ(standIns, 0);
        break;
    }
    EXPECT_TRUE(node->getStatistics().converged);
    EXPECT_GT(most, 5000);
    pictures.push_back(stage.render(root.get()));
    savePicture("debug_loading_clipmap", pictures);
}

/// What no texture of heights serves, triangle by triangle: at least what each pixel has, and still within the promise.
TEST(DebugView, ErrorsOfCurvedGridsAreThoseOfTheWorstSample) {
    const terrain::HeightMap map = fractalMap(129, 129, 30.0);
    const Surface flat = surfaceOf(map);
    const Surface curved = surfaceOf(map, [](int column, int row, float height) {
        return SbVec3f(float(column), float(row),
                       height - 1e-3f * float((column - 64) * (column - 64)) + 0.02f * std::sin(float(row)));
    });
    // One sample aside makes a grid that is no regular one of almost the same surface.
    Surface nearlyFlat = flat;
    nearlyFlat.points[nearlyFlat.index(64, 64)] += SbVec3f(0.05f, 0.0f, 0.0f);
    Stage stage(kWidth, kHeight);
    SoCamera* (*camera)() = [] { return cameraAt(SbVec3f(64.0f, -30.0f, 60.0f), SbVec3f(64.0f, 64.0f, 10.0f), 1.0f, 300.0f); };
    std::vector<Image> pictures;
    for (const Kind kind : kLodKinds) {
        std::array<double, 3> largest{};
        int i = 0;
        for (const Surface* surface : {&flat, const_cast<const Surface*>(&nearlyFlat), &curved}) {
            const auto root = sceneFor(kind, *surface, camera());
            terrainIn(root.get())->debugView = SoTerrainShape::ERRORS;
            pictures.push_back(stage.render(root.get()));
            const std::vector<float> depth = stage.depth();
            for (int pixel = 0; pixel < kWidth * kHeight; ++pixel)
                if (depth[std::size_t(pixel)] < 1.0f)
                    largest[std::size_t(i)] =
                        std::max(largest[std::size_t(i)], partOf(pixelOf(pictures.back(), pixel % kWidth, pixel / kWidth)));
            ++i;
        }
        std::printf("%s: flat %.3f, by triangle %.3f, curved %.3f\n", nameOf(kind), largest[0], largest[1], largest[2]);
        if (kind == Kind::Clipmap) continue;
        EXPECT_LE(largest[1], 1.0) << nameOf(kind);
        EXPECT_LE(largest[2], 1.0) << nameOf(kind);
        EXPECT_GT(largest[2], 0.4) << nameOf(kind);
    }
    savePicture("debug_errors_curved", pictures);
}

TEST_P(DebugViews, LeaveHolesOpen) {
    auto map = fractalMap(129, 97, 30.0);
    for (int row = 30; row < 55; ++row)
        for (int column = 40; column < 90; ++column) map.heights[std::size_t(row * 129 + column)] = std::numeric_limits<float>::quiet_NaN();
    const Surface surface = surfaceOf(map);
    Stage stage(kWidth, kHeight);
    const auto root =
        sceneFor(GetParam(), surface, cameraAt(SbVec3f(64.0f, -20.0f, 70.0f), SbVec3f(64.0f, 45.0f, 10.0f), 1.0f, 300.0f), unlitTexture);
    SoTerrainShape* node = terrainIn(root.get());
    if (auto* clipmap = dynamic_cast<SoGeometryClipmapTerrain*>(node)) clipmap->implementation = SoGeometryClipmapTerrain::CPU;
    const Image plain = stage.render(root.get());
    const std::vector<float> depth = stage.depth();
    std::vector<Image> pictures{plain};
    for (const int view : {SoTerrainShape::TILES, SoTerrainShape::LEVELS, SoTerrainShape::ERRORS, SoTerrainShape::LOADING}) {
        node->debugView = view;
        pictures.push_back(stage.render(root.get()));
        EXPECT_EQ(stage.depth(), depth) << "the same mesh at the same depth";
        if (view != SoTerrainShape::ERRORS || GetParam() == Kind::Clipmap) continue;
        for (int i = 0; i < kWidth * kHeight; ++i) {
            if (depth[std::size_t(i)] < 1.0f) {
                ASSERT_LE(partOf(pixelOf(pictures.back(), i % kWidth, i / kWidth)), 1.0) << i % kWidth << ' ' << i / kWidth;
            }
        }
    }
    savePicture("debug_holes_" + identifierOf(GetParam()), pictures);
}

/// Two cameras on one node: each has the errors of its own mesh, on its own screen.
TEST_P(DebugViews, OfTwoViewsAreThoseOfEach) {
    const Surface surface = hills();
    Stage stage(kWidth, kHeight);
    const auto one = sceneFor(GetParam(), surface, slanted()), other = sceneFor(GetParam(), surface, near());
    // The second scene draws the first one's node.
    auto* shape = static_cast<SoSeparator*>(static_cast<SoSeparator*>(other->getChild(2))->getChild(1));
    SoTerrainShape* node = terrainIn(one.get());
    const Ref<SoSeparator> alone = sceneFor(GetParam(), surface, near());
    terrainIn(alone.get())->debugView = node->debugView = SoTerrainShape::ERRORS;
    const Image expected = stage.render(alone.get());
    shape->replaceChild(shape->getNumChildren() - 1, node);
    const Image first = stage.render(one.get());
    EXPECT_EQ(stage.render(other.get()).pixels, expected.pixels);
    EXPECT_EQ(stage.render(one.get()).pixels, first.pixels);
    EXPECT_EQ(stage.render(other.get()).pixels, expected.pixels);
}

INSTANTIATE_TEST_SUITE_P(Nodes, DebugViews, testing::ValuesIn(kOurKinds),
                         [](const auto& info) { return identifierOf(info.param); });
