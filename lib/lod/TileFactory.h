// Builds tiles with their parents at hand, in any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>

#include "lod/TileMesh.h"

namespace terrain {

/// A tile's mesh refines its parent's, so parents come first: one that is gone is built again, with the same result.
class TileFactory {
public:
    TileFactory(std::shared_ptr<const TileSamples> samples, const TileTree& tree) : samples_(std::move(samples)), tree_(tree) {}

    std::shared_ptr<const TileMesh> build(const TileId& id);
    /// Tiles with changed samples in them are not parents any more.
    void forget(const GridEdits& edits);
    /// A tile that was made otherwise is the parent of those built from now on.
    void keep(const std::shared_ptr<const TileMesh>& mesh);
    const TileTree& tree() const { return tree_; }

private:
    std::shared_ptr<const TileMesh> find(const TileId& id);
    std::uint64_t editsSoFar();

    const std::shared_ptr<const TileSamples> samples_;
    const TileTree tree_;
    std::mutex mutex_;
    std::map<TileId, std::weak_ptr<const TileMesh>> tiles_;
    std::uint64_t edits_ = 0;  ///< what was begun before the last of them may be of samples that were there before
    std::size_t kept_ = 512;   ///< of tiles_, after those that are gone were last removed
};

}  // namespace terrain
