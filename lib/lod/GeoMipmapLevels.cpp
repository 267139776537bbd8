// Which level each block of Geo Mip-Mapping has in a view.
#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "lod/GeoMipmapMesh.h"
#include "lod/ViewMotion.h"

namespace terrain {

namespace {

/// Detail goes in steps that floats hold exactly, so that no difference of levels comes from rounding.
float inSteps(float detail) {
    constexpr float kSteps = 4096.0f;
    return std::floor(detail * kSteps) / kSteps;
}

/// Whether nothing of the box is out of view.
bool isInside(const ScreenSpace& space, const Box& box) {
    const glm::vec3 low = box.lowest(), high = box.highest();
    return std::all_of(space.planes().begin(), space.planes().end(), [&](const glm::vec4& plane) {
        const auto least = [&](int axis) { return std::min(plane[axis] * low[axis], plane[axis] * high[axis]); };
        return least(0) + least(1) + least(2) + plane.w >= 0.0f;
    });
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

/// What a walk over the pyramid of bounds needs to know.
struct GeoMipmapMesh::Visit {
    const ScreenSpace& space;
    const Turned* turned;  ///< null: leave out what is outside
};

float GeoMipmapMesh::morphStart(float pixelError) {
    constexpr float kNarrowest = 0.05f, kWidest = 0.5f, kFullWidth = 0.0125f;
    return pixelError * (1.0f - std::clamp(kFullWidth * pixelError * pixelError, kNarrowest, kWidest));
}

void GeoMipmapMesh::choose(const SampleGrid& grid) {
    for (const BlockAt& at : chosen_) detail_[at] = kHidden;
    chosen_.clear();
    const ScreenSpace space(*view_, grid.localFromFrame(), grid.isRegular() ? ErrorDirection::Vertical : ErrorDirection::Any);
    std::optional<Turned> turned;
    if (!settings_.cull) turned.emplace(space, *view_, grid);
    visit({space, turned ? &*turned : nullptr}, errors_->boundsLevels() - 1, 0, 0, true);
}

void GeoMipmapMesh::visit(const Visit& v, int boundsLevel, int column, int row, bool mayBeOutside) {
    const BoxPyramid::Bounds bounds = errors_->bounds(boundsLevel, column, row);
    if (bounds.isEmpty()) return;
    const Box box = boxOf(bounds);
    const bool outside = mayBeOutside && v.space.isOutside(box);
    if (outside && !v.turned && !(morphing_ && isNextToView(v, box))) return;
    if (boundsLevel == 0) {
        const BlockAt at{std::uint32_t(layout_.block(column, row)), std::uint16_t(column), std::uint16_t(row)};
        evaluate(at, outside && v.turned ? v.turned->factor(v.space, box) : v.space.screenError(1.0f, box));
        if (outside) factor_[at.number] = -factor_[at.number];
        return;
    }
    mayBeOutside = mayBeOutside && !isInside(v.space, box);
    for (int y = 2 * row; y < std::min(2 * row + 2, errors_->boundsRows(boundsLevel - 1)); ++y)
        for (int x = 2 * column; x < std::min(2 * column + 2, errors_->boundsColumns(boundsLevel - 1)); ++x)
            visit(v, boundsLevel - 1, x, y, mayBeOutside);
}

/// Whether a block near by may be in view.
bool GeoMipmapMesh::isNextToView(const Visit& v, const Box& box) const {
    // Where slides are wide, neighbours differ by less and more blocks have a say.
    const int blocks = settings_.pixelError > 2.0f ? 4 : 2;
    const float cells = float(blocks * layout_.tileSize + 1);
    const glm::vec3 reach =
        v.space.direction() == ErrorDirection::Vertical ? glm::vec3(cells, cells, 0.0f) : box.half * float(2 * blocks);
    return !v.space.isOutside({box.centre, box.half + reach});
}

void GeoMipmapMesh::evaluate(const BlockAt& at, float factor) {
    float detail = 0.0f;
    if (morphing_ && canMorph(at)) {
        // Where the errors of several levels are near to each other, several are on their way at once; never further than to one
        // whose error is within pixelError.
        for (int level = 1; level <= layout_.exponent; ++level) {
            const float part = fade(errors_->level(at.number, level), factor);
            detail += part;
            if (part == 0.0f) break;
        }
    } else {
        int level = layout_.exponent;
        while (level > 0 && !fits(errors_->level(at.number, level), factor)) --level;
        detail = float(level);
    }
    detail_[at] = detail;
    factor_[at.number] = factor;
    chosen_.push_back(at);
}

/// How far what has this error has come to be drawn.
float GeoMipmapMesh::fade(float error, float factor) const {
    if (error == 0.0f) return 1.0f;
    const float pixels = error * factor, full = settings_.pixelError;
    if (!(pixels < full)) return 0.0f;
    return inSteps(std::clamp((full - pixels) / (full - limit_), 0.0f, 1.0f));
}

BlockAt GeoMipmapMesh::neighbour(const BlockAt& at, int side) const {
    const std::uint32_t columns = std::uint32_t(layout_.blockColumns);
    switch (side) {
    case GeoMipmapShape::Bottom:
        return {at.number - columns, at.column, std::uint16_t(at.row - 1)};
    case GeoMipmapShape::Right:
        return {at.number + 1, std::uint16_t(at.column + 1), at.row};
    case GeoMipmapShape::Top:
        return {at.number + columns, at.column, std::uint16_t(at.row + 1)};
    default:
        return {at.number - 1, std::uint16_t(at.column - 1), at.row};
    }
}

void GeoMipmapMesh::push(const BlockAt& at) {
    if (queued_[at.number]) return;
    queued_[at.number] = true;
    queue_.push_back(at);
}

void GeoMipmapMesh::lower(const BlockAt& at, float detail) {
    detail_[at] = detail;
    push(at);
    for (int side = 0; side < 4; ++side)
        if (detail_.beyond(at, side) != kHidden) push(neighbour(at, side));
}

/// Refines blocks whose finer neighbours could not meet them, until all can. Levels only become finer, so it ends; and what is
/// there in the end does not depend on the order.
void GeoMipmapMesh::settle() {
    queue_.clear();
    for (const BlockAt& at : chosen_) settleBlock(at);
    for (std::size_t i = 0; i < queue_.size(); ++i) {
        const BlockAt at = queue_[i];
        queued_[at.number] = false;
        settleBlock(at);
    }
}

void GeoMipmapMesh::settleBlock(const BlockAt& at) {
    for (int side = 0; side < 4; ++side) {
        if (detail_.beyond(at, side) <= detail_[at]) continue;
        if (morphing_)
            settleMorph(at, side);
        else
            settleSide(at, side);
    }
}

void GeoMipmapMesh::settleSide(const BlockAt& at, int side) {
    const BlockAt next = neighbour(at, side);
    const GeoMipmapShape& shape = errors_->shape(next.column, next.row);
    const int level = int(detail_[at]), before = int(detail_[next]);
    const float factor = std::fabs(factor_[at.number]);
    int border = before;
    while (border > level && !(shape.hasLevel(border) && fits(errors_->side(at.number, side, level, border), factor))) --border;
    while (!shape.hasLevel(border)) --border;
    if (border < before) lower(next, float(border));
}

/// The neighbour may be coarser by as much of a level as the errors of this side at the next border levels allow.
void GeoMipmapMesh::settleMorph(const BlockAt& at, int side) {
    const BlockAt next = neighbour(at, side);
    const int last = layout_.exponent, level = int(detail_[at]);
    const float coarse = detail_[at] - float(level), factor = std::fabs(factor_[at.number]);
    float error = 0.0f;
    for (int k = 0; k <= std::min(level, last - 1); ++k)
        if (errors_->shape(at.column, at.row).hasLevel(k)) error = std::max(error, errors_->side(at.number, side, k, k + 1));
    float most = detail_[at] + (1.0f - coarse) * fade(error, factor);
    if (coarse > 0.0f && level + 1 < last)
        most += coarse * fade(std::max(error, errors_->side(at.number, side, level + 1, level + 2)), factor);
    most = inSteps(most);
    if (!canMorph(next)) {
        int rounded = int(most);
        while (!errors_->shape(next.column, next.row).hasLevel(rounded)) --rounded;
        most = float(rounded);
    }
    if (most < detail_[next]) lower(next, most);
}

float GeoMipmapMesh::boundError() const {
    float largest = 0.0f;
    for (const BlockAt& at : chosen_) {
        const float factor = factor_[at.number], detail = detail_[at];
        if (std::signbit(factor)) continue;
        // Of a block on its way to the next level, that level's: errors grow with the level.
        float error = detail > 0.0f ? errors_->level(at.number, int(std::ceil(detail))) : 0.0f;
        for (int side = 0; side < 4; ++side)
            if (detail_.beyond(at, side) > detail) {
                error = std::max(error, boundSides(at));
                break;
            }
        if (error > 0.0f) largest = std::max(largest, error * factor);
    }
    return largest;
}

/// Largest error of a block's sides whose borders are coarser, in units.
float GeoMipmapMesh::boundSides(const BlockAt& at) const {
    const float detail = detail_[at];
    const int level = int(detail), last = layout_.exponent;
    float largest = 0.0f;
    for (int side = 0; side < 4; ++side) {
        const float detailBeyond = detail_.beyond(at, side);
        if (detailBeyond <= detail) continue;
        const int beyond = int(detailBeyond);
        const auto consider = [&](int own, int border) {
            largest = std::max(largest, errors_->side(at.number, side, own, border));
        };
        if (beyond > level) consider(level, beyond);
        if (!morphing_) continue;
        // Of the meshes that are averaged: where the neighbour alone has come to its next level, or both have.
        if (beyond == level) consider(level, level + 1);
        if (beyond > level && detail > float(level) && detailBeyond > float(beyond) && level + 2 <= last)
            consider(level + 1, level + 2);
    }
    return largest;
}

}  // namespace terrain
