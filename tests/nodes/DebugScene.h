// What the tests of debugView share: scenes, and the mesh that a node has for a view, chosen once more and looked at pixel by
// pixel.
#pragma once

#include "Scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include <Inventor/nodes/SoLightModel.h>

#include <SoTerrain/SoGeometryClipmapTerrain.h>

#include "lod/BruteForceMesh.h"
#include "lod/ChunkedLod.h"
#include "lod/ClipmapMesh.h"
#include "lod/DebugColours.h"
#include "lod/GeoMipmapMesh.h"
#include "lod/RoamMesh.h"

namespace test::debug {

using terrain::Colour;
using terrain::Image;

inline constexpr int kWidth = 320, kHeight = 240;

inline terrain::View viewOf(SoCamera* camera) {
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

inline Surface hills() {
    return surfaceOf(fractalMap(193, 161, 50.0));
}

inline SoCamera* slanted() {
    return cameraAt(SbVec3f(96.0f, -30.0f, 90.0f), SbVec3f(96.0f, 80.0f, 20.0f), 2.0f, 400.0f);
}
inline SoCamera* near() {
    return cameraAt(SbVec3f(90.0f, 20.0f, 62.0f), SbVec3f(100.0f, 80.0f, 25.0f), 0.5f, 400.0f);
}
inline SoCamera* grazing() {
    return cameraAt(SbVec3f(-60.0f, 81.3f, 48.0f), SbVec3f(100.0f, 80.0f, 22.0f), 1.0f, 400.0f);
}
inline SoCamera* far() {
    return cameraAt(SbVec3f(96.0f, -900.0f, 500.0f), SbVec3f(96.0f, 80.0f, 20.0f), 100.0f, 2000.0f);
}

inline void unlit(SoSeparator* group) {
    auto* model = new SoLightModel;
    model->model = SoLightModel::BASE_COLOR;
    group->addChild(model);
}

inline Ref<SoSeparator> sceneFor(Kind kind, const Surface& surface, SoCamera* camera, const Dressing& dress = unlit,
                                 float pixelError = 2.0f) {
    Ref<SoSeparator> root = sceneOf(kind, surface, {.pixelError = pixelError}, dress, camera);
    if (auto* clipmap = dynamic_cast<SoGeometryClipmapTerrain*>(terrainIn(root.get()))) clipmap->clipmapSize = 31;
    return root;
}

/// Pixels are counted from the bottom, as GL counts them.
inline Colour pixelOf(const Image& image, int x, int y) {
    const std::uint8_t* p = &image.pixels[std::size_t((kHeight - 1 - y) * kWidth + x) * std::size_t(image.channels)];
    return Colour(p[0], p[1], p[2]) / 255.0f;
}

inline float distanceOf(const Colour& a, const Colour& b) {
    const Colour off = glm::abs(a - b);
    return std::max({off.x, off.y, off.z});
}

/// The part of the allowed error that a colour says.
inline double partOf(const Colour& colour) {
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

inline constexpr float kSame = 1.5f / 255.0f;

}  // namespace test::debug
