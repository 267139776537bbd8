#include <SoTerrain/SoTerrain.h>

#include <SoTerrain/SoBruteForceTerrain.h>
#include <SoTerrain/SoChunkedLoDTerrain.h>
#include <SoTerrain/SoGeoMipmapTerrain.h>
#include <SoTerrain/SoGeometryClipmapTerrain.h>
#include <SoTerrain/SoHeightMap.h>
#include <SoTerrain/SoHeightMapElement.h>
#include <SoTerrain/SoPerfGraph.h>
#include <SoTerrain/SoROAMTerrain.h>
#include <SoTerrain/SoTerrainDetail.h>
#include <SoTerrain/SoTerrainDrape.h>
#include <SoTerrain/SoTerrainKit.h>
#include <SoTerrain/SoTerrainPlacement.h>
#include <SoTerrain/SoTerrainShape.h>
#include <SoTerrain/SoTerrainTexture.h>
#include <SoTerrain/SoTerrainTextureElement.h>

#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

void SoTerrain::init()
{
    SoHeightMapElement::initClass();
    SoTerrainDetail::initClass();
    SoHeightMap::initClass();
    SoPerfGraph::initClass();
    SoTerrainTextureElement::initClass();
    SoTerrainTexture::initClass();
    SoTerrainShape::initClass();
    SoBruteForceTerrain::initClass();
    SoChunkedLoDTerrain::initClass();
    SoGeoMipmapTerrain::initClass();
    SoGeometryClipmapTerrain::initClass();
    SoROAMTerrain::initClass();
    SoTerrainDrape::initClass();
    SoTerrainKit::initClass();
    SoTerrainPlacement::initClass();
}

const char * SoTerrain::getVersion()
{
    return PACKAGE_VERSION;
}

void soterrain_init(void)
{
    SoTerrain::init();
}
