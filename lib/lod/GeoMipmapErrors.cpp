#include "lod/GeoMipmapErrors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/VectorClones.h"

namespace terrain {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::size_t kWide = 16;

/// A sample that a triangle covers, with the weights of the triangle's corners there.
struct Covered {
    GeoMipmapShape::Place sample;
    GeoMipmapShape::Triangle corner;
    std::array<float, 3> weight;
};

/// Largest deviation of the samples, in each lane. `values` holds kWide floats a place, times the number of axes.
SOTERRAIN_VECTOR_CLONES
void deviate(const Covered* first, const Covered* last, const float* values, float* result) {
    float largest[kWide] = {};
    for (const Covered* c = first; c != last; ++c) {
        const float *sample = values + c->sample * kWide, *p0 = values + c->corner[0] * kWide;
        const float *p1 = values + c->corner[1] * kWide, *p2 = values + c->corner[2] * kWide;
        const float w0 = c->weight[0], w1 = c->weight[1], w2 = c->weight[2];
#pragma omp simd
        for (std::size_t i = 0; i < kWide; ++i) {
            const float error = std::fabs(sample[i] - (w0 * p0[i] + w1 * p1[i] + w2 * p2[i]));
            largest[i] = largest[i] > error ? largest[i] : error;
        }
    }
    std::copy(largest, largest + kWide, result);
}

SOTERRAIN_VECTOR_CLONES
void deviateInSpace(const Covered* first, const Covered* last, const float* values, float* result) {
    float largest[kWide] = {};
    for (const Covered* c = first; c != last; ++c) {
        const float *sample = values + c->sample * 3 * kWide, *p0 = values + c->corner[0] * 3 * kWide;
        const float *p1 = values + c->corner[1] * 3 * kWide, *p2 = values + c->corner[2] * 3 * kWide;
        const float w0 = c->weight[0], w1 = c->weight[1], w2 = c->weight[2];
#pragma omp simd
        for (std::size_t i = 0; i < kWide; ++i) {
            const auto off = [&](std::size_t j) { return sample[j] - (w0 * p0[j] + w1 * p1[j] + w2 * p2[j]); };
            const float x = off(i), y = off(kWide + i), z = off(2 * kWide + i);
            const float error = std::sqrt(x * x + y * y + z * z);
            largest[i] = largest[i] > error ? largest[i] : error;
        }
    }
    std::copy(largest, largest + kWide, result);
}

int cross(glm::ivec2 a, glm::ivec2 b) {
    return a.x * b.y - a.y * b.x;
}

/// Appends what the triangles cover, but for their corners and for what is there already.
void cover(const GeoMipmapShape& shape, std::span<const GeoMipmapShape::Triangle> triangles, std::vector<bool>& seen,
           std::vector<Covered>& covered) {
    for (const auto& triangle : triangles) {
        const glm::ivec2 a = shape.at(triangle[0]), b = shape.at(triangle[1]), c = shape.at(triangle[2]);
        const int area = cross(b - a, c - a);
        for (int row = std::min({a.y, b.y, c.y}); row <= std::max({a.y, b.y, c.y}); ++row)
            for (int column = std::min({a.x, b.x, c.x}); column <= std::max({a.x, b.x, c.x}); ++column) {
                const glm::ivec2 p(column, row);
                const int w0 = cross(b - p, c - p), w1 = cross(c - p, a - p), w2 = cross(a - p, b - p);
                const auto place = GeoMipmapShape::Place(row * shape.pitch() + column);
                if (std::min({w0, w1, w2}) < 0 || std::max({w0, w1, w2}) == area || seen[place]) continue;
                seen[place] = true;
                covered.push_back({place, triangle, {float(w0) / float(area), float(w1) / float(area), float(w2) / float(area)}});
            }
    }
}

}  // namespace

/// What to measure of blocks of one shape: for each slot, and the last level's second diagonal, a range of `covered`.
struct GeoMipmapErrors::Program {
    std::vector<Covered> covered;
    std::vector<std::size_t> ends;
    std::vector<bool> exists;
};

