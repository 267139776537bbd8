// The inside of SoTerrainShape.
#ifndef SOTERRAIN_SOTERRAINSHAPEP_H
#define SOTERRAIN_SOTERRAINSHAPEP_H

#include <optional>
#include <set>
#include <string>

#include <Inventor/sensors/SoOneShotSensor.h>

#include <SoTerrain/SoTerrainShape.h>

#include "GridCache.h"
#include "TerrainCounters.h"
#include "TerrainViews.h"

class StateAttributes;
struct TerrainFrame;

class SoTerrainShape::Private {
public:
    explicit Private(SoTerrainShape * masterArg);

    /// The grid of the state, or nothing after a warning.
    std::optional<TerrainGrid> findGrid(SoState * state, bool withErrors);
    void render(SoGLRenderAction * action);
    terrain::LodSettings settingsFor(SoState * state, const TerrainGrid & data) const;
    void select(TerrainView & view, const terrain::View & camera, const terrain::LodSettings & settings, const TerrainGrid & data,
                const StateAttributes & attributes);
    /// What the view keeps follows the data's edits, or is given up where the data is another or stands elsewhere.
    void bringUpToDate(TerrainView & view, const TerrainGrid & data) const;
    /// Draws from the view's mesh.
    void renderMesh(const TerrainFrame & frame);
    /// What is to be drawn of the mesh itself, instead of or beside the terrain; none while shadows are being made.
    bool wantsDebug(SoState * state) const;
    void renderDebug(const TerrainFrame & frame, bool isSelection);
    /// Whether undersides of triangles are hidden by upper sides, so that GL may leave them out and the picture stays the same.
    bool hidesUndersides(const TerrainView & view, const terrain::View & camera, SoState * state, const TerrainGrid & data) const;

    SoTerrainShape * master;
    GridCache grids;
    TerrainViews views;
    std::uint64_t meshVersion = 0;  ///< meshes of an earlier one are replaced
    std::uint64_t start = 0;        ///< views of an earlier one begin again
    SoTerrainStatistics statistics;
    TerrainCounters counters;
    std::set<std::string> warned;
    SoOneShotSensor again;  ///< asks for another frame while a mesh has not converged
};

#endif
