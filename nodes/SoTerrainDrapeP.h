// The inside of SoTerrainDrape.
#ifndef SOTERRAIN_SOTERRAINDRAPEP_H
#define SOTERRAIN_SOTERRAINDRAPEP_H

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include <SoTerrain/SoTerrainDrape.h>

#include "GridCache.h"
#include "TerrainViews.h"
#include "lod/DrapedLines.h"

class SoAction;
class SoLineDetail;
class SoPointDetail;
class SoState;

class SoTerrainDrape::Private {
public:
    /// Lines on the data of one place in the scene.
    struct Draped {
        std::shared_ptr<const terrain::BoxPyramid> boxes;  ///< names the data, together with the node ids
        SbUniqueId mapId = 0, coordinatesId = 0;
        std::uint64_t version = 0;  ///< of the node's own fields
        bool asLines = true;        ///< false: SoDrawStyle asks for points
        glm::dmat4 localFromFrame{1.0};
        float top = 0.0f;
        terrain::DrapedLines lines;
    };
    enum Binding { OVERALL, PER_POLYLINE, PER_SEGMENT, PER_POINT };

    explicit Private(SoTerrainDrape * masterArg) : master(masterArg) {}

    /// NULL after a warning where there is nothing to lie on.
    std::shared_ptr<const Draped> find(SoState * state);
    terrain::DrapeInput inputFor(const terrain::SampleGrid & grid);
    void render(SoGLRenderAction * action);
    float errorFor(SoState * state);
    Binding bindingFor(SoState * state) const;
    /// Index into the state's materials at the begin of a run, or at its end.
    int materialIndex(Binding binding, const terrain::DrapedLines::Run & run, bool atEnd) const;
    void fill(SoLineDetail & detail, const terrain::DrapedLines::Run & run, Binding binding) const;
    void fill(SoPointDetail & detail, const terrain::DrapedLines::Run & run, Binding binding) const;
    void warnOnce(const std::string & text);

    SoTerrainDrape * master;
    GridCache grids;
    TerrainViews views;
    std::vector<std::shared_ptr<const Draped>> draped;  ///< the latest last
    std::uint64_t version = 1;
    std::set<std::string> warned;
};

#endif
