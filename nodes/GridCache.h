// From the traversal state to a grid and what is known of it.
#ifndef SOTERRAIN_GRIDCACHE_H
#define SOTERRAIN_GRIDCACHE_H

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Inventor/SbBasic.h>

#include "CoordinateDigest.h"
#include "base/Result.h"
#include "height/MapSource.h"
#include "height/SampleGrid.h"
#include "lod/TerrainModel.h"

class SoState;

/// Which part of the state's samples a node draws: its fields of the same names.
struct GridRequest {
    int verticesPerRow = 0;
    int verticesPerColumn = 0;
    int startIndex = 0;
};

/// A grid for one traversal.
struct TerrainGrid {
    terrain::SampleGrid grid;
    terrain::TerrainModel model;  ///< bounds; errors only where they were asked for
    bool fromHeightMap = false;
    double buildMilliseconds = 0.0;
};

/// Bounds and errors of what the samples come from, computed once and then kept up to date with its edits. A node under several
/// properties keeps one entry for each.
class GridCache {
public:
    /// Error: no height map and no coordinates, fewer coordinates than the fields ask for, sizes that make no grid.
    terrain::Result<TerrainGrid> find(SoState * state, const GridRequest & request, bool withErrors);
    /// The samples alone, whose bounds nobody needs; nothing of them is kept alive. Errors as find().
    terrain::Result<terrain::SampleGrid> findSamples(SoState * state, const GridRequest & request);
    std::size_t bytes() const;

private:
    struct Entry {
        const terrain::HeightSource * source = nullptr;  ///< of a height map; kept by model.samples
        std::uint64_t version = 0;                       ///< of its edits that are in the model
        SbUniqueId nodeId = 0;                           ///< of coordinates
        int columns = 0;
        int rows = 0;
        int start = 0;
        terrain::SampleGrid grid;  ///< its samples may be gone
        std::shared_ptr<terrain::BoxPyramid> boxes;
        std::shared_ptr<terrain::ErrorHierarchy> errors;
        std::shared_ptr<terrain::EditLog> edits;
        std::shared_ptr<terrain::SampleGate> gate;
        std::shared_ptr<const void> samples;
        CoordinateDigest digest;  ///< of coordinates
        std::uint64_t lastUse = 0;

        terrain::TerrainModel model() const { return {boxes, errors, samples, gate, edits}; }
        bool isFor(const Entry & key) const;
    };
    static terrain::Result<Entry> coordinateKey(SoState * state, const GridRequest & request);
    Entry * known(const Entry & key);
    Entry & entryFor(const Entry & key);
    void update(Entry & entry, const terrain::GridEdits & edits);
    Entry * changedEntry(const Entry & key, const float * points);
    terrain::Result<TerrainGrid> complete(Entry & entry, bool withErrors);
    terrain::Result<TerrainGrid> findMap(SoState * state, const GridRequest & request, bool withErrors);
    terrain::Result<TerrainGrid> findCoordinates(SoState * state, const GridRequest & request, bool withErrors);

    std::vector<Entry> entries_;
    std::uint64_t use_ = 0;
};

#endif
