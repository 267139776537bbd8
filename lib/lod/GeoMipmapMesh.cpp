#include "lod/GeoMipmapMesh.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "base/ProfileScope.h"
#include "lod/BruteForceMesh.h"
#include "lod/ViewMotion.h"

namespace terrain {

namespace {

/// Detail goes in steps that floats hold exactly, so that no difference of levels comes from rounding.
float inSteps(float detail) {
    constexpr float kSteps = 4096.0f;
    return std::floor(detail * kSteps) / kSteps;
}

}  // namespace

/// Without culling, what is outside of the view has half the error that it would have if the camera turned to it.
struct GeoMipmapMesh::Turned {
    ViewMotion motion;
    float depthAtEye = 0.0f, depthPerLength = 0.0f;

    Turned(const ScreenSpace& space, const View& view, const SampleGrid& grid) {
        motion.advance(view, grid.localFromFrame());
        const glm::vec4 w = space.depth();
        depthPerLength = glm::length(glm::vec3(w) / motion.unitLength());
        depthAtEye = std::max(0.0f, glm::dot(glm::vec3(w), motion.eye()) + w.w);
    }
    float factor(const ScreenSpace& space, const Box& box) const {
        const glm::vec3 gap = glm::max(glm::abs(box.centre - motion.eye()) - box.half, glm::vec3(0.0f));
        return 0.5f * space.largestFactor() / (depthAtEye + depthPerLength * glm::length(gap * motion.unitLength()));
    }
};

GeoMipmapMesh::GeoMipmapMesh(std::shared_ptr<const GeoMipmapErrors> errors)
    : errors_(std::move(errors)), layout_(errors_->layout()), vertices_(errors_), detail_(layout_.blockCount(), kHidden),
      factor_(layout_.blockCount()), queued_(layout_.blockCount()) {}

DrawList GeoMipmapMesh::select(const SampleGrid& grid, const View& view, const LodSettings& settings) {
    const ProfileScope scope("geo mip-mapping: select");
    vertices_.forgetNewVertices();
    DrawList drawList;
    if (view_ != view || settings_ != settings) {
        const bool otherTriangles = !view_ || settings_.clockwise != settings.clockwise ||
                                    settings_.geomorph != settings.geomorph ||
                                    (settings_.pixelError > 0.0f) != (settings.pixelError > 0.0f);
        view_ = view;
        settings_ = settings;
        morphing_ = settings.geomorph && settings.pixelError > 0.0f;
        limit_ = morphing_ ? kMorphStart * settings.pixelError : settings.pixelError;
        for (const std::uint32_t block : chosen_) detail_[block] = kHidden;
        chosen_.clear();
        const ScreenSpace space(view, grid.localFromFrame(), grid.isRegular() ? ErrorDirection::Vertical : ErrorDirection::Any);
        std::optional<Turned> turned;
        if (!settings.cull) turned.emplace(space, view, grid);
        choose(space, turned ? &*turned : nullptr, errors_->boundsLevels() - 1, 0, 0);
        settle();
        list();
        if (otherTriangles || drawn_ != drawnBefore_) {
            vertices_.update(grid, drawn_);
            emit(grid);
            drawList.indicesChanged = true;
            drawList.positionsChanged = !vertices_.newVertices().empty();
        }
        if (vertices_.morph(grid, drawn_, detail_)) drawList.positionsChanged = true;
        report_ = {};
        report_.triangles = std::uint32_t(indices_.size() / 3);
        report_.errorPixels = boundError(space);
    }
    drawList.positions = vertices_.positions();
    drawList.samples = vertices_.samples();
    drawList.indices = indices_;
    drawList.newVertices = vertices_.newVertices();
    drawList.report = report_;
    return drawList;
}

void GeoMipmapMesh::choose(const ScreenSpace& space, const Turned* turned, int boundsLevel, int column, int row) {
    const BoxPyramid::Bounds bounds = errors_->bounds(boundsLevel, column, row);
    if (bounds.isEmpty()) return;
    const Box box = boxOf(bounds);
    const bool outside = space.isOutside(box);
    if (outside && !turned) return;
    if (boundsLevel == 0) {
        const std::uint32_t block = std::uint32_t(row) * std::uint32_t(layout_.blockColumns) + std::uint32_t(column);
        evaluate(block, outside ? turned->factor(space, box) : space.screenError(1.0f, box));
        return;
    }
    for (int y = 2 * row; y < std::min(2 * row + 2, errors_->boundsRows(boundsLevel - 1)); ++y)
        for (int x = 2 * column; x < std::min(2 * column + 2, errors_->boundsColumns(boundsLevel - 1)); ++x)
            choose(space, turned, boundsLevel - 1, x, y);
}

void GeoMipmapMesh::evaluate(std::uint32_t block, float factor) {
    int level = layout_.exponent;
    while (level > 0 && !fits(errors_->level(block, level), factor)) --level;
    float detail = float(level);
    if (morphing_ && level < layout_.exponent && canMorph(block)) detail += fade(errors_->level(block, level + 1), factor);
    detail_[block] = detail;
    factor_[block] = factor;
    chosen_.push_back(block);
}

/// How far a block whose next coarser level has this error has come to it.
float GeoMipmapMesh::fade(float error, float factor) const {
    if (error == 0.0f) return 1.0f;
    const float pixels = error * factor, full = settings_.pixelError;
    if (!(pixels < full)) return 0.0f;
    return inSteps(std::clamp((full - pixels) / (full - limit_), 0.0f, 1.0f));
}

std::uint32_t GeoMipmapMesh::neighbour(std::uint32_t block, int side) const {
    const std::uint32_t columns = std::uint32_t(layout_.blockColumns), column = block % columns, row = block / columns;
    switch (side) {
    case GeoMipmapShape::Bottom:
        return row > 0 ? block - columns : kNone;
    case GeoMipmapShape::Right:
        return column + 1 < columns ? block + 1 : kNone;
    case GeoMipmapShape::Top:
        return row + 1 < std::uint32_t(layout_.blockRows) ? block + columns : kNone;
    default:
        return column > 0 ? block - 1 : kNone;
    }
}

void GeoMipmapMesh::push(std::uint32_t block) {
    if (queued_[block]) return;
    queued_[block] = true;
    queue_.push_back(block);
}

void GeoMipmapMesh::lower(std::uint32_t block, float detail) {
    detail_[block] = detail;
    push(block);
    for (int side = 0; side < 4; ++side)
        if (const std::uint32_t next = neighbour(block, side); next != kNone && detail_[next] != kHidden) push(next);
}

/// Refines blocks whose finer neighbours could not meet them, until all can. Levels only become finer, so it ends; and what is
/// there in the end does not depend on the order.
void GeoMipmapMesh::settle() {
    queue_.clear();
    for (const std::uint32_t block : chosen_) push(block);
    for (std::size_t i = 0; i < queue_.size(); ++i) {
        const std::uint32_t block = queue_[i];
        queued_[block] = false;
        for (int side = 0; side < 4; ++side) {
            const std::uint32_t next = neighbour(block, side);
            if (next == kNone || detail_[next] == kHidden || detail_[next] <= detail_[block]) continue;
            if (morphing_)
                settleMorph(block, side);
            else
                settleFinerThan(block, side);
        }
    }
}

void GeoMipmapMesh::settleFinerThan(std::uint32_t block, int side) {
    const std::uint32_t next = neighbour(block, side);
    const int level = levelOf(block), before = levelOf(next);
    int border = before;
    while (border > level &&
           (!errors_->shape(next).hasLevel(border) || !fits(errors_->side(block, side, level, border), factor_[block])))
        --border;
    while (!errors_->shape(next).hasLevel(border)) --border;
    if (border < before) lower(next, float(border));
}

/// The neighbour may be coarser by as much of a level as the errors of this side at the next border levels allow.
void GeoMipmapMesh::settleMorph(std::uint32_t block, int side) {
    const std::uint32_t next = neighbour(block, side);
    const int level = levelOf(block), last = layout_.exponent;
    const float coarse = detail_[block] - float(level), factor = factor_[block];
    float error = 0.0f;
    for (int k = 0; k <= std::min(level, last - 1); ++k)
        if (errors_->shape(block).hasLevel(k)) error = std::max(error, errors_->side(block, side, k, k + 1));
    float most = detail_[block] + (1.0f - coarse) * fade(error, factor);
    if (coarse > 0.0f && level + 1 < last)
        most += coarse * fade(std::max(error, errors_->side(block, side, level + 1, level + 2)), factor);
    most = inSteps(most);
    if (!canMorph(next)) {
        int rounded = int(most);
        while (!errors_->shape(next).hasLevel(rounded)) --rounded;
        most = float(rounded);
    }
    if (most < detail_[next]) lower(next, most);
}

void GeoMipmapMesh::list() {
    drawnBefore_.swap(drawn_);
    drawn_.clear();
    for (const std::uint32_t block : chosen_) {
        DrawnBlock drawn{block, std::uint8_t(levelOf(block)), {}};
        for (int side = 0; side < 4; ++side) {
            const std::uint32_t next = neighbour(block, side);
            const int beyond = next != kNone && detail_[next] != kHidden ? levelOf(next) : 0;
            drawn.border[std::size_t(side)] = std::uint8_t(std::max(beyond, int(drawn.level)));
        }
        drawn_.push_back(drawn);
    }
}

void GeoMipmapMesh::emit(const SampleGrid& grid) {
    indices_.clear();
    for (const DrawnBlock& drawn : drawn_) emitBlock(grid, drawn);
}

void GeoMipmapMesh::emitBlock(const SampleGrid& grid, const DrawnBlock& drawn) {
    const std::uint32_t* vertices = vertices_.of(drawn);
    const GeoMipmapShape& shape = errors_->shape(drawn.block);
    const bool holes = errors_->hasHoles(drawn.block);
    if (drawn.level == layout_.exponent) return emitTriangles(shape.flat(errors_->hasOtherDiagonal(drawn.block)), vertices);
    if (drawn.level == 0 && !morphing_ && drawn.border == std::array<std::uint8_t, 4>{}) {
        if (holes) return emitSolid(grid, drawn, shape.cells(), vertices);
        return emitTriangles(shape.cells(), vertices);
    }
    if (holes)
        emitSolid(grid, drawn, shape.inner(drawn.level), vertices);
    else
        emitTriangles(shape.inner(drawn.level), vertices);
    for (int side = 0; side < 4; ++side) {
        const int border = drawn.border[std::size_t(side)];
        // A border that is coarser has no hole along it.
        if (holes && border == 0)
            emitSolid(grid, drawn, shape.side(side, 0, 0), vertices);
        else
            emitTriangles(shape.side(side, drawn.level, border), vertices);
    }
}

void GeoMipmapMesh::emitTriangles(std::span<const GeoMipmapShape::Triangle> triangles, const std::uint32_t* vertices) {
    const std::size_t first = indices_.size();
    indices_.resize(first + 3 * triangles.size());
    std::uint32_t* out = indices_.data() + first;
    const std::size_t second = settings_.clockwise ? 2 : 1, third = 3 - second;
    for (const GeoMipmapShape::Triangle& triangle : triangles) {
        *out++ = vertices[triangle[0]];
        *out++ = vertices[triangle[second]];
        *out++ = vertices[triangle[third]];
    }
}

/// Triangles of the finest level, without those in cells that are holes.
void GeoMipmapMesh::emitSolid(const SampleGrid& grid, const DrawnBlock& drawn, std::span<const GeoMipmapShape::Triangle> triangles,
                              const std::uint32_t* vertices) {
    const GeoMipmapShape& shape = errors_->shape(drawn.block);
    const glm::ivec2 from(int(drawn.block % std::uint32_t(layout_.blockColumns)) * layout_.tileSize,
                          int(drawn.block / std::uint32_t(layout_.blockColumns)) * layout_.tileSize);
    for (const GeoMipmapShape::Triangle& triangle : triangles) {
        const glm::ivec2 cell = from + glm::min(shape.at(triangle[0]), glm::min(shape.at(triangle[1]), shape.at(triangle[2])));
        if (!isCellHole(grid, cell.x, cell.y)) emitTriangles({&triangle, 1}, vertices);
    }
}

float GeoMipmapMesh::boundError(const ScreenSpace& space) const {
    float largest = 0.0f;
    for (const std::uint32_t block : chosen_) {
        const int level = levelOf(block);
        const bool moves = detail_[block] > float(level);
        const float error = errors_->level(block, moves ? level + 1 : level), factor = factor_[block];
        if (!settings_.cull) {
            const std::uint32_t columns = std::uint32_t(layout_.blockColumns);
            if (space.isOutside(boxOf(errors_->bounds(0, int(block % columns), int(block / columns))))) continue;
        }
        if (error > 0.0f) largest = std::max(largest, error * factor);
        if (const float sides = boundSides(block); sides > 0.0f) largest = std::max(largest, sides * factor);
    }
    return largest;
}

/// Largest error of a block's sides whose borders are coarser, in units.
float GeoMipmapMesh::boundSides(std::uint32_t block) const {
    const int level = levelOf(block), last = layout_.exponent;
    float largest = 0.0f;
    for (int side = 0; side < 4; ++side) {
        const std::uint32_t next = neighbour(block, side);
        if (next == kNone || detail_[next] <= detail_[block]) continue;
        const int beyond = levelOf(next);
        if (!morphing_) {
            largest = std::max(largest, errors_->side(block, side, level, beyond));
            continue;
        }
        // Of the meshes that are averaged: where the neighbour is coarser at first, or alone has come to its next level.
        const float coarse = detail_[block] - float(level), coarseBeyond = detail_[next] - float(beyond);
        if (beyond > level) largest = std::max(largest, errors_->side(block, side, level, beyond));
        if (beyond == level && coarseBeyond > coarse) largest = std::max(largest, errors_->side(block, side, level, level + 1));
        if (beyond > level && coarse > 0.0f && coarseBeyond > 0.0f && level + 2 <= last)
            largest = std::max(largest, errors_->side(block, side, level + 1, level + 2));
    }
    return largest;
}

std::size_t GeoMipmapMesh::bytes() const {
    const auto held = [](const auto& items) { return items.capacity() * sizeof(items[0]); };
    // Its share of the table, which meshes and their vertices refer to.
    const std::size_t table = 2 * errors_->bytes() / std::size_t(std::max(2L, errors_.use_count()));
    return table + vertices_.bytes() + held(detail_) + held(factor_) + queued_.capacity() / 8 + held(chosen_) + held(queue_) +
           held(drawn_) + held(drawnBefore_) + held(indices_);
}

int GeoMipmapMesh::level(int blockColumn, int blockRow) const {
    const float detail = detail_[std::size_t(blockRow) * std::size_t(layout_.blockColumns) + std::size_t(blockColumn)];
    return detail == kHidden ? -1 : int(detail);
}

}  // namespace terrain
