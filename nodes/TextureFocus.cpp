#include "TextureFocus.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Inventor/SbMatrix.h>
#include <Inventor/elements/SoMultiTextureCoordinateElement.h>
#include <Inventor/elements/SoMultiTextureMatrixElement.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include "StateAttributes.h"

namespace {

/// Samples looked at along each axis where a whole grid is too many.
constexpr int kProbes = 32;

/// The texture coordinates that GL will have at samples.
class Coordinates {
public:
    Coordinates(SoState * state, const terrain::SampleGrid & gridArg, const StateAttributes & attributesArg)
        : grid(gridArg), attributes(attributesArg), element(SoMultiTextureCoordinateElement::getInstance(state)),
          matrix(SoMultiTextureMatrixElement::get(state, 0))
    {
    }

    glm::dvec2 at(int column, int row) const
    {
        const SbVec2f plain = attributes.textureCoordinate(0, column, row);
        SbVec4f full(plain[0], plain[1], 0.0f, 1.0f);
        if (element->getType(0) == SoMultiTextureCoordinateElement::FUNCTION && !grid.isHole(column, row)) {
            const glm::vec3 p = grid.position(column, row);
            full = element->get(0, SbVec3f(p.x, p.y, p.z), attributes.normal(column, row));
        }
        SbVec4f moved;
        matrix.multVecMatrix(full, moved);
        const double q = moved[3] != 0.0f ? moved[3] : 1.0;
        return {moved[0] / q, moved[1] / q};
    }

