// Cameras for tests, and a direct projection in double to compare with.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "base/Box.h"
#include "base/View.h"
#include "height/SampleGrid.h"
#include "lod/LodAlgorithm.h"

namespace terrain::test {

/// The same numbers with every standard library, unlike its distributions.
inline double uniform(std::mt19937& random, double low, double high)
{
    return low + (high - low) * (double(random()) / 4294967295.0);
}

inline int uniformInt(std::mt19937& random, int low, int high)
{
    return low + int(random() % unsigned(high - low + 1));
}

inline glm::dvec3 uniformIn(std::mt19937& random, const glm::dvec3& low, const glm::dvec3& high)
{
    return {uniform(random, low.x, high.x), uniform(random, low.y, high.y), uniform(random, low.z, high.z)};
}

inline glm::dvec3 randomDirection(std::mt19937& random)
{
    for (;;) {
        const glm::dvec3 v = uniformIn(random, glm::dvec3(-1.0), glm::dvec3(1.0));
        const double length = glm::length(v);
        if (length > 0.1 && length < 1.0) return v / length;
    }
}

/// Where a local point lands.
struct Projected {
    bool inView = false;
    glm::dvec2 pixel{0.0};
    double w = 0.0;
};

/// `margin` > 0 makes the view volume smaller by this part, so that rounding cannot make an outside point count.
inline Projected project(const View& view, const glm::dvec3& local, double margin = 1e-5)
{
    const glm::dvec4 clip = view.clipFromLocal * glm::dvec4(local, 1.0);
    const double limit = clip.w * (1.0 - margin);
    Projected result;
    result.inView = clip.w > 0.0 && std::fabs(clip.x) <= limit && std::fabs(clip.y) <= limit && std::fabs(clip.z) <= limit;
    result.pixel = (glm::dvec2(clip.x, clip.y) / clip.w * 0.5 + 0.5) * view.viewportPixels;
    result.w = clip.w;
    return result;
}

/// Rotation, translation and a scale that differs along the axes, as a model transform may have them.
inline glm::dmat4 randomModel(std::mt19937& random)
{
    glm::dmat4 model = glm::translate(glm::dmat4(1.0), uniformIn(random, glm::dvec3(-50.0), glm::dvec3(50.0)));
    model = glm::rotate(model, uniform(random, -3.0, 3.0), randomDirection(random));
    return glm::scale(model, uniformIn(random, glm::dvec3(0.3), glm::dvec3(3.0)));
}

/// Perspective, off-axis or orthographic projection for something `distance` away, `size` large.
inline glm::dmat4 randomProjection(std::mt19937& random, double aspect, double distance, double size)
{
    const double nearPlane = distance * uniform(random, 0.005, 0.1), farPlane = distance + 4.0 * size;
    switch (uniformInt(random, 0, 2)) {
    case 0: return glm::perspective(uniform(random, 0.3, 1.8), aspect, nearPlane, farPlane);
    case 1: {
        const double half = nearPlane * uniform(random, 0.2, 0.8), x = half * uniform(random, -0.8, 0.8), y = half * uniform(random, -0.8, 0.8);
        return glm::frustum(x - half * aspect, x + half * aspect, y - half, y + half, nearPlane, farPlane);
    }
    default: {
        const double half = size * uniform(random, 0.1, 0.7);
        return glm::ortho(-half * aspect, half * aspect, -half, half, nearPlane, farPlane);
    }
    }
}

/// A camera anywhere in or around the box that looks at a point of it, with or without a model transform.
inline View randomView(std::mt19937& random, const Box& around)
{
    const glm::dvec2 viewport(uniformInt(random, 300, 1200), uniformInt(random, 200, 900));
    const glm::dmat4 model = uniformInt(random, 0, 1) ? randomModel(random) : glm::dmat4(1.0);
    const glm::dvec3 low(around.lowest()), high(around.highest());
    const double size = glm::length(high - low);
    const glm::dvec3 target = uniformIn(random, low, high);
    glm::dvec3 eye = target + randomDirection(random) * size * std::pow(uniform(random, 0.2, 1.2), 2.0);
    if (uniformInt(random, 0, 3) > 0) eye.z = std::max(eye.z, target.z + 0.1 * std::fabs(eye.z - target.z));
    const auto world = [&model](const glm::dvec3& p) { return glm::dvec3(model * glm::dvec4(p, 1.0)); };
    const double distance = glm::length(world(target) - world(eye));
    const glm::dmat4 camera = glm::lookAt(world(eye), world(target), uniformInt(random, 0, 1) ? glm::dvec3(0.1, 0.05, 1.0) : randomDirection(random));
    return {randomProjection(random, viewport.x / viewport.y, distance, glm::length(world(high) - world(low))) * camera * model, viewport};
}

/// Frame `frame` of a round of `frames` over the middle of the box, looking along the path and down a little.
inline View flightView(const Box& over, int frame, int frames)
{
    const double t = 6.283185307179586 * frame / frames;
    const glm::dvec3 half(over.half);
    const double reach = std::max(half.x, half.y);
    const glm::dvec3 eye = glm::dvec3(over.centre) + glm::dvec3(0.6 * half.x * std::cos(t), 0.6 * half.y * std::sin(t), half.z + 0.15 * reach);
    const glm::dvec3 ahead(-half.x * std::sin(t), half.y * std::cos(t), -0.4 * reach);
    const glm::dmat4 camera = glm::lookAt(eye, eye + ahead, glm::dvec3(0.0, 0.0, 1.0));
    return {glm::perspective(0.9, 4.0 / 3.0, 0.01 * reach, 6.0 * reach) * camera, {1024.0, 768.0}};
}

/// Now a jump, now a step of a flight.
inline View nextView(std::mt19937& random, const Box& over, int i)
{
    return i % 3 == 0 ? randomView(random, over) : flightView(over, i, 40);
}

/// Largest way on screen, beyond what the camera does, of any sample in view whose drawn height, by its index, was `before` and is
/// `now`; NaN: not drawn.
inline double largestMove(const SampleGrid& grid, const View& view, const std::vector<double>& before, const std::vector<double>& now)
{
    double largest = 0.0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        if (std::isnan(now[i]) || std::isnan(before[i]) || now[i] == before[i]) continue;
        glm::dvec3 p(grid.position(int(i % std::size_t(grid.columns())), int(i / std::size_t(grid.columns()))));
        if (!project(view, p).inView) continue;
        p.z = now[i];
        const glm::dvec2 there = project(view, p).pixel;
        p.z = before[i];
        largest = std::max(largest, glm::distance(there, project(view, p).pixel));
    }
    return largest;
}

inline LodSettings randomSettings(std::mt19937& random)
{
    constexpr float errors[] = {0.5f, 1.0f, 2.0f, 6.0f, 40.0f};
    LodSettings settings;
    settings.pixelError = errors[uniformInt(random, 0, 4)];
    settings.cull = uniformInt(random, 0, 1) != 0;
    settings.geomorph = uniformInt(random, 0, 1) != 0;
    settings.clockwise = uniformInt(random, 0, 3) == 0;
    return settings;
}

}  // namespace terrain::test
