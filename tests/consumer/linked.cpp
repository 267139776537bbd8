// A program that links the installed library by pkg-config and includes every installed header.
#include <cstdio>

#include <Inventor/SoDB.h>
#include <Inventor/nodes/SoSeparator.h>

#include <SoTerrain/SoBruteForceTerrain.h>
#include <SoTerrain/SoHeightMap.h>
#include <SoTerrain/SoROAMTerrain.h>
#include <SoTerrain/SoTerrain.h>

int main() {
    SoDB::init();
    SoTerrain::init();
    soterrain_init();
    SoSeparator* root = new SoSeparator;
    root->ref();
    root->addChild(new SoHeightMap);
    root->addChild(new SoROAMTerrain);
    root->addChild(new SoBruteForceTerrain);
    const bool works = root->getNumChildren() == 3 && root->getChild(1)->isOfType(SoTerrainShape::getClassTypeId());
    std::printf("SoTerrain %s\n", SoTerrain::getVersion());
    root->unref();
    return works ? 0 : 1;
}