/// Blocks side by side.
struct GeoMipmapErrors::Lanes {
    std::vector<float> values;   ///< by place, axis, lane
    std::vector<float> results;  ///< by slot, lane
    std::array<BoxPyramid::Bounds, kLanes> bounds;
    std::array<bool, kLanes> holes;
};

GeoMipmapErrors::Program GeoMipmapErrors::programFor(const GeoMipmapShape& shape) const {
    Program program;
    const int n = layout_.exponent;
    std::vector<bool> seen;
    const auto begin = [&] { seen.assign(std::size_t(shape.pitch()) * std::size_t(shape.pitch()), false); };
    const auto end = [&](bool exists) {
        program.ends.push_back(program.covered.size());
        program.exists.push_back(exists);
    };
    for (int level = 1; level < n; ++level) {
        begin();
        cover(shape, shape.inner(level), seen, program.covered);
        for (int side = 0; side < 4; ++side) cover(shape, shape.side(side, level, level), seen, program.covered);
        end(shape.hasLevel(level));
    }
    begin();
    cover(shape, shape.flat(false), seen, program.covered);
    end(true);
    for (int level = 0; level < n; ++level)
        for (int border = level + 1; border <= n; ++border)
            for (int side = 0; side < 4; ++side) {
                begin();
                cover(shape, shape.side(side, level, border), seen, program.covered);
                end(!shape.side(side, level, border).empty());
            }
    begin();
    cover(shape, shape.flat(true), seen, program.covered);
    end(true);
    return program;
}

GeoMipmapErrors::GeoMipmapErrors(const SampleGrid& grid, int tileSize, std::shared_ptr<const EditLog> edits)
    : layout_(grid.columns(), grid.rows(), tileSize), regular_(grid.isRegular()),
      slots_(std::size_t(layout_.exponent + 2 * layout_.exponent * (layout_.exponent + 1))), edits_(std::move(edits)),
      version_(edits_ ? edits_->version() : 0) {
    for (int i = 0; i < 4; ++i)
        shapes_.emplace_back(layout_.width(i % 2 ? layout_.blockColumns - 1 : 0), layout_.height(i / 2 ? layout_.blockRows - 1 : 0),
                             layout_.exponent);
    codes_.resize(layout_.blockCount() * slots_);
    flags_.resize(layout_.blockCount());
    bounds_.push_back({layout_.blockColumns, layout_.blockRows, std::vector<float>(layout_.blockCount() * (regular_ ? 2 : 6))});
    build(grid, glm::ivec2(0), glm::ivec2(layout_.blockColumns, layout_.blockRows) - 1);
    buildBounds();
}

void GeoMipmapErrors::follow(const SampleGrid& grid) {
    if (!edits_ || edits_->version() == version_) return;
    const SampleRect all{glm::ivec2(0), glm::ivec2(layout_.columns, layout_.rows) - 1};
    const GridEdits edits = edits_->since(version_).value_or(GridEdits{{all}, true});
    version_ = edits_->version();
    const glm::ivec2 last = glm::ivec2(layout_.blockColumns, layout_.blockRows) - 1;
    // Samples on a border belong to the blocks on both sides.
    for (const SampleRect& rect : edits.rects)
        build(grid, glm::min(glm::max(rect.low - 1, glm::ivec2(0)) / layout_.tileSize, last), glm::min(rect.high / layout_.tileSize, last));
    bounds_.resize(1);
    buildBounds();
}

