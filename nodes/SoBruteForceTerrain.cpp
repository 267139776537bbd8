/*!
  \class SoBruteForceTerrain SoBruteForceTerrain.h SoTerrain/SoBruteForceTerrain.h
  \brief The SoBruteForceTerrain class draws a terrain at full resolution, always.

  Every sample is a vertex in a static buffer and the whole terrain is one draw call. It is what the other terrain nodes are compared
  with, and the right node for small grids: there is nothing to choose, so the traversing thread has nothing to do. Each vertex takes
  12 bytes for its position, 12 for its normal, 4 for its colour and 8 for each texture unit, as far as they are used, and each
  cell 24 bytes of indices.

  Sources, order of points and bindings are those of SoTerrainShape.

  \code
  #Inventor V2.1 ascii
  Separator {
    Coordinate3 { point [ 0 0 0, 1 0 0, 2 0 0,  0 1 0, 1 1 1, 2 1 0,  0 2 0, 1 2 0, 2 2 0 ] }
    SoBruteForceTerrain { verticesPerRow 3 verticesPerColumn 3 }
  }
  \endcode

  \image html pictures/bruteforce.png

  <b>FILE FORMAT/DEFAULTS:</b>
  \code
    SoBruteForceTerrain {
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
    }
  \endcode

  pixelError, frustumCulling and freeze have no effect here.

  \sa SoROAMTerrain, SoTerrainShape
*/

#include <SoTerrain/SoBruteForceTerrain.h>

#include "lod/BruteForceMesh.h"

SO_NODE_SOURCE(SoBruteForceTerrain);

void SoBruteForceTerrain::initClass()
{
    if (getClassTypeId() != SoType::badType()) return;
    SoTerrainShape::initClass();
    SO_NODE_INIT_CLASS(SoBruteForceTerrain, SoTerrainShape, "SoTerrainShape");
}

SoBruteForceTerrain::SoBruteForceTerrain()
{
    SO_NODE_CONSTRUCTOR(SoBruteForceTerrain);
}

SoBruteForceTerrain::~SoBruteForceTerrain() {}

std::unique_ptr<terrain::LodAlgorithm> SoBruteForceTerrain::createAlgorithm(const terrain::TerrainModel &, const terrain::SampleGrid &)
{
    return std::make_unique<terrain::BruteForceMesh>();
}

bool SoBruteForceTerrain::needsErrors() const
{
    return false;
}
