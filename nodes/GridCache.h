// From the traversal state to a grid and what is known of it.
#ifndef SOTERRAIN_GRIDCACHE_H
#define SOTERRAIN_GRIDCACHE_H

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Inventor/SbBasic.h>

#include "base/Result.h"
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

/// Bounds and errors by the node id of what the samples come from, so that they are computed once per change of the data. A node under
/// several properties keeps one entry for each.
class GridCache {
public:
    /// Error: no height map and no coordinates, fewer coordinates than the fields ask for, sizes that make no grid.
    terrain::Result<TerrainGrid> find(SoState * state, const GridRequest & request, bool withErrors);
    std::size_t bytes() const;

private:
    struct Entry {
        SbUniqueId nodeId = 0;
        int columns = 0;
        int rows = 0;
        int start = 0;
        bool fromHeightMap = false;
        terrain::SampleGrid grid;  ///< its samples may be gone
        terrain::TerrainModel model;
        std::uint64_t lastUse = 0;
    };
    Entry & entryFor(const Entry & key);
    terrain::Result<TerrainGrid> complete(Entry & entry, bool withErrors);
    terrain::Result<TerrainGrid> findMap(SoState * state, const GridRequest & request, bool withErrors);
    terrain::Result<TerrainGrid> findCoordinates(SoState * state, const GridRequest & request, bool withErrors);

    std::vector<Entry> entries_;
    std::uint64_t use_ = 0;
};

#endif