void GeoMipmapErrors::build(const SampleGrid& grid, glm::ivec2 low, glm::ivec2 high) {
    std::vector<Program> programs;
    for (const GeoMipmapShape& shape : shapes_) programs.push_back(programFor(shape));
    Lanes lanes;
    const std::size_t axes = regular_ ? 1 : 3, pitch = std::size_t(GeoMipmapShape::pitch(layout_.exponent));
    lanes.values.assign(pitch * pitch * axes * kLanes, 0.0f);
    lanes.results.resize((slots_ + 1) * kLanes);
    for (int row = low.y; row <= high.y; ++row) {
        for (int column = low.x; column <= high.x;) {
            // Blocks of one shape together: those up to the last column.
            const int last = layout_.blockColumns - 1;
            const int count = column == last ? 1 : std::min({int(kLanes), last - column, high.x + 1 - column});
            const std::size_t first = layout_.block(column, row);
            const GeoMipmapShape& block = shape(column, row);
            const Program& program = programs[std::size_t(&block - shapes_.data())];
            load(grid, {column, row}, count, lanes);
            for (std::size_t slot = 0; slot <= slots_; ++slot)
                (regular_ ? deviate : deviateInSpace)(program.covered.data() + (slot ? program.ends[slot - 1] : 0),
                                                      program.covered.data() + program.ends[slot], lanes.values.data(),
                                                      lanes.results.data() + slot * kLanes);
            for (int i = 0; i < count; ++i) {
                store(program, block, first + std::size_t(i), std::size_t(i), lanes);
                if (lanes.holes[std::size_t(i)]) storeHoles(grid, block, first + std::size_t(i));
            }
            column += count;
        }
        grid.releaseRows(row * layout_.tileSize, layout_.height(row));
    }
}

