// Full-resolution terrain from static buffers.
#ifndef SOTERRAIN_SOBRUTEFORCETERRAIN_H
#define SOTERRAIN_SOBRUTEFORCETERRAIN_H

#include <SoTerrain/SoTerrainShape.h>

class SoBruteForceTerrain : public SoTerrainShape {
    typedef SoTerrainShape inherited;
    SO_NODE_HEADER(SoBruteForceTerrain);

public:
    static void initClass();
    SoBruteForceTerrain();

protected:
    virtual ~SoBruteForceTerrain();
    virtual std::unique_ptr<terrain::LodAlgorithm> createAlgorithm(const terrain::TerrainModel & model, const terrain::SampleGrid & grid);
    virtual bool needsErrors() const;
};

#endif
