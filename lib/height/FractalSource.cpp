#include "height/FractalSource.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

namespace terrain {

namespace {

// Heights are whole numbers while they are made: integer arithmetic has one result everywhere, whatever the compiler contracts or
// reorders. The first displacement is 2^24; with every later one as large, 15 levels of two steps stay far inside 32 bits.
using Fixed = std::int32_t;
constexpr std::int64_t firstDisplacement = std::int64_t(1) << 24;
constexpr int largestSide = 32769;

/// Well-mixed 32 bits of a grid point and the seed (finaliser of MurmurHash3, Appleby 2008).
std::uint32_t mix(std::uint32_t value) {
    value ^= value >> 16;
    value *= 0x85ebca6bu;
    value ^= value >> 13;
    value *= 0xc2b2ae35u;
    return value ^ (value >> 16);
}

std::uint32_t hashOf(std::uint32_t seed, int column, int row) {
    return mix(mix(mix(seed + 0x9e3779b9u) ^ std::uint32_t(column)) + 0x7f4a7c15u * std::uint32_t(row));
}

/// A square of 2^n + 1 points a side, displaced from coarse to fine.
class Square {
public:
    Square(int side, std::uint32_t seed) : side_(side), seed_(seed), heights_(std::size_t(side) * std::size_t(side)) {}

    void displace(double roughness);
    void filter(std::int64_t coefficient, int columns, int rows);
    Fixed& at(int column, int row) { return heights_[std::size_t(row) * std::size_t(side_) + std::size_t(column)]; }

private:
    Fixed offset(int column, int row, std::int64_t displacement) const {
        const std::int64_t random = std::int64_t(hashOf(seed_, column, row)) - (std::int64_t(1) << 31);
        return Fixed((random * displacement) >> 31);
    }

    void centres(int step, std::int64_t displacement);
    void edges(int step, std::int64_t displacement);
    void edge(int column, int row, int half, std::int64_t displacement);
    void pass(int first, int step, int count, std::int64_t coefficient);

