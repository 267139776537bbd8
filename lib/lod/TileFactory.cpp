#include "lod/TileFactory.h"

#include <algorithm>

namespace terrain {

std::shared_ptr<const TileMesh> TileFactory::find(const TileId& id) {
    const std::lock_guard lock(mutex_);
    const auto found = tiles_.find(id);
    return found == tiles_.end() ? nullptr : found->second.lock();
}

std::shared_ptr<const TileMesh> TileFactory::build(const TileId& id) {
    std::shared_ptr<const TileMesh> parent;
    if (id.level < tree_.rootLevel()) {
        parent = find(id.parent());
        if (!parent) parent = build(id.parent());
    }
    auto mesh = buildTile(*samples_, tree_, id, parent.get());
    const std::lock_guard lock(mutex_);
    tiles_[id] = mesh;
    if (tiles_.size() > 2 * kept_) {
        std::erase_if(tiles_, [](const auto& entry) { return entry.second.expired(); });
        kept_ = std::max(kept_, tiles_.size());
    }
    return mesh;
}

}  // namespace terrain
