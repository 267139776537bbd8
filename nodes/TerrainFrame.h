// What a terrain node has found out by the time that it draws.
#ifndef SOTERRAIN_TERRAINFRAME_H
#define SOTERRAIN_TERRAINFRAME_H

#include "GridCache.h"
#include "StateAttributes.h"
#include "TerrainTextureUse.h"
#include "TerrainViews.h"
#include "base/View.h"
#include "lod/LodAlgorithm.h"

class SoGLRenderAction;

/// Valid during one GLRender.
struct TerrainFrame {
    SoGLRenderAction * action;
    const TerrainGrid & data;
    const terrain::View & camera;
    terrain::LodSettings settings;
    const StateAttributes & attributes;
    const TerrainTextureUse::Frame & texture;
    TerrainView & view;
};

#endif
