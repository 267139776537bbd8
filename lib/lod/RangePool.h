// Ranges of numbers for the vertices of tiles in one pool.
#pragma once

#include <cstdint>
#include <iterator>
#include <map>

namespace terrain {

/// First-fit allocation of ranges; freed neighbours grow together.
class RangePool {
public:
    /// First number of a range of `count` that are not in use.
    std::uint32_t allocate(std::uint32_t count) {
        for (auto range = free_.begin(); range != free_.end(); ++range)
            if (range->second >= count) {
                const std::uint32_t first = range->first, rest = range->second - count;
                free_.erase(range);
                if (rest > 0) free_.emplace(first + count, rest);
                return first;
            }
        const std::uint32_t first = end_;
        end_ += count;
        return first;
    }

    void release(std::uint32_t first, std::uint32_t count) {
        auto range = free_.emplace(first, count).first;
        if (const auto next = std::next(range); next != free_.end() && next->first == first + count) {
            range->second += next->second;
            free_.erase(next);
        }
        if (range != free_.begin())
            if (const auto before = std::prev(range); before->first + before->second == first) {
                before->second += range->second;
                free_.erase(range);
                range = before;
            }
        if (range->first + range->second == end_) {
            end_ = range->first;
            free_.erase(range);
        }
    }

    /// One beyond the largest number in use.
    std::uint32_t end() const { return end_; }

private:
    std::map<std::uint32_t, std::uint32_t> free_;  ///< count by first
    std::uint32_t end_ = 0;
};

}  // namespace terrain
