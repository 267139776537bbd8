// What the colours of the debug views mean.
#pragma once

#include <cstddef>
#include <span>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "lod/DrawnPatch.h"

namespace terrain {

/// Red, green, blue from 0 to 1.
using Colour = glm::vec3;

/// Level of a triangle with these corners in (column, row): log2 of the size, in samples, of the cell that it is half of, rounded
/// down. 0 is full detail, below 0 finer than the samples. Of a triangle without area it is that of its longest side.
int levelOf(glm::vec2 a, glm::vec2 b, glm::vec2 c);

/// Colour of a level, ordered from bright yellow (0) over green and blue to dark violet (kCoarsestLevel and coarser), in steps that
/// also those tell apart who do not see red or green as others do (viridis, by Smith and van der Walt); levels below 0 are paler.
inline constexpr int kFinestLevel = -4, kCoarsestLevel = 9;
Colour levelColour(int level);

/// One of sixteen colours. Neighbours, corner to corner, have another one unless their sizes differ by a factor of sixteen.
Colour patchColour(const DrawnPatch& patch);
inline constexpr Colour kGapColour{0.25f, 0.25f, 0.25f};

/// Colour of an error that is `part` of the allowed one: dark blue at 0, over green and yellow to red at 1, in between linear;
/// above 1, but for rounding, magenta.
Colour errorColour(float part);
/// Colours at even steps of `part` from 0 to 1.
std::span<const Colour> errorRamp();
inline constexpr Colour kBrokenColour{1.0f, 0.0f, 1.0f};
inline constexpr float kRounding = 1e-3f;

/// Of what is loaded: there as wanted, in place of something finer, new in this frame, new and in place of something finer.
inline constexpr Colour kSettledColour{0.72f, 0.72f, 0.70f}, kStandInColour{0.90f, 0.45f, 0.10f}, kNewColour{0.20f, 0.75f, 0.95f},
    kNewStandInColour{0.97f, 0.85f, 0.30f};
/// There as wanted, but for the texture.
inline constexpr Colour kTextureToComeColour{0.72f, 0.55f, 0.88f};
Colour loadingColour(const DrawnPatch& patch);

/// How bright a face with this unit normal is drawn, from kDarkest to 1: as if light came from the upper left. `up`: unit vector.
inline constexpr float kDarkest = 0.62f;
float slopeShade(const glm::vec3& normal, const glm::vec3& up);

/// Black or white, whichever is seen better on a colour.
Colour lineColourOn(const Colour& colour);

}  // namespace terrain
