// The inside of SoTerrainShape.
#ifndef SOTERRAIN_SOTERRAINSHAPEP_H
#define SOTERRAIN_SOTERRAINSHAPEP_H

#include <optional>
#include <set>
#include <string>

#include <Inventor/sensors/SoOneShotSensor.h>

#include <SoTerrain/SoTerrainShape.h>

#include "GridCache.h"
#include "TerrainViews.h"

class StateAttributes;

class SoTerrainShape::Private {
public:
    explicit Private(SoTerrainShape * masterArg);

    /// The grid of the state, or nothing after a warning.
    std::optional<TerrainGrid> findGrid(SoState * state, bool withErrors);
    void render(SoGLRenderAction * action);
    terrain::LodSettings settingsFor(SoState * state, const TerrainGrid & data) const;
    void select(TerrainView & view, SoState * state, const TerrainGrid & data, const StateAttributes & attributes);

    SoTerrainShape * master;
    GridCache grids;
    TerrainViews views;
    SoTerrainStatistics statistics;
    std::set<std::string> warned;
    SoOneShotSensor again;  ///< asks for another frame while a mesh has not converged
};

#endif
