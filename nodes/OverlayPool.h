// What overlays need of each context.
#ifndef SOTERRAIN_OVERLAYPOOL_H
#define SOTERRAIN_OVERLAYPOOL_H

#include <memory>

#include "gl/Overlay.h"

class SoState;

/// Those of the context that is being drawn to; contexts of one cache context id share them. They are deleted when Coin is told that the
/// id's last context goes.
std::shared_ptr<terrain::OverlayResources> overlayResourcesOf(SoState * state);

#endif
