#include "lod/ErrorHierarchy.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <unordered_set>
#include <utility>

#include <glm/geometric.hpp>

#include "lod/TriangleSearch.h"

namespace terrain {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Heights of a regular grid, so that the innermost loop runs over consecutive floats: packed unless they are.
class PackedHeights {
public:
    using Value = float;
    explicit PackedHeights(const SampleGrid& grid) : heights_(grid.heightRow(0)), resident_(grid.residentRows()) {
        if (grid.heightStride() == 1) {
            pitch_ = std::size_t(grid.heightRow(1) - grid.heightRow(0));
            return;
        }
        pitch_ = std::size_t(grid.columns());
        packed_.reserve(pitch_ * std::size_t(grid.rows()));
        for (int row = 0; row < grid.rows(); ++row)
            for (int column = 0; column < grid.columns(); ++column) packed_.push_back(grid.height(column, row));
        heights_ = packed_.data();
    }
    float at(glm::ivec2 p) const { return heights_[std::size_t(p.y) * pitch_ + std::size_t(p.x)]; }
    static float length(float v) { return std::fabs(v); }
    /// Largest distance of samples [first, last] of a row from start + i * step.
    float rowDeviation(int row, int first, int last, float start, float step) const {
        const float* sample = heights_ + std::size_t(row) * pitch_ + first;
        float deviation = 0.0f;
#pragma omp simd reduction(max : deviation)
        for (int i = 0; i <= last - first; ++i) deviation = std::max(deviation, std::fabs(sample[i] - (start + float(i) * step)));
        resident_.visit(row);
        return deviation;
    }

private:
    const float* heights_;
    std::size_t pitch_ = 0;
    std::vector<float> packed_;
    mutable ResidentRows resident_;  ///< small diamonds go over the rows in order, large ones each over many
};

/// The same where they are, for going over some of them only.
class HeightsInPlace {
public:
    using Value = float;
    explicit HeightsInPlace(const SampleGrid& grid) : grid_(grid), resident_(grid.residentRows()) {}
    float at(glm::ivec2 p) const { return grid_.height(p.x, p.y); }
    float rowDeviation(int row, int first, int last, float start, float step) const {
        const std::size_t stride = grid_.heightStride();
        const float* sample = grid_.heightRow(row) + std::size_t(first) * stride;
        float deviation = 0.0f;
#pragma omp simd reduction(max : deviation)
        for (int i = 0; i <= last - first; ++i)
            deviation = std::max(deviation, std::fabs(sample[std::size_t(i) * stride] - (start + float(i) * step)));
        resident_.visit(row);
        return deviation;
    }
    /// The same of samples [part.x, part.y] of the row.
    float partDeviation(int row, glm::ivec2 part, int first, float start, float step) const {
        const std::size_t stride = grid_.heightStride();
        const float* sample = grid_.heightRow(row) + std::size_t(first) * stride;
        float deviation = 0.0f;
        for (int i = part.x - first; i <= part.y - first; ++i)
            deviation = std::max(deviation, std::fabs(sample[std::size_t(i) * stride] - (start + float(i) * step)));
        return deviation;
    }

private:
    const SampleGrid& grid_;
    mutable ResidentRows resident_;
};

class CurvedPoints {
public:
    using Value = glm::vec3;
    explicit CurvedPoints(const SampleGrid& grid) : grid_(grid) {}
    glm::vec3 at(glm::ivec2 p) const { return grid_.position(p.x, p.y); }
    static float length(const glm::vec3& v) { return glm::length(v); }
    float rowDeviation(int row, int first, int last, const glm::vec3& start, const glm::vec3& step) const {
        float deviation = 0.0f;
        for (int i = 0; i <= last - first; ++i)
            deviation = std::max(deviation, glm::length(grid_.position(first + i, row) - (start + float(i) * step)));
        return deviation;
    }

private:
    const SampleGrid& grid_;
};

/// The rows of samples of one triangle of a diamond: calls visit(row, first column, last column).
template <class Visit>
void forEachRow(const DiamondShape& d, int half, Visit visit) {
    const glm::ivec2 apex = d.corner[half ? 3 : 1];
    const glm::ivec2 toCentre{d.centre.x > apex.x ? 1 : -1, d.centre.y > apex.y ? 1 : -1};
    if (d.isSquare) {
        for (int j = 0; j <= 2 * d.size; ++j) {
            const int end = apex.x + toCentre.x * (2 * d.size - j);
            visit(apex.y + toCentre.y * j, std::min(apex.x, end), std::max(apex.x, end));
        }
    } else if (apex.x == d.centre.x) {
        for (int j = 0; j <= d.size; ++j) visit(apex.y + toCentre.y * j, apex.x - j, apex.x + j);
    } else {
        for (int k = -d.size; k <= d.size; ++k) {
            const int from = apex.x + toCentre.x * std::abs(k), to = d.centre.x;
            visit(apex.y + k, std::min(from, to), std::max(from, to));
        }
    }
}

template <class Samples>
TrianglePlane<typename Samples::Value> planeOf(const Samples& samples, const DiamondShape& d, int half) {
    using Value = typename Samples::Value;
    const glm::ivec2 apex = d.corner[half ? 3 : 1];
    const Value atApex = samples.at(apex), at0 = samples.at(d.corner[0]), at2 = samples.at(d.corner[2]);
    const float span = 1.0f / float(2 * d.size);
    if (d.isSquare) {
        const bool zeroSharesRow = d.corner[0].y == apex.y;
        const Value alongX = zeroSharesRow ? at0 : at2, alongY = zeroSharesRow ? at2 : at0;
        return {apex, atApex, (alongX - atApex) * (d.centre.x > apex.x ? span : -span), (alongY - atApex) * (d.centre.y > apex.y ? span : -span)};
    }
    const Value middle = (at0 + at2) * 0.5f;
    const bool edgeAlongX = d.corner[0].y == d.corner[2].y;
    const Value alongEdge = (at2 - at0) * ((edgeAlongX ? d.corner[2].x > d.corner[0].x : d.corner[2].y > d.corner[0].y) ? span : -span);
    const bool positive = edgeAlongX ? d.centre.y > apex.y : d.centre.x > apex.x;
    const Value across = (middle - atApex) * ((positive ? 2.0f : -2.0f) * span);
    return {apex, atApex, edgeAlongX ? alongEdge : across, edgeAlongX ? across : alongEdge};
}

/// Largest deviation of the samples of one triangle from the plane through its corners.
template <class Samples>
float triangleDeviation(const Samples& samples, const DiamondShape& d, int half) {
    const auto plane = planeOf(samples, d, half);
    float deviation = 0.0f;
    forEachRow(d, half, [&](int row, int first, int last) {
        deviation = std::max(deviation, samples.rowDeviation(row, first, last, plane.at(first, row), plane.gradientX));
    });
    return deviation;
}

/// The same where it is more than `known`, else that. `boxes`: of the samples, or null.
template <class Samples>
float deviationAbove(const Samples& samples, const BoxPyramid*, const DiamondShape& d, int half, float known) {
    return std::max(known, triangleDeviation(samples, d, half));
}

template <>
float deviationAbove(const HeightsInPlace& heights, const BoxPyramid* boxes, const DiamondShape& d, int half, float known) {
    constexpr int kLarge = 2 * BoxPyramid::kBlockCells;
    if (!boxes || d.size < kLarge) return std::max(known, triangleDeviation(heights, d, half));
    return TriangleSearch(heights, *boxes, d, half, planeOf(heights, d, half)).above(known);
}

/// Finest diamonds cover no sample but their corners and centre.
float finestDeviation(const SampleGrid& grid, const DiamondShape& d) {
    const auto [a, b] = std::pair(d.corner[0], d.corner[2]);
    if (grid.isRegular())
        return std::fabs(grid.height(d.centre.x, d.centre.y) - (grid.height(a.x, a.y) + grid.height(b.x, b.y)) * 0.5f);
    return glm::length(grid.position(d.centre.x, d.centre.y) - (grid.position(a.x, a.y) + grid.position(b.x, b.y)) * 0.5f);
}

enum State : std::uint8_t { Full, Empty, Mixed };

bool overlapsGrid(const SampleGrid& grid, const DiamondShape& d, int half) {
    const glm::ivec2 a = d.corner[half ? 3 : 1], b = d.corner[0], c = d.corner[2];
    return std::min({a.x, b.x, c.x}) < grid.columns() - 1 && std::min({a.y, b.y, c.y}) < grid.rows() - 1 &&
           std::max({a.x, b.x, c.x}) > 0 && std::max({a.y, b.y, c.y}) > 0;
}

bool liesInGrid(const SampleGrid& grid, const DiamondShape& d, int half) {
    const auto contains = [&grid](glm::ivec2 p) { return grid.contains(p.x, p.y); };
    return contains(d.corner[half ? 3 : 1]) && contains(d.corner[0]) && contains(d.corner[2]);
}

/// State of a triangle of which each half, next to the sides of the apex, is empty or not.
State joined(const SampleGrid& grid, const DiamondShape& d, int half, const bool (&empty)[2]) {
    if (empty[0] != empty[1]) return Mixed;
    if (!empty[0]) return Full;
    // A hole that no corner shows would not be told from solid ground when it is drawn: keep splitting.
    const auto isHole = [&grid](glm::ivec2 p) { return grid.isHole(p.x, p.y); };
    return isHole(d.corner[half ? 3 : 1]) || isHole(d.corner[0]) || isHole(d.corner[2]) ? Empty : Mixed;
}

State finestState(const SampleGrid& grid, const DiamondShape& d, int half) {
    if (!liesInGrid(grid, d, half)) return overlapsGrid(grid, d, half) ? Mixed : Empty;
    const glm::ivec2 apex = d.corner[half ? 3 : 1];
    const auto cellIsHole = [&](glm::ivec2 end) {
        return grid.isHole(apex.x, apex.y) || grid.isHole(end.x, end.y) || grid.isHole(apex.x, end.y) || grid.isHole(end.x, apex.y);
    };
    return joined(grid, d, half, {cellIsHole(d.corner[half ? 2 : 0]), cellIsHole(d.corner[half ? 0 : 2])});
}

/// Code of a finest diamond. `isSolid`: no holes, so that what lies in the grid is full.
std::uint16_t finestCode(const SampleGrid& grid, const DiamondShape& d, bool isSolid) {
    const auto stateOf = [&](int half) { return isSolid && liesInGrid(grid, d, half) ? Full : finestState(grid, d, half); };
    const State states[2] = {stateOf(0), stateOf(1)};
    if (states[0] == Mixed || states[1] == Mixed) return ErrorHierarchy::encode(kInfinity);
    return states[0] == Full || states[1] == Full ? ErrorHierarchy::encode(finestDeviation(grid, d)) : std::uint16_t(0);
}

/// Whether triangles lie in the grid's valid part. States of both triangles of a diamond are packed into one byte a sample.
class Coverage {
public:
    explicit Coverage(const SampleGrid& grid) : grid_(grid) {
        constexpr int kBand = 64;
        for (int row = 0; row < grid.rows() && !hasHoles_; ++row) {
            for (int column = 0; column < grid.columns() && !hasHoles_; ++column) hasHoles_ = grid.isHole(column, row);
            if (row % kBand == kBand - 1) grid.releaseRows(row + 1 - kBand, kBand);
        }
        if (hasHoles_) states_.assign(std::size_t(grid.columns()) * std::size_t(grid.rows()), 0);
    }
    /// Of a grid that has changed, with what states() gave before. Without holes before, there is none: then all are full.
    Coverage(const SampleGrid& grid, bool hasHoles, std::vector<std::uint8_t> states)
        : grid_(grid), hasHoles_(hasHoles), states_(std::move(states)) {
        if (hasHoles_) states_.resize(std::size_t(grid.columns()) * std::size_t(grid.rows()), 0);
    }

