// Synthesised detail on the GPU: the same heights as SynthesisedDetail computes, bit for bit.
#pragma once

#include <epoxy/gl.h>

#include "lod/SynthesisedDetail.h"

namespace terrain {

/// Functions in GLSL 1.30, to be put after the #version line of a shader of any stage:
///
///     float detailNoise(ivec2 vertex, int level);
///     float detailPrediction(ivec2 vertex, ivec2 lastCoarser);
///     float detailHeight(ivec2 vertex, int level, ivec2 lastCoarser);
///
/// The first is SynthesisedDetail::noise(), for levels from 1 on; the second is the four-point subdivision alone, which is also
/// what levels of the data itself are predicted by; the last is the height of a vertex in the grid, with noise where it is odd.
/// `lastCoarser` is lastVertex() of level - 1. The shader itself must have `float coarserHeightAt(ivec2 vertex)`, the height of a
/// vertex of level - 1 from (0, 0) to lastCoarser, NaN in a hole: of up to sixteen around the one asked for.
const char* detailShaderSource();

/// The table of noise as a new texture, kNoiseValues x 1 of R32F, bound to GL_TEXTURE_2D of the active unit. To be made anew when
/// the amplitude changes.
GLuint makeNoiseTexture(const SynthesisedDetail& detail);

/// Sets what the functions take from uniforms of `program`, which must be in use: the texture unit of the table, and the seed.
void setDetailUniforms(GLuint program, const SynthesisedDetail& detail, int unit);

}  // namespace terrain
