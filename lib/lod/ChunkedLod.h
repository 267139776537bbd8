// Chunked level of detail: a quadtree of tiles that are built once and drawn as they are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "base/View.h"
#include "lod/LodAlgorithm.h"
#include "lod/RangePool.h"
#include "lod/TerrainModel.h"
#include "lod/TileCache.h"
#include "lod/TileFactory.h"
#include "lod/TileWalls.h"

namespace terrain {

/// Ulrich, "Rendering Massive Terrains using Chunked Level of Detail Control", SIGGRAPH course notes 2002. A tile is drawn where
/// its error on screen is within the pixel error, else its children are, once all of those in view are there: they are built by a
/// TaskRunner in the order of the errors that are on screen without them, and until then the nearest ancestor stands in.
///
/// Geomorph. A tile of error e, whose parent has the error E and shows as S pixels, stands between its own surface (t = 1) and its
/// parent's (t = 0) at t = (1 - p / S) / (1 - e / E), with p the pixel error. So it takes its parent's place as an exact copy of
/// it, at S = p; its error on screen, at most S (1 - t + t e / E), is p at all times; and t is 1 before S (e / E) = p, when its own
/// children may take its place. Its mesh refines its parent's, which makes the copy exact.
class ChunkedLod : public LodAlgorithm {
public:
    /// `owner` keeps the grid's memory while tiles are built from it; without it the samples are copied. Without a runner that of
    /// the process is used.
    ChunkedLod(const TerrainModel& model, const SampleGrid& grid, int tileCells, std::shared_ptr<const void> owner,
               std::shared_ptr<TaskRunner> runner = nullptr);

    DrawList select(const SampleGrid& grid, const View& view, const LodSettings& settings) override;
    /// Tiles with changed samples are made anew at once; those larger than kAtOnce cells keep their vertices and take a new error,
    /// which may be larger than exact, until they are made anew some time. What is being built of changed samples is dropped.
    bool update(const SampleGrid& grid, const GridEdits& edits) override;
    void eachPatch(const SampleGrid& grid, const PatchVisitor& visit) const override;
    static constexpr int kAtOnce = 512;

    std::size_t bytes() const override;

    const TileCache<TileMesh>& cache() const { return cache_; }
    std::uint32_t drawnTiles() const { return std::uint32_t(drawn_.size()); }
    /// Bytes of vertices of tiles that came on screen in the last selection.
    std::size_t placedBytes() const { return placedBytes_; }

private:
    struct Tile {
        TileId id;
        const TileMesh* mesh = nullptr;
        float parentShare = 0.0f;  ///< 1 - t
        std::uint32_t base = 0;    ///< first vertex in the pool
        // Of the mesh, which an edit may replace before the next selection:
        float error = 0.0f;
        std::uint32_t indexCount = 0;
    };
    struct Slot {
        std::uint32_t base = 0;
        std::uint32_t count = 0;
        float parentShare = -1.0f;
        bool isDrawn = false;
        bool isOld = false;  ///< vertices are those of samples before an edit
    };
    struct BorderLine {
        bool alongRows = false;  ///< runs from row to row, at one column
        int line = 0;            ///< that column, or row
        bool isRight = false;    ///< of the border, along increasing places
        int first = 0, last = 0;
        std::size_t tile = 0;
        std::size_t side = 0;
    };

    TileKey keyOf(const TileId& id) const { return {id.level, id.column, id.row, tree_.tileCells}; }
    Box boxOf(const TileId& id) const;

    // Choice of tiles
    void choose();
    void chooseOnce();
    void chooseTiles();
    bool visit(const TileId& id, float parentPixels);
    bool areChildrenReady(const TileId& id, float pixels);
    /// Asks for what will be drawn when the camera turns or comes a little nearer.
    void prefetch(const TileId& id, float parentPixels);
    void prefetchChildren(const TileId& id, float pixels);
    bool visitChildren(const TileId& id, float pixels);
    bool drawChildren(const TileId& id, float pixels);
    bool draw(const TileId& id, const TileMesh& mesh, const Box& box, float parentPixels);
    float parentShare(const TileMesh& mesh, float parentPixels);
    void updateTiles(const GridEdits& edits);
    void reportTiles();
    std::size_t vertexBytes(const TileMesh& mesh) const { return mesh.at.size() * settings_.vertexBytes; }

    // The list
    void place(const SampleGrid& grid);
    void writePositions(const SampleGrid& grid, Tile& tile, Slot& slot);
    void writeIndices();
    void writeWalls();
    std::vector<BorderLine> borderLines() const;
    void appendVertices(const BorderLine& line, std::vector<BorderVertex>& out) const;

    TerrainModel model_;
    TileTree tree_;
    std::shared_ptr<TileSamples> samples_;
    std::shared_ptr<TileFactory> factory_;
    TileCache<TileMesh> cache_;

    View view_;
    LodSettings settings_;
    std::optional<ScreenSpace> space_, wide_;  ///< what is in view, and what may soon be
    SelectionReport report_;
    std::size_t credit_ = 0;   ///< bytes that may still come on screen
    bool wasTooMuch_ = false;  ///< something did not come because of that
    bool mayExceed_ = false;   ///< one group of tiles may come although it exceeds the budget
    bool isFirst_ = true;
    bool wasEdited_ = false;  ///< since the last selection
    bool hasEdits_ = false;   ///< ever
    bool isSettled_ = false;  ///< nothing is being built, and all tiles that are there could be looked at
    std::size_t placedBytes_ = 0;
    double toldMilliseconds_ = 0.0;  ///< of building tiles
    std::vector<Tile> drawn_, drawnBefore_;
    std::map<TileId, Slot> slots_;

    RangePool pool_;
    std::vector<glm::vec3> positions_, targets_;  ///< by vertex: drawn, and with t = 1
    std::vector<std::uint32_t> samplesOf_;
    std::vector<std::uint32_t> newVertices_, indices_;
    bool positionsChanged_ = false;
    std::vector<BorderVertex> rightLine_, leftLine_;
};

}  // namespace terrain
