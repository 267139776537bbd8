// What of each level of a clipmap is there, and how it follows the viewer.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lod/ClipmapLayout.h"

namespace terrain {

/// Keeps, for each level, the rectangle of vertices that are in store (the clip region of Losasso and Hoppe 2004, sect. 4), cut to
/// the grid, and says what to add when the viewer has moved: the newly exposed strips, up to four for a level, none twice. Levels
/// are served from coarse to fine, until the budget is used up; what is then missing is added in later frames, and is not drawn
/// until it is there.
class ClipmapUpdates {
public:
    struct Update {
        int level = 0;
        ClipRect rect;
    };

    explicit ClipmapUpdates(const ClipmapLayout& layout) : layout_(layout), valid_(std::size_t(layout.levels())) {}

    /// Levels from the coarsest to `finest`, with at most `budget` vertices (0: no limit). Valid until the next call.
    std::span<const Update> follow(glm::dvec2 viewer, int finest, std::int64_t budget);
    /// What is in store of each level, in its domain.
    std::span<const ClipRect> valid() const { return valid_; }
    /// Whether every level that was asked for is all there.
    bool isComplete() const { return complete_; }
    void forget() { valid_.assign(valid_.size(), {}); }

private:
    ClipRect wanted(int level, glm::dvec2 viewer) const;
    void extend(int level, const ClipRect& to, std::int64_t& left);
    void add(int level, const ClipRect& rect, std::int64_t& left);

    ClipmapLayout layout_;
    std::vector<ClipRect> valid_;
    std::vector<Update> updates_;
    glm::ivec2 centre_{0};
    bool complete_ = false;
};

}  // namespace terrain
