// What each algorithm has drawn, part by part: see LodAlgorithm::eachPatch().
#include <algorithm>
#include <bit>
#include <map>
#include <tuple>
#include <vector>

#include <glm/common.hpp>

#include "lod/BruteForceMesh.h"
#include "lod/ChunkedLod.h"
#include "lod/ClipmapMesh.h"
#include "lod/GeoMipmapMesh.h"
#include "lod/RoamMesh.h"

namespace terrain {

namespace {

/// Of a mesh of many small triangles: those of one part that come one after the other are handed on together.
class Runs {
public:
    Runs(DrawnPatch mesh, const PatchVisitor& visit) : patch_(mesh), visit_(visit) {}
    ~Runs() { flush(); }
    Runs(const Runs&) = delete;
    Runs& operator=(const Runs&) = delete;

    void add(glm::ivec2 place, int size, std::span<const std::uint32_t> triangle) {
        if (place != patch_.place || size != patch_.size) flush();
        patch_.place = place;
        patch_.size = size;
        indices_.insert(indices_.end(), triangle.begin(), triangle.end());
    }

private:
    void flush() {
        if (indices_.empty()) return;
        patch_.indices = indices_;
        visit_(patch_);
        indices_.clear();
    }

    DrawnPatch patch_;
    const PatchVisitor& visit_;
    std::vector<std::uint32_t> indices_;
};

}  // namespace

/// One part, handed on in strips: indices of all of it may not fit into memory once more.
void BruteForceMesh::eachPatch(const SampleGrid& grid, const PatchVisitor& visit) const {
    if (!built_) return;
    DrawnPatch patch;
    patch.wholeGrid = true;
    std::vector<std::uint32_t> indices;
    for (int row = 0; row < grid.rows() - 1; ++row) {
        indices.clear();
        for (int column = 0; column < grid.columns() - 1; ++column) {
            if (isCellHole(grid, column, row)) continue;
            for (const auto& triangle : kCellTriangles)
                for (int i = 0; i < 3; ++i) {
                    const auto& corner = triangle[clockwise_ ? 2 - i : i];
                    indices.push_back(std::uint32_t(grid.index(column + corner[0], row + corner[1])));
                }
        }
        patch.indices = indices;
        if (!indices.empty()) visit(patch);
    }
}

/// The smallest square of the bisection that a triangle lies in, of those that are at least a sixteenth of the map wide.
void RoamMesh::eachPatch(const SampleGrid& grid, const PatchVisitor& visit) const {
    const int least = std::max(3, int(std::bit_width(unsigned(side_))) - 5);
    DrawnPatch mesh;
    mesh.positions = positions_;
    mesh.samples = samples_;
    Runs runs(mesh, visit);
    const std::uint32_t columns = std::uint32_t(grid.columns());
    for (std::size_t i = 0; i + 2 < indices_.size(); i += 3) {
        glm::ivec2 low(side_), high(0);
        for (std::size_t corner = i; corner < i + 3; ++corner) {
            const std::uint32_t sample = samples_[indices_[corner]];
            const glm::ivec2 at(int(sample % columns), int(sample / columns));
            low = glm::min(low, at);
            high = glm::max(high, at);
        }
        // The last row and column of a square belong to it as well.
        high = glm::max(high - 1, low);
        int size = least;
        while (low >> size != high >> size) ++size;
        runs.add(low >> size, size, {indices_.data() + i, 3});
    }
}

void GeoMipmapMesh::eachPatch(const SampleGrid&, const PatchVisitor& visit) const {
    DrawnPatch patch;
    patch.positions = vertices_.positions();
    patch.samples = vertices_.samples();
    for (const DrawnBlock& drawn : drawn_) {
        const IndexRange& range = emitted_[drawn.at.number];
        patch.place = {drawn.at.column, drawn.at.row};
        patch.indices = {indices_.data() + range.first, range.count};
        if (range.count > 0) visit(patch);
    }
}

/// A tile stands in where its error is too large and finer ones exist. Vertices that are new begin with a tile that is.
void ChunkedLod::eachPatch(const SampleGrid&, const PatchVisitor& visit) const {
    DrawnPatch patch;
    patch.positions = positions_;
    patch.samples = samplesOf_;
    std::vector<std::uint32_t> begins(newVertices_);
    std::sort(begins.begin(), begins.end());
    std::size_t first = 0;
    for (const Tile& tile : drawn_) {
        const Box box = boxOf(tile.id);
        // Tiles of the two errors of one size never lie in one place.
        patch.place = {tile.id.column, tile.id.row};
        patch.size = tile.id.level >> 1;
        patch.standsIn = tile.id.level > tree_.leafLevel() && !space_->isOutside(box) &&
                         space_->screenError(tile.error, box) > settings_.pixelError;
        patch.isNew = std::binary_search(begins.begin(), begins.end(), tile.base);
        patch.indices = {indices_.data() + first, tile.indexCount};
        first += tile.indexCount;
        visit(patch);
    }
    DrawnPatch walls;
    walls.positions = positions_;
    walls.samples = samplesOf_;
    walls.closesGaps = true;
    walls.indices = {indices_.data() + first, indices_.size() - first};
    if (!walls.indices.empty()) visit(walls);
}

/// The squares of vertices that the pool keeps. A cell stands in where the next finer level would be drawn if it was there.
void ClipmapMesh::eachPatch(const SampleGrid&, const PatchVisitor& visit) const {
    struct Key {
        int level, row, column;
        bool standsIn, isNew;
        auto operator<=>(const Key&) const = default;
    };
    std::map<Key, std::vector<std::uint32_t>> parts;
    const Clipmap::Frame& frame = clipmap_.frame();
    // Of a selection that found nothing to do the updates are those of the one before.
    const bool anyNew = !newVertices_.empty();
    std::vector<ClipRect> finer(std::size_t(layout_.levels()));
    for (int level = frame.finest + 1; level < layout_.levels(); ++level)
        finer[std::size_t(level)] = coarserRect(layout_.place(level - 1, frame.viewer).cutTo(layout_.domain(level - 1)));
    const auto isNew = [&](int level, glm::ivec2 cell) {
        return anyNew && std::any_of(frame.updates.begin(), frame.updates.end(), [&](const ClipmapUpdates::Update& update) {
                   return update.level == level && (update.rect.contains(cell) || update.rect.contains(cell + 1));
               });
    };
    const auto emitCell = [&](int level, glm::ivec2 cell) {
        const glm::ivec2 corner[4] = {cell, cell + glm::ivec2(1, 0), cell + 1, cell + glm::ivec2(0, 1)};
        if (boxes_->hasHoles() && std::any_of(corner, corner + 4, [&](glm::ivec2 v) { return isHole(level, v); })) return;
        const ClipRect& wanted = finer[std::size_t(level)];
        const Key key{level, cell.y / kChunk, cell.x / kChunk, wanted.contains(cell) && wanted.contains(cell + 1),
                      isNew(level, cell)};
        auto& out = parts[key];
        for (const auto& [a, b, c] : {std::tuple{0, 1, 3}, {1, 2, 3}}) {
            out.push_back(vertexId(level, corner[a]));
            out.push_back(vertexId(level, corner[settings_.clockwise ? c : b]));
            out.push_back(vertexId(level, corner[settings_.clockwise ? b : c]));
        }
    };
    for (int footprint = 0; footprint < int(Footprint::Seam); ++footprint)
        for (const ClipmapPatch& patch : drawn_.by[footprint])
            for (int y = patch.low.y; y < patch.high.y; ++y)
                for (int x = patch.low.x; x < patch.high.x; ++x) emitCell(patch.level, {x, y});
    DrawnPatch patch;
    patch.positions = positions_;
    patch.samples = samples_;
    patch.places = places_;
    for (const auto& [key, indices] : parts) {
        patch.place = {key.column, key.row};
        patch.size = key.level;
        patch.standsIn = key.standsIn;
        patch.isNew = key.isNew;
        patch.indices = indices;
        visit(patch);
    }
    DrawnPatch seams;
    seams.positions = positions_;
    seams.samples = samples_;
    seams.places = places_;
    seams.closesGaps = true;
    seams.indices = {indices_.data() + firstSeam_, indexCount_ - firstSeam_};
    if (!seams.indices.empty()) visit(seams);
}

}  // namespace terrain