    /// Between samples: linear along both axes.
    glm::dvec2 between(glm::dvec2 place) const
    {
        const int column = std::min(int(place.x), grid.columns() - 2), row = std::min(int(place.y), grid.rows() - 2);
        const double u = place.x - column, v = place.y - row;
        return (1.0 - v) * ((1.0 - u) * at(column, row) + u * at(column + 1, row)) +
               v * ((1.0 - u) * at(column, row + 1) + u * at(column + 1, row + 1));
    }

private:
    const terrain::SampleGrid & grid;
    const StateAttributes & attributes;
    const SoMultiTextureCoordinateElement * element;
    const SbMatrix & matrix;
};

/// The eye in a frame of reference, or nothing for parallel rays.
std::optional<glm::dvec3> eyeOf(const glm::dmat4 & frameFromClip)
{
    const glm::dvec4 eye = frameFromClip[2];
    if (std::abs(eye.w) <= 1e-12 * glm::length(glm::dvec3(eye))) return std::nullopt;
    return glm::dvec3(eye) / eye.w;
}

glm::dvec2 clampTo(const terrain::SampleGrid & grid, glm::dvec2 place)
{
    if (!std::isfinite(place.x) || !std::isfinite(place.y)) return {0.5 * (grid.columns() - 1), 0.5 * (grid.rows() - 1)};
    return {std::clamp(place.x, 0.0, grid.columns() - 1.0), std::clamp(place.y, 0.0, grid.rows() - 1.0)};
}

double heightNear(const terrain::SampleGrid & grid, glm::dvec2 place)
{
    const int column = int(std::lround(place.x)), row = int(std::lround(place.y));
    return grid.isHole(column, row) ? 0.0 : double(grid.framePosition(column, row).z);
}

/// Of a regular grid, in columns and rows: where the rays of the view that meet a level plane do so nearest to `from`, or at the window's middle.
std::optional<glm::dvec2> nearestInView(const terrain::SampleGrid & grid, const glm::dmat4 & frameFromClip, double height,
                                        const std::optional<glm::dvec3> & eye)
{
    std::optional<glm::dvec2> best;
    double least = std::numeric_limits<double>::infinity();
    for (int j = -2; j <= 2; ++j)
        for (int i = -2; i <= 2; ++i) {
            const glm::dvec4 n = frameFromClip * glm::dvec4(i * 0.5, j * 0.5, -1.0, 1.0), f = frameFromClip * glm::dvec4(i * 0.5, j * 0.5, 1.0, 1.0);
            const glm::dvec3 begin = glm::dvec3(n) / n.w, end = glm::dvec3(f) / f.w;
            const double t = (height - begin.z) / (end.z - begin.z);
            if (!(t >= 0.0 && t <= 1.0)) continue;
            const glm::dvec2 place = clampTo(grid, glm::dvec2(begin + t * (end - begin)));
            const double far = eye ? glm::length(place - glm::dvec2(*eye)) : i * i + j * j;
            if (far >= least) continue;
            least = far;
            best = place;
        }
    return best;
}

bool isInView(const glm::dmat4 & clipFromFrame, const glm::dvec3 & point)
{
    const glm::dvec4 clip = clipFromFrame * glm::dvec4(point, 1.0);
    return std::abs(clip.x) <= clip.w && std::abs(clip.y) <= clip.w;
}

/// Calls `look(column, row)` for samples all over the grid, borders included.
template <class Look>
void probe(const terrain::SampleGrid & grid, const Look & look)
{
    for (int j = 0; j <= kProbes; ++j)
        for (int i = 0; i <= kProbes; ++i) {
            const int column = int(std::int64_t(grid.columns() - 1) * i / kProbes), row = int(std::int64_t(grid.rows() - 1) * j / kProbes);
            if (!grid.isHole(column, row)) look(column, row);
        }
}

glm::dvec2 nearestSample(const terrain::SampleGrid & grid, const glm::dvec3 & localEye)
{
    glm::dvec2 best(0.5 * (grid.columns() - 1), 0.5 * (grid.rows() - 1));
    double least = std::numeric_limits<double>::infinity();
    const auto look = [&](int column, int row) {
        const double far = glm::length(glm::dvec3(grid.position(column, row)) - localEye);
        if (far >= least) return;
        least = far;
        best = {column, row};
    };
    probe(grid, look);
    // Then around the best one, closer and closer.
    for (int step = std::max(grid.columns(), grid.rows()) / kProbes / 2; step >= 1; step /= 2) {
        const glm::ivec2 centre(best);
        for (int j = -2; j <= 2; ++j)
            for (int i = -2; i <= 2; ++i) {
                const int column = centre.x + i * step, row = centre.y + j * step;
                if (grid.contains(column, row) && !grid.isHole(column, row)) look(column, row);
            }
    }
    return best;
}

/// Texels along a unit of local length where they are densest, about.
double texelsPerUnit(const terrain::SampleGrid & grid, const Coordinates & coordinates, glm::dvec2 place, glm::dvec2 texels)
{
    const int column = std::min(int(place.x), grid.columns() - 2), row = std::min(int(place.y), grid.rows() - 2);
    const glm::dvec2 st = coordinates.at(column, row);
    double most = 0.0;
    for (const glm::ivec2 & step : {glm::ivec2(1, 0), glm::ivec2(0, 1)}) {
        const double wide = glm::length((coordinates.at(column + step.x, row + step.y) - st) * texels);
        const glm::dvec4 along = grid.localFromFrame() * glm::dvec4(step.x, step.y, 0.0, 0.0);
        const double length = grid.isRegular()
                                  ? glm::length(glm::dvec3(along))
                                  : glm::length(glm::dvec3(grid.position(column + step.x, row + step.y) - grid.position(column, row)));
        if (length > 0.0 && std::isfinite(wide / length)) most = std::max(most, wide / length);
    }
    return most;
}

/// The finest level that shows anywhere.
int finestLevelOf(const terrain::View & camera, const std::optional<glm::dvec3> & localEye, const terrain::SampleGrid & grid,
                  const Coordinates & coordinates, glm::dvec2 place, glm::dvec2 texels)
{
    // Nearest ground to the eye, by samples all over and at the focus; what lies between may be nearer by half.
    double nearest = 1.0;
    if (localEye) {
        nearest = std::numeric_limits<double>::infinity();
        const auto look = [&](int column, int row) {
            nearest = std::min(nearest, glm::length(glm::dvec3(grid.position(column, row)) - *localEye));
        };
        probe(grid, look);
        if (!grid.isHole(int(place.x), int(place.y))) look(int(place.x), int(place.y));
        nearest *= 0.5;
    }
    const terrain::ScreenSpace screen(camera, glm::dmat4(1.0), terrain::ErrorDirection::Any);
    const double pixelsPerUnit = double(screen.largestFactor()) / nearest;
    const double level = std::log2(texelsPerUnit(grid, coordinates, place, texels) / pixelsPerUnit);
    return level > 0.0 ? int(std::min(level, 30.0)) : 0;
}

/// How far ahead of the focus windows lie: by much of their size when looking to the horizon, not at all when looking down.
glm::dvec2 leadOf(const terrain::SampleGrid & grid, const Coordinates & coordinates, glm::dvec2 place, const glm::dmat4 & frameFromClip,
                  glm::dvec2 texels)
{
    // Leaves a part of the window to what lies beside and behind the focus, and for turning.
    constexpr double kMost = 0.3;
    const glm::dvec4 n = frameFromClip * glm::dvec4(0.0, 0.0, -1.0, 1.0), f = frameFromClip * glm::dvec4(0.0, 0.0, 1.0, 1.0);
    const glm::dvec3 ray = glm::dvec3(f) / f.w - glm::dvec3(n) / n.w;
    const glm::dmat4 & local = grid.localFromFrame();
    const double along = glm::length(glm::dvec3(local * glm::dvec4(ray.x, ray.y, 0.0, 0.0))), all = glm::length(glm::dvec3(local * glm::dvec4(ray, 0.0)));
    const double columns = std::max(std::abs(ray.x), std::abs(ray.y));
    if (!(all > 0.0) || !(columns > 0.0)) return {0.0, 0.0};
    // A cell ahead, or where there is none, behind.
    const glm::dvec2 step = glm::dvec2(ray) / columns, ahead = clampTo(grid, place + step), behind = clampTo(grid, place - step);
    const glm::dvec2 way = (coordinates.between(ahead) - coordinates.between(behind)) * texels;
    const double length = glm::length(way);
    if (!(length > 0.0) || !std::isfinite(length)) return {0.0, 0.0};
    return way / length * (kMost * along / all);
}

}  // namespace

