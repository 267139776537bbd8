// Geo Mip-Mapping: one view's choice of a level for each block.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "base/View.h"
#include "height/SampleGrid.h"
#include "lod/GeoMipmapErrors.h"
#include "lod/GeoMipmapVertices.h"
#include "lod/LodAlgorithm.h"

namespace terrain {

/// Geometrical mip-mapping (de Boer: "Fast Terrain Rendering Using Geometrical MipMapping", 2000): each block is drawn at the
/// coarsest of its levels whose error on screen is within pixelError. Errors are exact (GeoMipmapErrors.h), so that is a promise.
/// Neighbours of any difference of level meet in the vertices of the coarser one (GeoMipmapShape.h); where the triangles that this
/// takes would have too large an error, the coarser one is refined.
///
/// Geomorph (de Boer's trilinear mip-mapping). A block's detail is its level and, behind the point, how far it has come to the next
/// coarser one: nothing where the error of that one is pixelError, all the way where it is morphStart(pixelError). Drawn is
/// the average, over x in [0, 1], of the meshes whose blocks have the levels floor(detail + x). All of these are made of edges of
/// the finest, because neighbours differ by at most one level; and as each of them keeps the error within pixelError, their average
/// does too. Nothing moves at a switch of levels. Blocks at the far borders that are not of full size switch without sliding.
///
/// `triangleBudget` and `operationLimit` are not used. The mesh keeps no pointer to samples.
class GeoMipmapMesh : public LodAlgorithm {
public:
    /// The error on screen at which a level is all there, in pixels. What slides goes as far as pixelError while it comes nearer by
    /// the part 1 - morphStart() / pixelError of its distance, which itself is the less the larger pixelError is: so that nothing
    /// moves faster than at 2 pixels, that part grows with the square of pixelError.
    static float morphStart(float pixelError);

    /// The table, which may be shared by meshes, must be of the grid that select() is given.
    explicit GeoMipmapMesh(std::shared_ptr<GeoMipmapErrors> errors);

    DrawList select(const SampleGrid& grid, const View& view, const LodSettings& settings) override;
    bool update(const SampleGrid& grid, const GridEdits& edits) override;
    void eachPatch(const SampleGrid& grid, const PatchVisitor& visit) const override;
    std::size_t bytes() const override;

    /// Level of a block; -1 when it was not drawn.
    int level(int blockColumn, int blockRow) const;

private:
    static constexpr float kHidden = BlockDetails::kHidden;

    struct Turned;
    struct Visit;

    // GeoMipmapMesh.cpp: triangles
    void list();
    void emit(const SampleGrid& grid, bool everything);
    void makeRoom(std::size_t count);
    void emitBlock(const SampleGrid& grid, const DrawnBlock& drawn);
    void emitTriangles(std::span<const GeoMipmapShape::Triangle> triangles, const std::uint32_t* vertices);
    void emitSolid(const SampleGrid& grid, const DrawnBlock& drawn, std::span<const GeoMipmapShape::Triangle> triangles,
                   const std::uint32_t* vertices);

    // GeoMipmapLevels.cpp: levels
    void choose(const SampleGrid& grid);
    void visit(const Visit& v, int boundsLevel, int column, int row, bool mayBeOutside);
    bool isNextToView(const Visit& v, const Box& box) const;
    void evaluate(const BlockAt& at, float factor);
    bool fits(float error, float factor) const { return error == 0.0f || error * factor <= limit_; }
    float fade(float error, float factor) const;
    void settle();
    void settleBlock(const BlockAt& at);
    void settleSide(const BlockAt& at, int side);
    void settleMorph(const BlockAt& at, int side);
    void lower(const BlockAt& at, float detail);
    void push(const BlockAt& at);
    BlockAt neighbour(const BlockAt& at, int side) const;
    bool canMorph(const BlockAt& at) const { return errors_->shape(at.column, at.row).isFull() && !errors_->hasHoles(at.number); }
    float boundError() const;
    float boundSides(const BlockAt& at) const;

    std::shared_ptr<GeoMipmapErrors> errors_;
    BlockLayout layout_;
    GeoMipmapVertices vertices_;
    LodSettings settings_;
    std::optional<View> view_;
    GridEdits edits_;  ///< since the last selection
    bool morphing_ = false;
    float limit_ = 0.0f;  ///< pixels up to which a level is taken

    BlockDetails detail_;
    std::vector<float>
        factor_;  ///< by block: pixels that a unit of error takes on screen at most; below 0: the same outside of the view
    std::vector<bool> queued_;  ///< by block
    /// Blocks to be drawn; while morphing, with those around them, so that nothing jumps when they come into view.
    std::vector<BlockAt> chosen_;
    std::vector<BlockAt> queue_;
    std::vector<DrawnBlock> drawn_, drawnBefore_, sliding_;
    std::vector<std::uint32_t> indices_;  ///< the first indexCount_ are in use
    std::vector<std::uint32_t> indicesBefore_;
    struct IndexRange {
        std::uint32_t first = 0, count = 0;
    };
    std::vector<IndexRange> emitted_;  ///< by block, in indices_
    std::size_t indexCount_ = 0;
    SelectionReport report_;
};

}  // namespace terrain
