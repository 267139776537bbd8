#include "lod/ClipmapUpdates.h"

#include <limits>

namespace terrain {

namespace {

/// What a level can hold at most so that everything of it can be predicted from the coarser one: two of its vertices on each side,
/// but where the grid itself ends.
ClipRect predictable(const ClipmapLayout& layout, int level, const ClipRect& coarser) {
    if (coarser.isEmpty()) return {};
    const ClipRect all = layout.domain(level + 1), own = layout.domain(level);
    const auto low = [](int have, int end, int ownEnd) { return have <= end ? ownEnd : 2 * (have + 2); };
    const auto high = [](int have, int end, int ownEnd) { return have >= end ? ownEnd : 2 * (have - 2); };
    return {{low(coarser.low.x, all.low.x, own.low.x), low(coarser.low.y, all.low.y, own.low.y)},
            {high(coarser.high.x, all.high.x, own.high.x), high(coarser.high.y, all.high.y, own.high.y)}};
}

}  // namespace

ClipRect ClipmapUpdates::wanted(int level, glm::dvec2 viewer) const {
    const ClipRect rect = layout_.place(level, viewer).cutTo(layout_.domain(level));
    if (layout_.sourceLevel(level) >= 0 || level + 1 >= layout_.levels()) return rect;
    return rect.cutTo(predictable(layout_, level, valid_[std::size_t(level) + 1]));
}

void ClipmapUpdates::add(int level, const ClipRect& rect, std::int64_t& left) {
    if (rect.isEmpty()) return;
    updates_.push_back({level, rect});
    left -= rect.samples();
}

/// Adds strips to what is there of a level, as wide as the budget allows.
void ClipmapUpdates::extend(int level, const ClipRect& to, std::int64_t& left) {
    ClipRect& have = valid_[std::size_t(level)];
    const auto grow = [&](int axis, int sign) {
        const int across = axis == 0 ? have.rows() : have.columns();
        const int missing = sign < 0 ? have.low[axis] - to.low[axis] : to.high[axis] - have.high[axis];
        const int lines = int(std::min<std::int64_t>(missing, left / across));
        if (lines <= 0) return;
        ClipRect strip = have;
        if (sign < 0) {
            strip.high[axis] = have.low[axis] - 1;
            strip.low[axis] = have.low[axis] - lines;
            have.low[axis] = strip.low[axis];
        } else {
            strip.low[axis] = have.high[axis] + 1;
            strip.high[axis] = have.high[axis] + lines;
            have.high[axis] = strip.high[axis];
        }
        add(level, strip, left);
    };
    for (const int axis : {0, 1})
        for (const int sign : {-1, 1}) grow(axis, sign);
}

std::span<const ClipmapUpdates::Update> ClipmapUpdates::follow(glm::dvec2 viewer, int finest, std::int64_t budget) {
    updates_.clear();
    complete_ = true;
    std::int64_t left = budget > 0 ? budget : std::numeric_limits<std::int64_t>::max();
    for (int level = layout_.levels() - 1; level >= 0; --level) {
        ClipRect& have = valid_[std::size_t(level)];
        const ClipRect to = wanted(level, viewer);
        have = have.cutTo(to);
        if (have.isEmpty()) have = {};
        if (level < finest) continue;
        if (!have.isEmpty()) {
            extend(level, to, left);
        } else if (to.samples() <= left) {
            have = to;
            add(level, to, left);
        } else if (!to.isEmpty() && left > 0) {
            // As much of it as can be, around the viewer: one vertex to begin with.
            const glm::ivec2 middle = glm::clamp(glm::ivec2(glm::floor(layout_.viewerAt(level, viewer))), to.low, to.high);
            int reach = 0;
            const auto around = [&](int by) { return ClipRect{middle - by, middle + by}.cutTo(to); };
            while (around(reach + 1).samples() <= left) ++reach;
            have = around(reach);
            add(level, have, left);
        }
        complete_ = complete_ && have == to;
    }
    return updates_;
}

}  // namespace terrain
