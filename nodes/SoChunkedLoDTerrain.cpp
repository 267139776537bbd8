/*!
  \class SoChunkedLoDTerrain SoChunkedLoDTerrain.h SoTerrain/SoChunkedLoDTerrain.h
  \brief The SoChunkedLoDTerrain class draws a terrain in tiles of many sizes, each built once for one error.

  The method is chunked level of detail (Ulrich, "Rendering Massive Terrains using Chunked Level of Detail Control", 2002). Tiles form a
  quadtree; each is a mesh with as few triangles as keep its error, which is known exactly. In each frame the largest tiles whose error on
  screen is within SoTerrainShape::pixelError are drawn, so that the processor has little to do. What lies between neighbours of different
  levels is closed by walls just as high as the gap.

  Tiles are built by other threads when they are first needed, the most urgent ones first, while coarser ones stand in: a terrain of any
  size is on screen at once and sharpens within moments. SoTerrainStatistics::converged and errorPixels tell how far it is. With background
  FALSE each frame waits until it is complete: for pictures and measurements.

  \code
  #Inventor V2.1 ascii
  Separator {
    Texture2 { filename "terrain_texture.jpg" }
    SoHeightMap { filename "terrain.png" spacing 10 10 heightScale 0.05 }
    SoChunkedLoDTerrain { pixelError 2 }
  }
  \endcode

  <b>FILE FORMAT/DEFAULTS:</b>
  \code
    SoChunkedLoDTerrain {
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
      tileSize 64
      morphing TRUE
      memoryBudget 256
      uploadBudget 1024
      background TRUE
    }
  \endcode

  \sa SoTerrainShape, SoHeightMap, SoROAMTerrain, SoGeoMipmapTerrain
*/

/*!
  \var SoSFInt32 SoChunkedLoDTerrain::tileSize
  Cells along a side of a tile at full resolution, a power of two from 8 to 128; of another number the nearest of these is taken. Tiles of
  coarser levels have as many at a wider stride. Larger tiles are fewer and have somewhat more triangles. Default 64.
*/
/*!
  \var SoSFBool SoChunkedLoDTerrain::morphing
  Whether a tile begins as an exact copy of the surface whose place it takes and moves to its own as the camera comes nearer, so that nothing
  pops. It takes no more triangles, and the error stays within pixelError. Default TRUE.
*/
/*!
  \var SoSFInt32 SoChunkedLoDTerrain::memoryBudget
  Megabytes that tiles may take in each view: meshes that are built, those on their way included. Those that were not drawn for longest make
  room, and what would not fit stays as coarse as it is. It does not count what is kept beside tiles: bounds of the grid, a copy of
  coordinates (none of an SoHeightMap), and positions, attributes and indices of what is on screen. The one tile that covers everything is built
  whatever the budget. Full detail (pixelError 0) of a large terrain does not fit into the default. Default 256.
*/
/*!
  \var SoSFInt32 SoChunkedLoDTerrain::uploadBudget
  Kilobytes of vertices that tiles new on screen may send to GL in one frame: their positions and, as far as they have them, normals, colours
  and texture coordinates (SoTerrainStatistics::newVertexBytes). What exceeds it waits for the next frame. Tiles take the place of a coarser
  one all together; if they alone exceed the budget, they come in a frame in which nothing else does, so that every budget leads to the
  whole picture. It does not limit what follows from the view and not from new tiles: positions, which slide, and indices of
  all that is on screen; nor the first frame, nor what a change of normals, materials or textures makes new. 0 is no limit, and neither is any
  with background FALSE. Default 1024.
*/
/*!
  \var SoSFBool SoChunkedLoDTerrain::background
  Whether tiles are built by other threads while coarser ones stand in. When FALSE each frame waits for all of them. Default TRUE.
*/

#include <SoTerrain/SoChunkedLoDTerrain.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <Inventor/misc/SoNotification.h>

#include "lod/ChunkedLod.h"

SO_NODE_SOURCE(SoChunkedLoDTerrain);

void SoChunkedLoDTerrain::initClass()
{
    if (getClassTypeId() != SoType::badType()) return;
    SoTerrainShape::initClass();
    SO_NODE_INIT_CLASS(SoChunkedLoDTerrain, SoTerrainShape, "SoTerrainShape");
}

SoChunkedLoDTerrain::SoChunkedLoDTerrain()
{
    SO_NODE_CONSTRUCTOR(SoChunkedLoDTerrain);
    SO_NODE_ADD_FIELD(tileSize, (64));
    SO_NODE_ADD_FIELD(morphing, (TRUE));
    SO_NODE_ADD_FIELD(memoryBudget, (256));
    SO_NODE_ADD_FIELD(uploadBudget, (1024));
    SO_NODE_ADD_FIELD(background, (TRUE));
}

SoChunkedLoDTerrain::~SoChunkedLoDTerrain() {}

void SoChunkedLoDTerrain::restart()
{
    this->touch();
}

void SoChunkedLoDTerrain::notify(SoNotList * list)
{
    if (list->getLastField() == &this->tileSize) discardMeshes();
    inherited::notify(list);
}

std::unique_ptr<terrain::LodAlgorithm> SoChunkedLoDTerrain::createAlgorithm(const terrain::TerrainModel & model,
                                                                            const terrain::SampleGrid & grid)
{
    const int size = validTileSize(this->tileSize.getValue(), terrain::TileTree::kSmallest, terrain::TileTree::kLargest);
    return std::make_unique<terrain::ChunkedLod>(model, grid, size, model.samples);
}

void SoChunkedLoDTerrain::getSettings(terrain::LodSettings & settings) const
{
    const auto amountOf = [this](const SoSFInt32 & field, const char * name, int instead) {
        if (field.getValue() >= 0) return std::size_t(field.getValue());
        warnOnce((std::string(name) + ": expected 0 or more, found " + std::to_string(field.getValue()) + "; " + std::to_string(instead) +
                  " is taken").c_str());
        return std::size_t(instead);
    };
    settings.geomorph = this->morphing.getValue();
    settings.memoryBudget = amountOf(this->memoryBudget, "memoryBudget", 256) << 20;
    settings.uploadBudget = amountOf(this->uploadBudget, "uploadBudget", 1024) << 10;
    settings.complete = !this->background.getValue();
}

bool SoChunkedLoDTerrain::needsErrors() const
{
    return false;
}
