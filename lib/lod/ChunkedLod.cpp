#include "lod/ChunkedLod.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "base/ProfileScope.h"

namespace terrain {

namespace {

/// Tiles are asked for before they are needed: at this part of the pixel error, and within so much more than the window's width.
constexpr float kEarly = 0.6f;
constexpr double kMargin = 0.25;
constexpr std::size_t kUnlimited = std::numeric_limits<std::size_t>::max();

std::shared_ptr<const TileMesh> buildByKey(const std::shared_ptr<TileFactory>& factory, const TileKey& key) {
    return factory->build({key.level, key.column, key.row});
}

}  // namespace

ChunkedLod::ChunkedLod(const TerrainModel& model, const SampleGrid& grid, int tileCells, std::shared_ptr<const void> owner,
                       std::shared_ptr<TaskRunner> runner)
    : model_(model), tree_{grid.columns(), grid.rows(), tileCells},
      samples_(std::make_shared<TileSamples>(grid, *model.boxes, std::move(owner), model.gate)),
      factory_(std::make_shared<TileFactory>(samples_, tree_)),
      cache_(std::move(runner), [factory = factory_](const TileKey& key) { return buildByKey(factory, key); }) {}

Box ChunkedLod::boxOf(const TileId& id) const {
    const glm::ivec2 first = tree_.firstSample(id), last = first + tree_.extent(id.level);
    return terrain::boxOf(model_.boxes->bounds(first.x, first.y, last.x, last.y));
}

DrawList ChunkedLod::select(const SampleGrid& grid, const View& view, const LodSettings& settings) {
    const bool wasEdited = std::exchange(wasEdited_, false);
    const bool asBefore = !isFirst_ && !wasEdited && view == view_ && settings == settings_;
    const bool atRest = asBefore && report_.converged;
    const SelectionReport last = report_;
    report_ = SelectionReport{};
    newVertices_.clear();
    positionsChanged_ = false;
    placedBytes_ = 0;
    bool indicesChanged = false;
    if (atRest) {
        report_ = last;
    } else {
        const bool turned = settings.clockwise != settings_.clockwise;
        view_ = view;
        settings_ = settings;
        space_.emplace(view, grid.localFromFrame(), grid.isRegular() ? ErrorDirection::Vertical : ErrorDirection::Any);
        View wide = view;
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 2; ++row) wide.clipFromLocal[column][row] /= 1.0 + kMargin;
        wide_.emplace(wide, grid.localFromFrame(), ErrorDirection::Vertical);
        choose();
        place(grid);
        const auto isSame = [](const Tile& a, const Tile& b) { return a.id == b.id && a.base == b.base; };
        indicesChanged = turned || wasEdited || !std::equal(drawn_.begin(), drawn_.end(), drawnBefore_.begin(), drawnBefore_.end(), isSame);
        if (indicesChanged) writeIndices();
        report_.triangles = std::uint32_t(indices_.size() / 3);
        report_.patches = drawnTiles();
        // Where budgets allow no more, another selection would give the same.
        if (asBefore && isSettled_ && !indicesChanged && placedBytes_ == 0) report_.converged = true;
    }
    isFirst_ = false;
    reportTiles();
    DrawList list;
    list.positions = positions_;
    list.samples = samplesOf_;
    list.indices = indices_;
    list.newVertices = newVertices_;
    list.positionsChanged = positionsChanged_;
    list.indicesChanged = indicesChanged;
    list.report = report_;
    return list;
}

// Tiles come between selections, so that even one which chooses nothing has some to tell of.
void ChunkedLod::reportTiles() {
    const double milliseconds = cache_.buildMilliseconds();
    report_.buildMilliseconds = milliseconds - toldMilliseconds_;
    toldMilliseconds_ = milliseconds;
    // What may be in view soon is not missing.
    report_.pending = report_.converged ? 0 : std::uint32_t(cache_.pending() + cache_.inFlight());
}

bool ChunkedLod::update(const SampleGrid& grid, const GridEdits& edits) {
    const ProfileScope scope("chunked: edit");
    wasEdited_ = hasEdits_ = true;
    samples_->update(grid, *model_.boxes, edits);
    updateTiles(edits);
    // Normals look one sample around.
    const GridEdits around = edits.widened(1);
    for (auto& [id, slot] : slots_) slot.isOld = slot.isOld || around.touches(tree_.samplesOf(id));
    return true;
}

