// The program that draws a geometry clipmap under Coin's lights, material, texture and fog.
#pragma once

#include <string>
#include <tuple>

#include "base/Result.h"
#include "gl/GlProgram.h"

namespace terrain {

/// What a program is made for. All else comes from GL's state and from uniforms.
struct ClipmapShading {
    enum Fog { NoFog, LinearFog, ExpFog, Exp2Fog };
    enum Texture { NoTexture, Modulate, Decal, Blend, Replace, ReplaceAlpha, TextureClipmapModulate };

    int lights = 0;  ///< GL lights 0 to lights - 1 are on; -1: no lighting, colours as they are
    /// No light but directional ones, nothing specular, normals as long in eye coordinates as in the frame's axes: then what a
    /// pixel takes is a dot product for each light.
    bool isMatt = false;
    bool twoSided = false;
    bool clipPlanes = false;
    Fog fog = NoFog;
    Texture texture = NoTexture;
    bool holes = false;       ///< some vertices are not there
    bool showLevels = false;  ///< tint each level, and lighten where it blends into the next one

    auto operator<=>(const ClipmapShading&) const = default;
};

/// Most levels of a clipmap that a program has room for.
inline constexpr int kClipmapShaderLevels = 32;

/// Inputs of the vertex shader: `corner` (vertex of the footprint), `patchRect` (low and high of a ClipmapPatch), `patchLevel`.
enum ClipmapAttribute : unsigned { kCornerAttribute = 0, kPatchAttribute = 1, kLevelAttribute = 7 };

Result<GlProgram> buildClipmapProgram(const ClipmapShading& shading);
/// Another one for each program.
std::string nameOf(const ClipmapShading& shading);

}  // namespace terrain