    bool hasHoles() const { return hasHoles_; }
    std::vector<std::uint8_t>&& states() { return std::move(states_); }

    /// Children must have been asked for before, but for finest ones. `half` is 0 for the triangle at q1, 1 for the one at q3.
    State triangle(const DiamondShape& d, int half) {
        State state = Full;
        if (!liesInGrid(grid_, d, half))
            state = overlapsGrid(grid_, d, half) ? Mixed : Empty;
        else if (hasHoles_)
            state = holes(d, half);
        if (hasHoles_) {
            std::uint8_t& stored = states_[grid_.index(d.centre.x, d.centre.y)];
            stored = std::uint8_t((stored & (half ? 0x0f : 0xf0)) | (half ? state << 4 : state));
        }
        return state;
    }

private:
    State holes(const DiamondShape& d, int half) const {
        bool empty[2];
        for (int side = 0; side < 2; ++side) {
            const DiamondShape child(d.child((half ? 2 : 0) + side));
            const int childHalf = child.corner[1] == d.centre ? 0 : 1;
            State state;
            if (child.isFinest()) {
                state = finestState(grid_, child, childHalf);
            } else {
                const int stored = states_[grid_.index(child.centre.x, child.centre.y)];
                state = State(childHalf ? stored >> 4 : stored & 0x0f);
            }
            if (state == Mixed) return Mixed;
            empty[side] = state == Empty;
        }
        return joined(grid_, d, half, empty);
    }

