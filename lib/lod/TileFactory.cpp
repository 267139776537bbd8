#include "lod/TileFactory.h"

#include <algorithm>

namespace terrain {

std::shared_ptr<const TileMesh> TileFactory::find(const TileId& id) {
    const std::lock_guard lock(mutex_);
    const auto found = tiles_.find(id);
    return found == tiles_.end() ? nullptr : found->second.lock();
}

std::shared_ptr<const TileMesh> TileFactory::build(const TileId& id) {
    const std::uint64_t edits = editsSoFar();
    std::shared_ptr<const TileMesh> parent;
    if (id.level < tree_.rootLevel()) {
        parent = find(id.parent());
        if (!parent) parent = build(id.parent());
    }
    std::shared_ptr<const TileMesh> mesh;
    {
        const SampleGate::Reading reading(samples_->gate());
        mesh = buildTile(*samples_, tree_, id, parent.get());
    }
    const std::lock_guard lock(mutex_);
    if (edits != edits_) return mesh;
    tiles_[id] = mesh;
    if (tiles_.size() > 2 * kept_) {
        std::erase_if(tiles_, [](const auto& entry) { return entry.second.expired(); });
        kept_ = std::max(kept_, tiles_.size());
    }
    return mesh;
}

std::uint64_t TileFactory::editsSoFar() {
    const std::lock_guard lock(mutex_);
    return edits_;
}

void TileFactory::forget(const GridEdits& edits) {
    const std::lock_guard lock(mutex_);
    ++edits_;
    std::erase_if(tiles_, [&](const auto& entry) { return edits.touches(tree_.samplesOf(entry.first)); });
}

void TileFactory::keep(const std::shared_ptr<const TileMesh>& mesh) {
    const std::lock_guard lock(mutex_);
    tiles_[mesh->id] = mesh;
}

}  // namespace terrain
