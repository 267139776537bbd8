// Terrain by geometrical mip-mapping.
#ifndef SOTERRAIN_SOGEOMIPMAPTERRAIN_H
#define SOTERRAIN_SOGEOMIPMAPTERRAIN_H

#include <vector>

#include <SoTerrain/SoTerrainShape.h>

namespace terrain {
class BoxPyramid;
class GeoMipmapErrors;
}

class SoGeoMipmapTerrain : public SoTerrainShape {
    typedef SoTerrainShape inherited;
    SO_NODE_HEADER(SoGeoMipmapTerrain);

public:
    static void initClass();
    SoGeoMipmapTerrain();

    SoSFInt32 tileSize;  ///< cells along a side of a block, a power of two from 2 to 128
    SoSFBool morphing;   ///< let vertices slide between levels

    virtual void notify(SoNotList * list);

protected:
    virtual ~SoGeoMipmapTerrain();
    virtual std::unique_ptr<terrain::LodAlgorithm> createAlgorithm(const terrain::TerrainModel & model, const terrain::SampleGrid & grid);
    virtual void getSettings(terrain::LodSettings & settings) const;
    virtual bool needsErrors() const;

private:
    /// What is known of a grid, for as long as a view needs it.
    struct Table {
        std::weak_ptr<const terrain::BoxPyramid> grid;
        std::weak_ptr<terrain::GeoMipmapErrors> errors;
    };

    std::vector<Table> tables;
};

#endif
