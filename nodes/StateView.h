// The camera of the traversal state.
#ifndef SOTERRAIN_STATEVIEW_H
#define SOTERRAIN_STATEVIEW_H

#include <Inventor/SbMatrix.h>
#include <Inventor/elements/SoGLViewingMatrixElement.h>
#include <Inventor/elements/SoModelMatrixElement.h>
#include <Inventor/elements/SoProjectionMatrixElement.h>
#include <Inventor/elements/SoViewportRegionElement.h>

#include "base/View.h"

/// Coin multiplies row vectors from the left, GLM column vectors from the right, and both store the same numbers in the same order.
inline glm::dmat4 toGlm(const SbMatrix & matrix)
{
    glm::dmat4 result;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) result[i][j] = matrix[i][j];
    return result;
}

/// From the local coordinates of the node that is traversed to its viewport, while rendering. SoViewingMatrixElement leads from the
/// world to the eye only where no transform stands before the camera; what SoResetTransform goes back to does everywhere.
inline terrain::View viewOf(SoState * state)
{
    terrain::View view;
    view.clipFromLocal = toGlm(SoProjectionMatrixElement::get(state)) * toGlm(SoGLViewingMatrixElement::getResetMatrix(state)) *
                         toGlm(SoModelMatrixElement::get(state));
    const SbVec2s size = SoViewportRegionElement::get(state).getViewportSizePixels();
    view.viewportPixels = {size[0], size[1]};
    return view;
}

#endif
