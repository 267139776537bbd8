// What the terrain nodes tell SoPerfGraph.
#ifndef SOTERRAIN_TERRAINCOUNTERS_H
#define SOTERRAIN_TERRAINCOUNTERS_H

#include <SoTerrain/SoTerrainStatistics.h>

#include "PerfCounters.h"

/// One node's part in the counters.
class TerrainCounters {
public:
    TerrainCounters();
    /// Makes names and units known before a terrain is drawn.
    static void declare();
    /// After each frame that the node drew.
    void publish(const SoTerrainStatistics & figures);

private:
    PerfShare memory_, buffers_;
};

#endif
