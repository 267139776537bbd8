#include "EnlargedMap.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace app {

namespace {

/// Weights of the four samples around a place that lies `t` of the way from the second to the third.
std::array<double, 4> splineWeights(double t) {
    return {t * (-0.5 + t * (1.0 - 0.5 * t)), 1.0 + t * t * (-2.5 + 1.5 * t), t * (0.5 + t * (2.0 - 1.5 * t)),
            t * t * (-0.5 + 0.5 * t)};
}

/// From -1 to 1.
double noiseAt(std::uint32_t column, std::uint32_t row, std::uint32_t seed) {
    std::uint32_t bits = column * 0x9e3779b1u ^ row * 0x85ebca77u ^ seed * 0xc2b2ae3du;
    bits = (bits ^ bits >> 15) * 0x2c1b3c6du;
    bits = (bits ^ bits >> 12) * 0x297a2d39u;
    return double(bits ^ bits >> 15) / 2147483647.5 - 1.0;
}

}  // namespace

EnlargedMap::EnlargedMap(const terrain::HeightMap& map, int factor, double relief, double roughness, std::uint32_t seed)
    : map_(map), factor_(factor) {
    const auto [low, high] = std::minmax_element(map.heights.begin(), map.heights.end());
    lowest_ = *low;
    highest_ = *high;
    for (int spacing = factor / 2; spacing >= 1; spacing /= 2, relief *= roughness) {
        octaves_.push_back({spacing, relief, seed + std::uint32_t(spacing)});
        lowest_ -= relief;
        highest_ += relief;
    }
}

void EnlargedMap::makeRow(int row, double* heights) const {
    const int above = std::min(row / factor_, map_.rows - 2);
    const auto down = splineWeights(double(row - above * factor_) / factor_);
    std::vector<double> line(std::size_t(map_.columns));
    for (int i = 0; i < 4; ++i) {
        const int from = std::clamp(above - 1 + i, 0, map_.rows - 1);
        for (int column = 0; column < map_.columns; ++column)
            line[std::size_t(column)] += down[std::size_t(i)] * map_.at(column, from);
    }
    std::vector<std::array<double, 4>> along;
    for (int i = 0; i < factor_; ++i) along.push_back(splineWeights(double(i) / factor_));
    for (int column = 0; column + 1 < map_.columns; ++column) {
        const auto at = [&](int c) { return line[std::size_t(std::clamp(c, 0, map_.columns - 1))]; };
        const double p0 = at(column - 1), p1 = at(column), p2 = at(column + 1), p3 = at(column + 2);
        for (const auto& weight : along) *heights++ = weight[0] * p0 + weight[1] * p1 + weight[2] * p2 + weight[3] * p3;
    }
    *heights++ = line.back();
    heights -= columns();
    for (const Octave& octave : octaves_) addOctave(octave, row, heights);
    for (int column = 0; column < columns(); ++column) heights[column] = std::clamp(heights[column], lowest_, highest_);
}

void EnlargedMap::addOctave(const Octave& octave, int row, double* heights) const {
    const auto above = std::uint32_t(row / octave.spacing);
    const double v = double(row % octave.spacing) / octave.spacing;
    const auto knot = [&](int i) {
        return octave.relief *
               (noiseAt(std::uint32_t(i), above, octave.seed) * (1.0 - v) + noiseAt(std::uint32_t(i), above + 1, octave.seed) * v);
    };
    double left = knot(0);
    for (int first = 0, i = 0; first < columns(); first += octave.spacing, ++i) {
        const double right = knot(i + 1), step = (right - left) / octave.spacing;
        const int count = std::min(octave.spacing, columns() - first);
        for (int j = 0; j < count; ++j) heights[first + j] += left + step * j;
        left = right;
    }
}

}  // namespace app
