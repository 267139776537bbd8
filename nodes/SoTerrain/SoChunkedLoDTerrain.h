// Terrain by chunked level of detail.
#ifndef SOTERRAIN_SOCHUNKEDLODTERRAIN_H
#define SOTERRAIN_SOCHUNKEDLODTERRAIN_H

#include <SoTerrain/SoTerrainShape.h>

class SoChunkedLoDTerrain : public SoTerrainShape {
    typedef SoTerrainShape inherited;
    SO_NODE_HEADER(SoChunkedLoDTerrain);

public:
    static void initClass();
    SoChunkedLoDTerrain();

    SoSFInt32 tileSize;      ///< cells along a side of a tile, a power of two from 8 to 128
    SoSFBool morphing;       ///< let tiles take the shape of those whose place they take
    SoSFInt32 memoryBudget;  ///< megabytes that tiles may take
    SoSFInt32 uploadBudget;  ///< kilobytes a frame of tiles that are new on screen; 0: no limit
    SoSFBool background;     ///< build tiles in other threads while coarser ones stand in

    /// Tiles are the same whatever was drawn before, and stay.
    virtual void restart();

    virtual void notify(SoNotList * list);

protected:
    virtual ~SoChunkedLoDTerrain();
    virtual std::unique_ptr<terrain::LodAlgorithm> createAlgorithm(const terrain::TerrainModel & model, const terrain::SampleGrid & grid);
    virtual void getSettings(terrain::LodSettings & settings) const;
    virtual bool needsErrors() const;
};

#endif