void GeoMipmapErrors::load(const SampleGrid& grid, glm::ivec2 first, int count, Lanes& lanes) {
    const GeoMipmapShape& block = shape(first.x, first.y);
    const int firstColumn = first.x * layout_.tileSize, firstRow = first.y * layout_.tileSize;
    for (int i = 0; i < count; ++i) {
        float low[3] = {kInfinity, kInfinity, kInfinity}, high[3] = {-kInfinity, -kInfinity, -kInfinity};
        bool holes = false;
        for (int y = 0; y <= block.height(); ++y)
            for (int x = 0; x <= block.width(); ++x) {
                const int column = firstColumn + i * layout_.tileSize + x, row = firstRow + y;
                float* value = &lanes.values[std::size_t(y * block.pitch() + x) * (regular_ ? 1 : 3) * kLanes + std::size_t(i)];
                if (regular_) {
                    const float height = grid.height(column, row);
                    *value = height;
                    // Not finite: no number, or the difference is none.
                    if (!(height - height == 0.0f)) {
                        holes = true;
                        continue;
                    }
                    low[2] = std::min(low[2], height);
                    high[2] = std::max(high[2], height);
                } else {
                    const glm::vec3 p = grid.position(column, row);
                    for (int axis = 0; axis < 3; ++axis) value[std::size_t(axis) * kLanes] = p[axis];
                    if (grid.isHole(column, row)) {
                        holes = true;
                        continue;
                    }
                    for (int axis = 0; axis < 3; ++axis)
                        low[axis] = std::min(low[axis], p[axis]), high[axis] = std::max(high[axis], p[axis]);
                }
            }
        lanes.bounds[std::size_t(i)] = {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
        lanes.holes[std::size_t(i)] = holes;
    }
}

void GeoMipmapErrors::store(const Program& program, const GeoMipmapShape& shape, std::size_t block, std::size_t lane,
                            const Lanes& lanes) {
    std::uint16_t* codes = &codes_[block * slots_];
    flags_[block] = 0;
    const auto result = [&](std::size_t slot) { return program.exists[slot] ? lanes.results[slot * kLanes + lane] : kInfinity; };
    for (std::size_t slot = 0; slot < slots_; ++slot) codes[slot] = ErrorHierarchy::encode(result(slot));
    const std::size_t flat = std::size_t(layout_.exponent) - 1;
    if (result(slots_) < result(flat)) {
        flags_[block] |= kOtherDiagonal;
        codes[flat] = ErrorHierarchy::encode(result(slots_));
    }
    std::uint16_t finer = 0;
    for (int level = 1; level <= layout_.exponent; ++level)
        if (shape.hasLevel(level)) finer = codes[level - 1] = std::max(codes[level - 1], finer);
    const BoxPyramid::Bounds& bounds = lanes.bounds[lane];
    float* out = &bounds_.front().values[block * (regular_ ? 2 : 6)];
    for (int axis = regular_ ? 2 : 0; axis < 3; ++axis) {
        *out++ = bounds.low[axis];
        *out++ = bounds.high[axis];
    }
}

void GeoMipmapErrors::storeHoles(const SampleGrid& grid, const GeoMipmapShape& shape, std::size_t block) {
    flags_[block] |= kHoles;
    std::uint16_t* codes = &codes_[block * slots_];
    const std::uint16_t never = ErrorHierarchy::encode(kInfinity);
    const int firstColumn = int(block % std::size_t(layout_.blockColumns)) * layout_.tileSize;
    const int firstRow = int(block / std::size_t(layout_.blockColumns)) * layout_.tileSize;
    std::fill(codes, codes + layout_.exponent, never);
    for (int side = 0; side < 4; ++side) {
        // The cells along the side.
        const int left = side == GeoMipmapShape::Right ? shape.width() - 1 : 0,
                  right = side == GeoMipmapShape::Left ? 1 : shape.width();
        const int low = side == GeoMipmapShape::Top ? shape.height() - 1 : 0,
                  high = side == GeoMipmapShape::Bottom ? 1 : shape.height();
        bool solid = true;
        for (int y = low; y <= high; ++y)
            for (int x = left; x <= right; ++x) solid = solid && !grid.isHole(firstColumn + x, firstRow + y);
        for (int level = 0; level < layout_.exponent; ++level)
            for (int border = level + 1; border <= layout_.exponent; ++border)
                if (level > 0 || !solid) codes[sideSlot(side, level, border)] = never;
    }
}

void GeoMipmapErrors::buildBounds() {
    while (bounds_.back().columns > 1 || bounds_.back().rows > 1) {
        const BoundsLevel& fine = bounds_.back();
        const std::size_t size = regular_ ? 2 : 6;
        BoundsLevel coarse{(fine.columns + 1) / 2, (fine.rows + 1) / 2, {}};
        coarse.values.resize(std::size_t(coarse.columns) * std::size_t(coarse.rows) * size);
        for (std::size_t i = 0; i < coarse.values.size(); ++i) coarse.values[i] = i % 2 ? -kInfinity : kInfinity;
        for (int row = 0; row < fine.rows; ++row)
            for (int column = 0; column < fine.columns; ++column) {
                const float* from = &fine.values[(std::size_t(row) * std::size_t(fine.columns) + std::size_t(column)) * size];
                float* to = &coarse.values[(std::size_t(row / 2) * std::size_t(coarse.columns) + std::size_t(column / 2)) * size];
                for (std::size_t i = 0; i < size; i += 2) {
                    to[i] = std::min(to[i], from[i]);
                    to[i + 1] = std::max(to[i + 1], from[i + 1]);
                }
            }
        bounds_.push_back(std::move(coarse));
    }
}

BoxPyramid::Bounds GeoMipmapErrors::bounds(int level, int column, int row) const {
    const BoundsLevel& l = bounds_[std::size_t(level)];
    const float* values = &l.values[(std::size_t(row) * std::size_t(l.columns) + std::size_t(column)) * (regular_ ? 2 : 6)];
    if (!regular_) return {{values[0], values[2], values[4]}, {values[1], values[3], values[5]}};
    const auto start = [&](int block) { return float((block << level) * layout_.tileSize); };
    const float right = column + 1 < l.columns ? start(column + 1) : float(layout_.columns - 1);
    const float top = row + 1 < l.rows ? start(row + 1) : float(layout_.rows - 1);
    return {{start(column), start(row), values[0]}, {right, top, values[1]}};
}

std::size_t GeoMipmapErrors::bytes() const {
    std::size_t total = codes_.capacity() * sizeof(codes_[0]) + flags_.capacity();
    for (const BoundsLevel& level : bounds_) total += level.values.capacity() * sizeof(float);
    return total;
}

}  // namespace terrain