void ChunkedLod::updateTiles(const GridEdits& edits) {
    const auto isTouched = [&](const TileKey& key) { return edits.touches(tree_.samplesOf({key.level, key.column, key.row})); };
    factory_->forget(edits);
    cache_.forget(isTouched);
    std::vector<TileKey> touched = cache_.residentKeys();
    std::erase_if(touched, [&](const TileKey& key) { return !isTouched(key); });
    // Parents first: a tile refines its parent.
    std::sort(touched.begin(), touched.end(), [](const TileKey& a, const TileKey& b) { return a.level > b.level; });
    for (const TileKey& key : touched) {
        const TileId id{key.level, key.column, key.row};
        const bool isRoot = id.level == tree_.rootLevel();
        if (!isRoot && !cache_.contains(keyOf(id.parent()))) {
            cache_.remove(key);
            continue;
        }
        std::shared_ptr<const TileMesh> mesh;
        if (!edits.holes && tree_.extent(id.level) > kAtOnce) {
            mesh = changedTile(*samples_, cache_.at(key), edits);
            factory_->keep(mesh);
        } else {
            mesh = factory_->build(id);
        }
        cache_.replace(key, std::move(mesh));
    }
}

void ChunkedLod::choose() {
    const ProfileScope scope("chunked: choose tiles");
    std::swap(drawn_, drawnBefore_);
    for (;;) {
        chooseOnce();
        if (!settings_.complete || report_.converged || isSettled_) return;
        cache_.wait();
    }
}

void ChunkedLod::chooseOnce() {
    cache_.setBudget(settings_.memoryBudget);
    // Takes in what was built since the last frame, so that it serves this one.
    cache_.endFrame();
    cache_.beginFrame();
    mayExceed_ = false;
    chooseTiles();
    // What exceeds the budget by itself comes in a frame of its own, or it would never come.
    if (wasTooMuch_ && credit_ == settings_.uploadBudget) {
        mayExceed_ = true;
        chooseTiles();
    }
    // What comes only now was not there to be chosen.
    const std::size_t seen = cache_.arrived();
    cache_.endFrame();
    isSettled_ = cache_.isIdle() && cache_.arrived() == seen;
}

void ChunkedLod::chooseTiles() {
    report_ = SelectionReport{};
    drawn_.clear();
    wasTooMuch_ = false;
    credit_ = settings_.uploadBudget > 0 && !settings_.complete ? settings_.uploadBudget : kUnlimited;
    const TileId root{tree_.rootLevel(), 0, 0};
    if (!cache_.buildNow(keyOf(root)) || visit(root, 0.0f)) return;
    // Whatever the budget, something is drawn.
    credit_ = kUnlimited;
    draw(root, *cache_.find(keyOf(root)), boxOf(root), 0.0f);
    report_.converged = false;
}

bool ChunkedLod::visit(const TileId& id, float parentPixels) {
    const Box box = boxOf(id);
    const bool isOutside = space_->isOutside(box);
    if (isOutside && settings_.cull) {
        prefetch(id, parentPixels);
        return true;
    }
    const TileMesh& mesh = *cache_.find(keyOf(id));
    // Full detail is asked for everywhere, not only where it shows.
    const float outside = settings_.pixelError > 0.0f ? 0.0f : mesh.error;
    const float pixels = isOutside ? outside : space_->screenError(mesh.error, box);
    const bool isLeaf = id.level <= tree_.leafLevel();
    if (pixels > settings_.pixelError && !isLeaf) {
        if (areChildrenReady(id, pixels) && visitChildren(id, pixels)) return true;
        report_.converged = false;
    } else if (!isLeaf) {
        prefetchChildren(id, pixels);
    }
    if (draw(id, mesh, box, parentPixels)) return true;
    // Not on screen yet, and too much to send now: what is there may be finer.
    report_.converged = false;
    return !isLeaf && pixels <= settings_.pixelError && areChildrenReady(id, 0.0f) && visitChildren(id, pixels);
}

bool ChunkedLod::areChildrenReady(const TileId& id, float pixels) {
    bool ready = true;
    for (int i = 0; i < (id.hasFourChildren() ? 4 : 1); ++i) {
        const TileId child = id.child(i);
        if (!tree_.contains(child) || (settings_.cull && space_->isOutside(boxOf(child))) || cache_.find(keyOf(child))) continue;
        if (pixels > 0.0f) cache_.request(keyOf(child), pixels);
        ready = false;
    }
    return ready;
}

void ChunkedLod::prefetchChildren(const TileId& id, float pixels) {
    if (settings_.complete || pixels <= kEarly * settings_.pixelError || id.level <= tree_.leafLevel()) return;
    for (int i = 0; i < (id.hasFourChildren() ? 4 : 1); ++i)
        if (tree_.contains(id.child(i))) prefetch(id.child(i), pixels);
}

void ChunkedLod::prefetch(const TileId& id, float parentPixels) {
    const Box box = boxOf(id);
    if (settings_.complete || wide_->isOutside(box)) return;
    if (const TileMesh* mesh = cache_.find(keyOf(id)))
        prefetchChildren(id, space_->screenError(mesh->error, box));
    else
        // After whatever is needed now.
        cache_.request(keyOf(id), 1e-3 * std::min(parentPixels, 1e3f));
}

