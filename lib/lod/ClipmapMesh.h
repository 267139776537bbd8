// Geometry clipmaps as vertex arrays: what they are where nothing can be displaced in a shader.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <queue>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "base/View.h"
#include "height/SampleGrid.h"
#include "lod/BoxPyramid.h"
#include "lod/Clipmap.h"
#include "lod/ClipmapErrors.h"
#include "lod/LodAlgorithm.h"
#include "lod/SynthesisedDetail.h"

namespace terrain {

/// One view of a clipmap (Losasso and Hoppe: "Geometry clipmaps", 2004) on the CPU: the same levels, patches, heights and
/// transitions as in textures, for curved grids too.
///
/// Each level's own and coarser heights (of curved grids: positions) stay in arrays that wrap around, and are read only where the
/// clipmap says that something is new. The pool of vertices holds those of the levels' squares of kChunk x kChunk vertices that
/// patches in view use: such a square keeps its place for as long as it is in use, and is computed anew only where it blends or
/// has new vertices. A vertex stands at its own place or on the way to the coarser surface's, by Clipmap::blend(): exactly there
/// at 1.
///
/// Along a level's perimeter every second vertex lies on the coarser level's edge; triangles without area fill what rounding leaves
/// open between the two. They count in the report. A cell with a hole at a corner is not drawn. `triangleBudget`, `operationLimit`
/// and `geomorph` are not used: transitions are part of the method.
class ClipmapMesh : public LodAlgorithm {
public:
    using Errors = std::function<std::shared_ptr<const ClipmapErrors>(const SampleGrid&)>;
    static constexpr int kChunk = 16;

    /// `errors` is asked in every selection and may give none as long as there are none; it may be empty. `detail` may be null, and
    /// must be of the grid that is passed to select(); without it the layout's detailLevels() must be 0. Of `settings`, pixelError,
    /// cull and detail are not used.
    ClipmapMesh(const ClipmapLayout& layout, const ClipmapSettings& settings, std::shared_ptr<const BoxPyramid> boxes,
                Errors errors, std::shared_ptr<const SynthesisedDetail> detail);
    /// The same of a grid of columns x rows samples. A size of 0 is smallestClipmap() of each view; when that is another one, all
    /// begins anew.
    ClipmapMesh(int columns, int rows, const ClipmapShape& shape, const ClipmapSettings& settings,
                std::shared_ptr<const BoxPyramid> boxes, Errors errors, std::shared_ptr<const SynthesisedDetail> detail);

    DrawList select(const SampleGrid& grid, const View& view, const LodSettings& settings) override;
    bool update(const SampleGrid& grid, const GridEdits& edits) override;
    void eachPatch(const SampleGrid& grid, const PatchVisitor& visit) const override;
    std::size_t bytes() const override;

    const Clipmap& clipmap() const { return clipmap_; }

private:
    static constexpr std::uint32_t kNoPlace = 0xffffffffu;
    static constexpr int kChunkVertices = kChunk * kChunk;

    struct Chunk {
        std::uint32_t place = kNoPlace;  ///< in the pool, in chunks
        bool used = false, isNew = false;
        bool written = false, plain = false;  ///< positions are up to date; are those of no transition
    };
    struct Level {
        std::vector<glm::vec2> heights;  ///< own and coarser, by texel; of regular grids
        std::vector<glm::vec3> points;   ///< own and coarser, two a texel; of curved ones
        std::vector<Chunk> chunks;
        std::vector<float> share[2];  ///< of the coarser level, by texel along an axis
        std::vector<float> place[2];  ///< local coordinate likewise, of regular grids
        ClipRect valid;               ///< what `place` is of
        bool sharesChanged = false;   ///< or places
    };

    void start(const ClipmapLayout& layout);
    void fitSize(const SampleGrid& grid, const View& view);
    void findAxes(const SampleGrid& grid);
    void store(const SampleGrid& grid, const ClipmapUpdates::Update& update);
    void fillDetail(const SampleGrid& grid, int level, const ClipRect& rect);
    void useChunks(const ClipmapPatches& patches);
    void assignPlaces();
    void nameVertices(const SampleGrid& grid, std::span<const ClipmapUpdates::Update> updates);
    void nameVertex(const SampleGrid& grid, int level, glm::ivec2 vertex, std::uint32_t id);
    void share(const SampleGrid& grid, int level, const Clipmap::Frame& frame);
    bool writePositions(const SampleGrid& grid, int level);
    void writeRegular(const Level& level, glm::ivec2 texel, glm::vec3* out) const;
    void writeCurved(const Level& level, glm::ivec2 texel, glm::vec3* out) const;
    void emit(const ClipmapPatches& patches);
    void emitPatch(const ClipmapPatch& patch);
    void emitSeam(const ClipmapPatch& patch);
    void fillRow(int level, int row, int first, int last, std::vector<std::uint32_t>& out) const;
    bool isHole(int level, glm::ivec2 vertex) const;

    std::size_t texelIndex(glm::ivec2 vertex) const {
        return std::size_t(layout_.texel(vertex.y)) * std::size_t(layout_.pitch()) + std::size_t(layout_.texel(vertex.x));
    }
    std::size_t chunkIndex(glm::ivec2 vertex) const {
        const std::size_t across = std::size_t(layout_.pitch() / kChunk);
        return std::size_t(layout_.texel(vertex.y) / kChunk) * across + std::size_t(layout_.texel(vertex.x) / kChunk);
    }
    std::uint32_t vertexId(int level, glm::ivec2 vertex) const {
        const std::uint32_t place = levels_[std::size_t(level)].chunks[chunkIndex(vertex)].place;
        return place * kChunkVertices + std::uint32_t(vertex.y % kChunk) * kChunk + std::uint32_t(vertex.x % kChunk);
    }

    std::optional<ClipmapShape> anySize_;  ///< where each view has a size of its own
    ClipmapLayout layout_;
    ClipmapSettings options_;
    std::shared_ptr<const BoxPyramid> boxes_;
    Errors errors_;
    std::shared_ptr<const SynthesisedDetail> detail_;
    Clipmap clipmap_;

    std::optional<View> view_;
    LodSettings settings_;
    std::shared_ptr<const ClipmapErrors> errorsUsed_;
    ClipmapPatches drawn_;
    int columnAxis_ = 0, rowAxis_ = 1, heightAxis_ = 2;

    std::vector<Level> levels_;
    std::priority_queue<std::uint32_t, std::vector<std::uint32_t>, std::greater<>> free_;  ///< places below placeCount_
    std::uint32_t placeCount_ = 0;
    bool placesChanged_ = false;
    std::vector<glm::vec3> positions_;
    std::vector<std::uint32_t> samples_, newVertices_, indices_, rows_[2];
    std::vector<glm::vec2> places_;
    std::vector<float> scratch_, shares_;
    std::vector<glm::vec3> points_;
    std::size_t indexCount_ = 0, firstSeam_ = 0;
    bool wasEdited_ = false, holesChanged_ = false;  ///< since the last selection
    bool isFitted_ = false;                          ///< the size is that of an earlier view, by errors
    SelectionReport report_;
};

}  // namespace terrain
