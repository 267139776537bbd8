#include "lod/TileMesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "lod/DiamondTopology.h"
#include "lod/TileDeviation.h"

namespace terrain {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::uint16_t kNoPlace = 0xffff;
/// Error of a tile relative to its parent's. Larger: more levels and tiles; smaller: more triangles, because errors fit distances
/// less closely.
constexpr float kFiner = 0.75f;
/// Where the stride allows no smaller error than so much of the parent's, a tile is a copy of that part of its parent: between them
/// it could not morph before its own children take its place.
constexpr float kLeastGain = 0.95f;
/// Error of the root's mesh, as far as its stride allows, relative to the range of heights.
constexpr float kRootError = 0.125f;

/// Where the points of a tile's lattice lie. Those beyond the grid are moved onto its last column or row, so that triangles end
/// there.
class Lattice {
public:
    Lattice(const TileTree& tree, const TileId& id)
        : cells(tree.extent(id.level) / tree.stride(id.level)), stride(tree.stride(id.level)),
          first(glm::ivec2(id.column, id.row) * cells), last_(tree.columns - 1, tree.rows - 1) {}

    glm::ivec2 sampleAt(glm::ivec2 p) const { return glm::min((first + p) * stride, last_); }
    bool contains(glm::ivec2 p) const { return p.x >= 0 && p.y >= 0 && p.x <= cells && p.y <= cells; }
    std::size_t place(glm::ivec2 p) const { return std::size_t(p.y) * std::size_t(cells + 1) + std::size_t(p.x); }
    std::size_t places() const { return std::size_t(cells + 1) * std::size_t(cells + 1); }
    bool isCut() const { return (first.x + cells) * stride > last_.x || (first.y + cells) * stride > last_.y; }
    /// A diamond of the whole plane's bisection, moved to the tile's own coordinates: only so diagonals run as the parent's do.
    DiamondShape diamond(glm::ivec2 p) const {
        DiamondShape d(first + p);
        d.centre -= first;
        for (glm::ivec2& corner : d.corner) corner -= first;
        return d;
    }
    const int cells, stride;
    const glm::ivec2 first;

private:
    glm::ivec2 last_;
};

/// Which triangles of a tile reach into holes.
class HoleMap {
public:
    enum State { Full, Empty, Mixed };

    HoleMap(const TileSamples& samples, const Lattice& lattice) : side_(lattice.cells + 1) {
        if (!samples.hasHoles()) return;
        sums_.assign(std::size_t(side_) * std::size_t(side_), glm::ivec2(0));
        ResidentRows resident = samples.residentRows();
        for (int y = 0; y < lattice.cells; ++y)
            for (int x = 0; x < lattice.cells; ++x) {
                const glm::ivec2 low = lattice.sampleAt({x, y}), high = lattice.sampleAt({x + 1, y + 1});
                glm::ivec2 count(0);
                // Whatever lies on the last column or row already belongs to the cell before.
                if (low.x < high.x && low.y < high.y)
                    for (int row = low.y; row <= high.y; ++row) {
                        resident.visit(row);
                        for (int column = low.x; column <= high.x; ++column) ++count[samples.isHole(column, row) ? 1 : 0];
                    }
                hasHoles_ |= count[1] > 0;
                at(x + 1, y + 1) = at(x + 1, y) + at(x, y + 1) - at(x, y) + count;
            }
    }

    /// Of the box around a triangle, which is the triangle's own for what is left when nothing can be split any more.
    State state(glm::ivec2 a, glm::ivec2 b, glm::ivec2 c) const {
        if (!hasHoles_) return Full;
        const glm::ivec2 low = glm::min(glm::min(a, b), c), high = glm::max(glm::max(a, b), c);
        const glm::ivec2 count = at(high.x, high.y) - at(low.x, high.y) - at(high.x, low.y) + at(low.x, low.y);
        return count[1] == 0 ? Full : count[0] == 0 ? Empty : Mixed;
    }

private:
    glm::ivec2& at(int x, int y) { return sums_[std::size_t(y) * std::size_t(side_) + std::size_t(x)]; }
    const glm::ivec2& at(int x, int y) const { return sums_[std::size_t(y) * std::size_t(side_) + std::size_t(x)]; }

    int side_;
    bool hasHoles_ = false;
    std::vector<glm::ivec2> sums_;  ///< valid and invalid samples of all cells before (x, y)
};

template <class Samples>
class TileBuilder {
public:
    TileBuilder(const TileSamples& samples, const TileTree& tree, const TileId& id, const TileMesh* parent)
        : samples_{samples}, lattice_(tree, id), above_(tree, id.parent()), holes_(samples, lattice_), parent_(parent),
          mesh_(std::make_shared<TileMesh>()) {
        mesh_->id = id;
        mesh_->latticeCells = lattice_.cells;
        if (parent) mesh_->parentError = parent->error;
        const bool isLeaf = id.level == tree.leafLevel();
        target_ = isLeaf ? 0.0f : parent ? kFiner * parent->error : kRootError * samples.range();
        build();
        if (parent && mesh_->error > kLeastGain * parent->error) {
            target_ = kInfinity;
            build();
        }
        findBorders();
        if (parent && !lattice_.isCut()) findFall();
    }