bool ChunkedLod::visitChildren(const TileId& id, float pixels) {
    const std::size_t drawnSoFar = drawn_.size(), creditSoFar = credit_;
    const float error = report_.errorPixels;
    for (int i = 0; i < (id.hasFourChildren() ? 4 : 1); ++i) {
        const TileId child = id.child(i);
        if (!tree_.contains(child) || visit(child, pixels)) continue;
        drawn_.resize(drawnSoFar);
        credit_ = creditSoFar;
        report_.errorPixels = error;
        // What lies further below may have taken all that there was.
        return drawChildren(id, pixels);
    }
    return true;
}

/// The children themselves, without any of theirs.
bool ChunkedLod::drawChildren(const TileId& id, float pixels) {
    report_.converged = false;
    std::vector<std::pair<TileId, Box>> children;
    std::size_t bytes = 0;
    for (int i = 0; i < (id.hasFourChildren() ? 4 : 1); ++i) {
        const TileId child = id.child(i);
        if (!tree_.contains(child)) continue;
        const Box box = boxOf(child);
        if (settings_.cull && space_->isOutside(box)) continue;
        children.emplace_back(child, box);
        if (!slots_.contains(child)) bytes += vertexBytes(*cache_.find(keyOf(child)));
    }
    // The children of what is on screen need nothing else to come with them.
    const bool exceeds = mayExceed_ && bytes > credit_ && slots_.contains(id);
    if (bytes > credit_ && !exceeds) return false;
    if (exceeds) {
        mayExceed_ = false;
        credit_ = bytes;
    }
    for (const auto& [child, box] : children) draw(child, *cache_.find(keyOf(child)), box, pixels);
    return true;
}

float ChunkedLod::parentShare(const TileMesh& mesh, float parentPixels) {
    // A parent that has been edited elsewhere is not what the tile was made from.
    if (hasEdits_ && mesh.id.level < tree_.rootLevel()) {
        const TileMesh* parent = cache_.find(keyOf(mesh.id.parent()));
        if (!parent || parent->error != mesh.parentError) return 0.0f;
    }
    if (!settings_.geomorph || mesh.fall.empty() || !(mesh.parentError > 0.0f) || !std::isfinite(parentPixels)) return 0.0f;
    if (parentPixels <= settings_.pixelError) return 1.0f;
    const double ratio = double(mesh.error) / double(mesh.parentError);
    // A mesh no better than its parent's keeps the same error however it morphs.
    const double gain = ratio < 1.0 ? 1.0 - ratio : 0.25;
    // A little less than the pixel error, so that rounding does not exceed it.
    constexpr double kWithin = 1.0 - 1e-5;
    return float(std::max(0.0, 1.0 - (1.0 - kWithin * double(settings_.pixelError) / double(parentPixels)) / gain));
}

bool ChunkedLod::draw(const TileId& id, const TileMesh& mesh, const Box& box, float parentPixels) {
    const auto slot = slots_.find(id);
    if (slot == slots_.end()) {
        if (vertexBytes(mesh) > credit_) {
            wasTooMuch_ = true;
            return false;
        }
        credit_ -= vertexBytes(mesh);
    }
    const float share = parentShare(mesh, parentPixels);
    const float error = share > 0.0f ? mesh.error * (1.0f - share) + mesh.parentError * share : mesh.error;
    if (!space_->isOutside(box)) report_.errorPixels = std::max(report_.errorPixels, space_->screenError(error, box));
    drawn_.push_back({id, &mesh, share, 0, mesh.error, std::uint32_t(mesh.indices.size())});
    return true;
}

void ChunkedLod::place(const SampleGrid& grid) {
    const ProfileScope scope("chunked: place vertices");
    for (auto& [id, slot] : slots_) slot.isDrawn = false;
    for (const Tile& tile : drawn_)
        if (const auto slot = slots_.find(tile.id); slot != slots_.end()) slot->second.isDrawn = true;
    std::erase_if(slots_, [this](const auto& entry) {
        if (!entry.second.isDrawn) pool_.release(entry.second.base, entry.second.count);
        return !entry.second.isDrawn;
    });
    for (Tile& tile : drawn_) {
        auto [slot, isNew] = slots_.try_emplace(tile.id);
        if (slot->second.isOld) {
            pool_.release(slot->second.base, slot->second.count);
            slot->second = Slot{0, 0, -1.0f, true, false};
            isNew = true;
        }
        if (isNew) {
            slot->second.count = std::uint32_t(tile.mesh->at.size());
            slot->second.base = pool_.allocate(slot->second.count);
            placedBytes_ += vertexBytes(*tile.mesh);
        }
        tile.base = slot->second.base;
    }
    positions_.resize(pool_.end());
    targets_.resize(pool_.end());
    samplesOf_.resize(pool_.end());
    for (Tile& tile : drawn_) writePositions(grid, tile, slots_.at(tile.id));
}

