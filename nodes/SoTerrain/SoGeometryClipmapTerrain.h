// Terrain drawn as a geometry clipmap: nested grids around the viewer.
#ifndef SOTERRAIN_SOGEOMETRYCLIPMAPTERRAIN_H
#define SOTERRAIN_SOGEOMETRYCLIPMAPTERRAIN_H

#include <Inventor/fields/SoSFEnum.h>
#include <Inventor/fields/SoSFUInt32.h>

#include <SoTerrain/SoTerrainShape.h>

class SoGeometryClipmapTerrain : public SoTerrainShape {
    typedef SoTerrainShape inherited;
    SO_NODE_HEADER(SoGeometryClipmapTerrain);

public:
    enum Implementation { AUTO, GPU, CPU };
    enum Storage { STORED, MEMORY_FREE };

    static void initClass();
    SoGeometryClipmapTerrain();

    SoSFInt32 clipmapSize;
    SoSFInt32 levels;
    SoSFInt32 transitionWidth;
    SoSFInt32 updateBudget;
    SoSFInt32 activeLevels;
    SoSFInt32 detailLevels;
    SoSFFloat detailAmplitude;
    SoSFUInt32 detailSeed;
    SoSFBool blendNormals;
    SoSFEnum implementation;
    SoSFEnum storage;
    SoSFBool showLevels;

    virtual void notify(SoNotList * list);

protected:
    virtual ~SoGeometryClipmapTerrain();
    virtual std::unique_ptr<terrain::LodAlgorithm> createAlgorithm(const terrain::TerrainModel & model, const terrain::SampleGrid & grid);
    virtual bool needsErrors() const;
    virtual const terrain::SynthesisedDetail * detailOf(const TerrainGrid & data);
    virtual SbBool renderOwn(const TerrainFrame & frame, SoTerrainStatistics & statistics);

private:
    class Clipmaps;
    std::unique_ptr<Clipmaps> clipmaps;
};

#endif