    const SampleGrid& grid_;
    bool hasHoles_ = false;
    std::vector<std::uint8_t> states_;
};

/// Visits all diamonds whose centres lie in `part` of the grid once it is widened by `reach` of their sizes, children before parents,
/// without the finest.
template <class Visit>
void forEachDiamondUpwards(const SampleRect& grid, const SampleRect& part, int reach, int side, Visit visit) {
    // The first number from `from` on that is `offset` more than a multiple of `step`.
    const auto firstFrom = [](int from, int offset, int step) { return offset + (std::max(0, from - offset) + step - 1) / step * step; };
    for (int s = 1; s < side; s *= 2) {
        const SampleRect at = part.widened(reach * s).cutTo(grid);
        for (int y = firstFrom(at.low.y, 0, s); y <= at.high.y && s > 1; y += s)
            for (int x = firstFrom(at.low.x, (y & s) ? 0 : s, 2 * s); x <= at.high.x; x += 2 * s) visit(DiamondShape({x, y}));
        for (int y = firstFrom(at.low.y, s, 2 * s); y <= at.high.y; y += 2 * s)
            for (int x = firstFrom(at.low.x, s, 2 * s); x <= at.high.x; x += 2 * s) visit(DiamondShape({x, y}));
    }
}

SampleRect whole(const SampleGrid& grid) {
    return {glm::ivec2(0), glm::ivec2(grid.columns() - 1, grid.rows() - 1)};
}

/// Fills `codes`, of which placeOf(centre) is the diamond's.
template <class Samples, class PlaceOf>
class Measurement {
public:
    Measurement(const SampleGrid& grid, Coverage& coverage, std::vector<std::uint16_t>& codes, PlaceOf placeOf, const BoxPyramid* boxes = nullptr)
        : grid_(grid), samples_(grid), coverage_(coverage), codes_(codes), placeOf_(placeOf), boxes_(boxes) {}