    std::shared_ptr<const TileMesh> result() const { return mesh_; }

private:
    using Value = typename Samples::Value;

    float deviation(glm::ivec2 a, glm::ivec2 b, glm::ivec2 c, float enough) const {
        switch (holes_.state(a, b, c)) {
        case HoleMap::Empty:
            return 0.0f;
        case HoleMap::Mixed:
            return kInfinity;
        default:
            return triangleDeviation(samples_, lattice_.sampleAt(a), lattice_.sampleAt(b), lattice_.sampleAt(c), enough);
        }
    }

    bool isCorner(glm::ivec2 p) const { return p.x % lattice_.cells == 0 && p.y % lattice_.cells == 0; }
    float& deviationOf(glm::ivec2 middle, int half) { return deviation_[2 * lattice_.place(middle) + std::size_t(half)]; }

    void build() {
        refine();
        vertexAt_.assign(lattice_.places(), kNoPlace);
        mesh_->at.clear();
        mesh_->indices.clear();
        mesh_->error = 0.0f;
        emitAll();
    }

    /// From the whole square down: what deviates too much is split, and so is what the parent has split, and what a split diamond
    /// hangs on. Most of what is large deviates at once, so that all samples are looked at only about once, under the triangles
    /// that stay.
    void refine() {
        mesh_->active.assign(lattice_.places(), 0);
        deviation_.assign(2 * lattice_.places(), 0.0f);
        const glm::ivec2 middle(lattice_.cells / 2);
        open_ = {{middle, 0}, {middle, 1}};
        if (parent_)
            for (int y = 0; y <= lattice_.cells; ++y)
                for (int x = 0; x <= lattice_.cells; ++x)
                    if (isActiveInParent({x, y})) activate({x, y});
        while (!open_.empty()) {
            const OpenTriangle t = open_.back();
            open_.pop_back();
            if (mesh_->active[lattice_.place(t.middle)]) continue;
            const DiamondShape d = lattice_.diamond(t.middle);
            float& worst = deviationOf(t.middle, t.half);
            worst = deviation(d.corner[0], d.corner[t.half ? 3 : 1], d.corner[2], target_);
            if (worst > target_) activate(t.middle);
        }
    }

    void activate(glm::ivec2 p) {
        if (isCorner(p) || mesh_->active[lattice_.place(p)]) return;
        mesh_->active[lattice_.place(p)] = 1;
        const DiamondShape d = lattice_.diamond(p);
        for (int half = 0; half < 2; ++half) {
            const glm::ivec2 apex = d.corner[half ? 3 : 1];
            if (!lattice_.contains(apex)) continue;
            activate(apex);
            // The two halves of this triangle, whose right angle is at p.
            for (const glm::ivec2 end : {d.corner[0], d.corner[2]}) {
                const glm::ivec2 sum = apex + end;
                if ((sum.x | sum.y) & 1) continue;
                open_.push_back({sum / 2, lattice_.diamond(sum / 2).corner[1] == p ? 0 : 1});
            }
        }
    }

    bool isActiveInParent(glm::ivec2 p) const {
        if (!parent_) return false;
        const glm::ivec2 offset = (lattice_.first + p) * lattice_.stride - above_.first * above_.stride;
        if (offset.x % above_.stride != 0 || offset.y % above_.stride != 0) return false;
        return parent_->active[above_.place(offset / above_.stride)] != 0;
    }

    void emitAll() {
        const int m = lattice_.cells;
        const DiamondShape root = lattice_.diamond(glm::ivec2(m / 2));
        emit(root.corner[0], root.corner[1], root.corner[2], root.centre);
        emit(root.corner[2], root.corner[3], root.corner[0], root.centre);
    }

    /// A triangle with its right angle at `apex` and the middle of its longest edge.
    void emit(glm::ivec2 first, glm::ivec2 apex, glm::ivec2 last, glm::ivec2 middle) {
        if (mesh_->active[lattice_.place(middle)]) {
            half(last, middle, apex);
            half(apex, middle, first);
            return;
        }
        mesh_->error = std::max(mesh_->error, deviationOf(middle, lattice_.diamond(middle).corner[1] == apex ? 0 : 1));
        put(first, apex, last);
    }

    void half(glm::ivec2 first, glm::ivec2 apex, glm::ivec2 last) {
        const glm::ivec2 sum = first + last;
        if ((sum.x | sum.y) & 1) {
            // Nothing lies between: at full resolution such triangles are exact.
            if (lattice_.stride > 1) mesh_->error = std::max(mesh_->error, deviation(first, apex, last, kInfinity));
            put(first, apex, last);
        } else {
            emit(first, apex, last, sum / 2);
        }
    }