void ChunkedLod::writePositions(const SampleGrid& grid, Tile& tile, Slot& slot) {
    const TileMesh& mesh = *tile.mesh;
    if (slot.parentShare == tile.parentShare) return;
    const bool isNew = slot.parentShare < 0.0f;
    slot.parentShare = tile.parentShare;
    positionsChanged_ = true;
    if (isNew)
        for (std::uint32_t i = 0; i < slot.count; ++i) {
            const glm::ivec2 at = mesh.at[i];
            targets_[slot.base + i] = grid.position(at.x, at.y);
            samplesOf_[slot.base + i] = std::uint32_t(grid.index(at.x, at.y));
            newVertices_.push_back(slot.base + i);
        }
    if (tile.parentShare == 0.0f) {
        std::copy_n(targets_.begin() + slot.base, slot.count, positions_.begin() + slot.base);
        return;
    }
    const glm::vec3 up(grid.localFromFrame()[2]);
    for (std::uint32_t i = 0; i < slot.count; ++i) {
        const glm::vec3 fall = grid.isRegular() ? up * mesh.fall[i].z : mesh.fall[i];
        positions_[slot.base + i] = targets_[slot.base + i] + fall * tile.parentShare;
    }
}

void ChunkedLod::writeIndices() {
    const ProfileScope scope("chunked: write indices");
    indices_.clear();
    for (const Tile& tile : drawn_) {
        const std::vector<std::uint16_t>& own = tile.mesh->indices;
        const std::size_t before = indices_.size();
        indices_.resize(before + own.size());
        std::uint32_t* out = indices_.data() + before;
        for (std::size_t i = 0; i < own.size(); ++i) out[i] = own[i] + tile.base;
        if (settings_.clockwise)
            for (std::size_t i = 0; i + 2 < own.size(); i += 3) std::swap(out[i + 1], out[i + 2]);
    }
    writeWalls();
}

std::vector<ChunkedLod::BorderLine> ChunkedLod::borderLines() const {
    std::vector<BorderLine> lines;
    lines.reserve(drawn_.size() * 4);
    for (std::size_t tile = 0; tile < drawn_.size(); ++tile) {
        const TileId& id = drawn_[tile].id;
        const glm::ivec2 first = tree_.firstSample(id), last = first + tree_.extent(id.level);
        // A tile lies to the left of its lowest row as one goes along it, and so on.
        lines.push_back({false, first.y, false, first.x, last.x, tile, 0});
        lines.push_back({true, last.x, false, first.y, last.y, tile, 1});
        lines.push_back({false, last.y, true, first.x, last.x, tile, 2});
        lines.push_back({true, first.x, true, first.y, last.y, tile, 3});
    }
    std::sort(lines.begin(), lines.end(), [](const BorderLine& a, const BorderLine& b) {
        return std::tie(a.alongRows, a.line, a.first, b.last) < std::tie(b.alongRows, b.line, b.first, a.last);
    });
    return lines;
}

void ChunkedLod::appendVertices(const BorderLine& line, std::vector<BorderVertex>& out) const {
    const Tile& tile = drawn_[line.tile];
    const std::vector<std::uint16_t>& border = tile.mesh->border[line.side];
    // Borders run counter-clockwise around a tile: against the increasing place on two sides.
    for (std::size_t i = 0; i < border.size(); ++i) {
        const std::uint16_t vertex = border[line.side < 2 ? i : border.size() - 1 - i];
        const glm::ivec2 at = tile.mesh->at[vertex];
        out.push_back({line.alongRows ? at.y : at.x, tile.base + vertex});
    }
}

void ChunkedLod::writeWalls() {
    const std::vector<BorderLine> lines = borderLines();
    // The longest that begins at a place comes first: with all that lies along it on the other side it makes one wall.
    for (std::size_t i = 0; i < lines.size();) {
        const BorderLine& longest = lines[i];
        rightLine_.clear();
        leftLine_.clear();
        std::size_t j = i;
        for (; j < lines.size() && lines[j].alongRows == longest.alongRows && lines[j].line == longest.line &&
               lines[j].last <= longest.last;
             ++j)
            appendVertices(lines[j], lines[j].isRight ? rightLine_ : leftLine_);
        appendWall(rightLine_, leftLine_, settings_.clockwise, indices_);
        i = j;
    }
}

std::size_t ChunkedLod::bytes() const {
    const auto held = [](const auto& items) { return items.capacity() * sizeof(items[0]); };
    return samples_->bytes() + cache_.residentBytes() + held(positions_) + held(targets_) + held(samplesOf_) + held(newVertices_) +
           held(indices_) + held(drawn_) + held(drawnBefore_);
}

}  // namespace terrain
