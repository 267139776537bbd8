// Terrain by real-time optimally adapting meshes.
#ifndef SOTERRAIN_SOROAMTERRAIN_H
#define SOTERRAIN_SOROAMTERRAIN_H

#include <SoTerrain/SoTerrainShape.h>

class SoROAMTerrain : public SoTerrainShape {
    typedef SoTerrainShape inherited;
    SO_NODE_HEADER(SoROAMTerrain);

public:
    static void initClass();
    SoROAMTerrain();

    SoSFInt32 triangleCount;   ///< hard limit on the triangles of the mesh; 0: none
    SoSFBool geomorph;         ///< slide new vertices in and old ones out
    SoSFInt32 operationCount;  ///< most splits and merges in one frame after the first; 0: no limit

protected:
    virtual ~SoROAMTerrain();
    virtual std::unique_ptr<terrain::LodAlgorithm> createAlgorithm(const terrain::TerrainModel & model, const terrain::SampleGrid & grid);
    virtual void getSettings(terrain::LodSettings & settings) const;
};

#endif
