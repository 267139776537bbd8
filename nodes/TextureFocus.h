// Where on a terrain its texture is looked at most closely.
#ifndef SOTERRAIN_TEXTUREFOCUS_H
#define SOTERRAIN_TEXTUREFOCUS_H

#include <glm/vec2.hpp>

#include "base/View.h"
#include "height/SampleGrid.h"

class SoState;
class StateAttributes;

struct TextureFocus {
    glm::dvec2 place{0.5, 0.5};  ///< in texture coordinates, after the texture matrix of unit 0
    int finestLevel = 0;         ///< of an image of `texels`: finer levels show nowhere
};

/// The ground in view that is nearest to the viewer: his own place, or where the view first meets the plane that he stands on. For a curved grid the sample
/// nearest to him. What is looked at from above by an orthographic camera is equally near everywhere; then it is the middle of the view.
TextureFocus findTextureFocus(SoState * state, const terrain::View & camera, const terrain::SampleGrid & grid,
                              const StateAttributes & attributes, glm::dvec2 texels);

#endif
