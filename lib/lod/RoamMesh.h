// Real-time optimally adapting mesh: one view's triangulation, refined and coarsened from frame to frame.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/View.h"
#include "height/SampleGrid.h"
#include "lod/DiamondTable.h"
#include "lod/LodAlgorithm.h"
#include "lod/RoamBounds.h"
#include "lod/TerrainModel.h"
#include "lod/ViewMotion.h"

namespace terrain {

/// ROAM (Duchaineau, Wolinsky, Sigeti, Miller, Aldrich, Mineev-Weinstein: "ROAMing Terrain: Real-time Optimally Adapting Meshes",
/// Visualization 1997) over diamonds: a split queue of the diamonds that can be split, a merge queue of the split ones whose
/// children are not (sect. 4), forced splits for a mesh without cracks (fig. 3), frustum labels and priorities that are kept for as
/// long as the camera's motion can't have changed them (sect. 6.2 and 6.3; ViewMotion.h), a triangle budget met by splitting at the
/// top of one queue and merging at the bottom of the other (sect. 5). Priorities are screen errors (View.h) of the exact hierarchy
/// (ErrorHierarchy.h) instead of nested wedgies.
///
/// Geomorph. The vertex m of a split diamond with longest edge a-b stands at (a + b) / 2 + t (M - (A + B) / 2): capitals are the
/// true positions, small letters the drawn ones, and t goes from 0 to 1 while the diamond's screen error goes from `kMorphStart`
/// pixelError to pixelError. Where t never grows from parent to child, that surface is an average of the meshes { diamonds with t
/// >= x are split } over x in [0, 1], each of which keeps the error within pixelError, so the average does as well. morph() raises
/// the t of a parent to that of its children where the order would not hold by itself.
///
/// The mesh keeps no pointer to samples: select() is given them.
class RoamMesh : public LodAlgorithm {
public:
    static constexpr float kMorphStart = 0.9f;

    RoamMesh(const TerrainModel& model, const SampleGrid& grid);
    RoamMesh(const RoamMesh&) = delete;
    RoamMesh& operator=(const RoamMesh&) = delete;

    /// Adapts the mesh to a view. The first call refines until the view's error is met; later ones stop at the operation limit and
    /// say so. The same calls in the same order give the same results.
    DrawList select(const SampleGrid& grid, const View& view, const LodSettings& settings) override;

    /// Takes new bounds, errors and vertices where diamonds hold changed samples; what is split stays split until the next selection
    /// finds it needless. Not where holes come or go.
    bool update(const SampleGrid& grid, const GridEdits& edits) override;
    void eachPatch(const SampleGrid& grid, const PatchVisitor& visit) const override;

    /// Triangles of the whole mesh, those outside of the view included.
    std::uint32_t meshTriangles() const { return meshTriangles_; }
    std::size_t bytes() const override;

private:
    static constexpr std::uint32_t kNone = DiamondTable::kNone;

    /// A diamond that is split or could be: at least one of its parents is split. There are two for each triangle, and a frame's
    /// time goes into memory: what every frame reads of all of them is in RoamBounds, and what only split ones have in Links.
    struct Diamond {
        std::array<std::uint32_t, 2> parent{kNone, kNone};  ///< those that are split, at q1 and q3
        std::uint32_t links = kNone;                        ///< place in links_; none while not split
    };

    /// What a split diamond has beside.
    struct Links {
        std::array<std::uint32_t, 4> child{kFlatLink, kFlatLink, kFlatLink, kFlatLink};  ///< by side
        std::uint32_t vertex = kNoVertex;
        std::uint8_t splitChildren = 0;
        bool atRim = false;  ///< has one triangle only
        bool finest = false;
        std::uint8_t solidCells = 0xf;  ///< finest: bit per cell around the centre, see cellBit()
    };

    /// What a block of diamonds is at present; a bit for each.
    struct Block {
        std::uint16_t leaf = 0;       ///< in use and not split
        std::uint16_t mergeable = 0;  ///< split, with no split child
        std::uint16_t hidden = 0;     ///< leaf, outside of the view, and known as such to whoever links to it
        std::uint16_t due = 0;        ///< frame in which it must be evaluated again, modulo 2^16
    };

    /// A child by its number, with the half of it that lies at the parent and whether it is outside of the view; or, once it is
    /// split, by its place in links_: so a walk over the triangles reads nothing else.
    static constexpr std::uint32_t kSplitLink = 0x80000000u, kHiddenLink = 0x40000000u;
    /// No child, because its error is 0: drawn.
    static constexpr std::uint32_t kFlatLink = 0x3fffffffu;
    std::uint32_t leafLink(std::uint32_t number, unsigned half) const {
        return 2 * number + half + (blockOf(number).hidden & bitOf(number) ? kHiddenLink : 0u);
    }
    static std::uint32_t splitLink(std::uint32_t place, unsigned half) { return kSplitLink | (2 * place + half); }
    /// What links to `from` (half 0, hidden or not) links to `to` instead.
    void relink(std::uint32_t number, std::uint32_t from, std::uint32_t to);
    void showOrHide(std::uint32_t leaf);

    struct Vertex {
        glm::vec3 target{0.0f};                                   ///< true position
        float morph = 1.0f;                                       ///< t
        std::array<std::uint32_t, 2> edge{kNoVertex, kNoVertex};  ///< vertices q0 and q2
    };

    /// Entry of a priority queue; stale once the diamond's priority is another.
    struct Candidate {
        float priority;
        std::uint32_t diamond;
    };

