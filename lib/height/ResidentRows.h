// Bounds what a walk over the rows of a map in scratch space keeps in memory.
#pragma once

#include <algorithm>
#include <cstddef>

#include "height/HeightStorage.h"

namespace terrain {

/// Told of each row that samples are read from, it releases the map's pages whenever those of the rows since the last time may be
/// more than kBytes. For walks that come back to a few rows again and again, or that go over all of them. One for each thread; does
/// nothing for samples in memory.
class ResidentRows {
public:
    static constexpr std::size_t kBytes = std::size_t(64) << 20;

    ResidentRows() = default;
    /// `pitch`: samples of a row. `storage`: null, or what outlives this.
    ResidentRows(const HeightStorage* storage, std::size_t pitch)
        : storage_(storage && storage->isMapped() ? storage : nullptr), rowBytes_(pitch * sizeof(float)) {}

    void visit(int row) {
        if (storage_) count(row);
    }

private:
    void count(int row) {
        // The system maps so many bytes around one that is asked for.
        constexpr std::size_t kAround = std::size_t(64) << 10;
        lowest_ = std::min(lowest_, row);
        highest_ = std::max(highest_, row);
        if (++visits_ * kAround < kBytes || std::size_t(highest_ - lowest_) * rowBytes_ < kBytes) return;
        storage_->releasePages(0, storage_->size());
        lowest_ = highest_ = row;
        visits_ = 0;
    }

    const HeightStorage* storage_ = nullptr;
    std::size_t rowBytes_ = 0;
    std::size_t visits_ = 0;
    int lowest_ = 0, highest_ = 0;
};

}  // namespace terrain
