// The terrains that the tests of lib/lod share, made at run time.
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "base/Box.h"
#include "height/FractalSource.h"
#include "height/SampleGrid.h"
#include "lod/TerrainModel.h"

namespace terrain::test {

inline constexpr float kHole = std::numeric_limits<float>::quiet_NaN();

/// A grid with the memory that it looks at: a map, or points where there are any.
struct Terrain {
    std::string name;
    HeightMap map;
    std::vector<float> points;

    SampleGrid grid() const
    {
        return points.empty() ? SampleGrid(map) : SampleGrid::overPoints(points.data(), map.columns, map.rows).value();
    }
    TerrainModel model() const
    {
        return {std::make_shared<BoxPyramid>(grid()), std::make_shared<ErrorHierarchy>(grid())};
    }
    /// Bounds of the samples in local coordinates; of the unit cube when there is none.
    Box box() const
    {
        glm::vec3 low(std::numeric_limits<float>::infinity()), high = -low;
        const SampleGrid samples = grid();
        for (int row = 0; row < samples.rows(); ++row)
            for (int column = 0; column < samples.columns(); ++column)
                if (!samples.isHole(column, row)) {
                    low = glm::min(low, samples.position(column, row));
                    high = glm::max(high, samples.position(column, row));
                }
        return low.x <= high.x ? boxBetween(low, high) : Box{glm::vec3(0.0f), glm::vec3(1.0f)};
    }
};

using HeightAt = std::function<float(int column, int row)>;

inline HeightMap mapOf(int columns, int rows, const HeightAt& height)
{
    HeightMap map{columns, rows, {}, {-10.0, 7.0}, {1.0, 1.5}, {}};
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) map.heights.push_back(height(column, row));
    return map;
}

inline HeightMap fractalMap(int columns, int rows, std::uint32_t seed = 1)
{
    FractalParameters parameters;
    parameters.columns = columns;
    parameters.rows = rows;
    parameters.seed = seed;
    parameters.filterPasses = 2;
    parameters.amplitude = 0.2 * std::max(columns, rows);
    HeightMap map = makeFractalMap(parameters).value();
    map.origin = {3.0, -20.0};
    map.spacing = {1.25, 0.75};
    return map;
}

/// The map with holes wherever `isHole` says so.
inline HeightMap punched(HeightMap map, const std::function<bool(int column, int row)>& isHole)
{
    for (int row = 0; row < map.rows; ++row)
        for (int column = 0; column < map.columns; ++column)
            if (isHole(column, row)) map.heights[std::size_t(row) * std::size_t(map.columns) + std::size_t(column)] = kHole;
    return map;
}

/// A grid of points, at(column, row); its map holds the size only.
inline Terrain curved(std::string name, int columns, int rows, const std::function<glm::vec3(int column, int row)>& at)
{
    Terrain terrain{std::move(name), {columns, rows, {}, {}, {}, {}}, {}};
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const glm::vec3 p = at(column, row);
            terrain.points.insert(terrain.points.end(), {p.x, p.y, p.z});
        }
    return terrain;
}

inline Terrain hemisphere(int columns, int rows)
{
    return curved("Hemisphere", columns, rows, [=](int column, int row) {
        const float longitude = 6.0f * float(column) / float(columns - 1), latitude = 0.05f + 1.4f * float(row) / float(rows - 1);
        return 40.0f * glm::vec3(std::cos(longitude) * std::cos(latitude), std::sin(longitude) * std::cos(latitude), std::sin(latitude));
    });
}

/// A sheet with waves in all three coordinates and, where asked for, a hole.
inline Terrain wavySheet(int columns, int rows, bool withHole)
{
    return curved(withHole ? "WavySheetWithHole" : "WavySheet", columns, rows, [=](int column, int row) {
        if (withHole && std::hypot(column - columns * 0.4, row - rows * 0.6) < 6.0) return glm::vec3(kHole);
        const float x = float(column), y = float(row);
        return glm::vec3(x + 0.8f * std::sin(y * 0.3f), y + 0.7f * std::cos(x * 0.21f), 5.0f * std::sin(x * 0.11f) * std::cos(y * 0.13f));
    });
}

inline Terrain flat(int side)
{
    return {"Flat", mapOf(side, side, [](int, int) { return 3.0f; }), {}};
}
inline Terrain ramp(int side)
{
    return {"Ramp", mapOf(side, side, [](int column, int row) { return 0.5f * float(column) - 0.25f * float(row); }), {}};
}
inline Terrain spike(int side)
{
    return {"Spike", mapOf(side, side, [=](int column, int row) { return column == side / 3 && row == side / 2 ? 30.0f : 0.0f; }), {}};
}
inline Terrain fractal(int columns, int rows)
{
    return {"Fractal" + std::to_string(columns) + "x" + std::to_string(rows), fractalMap(columns, rows), {}};
}
inline Terrain withSingleHole(int side)
{
    return {"SingleHole", punched(fractalMap(side, side, 2), [=](int column, int row) { return column == side / 2 + 3 && row == side / 3; }), {}};
}
inline Terrain withDisc(int columns, int rows)
{
    const auto isHole = [=](int column, int row) { return std::hypot(column - columns * 0.55, row - rows * 0.4) < rows * 0.22; };
    return {"DiscOfHoles", punched(fractalMap(columns, rows, 3), isHole), {}};
}
inline Terrain withBorderStrip(int side)
{
    return {"BorderStripOfHoles", punched(fractalMap(side, side, 4), [=](int column, int row) { return column > side - 6 || row == 0; }), {}};
}
/// Holes so dense that only some cells remain.
inline Terrain withCheckerboard(int side)
{
    const auto isHole = [](int column, int row) { return ((column / 3) + (row / 3)) % 2 == 0; };
    return {"CheckerboardOfHoles", punched(fractalMap(side, side, 5), isHole), {}};
}
inline Terrain allHoles(int side)
{
    return {"AllHoles", mapOf(side, side, [](int, int) { return kHole; }), {}};
}

/// Small ones of every kind, for properties that are checked sample by sample.
inline std::vector<Terrain> smallTerrains()
{
    return {flat(33),          ramp(33),           spike(33),           fractal(33, 33),      fractal(2, 2),   fractal(3, 50),
            fractal(40, 23),   hemisphere(33, 33), wavySheet(21, 30, false), wavySheet(33, 33, true), withSingleHole(33), withDisc(40, 33),
            withBorderStrip(33), withCheckerboard(25), allHoles(17)};
}

/// Of every kind and shape, as large as a mesh can be checked in milliseconds.
inline std::vector<Terrain> terrains()
{
    return {flat(65),           ramp(65),           spike(65),           fractal(129, 129),    fractal(2, 2),   fractal(3, 1000),
            fractal(257, 129),  fractal(300, 300),  hemisphere(65, 65),  wavySheet(70, 50, false), wavySheet(65, 65, true), withSingleHole(65),
            withDisc(97, 80),   withBorderStrip(65), withCheckerboard(33), allHoles(33)};
}

inline std::ostream& operator<<(std::ostream& out, const Terrain& terrain)
{
    return out << terrain.name;
}

}  // namespace terrain::test
