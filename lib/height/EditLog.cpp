#include "height/EditLog.h"

#include <algorithm>

namespace terrain {

void GridEdits::add(const SampleRect& rect) {
    if (rect.isEmpty()) return;
    for (SampleRect& other : rects) {
        const SampleRect both = other.united(rect);
        if (both.samples() > other.samples() + rect.samples()) continue;
        other = both;
        return;
    }
    rects.push_back(rect);
}

bool GridEdits::touches(const SampleRect& rect) const {
    return std::any_of(rects.begin(), rects.end(), [&](const SampleRect& r) { return r.touches(rect); });
}

bool GridEdits::contains(glm::ivec2 sample) const {
    return std::any_of(rects.begin(), rects.end(), [&](const SampleRect& r) { return r.contains(sample); });
}

GridEdits GridEdits::widened(int by) const {
    GridEdits wider = *this;
    for (SampleRect& rect : wider.rects) rect = rect.widened(by);
    return wider;
}

GridEdits GridEdits::within(const SampleRect& part) const {
    GridEdits inside;
    inside.holes = holes;
    for (const SampleRect& rect : rects) {
        const SampleRect cut = rect.cutTo(part);
        if (!cut.isEmpty()) inside.rects.push_back({cut.low - part.low, cut.high - part.low});
    }
    return inside;
}

void GridEdits::include(const GridEdits& other) {
    constexpr std::size_t kMost = 32;
    holes = holes || other.holes;
    for (const SampleRect& rect : other.rects) add(rect);
    if (rects.size() <= kMost) return;
    SampleRect all = rects.front();
    for (const SampleRect& rect : rects) all = all.united(rect);
    rects = {all};
}

void EditLog::add(const GridEdits& edits) {
    edits_.push_back(edits);
    ++version_;
    if (edits_.size() > kKept) edits_.pop_front();
}

std::optional<GridEdits> EditLog::since(std::uint64_t version) const {
    if (version > version_ || version_ - version > edits_.size()) return std::nullopt;
    GridEdits all;
    for (auto i = edits_.size() - std::size_t(version_ - version); i < edits_.size(); ++i) all.include(edits_[i]);
    return all;
}

}  // namespace terrain
