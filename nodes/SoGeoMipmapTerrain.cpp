/*!
  \class SoGeoMipmapTerrain SoGeoMipmapTerrain.h SoTerrain/SoGeoMipmapTerrain.h
  \brief The SoGeoMipmapTerrain class draws a terrain in blocks, each at a level of detail of its own.

  The method is geometrical mip-mapping (de Boer, "Fast Terrain Rendering Using Geometrical MipMapping", 2000). In each frame every block
  in view gets the coarsest of its levels that keeps the error on screen within SoTerrainShape::pixelError: there is nothing to
  converge, so that a jump of the camera costs what any other frame does. Neighbours of different levels meet without cracks and without skirts,
  whatever the difference. Errors are the exact deviation of each level of each block from all samples that it covers, so pixelError is
  a promise here as well.

  It takes more triangles than SoROAMTerrain for the same error, and keeps about a byte a sample for it.

  \code
  #Inventor V2.1 ascii
  Separator {
    Texture2 { filename "terrain_texture.jpg" }
    SoHeightMap { filename "terrain.png" spacing 10 10 heightScale 0.05 }
    SoGeoMipmapTerrain { pixelError 2 tileSize 8 }
  }
  \endcode

  <b>FILE FORMAT/DEFAULTS:</b>
  \code
    SoGeoMipmapTerrain {
      verticesPerRow 0
      verticesPerColumn 0
      startIndex 0
      pixelError 2
      frustumCulling TRUE
      freeze FALSE
      frozenFrustum FALSE
      debugView NONE
      wireframeOverlay FALSE
      alternateRep NULL
      tileSize 8
      morphing TRUE
    }
  \endcode

  \sa SoTerrainShape, SoHeightMap, SoROAMTerrain
*/

/*!
  \var SoSFInt32 SoGeoMipmapTerrain::tileSize
  Cells along a side of a block, a power of two from 2 to 128; of another number the nearest of these is taken. Small blocks follow the
  terrain more closely and need fewer triangles; large ones make less work for the processor where maps are very large. Default 8.
*/
/*!
  \var SoSFBool SoGeoMipmapTerrain::morphing
  Whether vertices slide from one level to the next, so that nothing pops. The slide takes the last 5 % of pixelError, more where that exceeds 2
  (45 % at 6 pixels, half at most), because larger errors change faster as the camera moves; the error stays within pixelError all the while.
  So no sample moves by more than 0.25 pixels from frame to frame at a tenth of a cell a frame, for a pixelError up to 6 and an eye a cell and a
  half above the ground or higher. It grows in proportion to the speed, and with what is larger than 6. Neighbours differ by one level at
  most. Default TRUE.
*/

#include <SoTerrain/SoGeoMipmapTerrain.h>

#include <Inventor/misc/SoNotification.h>

#include "lod/GeoMipmapMesh.h"
#include "lod/TerrainModel.h"

using terrain::GeoMipmapErrors;

SO_NODE_SOURCE(SoGeoMipmapTerrain);

void SoGeoMipmapTerrain::initClass()
{
    if (getClassTypeId() != SoType::badType()) return;
    SoTerrainShape::initClass();
    SO_NODE_INIT_CLASS(SoGeoMipmapTerrain, SoTerrainShape, "SoTerrainShape");
}

SoGeoMipmapTerrain::SoGeoMipmapTerrain()
{
    SO_NODE_CONSTRUCTOR(SoGeoMipmapTerrain);
    SO_NODE_ADD_FIELD(tileSize, (8));
    SO_NODE_ADD_FIELD(morphing, (TRUE));
}

SoGeoMipmapTerrain::~SoGeoMipmapTerrain() {}

void SoGeoMipmapTerrain::notify(SoNotList * list)
{
    if (list->getLastField() == &this->tileSize) discardMeshes();
    inherited::notify(list);
}

std::unique_ptr<terrain::LodAlgorithm> SoGeoMipmapTerrain::createAlgorithm(const terrain::TerrainModel & model, const terrain::SampleGrid & grid)
{
    const int size = validTileSize(this->tileSize.getValue(), GeoMipmapErrors::kSmallestTile, GeoMipmapErrors::kLargestTile);
    std::erase_if(tables, [](const Table & table) { return table.grid.expired() || table.errors.expired(); });
    std::shared_ptr<GeoMipmapErrors> errors;
    for (const Table & table : tables) {
        const auto known = table.errors.lock();
        if (table.grid.lock() == model.boxes && known && known->layout().tileSize == size) errors = known;
    }
    if (errors) {
        errors->follow(grid);
    } else {
        errors = std::make_shared<GeoMipmapErrors>(grid, size, model.edits);
        tables.push_back({model.boxes, errors});
    }
    return std::make_unique<terrain::GeoMipmapMesh>(std::move(errors));
}

void SoGeoMipmapTerrain::getSettings(terrain::LodSettings & settings) const
{
    settings.geomorph = this->morphing.getValue();
}

bool SoGeoMipmapTerrain::needsErrors() const
{
    return false;
}