    int side_;
    std::uint32_t seed_;
    std::vector<Fixed> heights_;
};

void Square::displace(double roughness) {
    const int last = side_ - 1;
    for (int row : {0, last})
        for (int column : {0, last}) at(column, row) = offset(column, row, firstDisplacement);
    // 7 more binary digits, so that the displacement of fine levels is not lost in rounding.
    std::int64_t displacement = firstDisplacement << 7;
    const auto factor = std::int64_t(roughness * 4294967296.0);
    for (int step = last; step > 1; step /= 2) {
        centres(step, displacement >> 7);
        // The neighbours of an edge point are nearer than those of a centre by the root of 2: 181 / 256.
        edges(step, (displacement * 181) >> 15);
        displacement = (displacement * factor) >> 32;
    }
}

void Square::centres(int step, std::int64_t displacement) {
    const int half = step / 2;
    for (int row = half; row < side_; row += step)
        for (int column = half; column < side_; column += step) {
            const std::int64_t sum = std::int64_t(at(column - half, row - half)) + at(column + half, row - half) +
                                     at(column - half, row + half) + at(column + half, row + half);
            at(column, row) = Fixed(sum >> 2) + offset(column, row, displacement);
        }
}

void Square::edges(int step, std::int64_t displacement) {
    const int half = step / 2;
    for (int row = 0; row < side_; row += half)
        for (int column = (row / half) % 2 ? 0 : half; column < side_; column += step) edge(column, row, half, displacement);
}

void Square::edge(int column, int row, int half, std::int64_t displacement) {
    std::int64_t sum = 0;
    int count = 0;
    if (column >= half) sum += at(column - half, row), ++count;
    if (column + half < side_) sum += at(column + half, row), ++count;
    if (row >= half) sum += at(column, row - half), ++count;
    if (row + half < side_) sum += at(column, row + half), ++count;
    at(column, row) = Fixed(sum / count) + offset(column, row, displacement);
}

/// One run of h = h_neighbour * (1 - k) + h * k along a line of points, each taking in the one before it; k in 1/65536.
void Square::pass(int first, int step, int count, std::int64_t coefficient) {
    std::ptrdiff_t index = first;
    for (int i = 1; i < count; ++i) {
        const std::int64_t neighbour = heights_[std::size_t(index)];
        index += step;
        Fixed& height = heights_[std::size_t(index)];
        height = Fixed((neighbour * (65536 - coefficient) + height * coefficient + 32768) >> 16);
    }
}

/// Ch. 4.3.3, over the part that is kept: along rows and columns, in both directions so that nothing is shifted.
void Square::filter(std::int64_t coefficient, int columns, int rows) {
    for (int row = 0; row < rows; ++row) {
        pass(row * side_, 1, columns, coefficient);
        pass(row * side_ + columns - 1, -1, columns, coefficient);
    }
    for (int column = 0; column < columns; ++column) {
        pass(column, side_, rows, coefficient);
        pass(column + (rows - 1) * side_, -side_, rows, coefficient);
    }
}

std::optional<Error> problemOf(const FractalParameters& p) {
    const auto error = [](const char* what, const char* expected, const std::string& found) {
        return Error{std::string("fractal terrain: ") + what, expected, found};
    };
    if (p.columns < 2 || p.rows < 2 || p.columns > largestSide || p.rows > largestSide)
        return error("size", "2 to 32769 columns and rows", std::to_string(p.columns) + " x " + std::to_string(p.rows));
    if (!(p.roughness > 0.0 && p.roughness < 1.0))
        return error("roughness", "a number between 0 and 1", std::to_string(p.roughness));
    if (p.filterPasses < 0) return error("filter passes", "0 or more", std::to_string(p.filterPasses));
    if (!(p.filterCoefficient > 0.0 && p.filterCoefficient <= 1.0))
        return error("filter coefficient", "a number above 0, at most 1", std::to_string(p.filterCoefficient));
    if (!(p.amplitude > 0.0 && p.amplitude <= double(std::numeric_limits<float>::max())))
        return error("amplitude", "a number above 0 that a float holds", std::to_string(p.amplitude));
    return std::nullopt;
}

/// Stretches the kept part to [0, amplitude], through 24 bits that a float holds exactly.
HeightMap normalised(Square& square, const FractalParameters& p) {
    std::int64_t lowest = std::numeric_limits<Fixed>::max();
    std::int64_t highest = std::numeric_limits<Fixed>::min();
    for (int row = 0; row < p.rows; ++row)
        for (int column = 0; column < p.columns; ++column) {
            lowest = std::min<std::int64_t>(lowest, square.at(column, row));
            highest = std::max<std::int64_t>(highest, square.at(column, row));
        }
    const std::int64_t range = std::max<std::int64_t>(highest - lowest, 1);
    HeightMap map;
    map.columns = p.columns;
    map.rows = p.rows;
    map.heights.reserve(std::size_t(p.columns) * std::size_t(p.rows));
    for (int row = 0; row < p.rows; ++row)
        for (int column = 0; column < p.columns; ++column) {
            const std::int64_t part = ((square.at(column, row) - lowest) << 24) / range;
            map.heights.push_back(float(double(part) / 16777216.0 * p.amplitude));
        }
    return map;
}

}  // namespace

Result<HeightMap> makeFractalMap(const FractalParameters& parameters) {
    if (const auto problem = problemOf(parameters)) return *problem;
    int side = 2;
    while (side < std::max(parameters.columns, parameters.rows)) side = 2 * side - 1;
    try {
        Square square(side, parameters.seed);
        square.displace(parameters.roughness);
        const auto coefficient = std::int64_t(parameters.filterCoefficient * 65536.0 + 0.5);
        for (int i = 0; i < parameters.filterPasses; ++i) square.filter(coefficient, parameters.columns, parameters.rows);
        return normalised(square, parameters);
    } catch (const std::bad_alloc&) {
        return Error{"fractal terrain", "a size that fits into memory", std::to_string(side) + " points a side"};
    }
}

Result<std::shared_ptr<const HeightSource>> makeFractalSource(const FractalParameters& parameters) {
    auto map = makeFractalMap(parameters);
    if (!map) return map.error();
    return makeMapSource(std::move(map).value());
}

}  // namespace terrain