    void put(glm::ivec2 a, glm::ivec2 b, glm::ivec2 c) {
        const glm::ivec2 pa = lattice_.sampleAt(a), pb = lattice_.sampleAt(b), pc = lattice_.sampleAt(c);
        const std::int64_t turn = crossProduct(pb - pa, pc - pa);
        if (turn == 0 || holes_.state(a, b, c) != HoleMap::Full) return;
        const std::uint16_t va = vertex(a), vb = vertex(b), vc = vertex(c);
        mesh_->indices.insert(mesh_->indices.end(), {va, turn > 0 ? vb : vc, turn > 0 ? vc : vb});
    }

    std::uint16_t vertex(glm::ivec2 p) {
        // Points beyond the grid are one with those on its border.
        const glm::ivec2 sample = lattice_.sampleAt(p);
        const glm::ivec2 onLattice = (sample + lattice_.stride - 1) / lattice_.stride - lattice_.first;
        std::uint16_t& number = vertexAt_[lattice_.place(glm::min(p, onLattice))];
        if (number == kNoPlace) {
            number = std::uint16_t(mesh_->at.size());
            mesh_->at.push_back(sample);
        }
        return number;
    }

    void findBorders() {
        const int m = lattice_.cells;
        for (int i = 0; i <= m; ++i) {
            const glm::ivec2 on[4] = {{i, 0}, {m, i}, {m - i, m}, {0, m - i}};
            for (std::size_t side = 0; side < 4; ++side)
                if (const std::uint16_t number = vertexAt_[lattice_.place(on[side])]; number != kNoPlace)
                    mesh_->border[side].push_back(number);
        }
    }

    void findFall() {
        mesh_->fall.reserve(mesh_->at.size());
        for (const glm::ivec2 sample : mesh_->at) {
            // In steps of the parent's lattice, doubled, because a vertex may lie half-way.
            const glm::ivec2 p = 2 * (sample - above_.first * above_.stride) / above_.stride;
            mesh_->fall.push_back(Samples::toFrame(parentSurface(p, sample) - samples_.at(sample)));
        }
    }

    /// The parent's surface at a sample; `p` is its place on the parent's lattice in half steps.
    Value parentSurface(glm::ivec2 p, glm::ivec2 sample) const {
        const DiamondShape root = above_.diamond(glm::ivec2(above_.cells / 2));
        const glm::ivec2 side = 2 * root.corner[2] - 2 * root.corner[0];
        const bool inFirst =
            crossProduct(side, p - 2 * root.corner[0]) * crossProduct(side, 2 * root.corner[1] - 2 * root.corner[0]) >= 0;
        glm::ivec2 first = root.corner[0], apex = root.corner[inFirst ? 1 : 3], last = root.corner[2];
        for (;;) {
            const glm::ivec2 sum = first + last;
            if ((sum.x | sum.y) & 1) break;
            const glm::ivec2 middle = sum / 2;
            if (!parent_->active[above_.place(middle)]) break;
            // On the side of `first` or of `last` of the line from the apex to the middle.
            const glm::ivec2 edge = last - first, from = p - 2 * middle;
            const bool nearFirst = edge.x * from.x + edge.y * from.y < 0;
            last = nearFirst ? first : last;
            first = apex;
            apex = middle;
        }
        const auto plane = planeThrough(samples_, above_.sampleAt(first), above_.sampleAt(apex), above_.sampleAt(last));
        const Value value = plane.at(sample);
        return Samples::length(value) < kInfinity ? value : samples_.at(sample);
    }

    Samples samples_;
    Lattice lattice_, above_;  ///< the tile's and its parent's
    HoleMap holes_;
    const TileMesh* parent_;
    std::shared_ptr<TileMesh> mesh_;
    struct OpenTriangle {
        glm::ivec2 middle;  ///< of its longest edge
        int half;           ///< of the diamond with that middle: 0 at q1, 1 at q3
    };
    float target_ = 0.0f;
    std::vector<OpenTriangle> open_;       ///< not compared with the samples yet
    std::vector<float> deviation_;         ///< by place, two halves: of triangles that were
    std::vector<std::uint16_t> vertexAt_;  ///< by place
};

}  // namespace

int TileTree::rootLevel() const {
    int level = leafLevel() + 1;
    while (extent(level) < std::max(columns, rows) - 1) level += 2;
    return level;
}

int TileTree::leafLevel() const {
    int level = 0;
    while (extent(level) > kSmallest) level -= 2;
    return level;
}

std::size_t TileMesh::bytes() const {
    std::size_t total = sizeof(TileMesh) + at.capacity() * sizeof(at[0]) + fall.capacity() * sizeof(fall[0]) +
                        indices.capacity() * sizeof(indices[0]) + active.capacity();
    for (const auto& side : border) total += side.capacity() * sizeof(side[0]);
    return total;
}

std::shared_ptr<const TileMesh> buildTile(const TileSamples& samples, const TileTree& tree, const TileId& id,
                                          const TileMesh* parent) {
    if (samples.isRegular()) return TileBuilder<HeightSamples>(samples, tree, id, parent).result();
    return TileBuilder<PointSamples>(samples, tree, id, parent).result();
}

}  // namespace terrain