    void operator()(const DiamondShape& d) {
        // What its children are off by is known.
        std::uint16_t code = 0;
        for (int side = 0; side < 4; ++side) {
            const glm::ivec2 child = d.child(side);
            if (!grid_.contains(child.x, child.y)) continue;
            // A finest child's centre is among the samples of the parent, but rounded along another way.
            code = std::max(code, d.size == 1 && d.isSquare ? finestCode(grid_, DiamondShape(child), !coverage_.hasHoles())
                                                            : codes_[placeOf_(child)]);
        }
        const State states[2] = {coverage_.triangle(d, 0), coverage_.triangle(d, 1)};
        if (states[0] == Mixed || states[1] == Mixed) code = ErrorHierarchy::encode(kInfinity);
        float deviation = ErrorHierarchy::decode(code);
        for (int half = 0; half < 2 && deviation < kInfinity; ++half)
            if (states[half] == Full) deviation = deviationAbove(samples_, boxes_, d, half, deviation);
        codes_[placeOf_(d.centre)] = ErrorHierarchy::encode(deviation);
    }

private:
    const SampleGrid& grid_;
    Samples samples_;
    Coverage& coverage_;
    std::vector<std::uint16_t>& codes_;
    PlaceOf placeOf_;
    const BoxPyramid* boxes_;
};

template <class Samples, class PlaceOf>
void measure(const SampleGrid& grid, int side, Coverage& coverage, std::vector<std::uint16_t>& codes, PlaceOf placeOf) {
    forEachDiamondUpwards(whole(grid), whole(grid), 0, side, Measurement<Samples, PlaceOf>(grid, coverage, codes, placeOf));
}

/// The same for diamonds that cover changed samples, and for those whose children have another error now.
template <class Samples, class PlaceOf>
void measureAgain(const SampleGrid& grid, const SampleRect& changed, int side, Coverage& coverage, std::vector<std::uint16_t>& codes,
                  PlaceOf placeOf, const BoxPyramid& boxes) {
    Measurement<Samples, PlaceOf> measurement(grid, coverage, codes, placeOf, &boxes);
    std::unordered_set<std::size_t> others;
    const auto isDue = [&](const DiamondShape& d) {
        // Errors of the finest are not stored.
        const int reach = d.size == 1 ? 2 : d.size;
        if (changed.touches({d.centre - reach, d.centre + reach})) return true;
        for (int i = 0; i < 4 && d.size > 1; ++i)
            if (const glm::ivec2 child = d.child(i); grid.contains(child.x, child.y) && others.contains(placeOf(child))) return true;
        return false;
    };
    forEachDiamondUpwards(whole(grid), changed, ErrorHierarchy::kReach, side, [&](const DiamondShape& d) {
        if (!isDue(d)) return;
        const std::size_t place = placeOf(d.centre);
        const std::uint16_t before = codes[place];
        measurement(d);
        if (codes[place] != before) others.insert(place);
    });
}

}  // namespace

