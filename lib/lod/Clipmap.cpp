#include "lod/Clipmap.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "base/ProfileScope.h"

namespace terrain {

namespace {

/// Part of what lets a level go at which the next coarser one begins to take over.
constexpr float kFadeStart = 0.8f;

constexpr float kInfinite = std::numeric_limits<float>::infinity();

/// Where the eye of a perspective camera is in the frame; for an orthographic one, where the middle of its view meets the plane of
/// mean height.
struct FrameEye {
    glm::dvec3 at{0.0};
    bool isPerspective = false;
};

FrameEye frameEye(const View& view, const glm::dmat4& localFromFrame, double middle) {
    const glm::dmat4 inverse = glm::inverse(view.clipFromLocal * localFromFrame);
    const glm::dvec4 eye = inverse * glm::dvec4(0.0, 0.0, 1.0, 0.0);
    if (std::fabs(eye.w) > 1e-12 * glm::length(glm::dvec3(eye))) return {glm::dvec3(eye) / eye.w, true};
    const glm::dvec4 nearest = inverse * glm::dvec4(0.0, 0.0, -1.0, 1.0), farthest = inverse * glm::dvec4(0.0, 0.0, 1.0, 1.0);
    const glm::dvec3 a = glm::dvec3(nearest) / nearest.w, b = glm::dvec3(farthest) / farthest.w;
    const double fall = b.z - a.z, part = std::fabs(fall) > 1e-12 ? std::clamp((middle - a.z) / fall, 0.0, 1.0) : 0.5;
    return {a + (b - a) * part, false};
}

double distanceTo(const Box& box, const glm::dvec3& point) {
    return glm::length(glm::max(glm::abs(point - glm::dvec3(box.centre)) - glm::dvec3(box.half), glm::dvec3(0.0)));
}

/// The sample of a curved grid nearest to a point, to within the blocks of the pyramid.
glm::ivec2 nearestSample(const SampleGrid& grid, const BoxPyramid& boxes, const glm::dvec3& point) {
    glm::ivec2 block(0);
    for (int level = boxes.levelCount() - 2; level >= 0; --level) {
        double nearest = std::numeric_limits<double>::infinity();
        const glm::ivec2 first = block * 2;
        for (int row = first.y; row < std::min(first.y + 2, boxes.rows(level)); ++row)
            for (int column = first.x; column < std::min(first.x + 2, boxes.columns(level)); ++column) {
                const BoxPyramid::Bounds bounds = boxes.block(level, column, row);
                if (bounds.isEmpty()) continue;
                const double distance = distanceTo(boxOf(bounds), point);
                if (distance < nearest) nearest = distance, block = {column, row};
            }
    }
    const glm::ivec2 last(grid.columns() - 1, grid.rows() - 1);
    return glm::min(block * BoxPyramid::kBlockCells + BoxPyramid::kBlockCells / 2, last);
}

}  // namespace

Clipmap::Eye Clipmap::eyeOf(const SampleGrid& grid, const BoxPyramid& boxes, const View& view) const {
    const Box all = boxOf(boxes.all());
    const FrameEye eye = frameEye(view, grid.localFromFrame(), all.centre.z);
    const glm::dvec2 last(grid.columns() - 1, grid.rows() - 1);
    Eye result;
    if (!grid.isRegular()) {
        const glm::ivec2 sample = nearestSample(grid, boxes, eye.at);
        const glm::ivec2 next(std::min(sample.x + 1, grid.columns() - 1), std::min(sample.y + 1, grid.rows() - 1));
        const glm::dvec3 ground(grid.position(sample.x, sample.y)), beside(grid.position(next.x, next.y));
        const double spacing = glm::length(beside - ground) / std::sqrt(2.0);
        result.sample = glm::dvec2(sample);
        result.height = glm::length(eye.at - ground) / spacing;
    } else {
        const glm::dvec2 nearest = glm::clamp(glm::dvec2(eye.at), glm::dvec2(0.0), last);
        const float ground = grid.height(int(std::lround(nearest.x)), int(std::lround(nearest.y)));
        const auto unit = [&](int axis) { return glm::length(glm::dvec3(grid.localFromFrame()[axis])); };
        const double above = eye.at.z - (std::isfinite(ground) ? double(ground) : double(all.centre.z));
        const glm::dvec3 away((glm::dvec2(eye.at) - nearest) * glm::dvec2(unit(0), unit(1)), above * unit(2));
        result.sample = glm::dvec2(eye.at);
        result.height = glm::length(away) / std::min(unit(0), unit(1));
    }
    if (!eye.isPerspective || !std::isfinite(result.height)) result.height = 0.0;
    if (!std::isfinite(result.sample.x + result.sample.y)) result.sample = last * 0.5;
    return result;
}

ClipRect Clipmap::plainPart(int level, glm::dvec2 viewer) const {
    if (level + 1 == layout_.levels()) return layout_.domain(level);
    const double inner = double(layout_.size() - 1) / 2.0 - layout_.transitionWidth() - 1.0;
    const glm::dvec2 at = layout_.viewerAt(level, viewer);
    return ClipRect{glm::ivec2(glm::ceil(at - inner)), glm::ivec2(glm::floor(at + inner))}.cutTo(layout_.domain(level));
}

Clipmap::Choice Clipmap::choose(const SampleGrid& grid, const BoxPyramid& boxes, const ClipmapErrors* errors,
                                const ScreenSpace& space, const Eye& eye, glm::dvec2 viewer,
                                const ClipmapSettings& settings) const {
    const int last = layout_.levels() - 1, sampled = std::min(layout_.detailLevels(), last);
    if (settings.activeLevels > 0) return {std::max(0, layout_.levels() - settings.activeLevels), 0.0f};
    // Asirvatham and Hoppe 2005, sect. 3: levels that are less than 2.5 h wide are not drawn. Before that they fade.
    const auto narrowness = [&](int level) { return 2.5 * eye.height / (double(layout_.size() - 1) * layout_.spacing(level)); };
    int finest = 0;
    while (finest < last && narrowness(finest) > 1.0) ++finest;
    if (!errors || finest < sampled) {
        const double fade = (narrowness(finest) - kFadeStart) / (1.0 - kFadeStart);
        return {finest, finest < last ? float(std::clamp(fade, 0.0, 1.0)) : 0.0f};
    }
    const float enough = kFadeStart * settings.pixelError;
    const auto errorWithout = [&](int level) {
        // In the blocks that boundError() would see, so that it finds no more than this.
        constexpr int kBlock = ClipmapErrors::kBlockCells;
        ClipRect region = coarserRect(layout_.place(level - 1, viewer));
        region = {region.low & ~(kBlock - 1), (region.high + (kBlock - 1)) & ~(kBlock - 1)};
        return errors->screenError(space, grid, boxes, layout_.sourceLevel(level), false, region.cutTo(plainPart(level, viewer)),
                                   {}, enough);
    };
    while (finest > sampled && errorWithout(finest) > enough) --finest;
    float error = kInfinite;
    while (finest < last && (error = errorWithout(finest + 1)) <= enough) ++finest;
    if (finest == last || !(error < settings.pixelError)) return {finest, 0.0f};
    // What the next level would do still keeps pixelError: it is on its way to take over.
    return {finest, (settings.pixelError - error) / (settings.pixelError - enough)};
}

float Clipmap::blend(int level, int axis, int vertex) const {
    const ClipRect& active = frame_.active[std::size_t(level)];
    // Where the viewer is nothing blends.
    glm::ivec2 at(glm::floor(layout_.viewerAt(level, frame_.viewer)));
    at[axis] = vertex;
    const float least = level == frame_.finest ? frame_.leastBlend : 0.0f;
    const float share = std::max(least, layout_.blend(level, at, frame_.viewer));
    if (active == layout_.place(level, frame_.viewer) || level + 1 >= layout_.levels()) return share;
    // Along the border of what is there as along a perimeter: the 2004 article's eq. (1). Where the grid ends nothing lies beyond.
    const ClipRect domain = layout_.domain(level);
    int inside = std::numeric_limits<int>::max();
    if (active.low[axis] > domain.low[axis]) inside = std::min(inside, vertex - active.low[axis]);
    if (active.high[axis] < domain.high[axis]) inside = std::min(inside, active.high[axis] - vertex);
    return std::max(share, 1.0f - std::min(1.0f, float(inside) / float(layout_.transitionWidth())));
}

float Clipmap::boundError(const SampleGrid& grid, const BoxPyramid& boxes, const ClipmapErrors& errors, const ScreenSpace& space,
                          glm::dvec2 viewer, std::span<const ClipRect> active, const Choice& choice) const {
    float largest = 0.0f;
    const int last = layout_.levels() - 1;
    for (int level = last; level >= 0; --level) {
        const ClipRect& region = active[std::size_t(level)];
        if (region.isEmpty() && level == last) return kInfinite;
        if (region.isEmpty()) break;
        const int source = layout_.sourceLevel(level);
        // Levels of detail pass through all samples, whatever share of each is drawn.
        if (source < 0) break;
        const ClipRect hole = holeIn(active, level);
        const ClipRect domain = layout_.domain(level), whole = layout_.place(level, viewer);
        if (level == last) {
            if (!region.contains(domain)) return kInfinite;
            largest = std::max(largest, errors.screenError(space, grid, boxes, source, false, region.cutTo(domain), hole, largest));
            continue;
        }
        ClipRect plain;
        if (region == whole) plain = plainPart(level, viewer);
        if (!plain.isEmpty() && level == choice.finest && choice.leastBlend > 0.0f) {
            // All of it is the same share of two surfaces, but where the border cuts cells of the coarser one.
            const auto errorOn = [&](int l, bool blends, const ClipRect& part) {
                return errors.screenError(space, grid, boxes, layout_.sourceLevel(l), blends, part, {}, 0.0f);
            };
            const float own = errorOn(level, false, plain),
                        other = errorOn(level + 1, false, {plain.low >> 1, (plain.high + 1) >> 1});
            largest = std::max(largest, own + choice.leastBlend * (other - own));
            for (int axis = 0; axis < 2; ++axis) {
                ClipRect cut = plain;
                cut.low[axis] = std::max(plain.low[axis], domain.high[axis] - 2);
                if (plain.high[axis] == domain.high[axis]) largest = std::max(largest, errorOn(level, true, cut));
            }
        } else if (!plain.isEmpty()) {
            largest = std::max(largest, errors.screenError(space, grid, boxes, source, false, plain, hole, largest));
        }
        const ClipRect& without = plain.contains(hole.cutTo(domain)) && !plain.isEmpty() ? plain : hole;
        largest = std::max(largest, errors.screenError(space, grid, boxes, source, true, region.cutTo(domain), without, largest));
    }
    return largest;
}

void Clipmap::cover(const BoxPyramid& boxes, const ScreenSpace& space, const ClipmapSettings& settings) {
    frame_.patches.clear();
    for (int level = 0; level < layout_.levels(); ++level)
        coverLevel(layout_, level, frame_.active[std::size_t(level)], holeIn(frame_.active, level), frame_.patches);
    const auto boundsOf = [&](const ClipmapPatch& patch) {
        // Vertices blend towards heights from all of the coarser cells around.
        const bool blends = patch.level + 1 < layout_.levels();
        const glm::ivec2 first = blends ? patch.low & ~1 : patch.low, end = blends ? (patch.high + 1) & ~1 : patch.high;
        const glm::ivec2 low = layout_.unitAt(first, patch.level) >> layout_.detailLevels();
        const glm::ivec2 high = (layout_.unitAt(end, patch.level) + layout_.unitsPerSample() - 1) >> layout_.detailLevels();
        BoxPyramid::Bounds bounds = boxes.bounds(low.x, low.y, high.x, high.y);
        if (!settings.detail || layout_.sourceLevel(patch.level) >= 0 || bounds.isEmpty()) return bounds;
        // Detail looks two samples around.
        const BoxPyramid::Bounds around = boxes.bounds(low.x - 2, low.y - 2, high.x + 2, high.y + 2);
        const float reach = settings.detail->overshoot(0, around.high.z - around.low.z, boxes.hasHoles());
        bounds.low.z -= reach;
        bounds.high.z += reach;
        return bounds;
    };
    const auto isHidden = [&](const ClipmapPatch& patch) {
        const BoxPyramid::Bounds bounds = boundsOf(patch);
        return bounds.isEmpty() || (settings.cull && space.isOutside(boxOf(bounds)));
    };
    std::uint32_t triangles = 0, patches = 0;
    for (int footprint = 0; footprint < kFootprints; ++footprint) {
        auto& list = frame_.patches.by[footprint];
        std::erase_if(list, isHidden);
        patches += std::uint32_t(list.size());
        if (Footprint(footprint) == Footprint::Seam) continue;
        for (const ClipmapPatch& patch : list) {
            const glm::ivec2 cells = patch.high - patch.low;
            triangles += 2 * std::uint32_t(cells.x) * std::uint32_t(cells.y);
        }
    }
    frame_.report.triangles = triangles;
    frame_.report.patches = patches;
}

/// Vertices of a level whose heights or normals, own or coarser, depend on these samples.
ClipRect Clipmap::verticesBy(const SampleRect& samples, int level) const {
    const int source = layout_.sourceLevel(level);
    // Detail looks two samples around. On the other levels a coarser height depends on samples a vertex away, and a coarser normal
    // on those of vertices next to that one.
    constexpr int kAround = 3;
    if (source < 0) return {(samples.low - kAround) * (1 << -source), (samples.high + kAround) * (1 << -source)};
    const int round = (1 << source) - 1;
    return {(samples.low >> source) - kAround, ((samples.high + round) >> source) + kAround};
}

/// The same and, level by level from the coarsest one, what has changed of what is there.
std::span<const ClipmapUpdates::Update> Clipmap::withEdits(std::span<const ClipmapUpdates::Update> updates) {
    if (edits_.isEmpty()) return updates;
    allUpdates_.clear();
    auto next = updates.begin();
    for (int level = layout_.levels() - 1; level >= 0; --level) {
        for (; next != updates.end() && next->level == level; ++next) allUpdates_.push_back(*next);
        for (const SampleRect& rect : edits_.rects)
            if (const ClipRect there = verticesBy(rect, level).cutTo(updates_.valid()[std::size_t(level)]); !there.isEmpty())
                allUpdates_.push_back({level, there});
    }
    edits_ = {};
    return allUpdates_;
}

const Clipmap::Frame& Clipmap::select(const SampleGrid& grid, const BoxPyramid& boxes, const ClipmapErrors* errors,
                                      const View& view, const ClipmapSettings& settings) {
    const ProfileScope scope("clipmap: select");
    const ScreenSpace space(view, grid.localFromFrame(), grid.isRegular() ? ErrorDirection::Vertical : ErrorDirection::Any);
    const Eye eye = eyeOf(grid, boxes, view);
    frame_.viewer = layout_.viewerUnits(eye.sample);
    const Choice choice = choose(grid, boxes, errors, space, eye, frame_.viewer, settings);
    frame_.finest = choice.finest;
    frame_.leastBlend = choice.leastBlend;
    const std::int64_t all = std::int64_t(layout_.size()) * layout_.size();
    const std::int64_t budget = first_ ? 0 : settings.updateBudget > 0 ? settings.updateBudget : all;
    first_ = false;
    frame_.updates = withEdits(updates_.follow(frame_.viewer, frame_.finest, budget));
    frame_.active = activeRegions(layout_, updates_.valid(), frame_.finest, frame_.viewer);
    frame_.report = {};
    cover(boxes, space, settings);
    frame_.report.levels = std::uint32_t(layout_.levels() - frame_.finest);
    frame_.report.converged = updates_.isComplete();
    frame_.report.errorPixels = errors ? boundError(grid, boxes, *errors, space, frame_.viewer, frame_.active, choice) : kInfinite;
    return frame_;
}

float Clipmap::errorOf(const SampleGrid& grid, const BoxPyramid& boxes, const ClipmapErrors& errors, const View& view,
                       const ClipmapSettings& settings) const {
    const ScreenSpace space(view, grid.localFromFrame(), grid.isRegular() ? ErrorDirection::Vertical : ErrorDirection::Any);
    const Eye eye = eyeOf(grid, boxes, view);
    const glm::dvec2 viewer = layout_.viewerUnits(eye.sample);
    const Choice choice = choose(grid, boxes, &errors, space, eye, viewer, settings);
    std::vector<ClipRect> valid;
    for (int level = 0; level < layout_.levels(); ++level) valid.push_back(layout_.domain(level));
    return boundError(grid, boxes, errors, space, viewer, activeRegions(layout_, valid, choice.finest, viewer), choice);
}

void Clipmap::forget() {
    updates_.forget();
    first_ = true;
}

std::size_t Clipmap::bytes() const {
    std::size_t total = sizeof *this;
    for (const auto& list : frame_.patches.by) total += list.capacity() * sizeof(ClipmapPatch);
    return total;
}

int smallestClipmap(const SampleGrid& grid, const BoxPyramid& boxes, const ClipmapErrors* errors, const View& view,
                    const ClipmapShape& shape, const ClipmapSettings& settings, int now) {
    if (!errors) return now > 0 ? now : ClipmapShape::kLargest / 4;
    // Another size is another clipmap, all of which is to be made: a smaller one has to last for a while.
    constexpr float kLasting = 0.8f;
    ClipmapShape candidate = shape;
    candidate.size = ClipmapShape::kSmallest;
    while (candidate.size < ClipmapShape::kLargest) {
        const float wanted = candidate.size < now ? kLasting * settings.pixelError : settings.pixelError;
        const Clipmap clipmap(ClipmapLayout(grid.columns(), grid.rows(), candidate));
        if (clipmap.errorOf(grid, boxes, *errors, view, settings) <= wanted) break;
        candidate.size = 2 * candidate.size + 1;
    }
    return candidate.size;
}

}  // namespace terrain
