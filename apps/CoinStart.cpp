#include "CoinStart.h"

#include <cstring>

#include <Inventor/SoDB.h>
#include <Inventor/SoInteraction.h>
#include <Inventor/errors/SoDebugError.h>
#include <Inventor/nodekits/SoNodeKit.h>
#include <SoTerrain/SoTerrain.h>

namespace app {

namespace {

SoErrorCB* defaultHandler = nullptr;

void passOn(const SoError* error, void* data) {
    if (std::strstr(error->getDebugString().getString(), "glxglue_isdirect")) return;
    defaultHandler(error, data);
}

}  // namespace

void startCoin() {
    SoDB::init();
    SoNodeKit::init();
    SoInteraction::init();
    SoTerrain::init();
    if (defaultHandler) return;
    defaultHandler = SoDebugError::getHandlerCallback();
    SoDebugError::setHandlerCallback(passOn, SoDebugError::getHandlerData());
}

}  // namespace app
