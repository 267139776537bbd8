/*!
  \class SoROAMTerrain SoROAMTerrain.h SoTerrain/SoROAMTerrain.h
  \brief The SoROAMTerrain class draws a terrain as a real-time optimally adapting mesh.

  The mesh is a bisection of right triangles (Duchaineau et al., "ROAMing Terrain: Real-time Optimally Adapting Meshes", 1997). From
  frame to frame it is split where its error on screen exceeds SoTerrainShape::pixelError and merged where it need not be as
  fine, so that of all algorithms it needs the fewest triangles for an error. Errors are not nested wedgies but the exact deviation of
  every triangle from all samples that it covers, so the promise of pixelError is met with about half of the triangles.

  The first frame of a view is refined completely. After a jump of the camera a frame does at most operationCount splits and merges; the
  next frames go on, getStatistics() tells by SoTerrainStatistics::converged and by the error bound that was reached, and the node
  touches itself until all is done, so that the screen comes to rest at the error that was asked for.

  \code
  #Inventor V2.1 ascii
  Separator {
    Texture2 { filename "terrain_texture.jpg" }
    SoHeightMap { filename "terrain.png" spacing 10 10 heightScale 0.05 }
    SoROAMTerrain { pixelError 2 triangleCount 50000 }
  }
  \endcode

  \image html pictures/roam.png
  \image html pictures/roam_wireframe.png

  <b>FILE FORMAT/DEFAULTS:</b>
  \code
    SoROAMTerrain {
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
      triangleCount 0
      geomorph FALSE
      operationCount 10000
    }
  \endcode

  \sa SoTerrainShape, SoHeightMap, SoBruteForceTerrain
*/

/*!
  \var SoSFInt32 SoROAMTerrain::triangleCount
  Hard limit on the triangles of the mesh. When it is met, the mesh is as good as that many triangles make it, and
  SoTerrainStatistics::errorPixels is the error that was achieved. 0, the default, is no limit.
*/
/*!
  \var SoSFBool SoROAMTerrain::geomorph
  Whether vertices slide in and out instead of popping. Refinement begins at 0.9 pixelError then, so that the error stays within
  pixelError while they move, which takes about a fifth more triangles. Default FALSE: what pops, pops by no more than pixelError.
*/
/*!
  \var SoSFInt32 SoROAMTerrain::operationCount
  Most splits and merges of one frame after the first. 0 is no limit. Default 10000, some milliseconds.
*/

#include <SoTerrain/SoROAMTerrain.h>

#include <algorithm>

#include "lod/RoamMesh.h"

SO_NODE_SOURCE(SoROAMTerrain);

void SoROAMTerrain::initClass()
{
    if (getClassTypeId() != SoType::badType()) return;
    SoTerrainShape::initClass();
    SO_NODE_INIT_CLASS(SoROAMTerrain, SoTerrainShape, "SoTerrainShape");
}

SoROAMTerrain::SoROAMTerrain()
{
    SO_NODE_CONSTRUCTOR(SoROAMTerrain);
    SO_NODE_ADD_FIELD(triangleCount, (0));
    SO_NODE_ADD_FIELD(geomorph, (FALSE));
    SO_NODE_ADD_FIELD(operationCount, (10000));
}

SoROAMTerrain::~SoROAMTerrain() {}

std::unique_ptr<terrain::LodAlgorithm> SoROAMTerrain::createAlgorithm(const terrain::TerrainModel & model, const terrain::SampleGrid & grid)
{
    return std::make_unique<terrain::RoamMesh>(model, grid);
}

void SoROAMTerrain::getSettings(terrain::LodSettings & settings) const
{
    if (this->triangleCount.getValue() < 0) warnOnce("triangleCount: expected 0 or more, found a negative number; no limit is taken");
    if (this->operationCount.getValue() < 0) warnOnce("operationCount: expected 0 or more, found a negative number; no limit is taken");
    settings.triangleBudget = std::uint32_t(std::max(0, this->triangleCount.getValue()));
    settings.operationLimit = std::uint32_t(std::max(0, this->operationCount.getValue()));
    settings.geomorph = this->geomorph.getValue();
}