std::uint16_t ErrorHierarchy::encode(float error) {
    // The sign bit is not needed: 8 bits of exponent and 8 of mantissa remain, and their order is that of the values.
    if (!(error > 0.0f)) return 0;
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(error);
    return std::uint16_t((bits + 0x7fffu) >> 15);
}

ErrorHierarchy::ErrorHierarchy(const SampleGrid& grid) : columns_(grid.columns()), rows_(grid.rows()) {
    const unsigned cells = unsigned(std::max(columns_, rows_) - 1);
    exponent_ = int(std::bit_width(cells - 1));
    Coverage coverage(grid);
    hasHoles_ = coverage.hasHoles();
    whole_ = !hasHoles_ && columns_ == side() + 1 && rows_ == side() + 1;
    codes_.assign(std::size_t((columns_ + 1) / 2) * std::size_t(rows_), 0);
    const auto placeOf = [this](glm::ivec2 centre) { return place(centre); };
    if (grid.isRegular())
        measure<PackedHeights>(grid, side(), coverage, codes_, placeOf);
    else
        measure<CurvedPoints>(grid, side(), coverage, codes_, placeOf);
}

void ErrorHierarchy::update(const SampleGrid& grid, const SampleRect& rect, const BoxPyramid& boxes) {
    const bool hasHoles = boxes.hasHoles();
    const SampleRect changed = rect.cutTo(terrain::whole(grid));
    if (changed.isEmpty()) return;
    if (hasHoles && hasHoles_ && states_.empty()) {
        // They are not kept when building: most grids are never edited.
        Coverage coverage(grid, true, {});
        forEachDiamondUpwards(terrain::whole(grid), terrain::whole(grid), 0, side(), [&](const DiamondShape& d) {
            for (int half = 0; half < 2; ++half) coverage.triangle(d, half);
        });
        states_ = coverage.states();
    }
    Coverage coverage(grid, hasHoles, hasHoles ? std::move(states_) : std::vector<std::uint8_t>());
    hasHoles_ = hasHoles;
    whole_ = !hasHoles_ && columns_ == side() + 1 && rows_ == side() + 1;
    const auto placeOf = [this](glm::ivec2 centre) { return place(centre); };
    if (grid.isRegular())
        measureAgain<HeightsInPlace>(grid, changed, side(), coverage, codes_, placeOf, boxes);
    else
        measureAgain<CurvedPoints>(grid, changed, side(), coverage, codes_, placeOf, boxes);
    states_ = coverage.states();
}

float ErrorHierarchy::error(const SampleGrid& grid, const DiamondShape& d) const {
    if (d.centre.x >= columns_ || d.centre.y >= rows_) {
        // Beyond the grid: split as long as any of it may reach in.
        return d.centre.x - d.size < columns_ - 1 && d.centre.y - d.size < rows_ - 1 ? kInfinity : 0.0f;
    }
    if (!d.isFinest()) return decode(codes_[place(d.centre)]);
    return decode(finestCode(grid, d, !hasHoles_));
}

}  // namespace terrain
