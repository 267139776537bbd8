#include "lod/TileFactory.h"

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
    return mesh;
}

}  // namespace terrain
