#include "lod/TileFactory.h"

#include <algorithm>

namespace terrain {

std::shared_ptr<const TileMesh> TileFactory::find(const TileId& id) {
    const std::lock_guard lock(mutex_);
    const auto found = tiles_.find(id);
    return found == tiles_.end() ? nullptr : found->second.lock();
}

std::shared_ptr<const TileMesh> TileFactory::takeWaiting(const TileId& id) {
    const std::lock_guard lock(mutex_);
    const auto found = std::find_if(waiting_.begin(), waiting_.end(), [&](const auto& tile) { return tile->id == id; });
    if (found == waiting_.end()) return nullptr;
    const auto tile = *found;
    waiting_.erase(found);
    return tile;
}

std::shared_ptr<const TileMesh> TileFactory::build(const TileId& id) {
    if (const auto tile = takeWaiting(id)) return tile;
    std::shared_ptr<const TileMesh> parent;
    if (id.level < tree_.rootLevel()) {
        parent = find(id.parent());
        if (!parent) parent = build(id.parent());
    }
    const TilePair built = buildTile(*samples_, tree_, id, parent.get());
    const std::lock_guard lock(mutex_);
    tiles_[id] = built.tile;
    if (built.child) {
        tiles_[built.child->id] = built.child;
        waiting_.push_back(built.child);
        if (waiting_.size() > kMostWaiting) waiting_.pop_front();
    }
    return built.tile;
}

}  // namespace terrain
