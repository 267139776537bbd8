// Large tiles over samples that change.
#include <algorithm>
#include <limits>

#include <glm/common.hpp>

#include "lod/TileDeviation.h"
#include "lod/TileMesh.h"

namespace terrain {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Largest deviation of the changed samples in a triangle of which all corners are as they were.
template <class Samples>
float changedDeviation(const Samples& samples, glm::ivec2 a, glm::ivec2 b, glm::ivec2 c, const GridEdits& edits) {
    const auto plane = planeThrough(samples, a, b, c);
    const SampleRect box{glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))};
    float deviation = 0.0f;
    for (const SampleRect& rect : edits.rects) {
        const SampleRect part = rect.cutTo(box);
        for (int row = part.low.y; row <= part.high.y; ++row)
            for (int column = part.low.x; column <= part.high.x; ++column) {
                const glm::ivec2 p(column, row);
                if (crossProduct(b - a, p - a) < 0 || crossProduct(c - b, p - b) < 0 || crossProduct(a - c, p - c) < 0) continue;
                deviation = std::max(deviation, Samples::length(samples.at(p) - plane.at(p)));
            }
    }
    return deviation;
}

template <class Samples>
float changedError(const Samples& samples, const TileMesh& mesh, const GridEdits& edits) {
    float error = mesh.error;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const glm::ivec2 a = mesh.at[mesh.indices[i]], b = mesh.at[mesh.indices[i + 1]], c = mesh.at[mesh.indices[i + 2]];
        if (!edits.touches({glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))})) continue;
        const bool moves = edits.contains(a) || edits.contains(b) || edits.contains(c);
        error = std::max(error, moves ? triangleDeviation(samples, a, b, c, kInfinity) : changedDeviation(samples, a, b, c, edits));
    }
    return error;
}

}  // namespace

std::shared_ptr<const TileMesh> changedTile(const TileSamples& samples, const TileMesh& before, const GridEdits& edits) {
    auto mesh = std::make_shared<TileMesh>(before);
    mesh->fall.clear();
    mesh->error = samples.isRegular() ? changedError(HeightSamples{samples}, before, edits) : changedError(PointSamples{samples}, before, edits);
    return mesh;
}

}  // namespace terrain
