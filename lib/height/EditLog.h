// What of a grid has changed since somebody last looked.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "height/SampleRect.h"

namespace terrain {

/// Changed samples of a grid.
struct GridEdits {
    std::vector<SampleRect> rects;  ///< may overlap
    bool holes = false;             ///< some became holes, or were holes and are none any more

    bool isEmpty() const { return rects.empty(); }
    /// A rectangle more; one that nearly is one with another is joined to it.
    void add(const SampleRect& rect);
    bool touches(const SampleRect& rect) const;
    bool contains(glm::ivec2 sample) const;
    /// The same with rectangles larger by some samples on all sides.
    GridEdits widened(int by) const;
    /// Those within a part of the grid, counted from its first sample.
    GridEdits within(const SampleRect& part) const;
    /// Both; rectangles that are too many to be gone over one by one become one.
    void include(const GridEdits& other);
};

/// The latest edits of a grid, by number. Whoever keeps something that depends on samples keeps the version that it is of, and asks
/// what has changed since.
class EditLog {
public:
    std::uint64_t version() const { return version_; }
    void add(const GridEdits& edits);
    /// Nothing where that is too long ago to be told: all may have changed.
    std::optional<GridEdits> since(std::uint64_t version) const;

private:
    static constexpr std::size_t kKept = 256;
    std::uint64_t version_ = 0;
    std::deque<GridEdits> edits_;  ///< the last of them leads to version_
};

}  // namespace terrain