    // RoamMesh.cpp: the structure
    std::uint32_t create(const SampleGrid& grid, const DiamondShape& shape);
    void destroy(std::uint32_t number);
    void bound(const SampleGrid& grid, const DiamondShape& shape, std::uint32_t number);
    /// Splits what must be split before, too; false when the operations ran out on the way.
    bool split(const SampleGrid& grid, std::uint32_t number);
    void link(std::uint32_t parent, unsigned side, std::uint32_t child, const DiamondShape& childShape);
    void linkToParents(std::uint32_t number, const DiamondShape& shape);
    void adoptChildren(const SampleGrid& grid, std::uint32_t number, const DiamondShape& shape);
    void merge(std::uint32_t number);
    Block& blockOf(std::uint32_t number) { return blocks_[number / RoamBounds::kBlock]; }
    const Block& blockOf(std::uint32_t number) const { return blocks_[number / RoamBounds::kBlock]; }
    static std::uint16_t bitOf(std::uint32_t number) { return std::uint16_t(1u << number % RoamBounds::kBlock); }
    bool isSplit(std::uint32_t number) const { return diamonds_[number].links != kNone; }
    Links& links(std::uint32_t number) { return links_[diamonds_[number].links]; }
    const Links& links(std::uint32_t number) const { return links_[diamonds_[number].links]; }
    /// At the rim of the square a diamond has one triangle, elsewhere two; splitting it adds as many.
    bool isAtRim(const DiamondShape& shape) const { return !inSquare(shape.corner[1]) || !inSquare(shape.corner[3]); }
    std::uint32_t addVertex(const SampleGrid& grid, glm::ivec2 at);
    std::uint32_t vertexAt(glm::ivec2 at) const;
    bool inSquare(glm::ivec2 p) const { return p.x >= 0 && p.y >= 0 && p.x <= side_ && p.y <= side_; }
    static unsigned cellBit(int dx, int dy) { return (dx > 0 ? 1u : 0u) | (dy > 0 ? 2u : 0u); }
    std::uint8_t findSolidCells(const SampleGrid& grid, glm::ivec2 centre) const;

    // RoamUpdate.cpp: edits
    void boundAgain(const SampleGrid& grid, const DiamondShape& shape, std::uint32_t number);
    void addMissingChildren(const SampleGrid& grid, std::uint32_t number);
    void moveVertices(const SampleGrid& grid, const GridEdits& edits);

    // RoamRefine.cpp: queues
    void prepare(const SampleGrid& grid, const View& view, const LodSettings& settings, bool wasDone);
    void evaluate(std::uint32_t number);
    void gather(const SampleGrid& grid, std::size_t block, const BlockEvaluation& found);
    void update(const SampleGrid& grid);
    void refine(const SampleGrid& grid, std::uint32_t limit);
    void coarsen(std::uint32_t limit);
    bool makeRoom(const Candidate& candidate);
    void mergeAndQueueParents(std::uint32_t number);
    std::uint32_t triangleCost(std::uint32_t number) const;
    void enqueue(std::uint32_t number);
    bool isCurrent(const Candidate& c) const { return bounds_.priority(c.diamond) == c.priority; }
    bool isMergeable(std::uint32_t number) const { return (blockOf(number).mergeable & bitOf(number)) != 0; }
    float splitThreshold() const { return settings_.geomorph ? settings_.pixelError * kMorphStart : settings_.pixelError; }

    // RoamEmit.cpp: triangles and morphs
    void emit();
    template <bool Whole, bool Clockwise>
    class Emitter;
    template <bool Whole, bool Clockwise>
    std::uint32_t* emitAll(std::uint32_t* out) const;
    void boundError();
    void morph();
    void collectMoving(float full);
    void place(std::uint32_t vertex);

    TerrainModel model_;
    int side_;
    bool whole_;
    bool regular_;
    int columns_;
    RoamBounds bounds_;  ///< by the number of a diamond, as the next
    std::vector<Diamond> diamonds_;
    std::vector<Block> blocks_;                ///< by block of bounds_
    std::vector<std::uint64_t> freeDiamonds_;  ///< a bit for each that is free
    std::size_t freeWord_ = 0;                 ///< no word before it has a bit
    std::size_t freeCount_ = 0;
    std::vector<Links> links_;
    std::uint32_t freeLinks_ = kNone;  ///< first of a list through child[0]
    DiamondTable table_;
    std::uint32_t root_ = kNone;
    std::array<std::uint32_t, 4> corners_{};  ///< vertices at (0, 0), (side, 0), (side, side), (0, side)
    std::uint32_t meshTriangles_ = 2;

    std::vector<glm::vec3> positions_;  ///< drawn
    std::vector<Vertex> vertices_;
    std::vector<std::uint32_t> samples_;
    std::uint32_t freeVertex_ = kNone;  ///< first of a list through edge[0]
    std::vector<std::uint32_t> newVertices_;
    std::vector<std::uint32_t> indices_;

    // One selection
    View view_;
    LodSettings settings_;
    std::optional<ScreenSpace> space_;  ///< none before the first selection
    ViewMotion motion_;
    std::uint16_t frame_ = 0;
    EvaluationRequest request_;
    bool mayDefer_ = false;  ///< false: every diamond is evaluated in this frame
    std::vector<Candidate> splitQueue_, mergeQueue_;
    float leafError_ = 0.0f;  ///< largest priority of what is not split, but for those left in splitQueue_
    std::uint32_t operations_ = 0;
    std::uint32_t operationCap_ = 0;  ///< splits stop here
    SelectionReport report_;
    bool positionsChanged_ = false;
    bool wasEdited_ = false;             ///< since the last selection
    std::vector<std::uint32_t> edited_;  ///< vertices whose position or normal has changed with it
    std::vector<std::uint32_t> moving_;  ///< split diamonds with t < 1, coarse ones first
    std::vector<std::uint32_t> moved_;   ///< vertices that were off their targets in the last frame
};

}  // namespace terrain
