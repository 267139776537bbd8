// Where on a terrain its texture is looked at most closely.
#ifndef SOTERRAIN_TEXTUREFOCUS_H
#define SOTERRAIN_TEXTUREFOCUS_H

#include <glm/vec2.hpp>

#include "base/View.h"
#include "gl/TextureClipmap.h"
#include "height/SampleGrid.h"

class SoState;
class StateAttributes;

/// The ground in view that is nearest to the viewer: his own place, or where the view first meets the plane that he stands on; what lies
/// ahead is more in view than what lies behind. For a curved grid it is the sample nearest to him. What is looked at by an orthographic
/// camera is equally near everywhere; then it is the middle of the view. In texture coordinates after the texture matrix of unit 0.
/// `texels`: the size of the image.
terrain::TextureClipmap::Focus findTextureFocus(SoState * state, const terrain::View & camera, const terrain::SampleGrid & grid,
                                                const StateAttributes & attributes, glm::dvec2 texels);

#endif