terrain::TextureClipmap::Focus findTextureFocus(SoState * state, const terrain::View & camera, const terrain::SampleGrid & grid,
                                                const StateAttributes & attributes, glm::dvec2 texels)
{
    terrain::TextureClipmap::Focus focus;
    const Coordinates coordinates(state, grid, attributes);
    const glm::dmat4 clipFromFrame = camera.clipFromLocal * grid.localFromFrame(), frameFromClip = glm::inverse(clipFromFrame);
    const std::optional<glm::dvec3> eye = eyeOf(frameFromClip), localEye = eyeOf(glm::inverse(camera.clipFromLocal));
    glm::dvec2 place = clampTo(grid, eye ? glm::dvec2(*eye) : glm::dvec2(std::numeric_limits<double>::quiet_NaN()));
    if (grid.isRegular()) {
        const double height = heightNear(grid, place);
        if (!eye || !isInView(clipFromFrame, glm::dvec3(place, height)))
            if (const auto seen = nearestInView(grid, frameFromClip, height, eye)) place = *seen;
        if (eye) focus.lead = leadOf(grid, coordinates, place, frameFromClip, texels);
    } else if (localEye) {
        place = nearestSample(grid, *localEye);
    }
    focus.place = coordinates.between(place);
    focus.finestLevel = finestLevelOf(camera, localEye, grid, coordinates, place, texels);
    return focus;
}
