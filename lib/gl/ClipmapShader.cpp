#include "gl/ClipmapShader.h"

#include "gl/TextureClipmap.h"

namespace terrain {

namespace {

const char* const kVertexShader = R"(
in ivec2 corner;
in ivec4 patchRect;
in int patchLevel;

uniform sampler2DArray heights;
uniform int mask, layerMask, coarsest, blendedLevel;
uniform ivec2 lastUnit, baseUnit;
uniform float samplesPerUnit, transition, inner, leastBlend;
uniform ivec2 places[LEVELS];   // first vertex of the level
uniform vec2 viewers[LEVELS];   // behind the first vertex
uniform ivec4 borders[LEVELS];  // of what is there, where less than all is
uniform mat4 clipFromFrame, eyeFromFrame;
uniform mat3x2 textureFromSample;

#ifdef EYE
out vec3 eyePoint;
#endif
#ifdef HOLES
out vec2 cellPlace;
#endif
out vec2 normalPlace;
out vec2 texturePlace;
out float share;
flat out int level;

void main()
{
    level = patchLevel;
    ivec2 v = min(patchRect.xy + corner, patchRect.zw), begin = places[level], behind = v - begin;
    ivec2 unit = clamp(v << level, ivec2(0), lastUnit);
    vec2 z = texelFetch(heights, ivec3(v & mask, level & layerMask), 0).rg;

    // ClipmapLayout::blend() and Clipmap::blend().
    share = 0.0;
    if (level < coarsest) {
        vec2 away = abs(vec2(behind) - viewers[level]);
        share = clamp((max(away.x, away.y) - inner) / transition, 0.0, 1.0);
        ivec4 inside = ivec4(v - borders[level].xy, borders[level].zw - v);
        int least = min(min(inside.x, inside.y), min(inside.z, inside.w));
        share = max(share, 1.0 - clamp(float(least) / transition, 0.0, 1.0));
        if (any(lessThanEqual(behind, ivec2(0))) || any(greaterThanEqual(behind, ivec2(mask - 1)))) share = 1.0;
        if (level == blendedLevel) share = max(share, leastBlend);
    }
    float height = share >= 1.0 ? z.y : z.x + share * (z.y - z.x);
    if (isnan(height)) height = 0.0;

    vec4 point = vec4(vec2(unit - baseUnit) * samplesPerUnit, height, 1.0);
    gl_Position = clipFromFrame * point;
#ifdef CLIP
    gl_ClipVertex = eyeFromFrame * point;
#endif
#ifdef EYE
    eyePoint = (eyeFromFrame * point).xyz;
#endif
#ifdef HOLES
    cellPlace = vec2(behind);
#endif
    normalPlace = (2.0 * vec2(behind + (begin & mask)) + 0.5) / float(2 * (mask + 1));
    texturePlace = (gl_TextureMatrix[0] * vec4(textureFromSample * vec3(vec2(unit) * samplesPerUnit, 1.0), 0.0, 1.0)).st;
}
)";

const char* const kFragmentHead = R"(
uniform sampler2DArray heights, normals;
uniform int mask, layerMask;
uniform ivec2 places[LEVELS];
uniform sampler2D colourTexture;
uniform vec4 colourOfAll;

#ifdef EYE
in vec3 eyePoint;
#endif
#ifdef HOLES
in vec2 cellPlace;
#endif
in vec2 normalPlace;
in vec2 texturePlace;
in float share;
flat in int level;
)";

const char* const kNormal = R"(
uniform float normalBlend;

vec3 frameNormal()
{
    vec4 both = texture(normals, vec3(normalPlace, float(level & layerMask))) * (255.0 / 127.0) - 128.0 / 127.0;
    vec2 n = mix(both.xy, both.zw, normalBlend * share);
    return vec3(n, sqrt(max(0.0, 1.0 - dot(n, n))));
}
)";

/// Directional lights, by the light's direction in the axes of normals.
const char* const kMattLighting = R"(
uniform vec3 ambientOfAll;
uniform vec3 lightDirections[LIGHTS + 1], lightColours[LIGHTS + 1];

vec4 litColour()
{
    vec3 normal = frameNormal(), colour = ambientOfAll;
#ifdef TWO_SIDED
    if (!gl_FrontFacing) normal = -normal;
#endif
    for (int i = 0; i < LIGHTS; ++i) colour += max(dot(normal, lightDirections[i]), 0.0) * lightColours[i];
    return vec4(min(colour, 1.0), colourOfAll.a);
}
)";

/// Per-pixel lighting by the formulas of fixed function (GL 2.1 specification, sect. 2.14.1).
const char* const kLighting = R"(
uniform bool localViewer;
uniform mat3 eyeFromNormal;

vec3 normalHere()
{
    vec3 normal = normalize(eyeFromNormal * frameNormal());
#ifdef TWO_SIDED
    if (!gl_FrontFacing) normal = -normal;
#endif
    return normal;
}

vec3 lightBy(int i, vec3 normal, vec3 diffuse)
{
    vec4 source = gl_LightSource[i].position;
    vec3 toLight = source.xyz - eyePoint * source.w;
    float distance = length(toLight), strength = 1.0;
    toLight /= max(distance, 1e-30);
    if (source.w != 0.0) {
        distance /= abs(source.w);
        strength = 1.0 / (gl_LightSource[i].constantAttenuation + distance * (gl_LightSource[i].linearAttenuation +
                                                                             distance * gl_LightSource[i].quadraticAttenuation));
        if (gl_LightSource[i].spotCutoff < 180.0) {
            float along = dot(-toLight, normalize(gl_LightSource[i].spotDirection));
            strength *= along < gl_LightSource[i].spotCosCutoff ? 0.0 : pow(max(along, 0.0), gl_LightSource[i].spotExponent);
        }
    }
    float facing = dot(normal, toLight);
    vec3 colour = gl_LightSource[i].ambient.rgb * gl_FrontMaterial.ambient.rgb;
    if (facing > 0.0) {
        vec3 toEye = localViewer ? normalize(-eyePoint) : vec3(0.0, 0.0, 1.0);
        float shine = max(dot(normal, normalize(toLight + toEye)), 0.0);
        colour += facing * gl_LightSource[i].diffuse.rgb * diffuse;
        colour += (gl_FrontMaterial.shininess > 0.0 ? pow(shine, gl_FrontMaterial.shininess) : 1.0) * gl_LightSource[i].specular.rgb *
                  gl_FrontMaterial.specular.rgb;
    }
    return strength * colour;
}

vec4 litColour()
{
    vec3 normal = normalHere(), colour = gl_FrontMaterial.emission.rgb + gl_LightModel.ambient.rgb * gl_FrontMaterial.ambient.rgb;
    for (int i = 0; i < LIGHTS; ++i) colour += lightBy(i, normal, colourOfAll.rgb);
    return vec4(clamp(colour, 0.0, 1.0), colourOfAll.a);
}
)";

const char* const kFragmentMain = R"(
void main()
{
#ifdef HOLES
    // A cell that lacks a corner is not there.
    ivec2 cell = places[level] + ivec2(floor(cellPlace));
    int from = level & layerMask;
    if (isnan(texelFetch(heights, ivec3(cell & mask, from), 0).r + texelFetch(heights, ivec3((cell + ivec2(1, 0)) & mask, from), 0).r +
              texelFetch(heights, ivec3((cell + ivec2(0, 1)) & mask, from), 0).r + texelFetch(heights, ivec3((cell + 1) & mask, from), 0).r))
        discard;
#endif
    vec4 colour = COLOUR;
    TEXTURE
#ifdef SHOW_LEVELS
    float hue = 0.618034 * float(level);
    vec3 tint = clamp(abs(fract(hue + vec3(0.0, 2.0 / 3.0, 1.0 / 3.0)) * 6.0 - 3.0) - 1.0, 0.0, 1.0);
    colour.rgb = mix(colour.rgb * (0.4 + 0.6 * tint), vec3(1.0), 0.5 * share);
#endif
    FOG
    gl_FragColor = colour;
}
)";

const char* textureCode(ClipmapShading::Texture texture) {
    switch (texture) {
    case ClipmapShading::Modulate:
        return "colour *= texture(colourTexture, texturePlace);";
    case ClipmapShading::Decal:
        return "vec4 t = texture(colourTexture, texturePlace); colour.rgb = mix(colour.rgb, t.rgb, t.a);";
    case ClipmapShading::Blend:
        return "vec4 t = texture(colourTexture, texturePlace); colour = vec4(mix(colour.rgb, gl_TextureEnvColor[0].rgb, t.rgb), "
               "colour.a * t.a);";
    case ClipmapShading::Replace:
        return "colour.rgb = texture(colourTexture, texturePlace).rgb;";
    case ClipmapShading::ReplaceAlpha:
        return "colour = texture(colourTexture, texturePlace);";
    case ClipmapShading::TextureClipmapModulate:
        return "colour *= terrainTexture(texturePlace);";
    default:
        return "";
    }
}

const char* fogCode(ClipmapShading::Fog fog) {
    switch (fog) {
    case ClipmapShading::LinearFog:
        return "colour.rgb = mix(gl_Fog.color.rgb, colour.rgb, clamp((gl_Fog.end - abs(eyePoint.z)) * gl_Fog.scale, 0.0, 1.0));";
    case ClipmapShading::ExpFog:
        return "colour.rgb = mix(gl_Fog.color.rgb, colour.rgb, clamp(exp(-gl_Fog.density * abs(eyePoint.z)), 0.0, 1.0));";
    case ClipmapShading::Exp2Fog:
        return "float thick = gl_Fog.density * abs(eyePoint.z); colour.rgb = mix(gl_Fog.color.rgb, colour.rgb, clamp(exp(-thick * "
               "thick), "
               "0.0, 1.0));";
    default:
        return "";
    }
}

void replace(std::string& text, const std::string& word, const std::string& by) {
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + by.size()))
        text.replace(at, word.size(), by);
}

}  // namespace

Result<GlProgram> buildClipmapProgram(const ClipmapShading& shading) {
    const bool isLit = shading.lights >= 0;
    std::string head = "#version 130\n#define LEVELS " + std::to_string(kClipmapShaderLevels) + "\n";
    const auto define = [&head](bool when, const char* what) {
        if (when) head += std::string("#define ") + what + "\n";
    };
    define(shading.holes, "HOLES");
    define(shading.showLevels, "SHOW_LEVELS");
    define(shading.twoSided, "TWO_SIDED");
    define(shading.clipPlanes, "CLIP");
    define((isLit && !shading.isMatt) || shading.fog != ClipmapShading::NoFog, "EYE");
    if (isLit) head += "#define LIGHTS " + std::to_string(shading.lights) + "\n";
    std::string fragment = head + kFragmentHead;
    if (shading.texture == ClipmapShading::TextureClipmapModulate) fragment += TextureClipmap::glsl();
    if (isLit) fragment += std::string(kNormal) + (shading.isMatt ? kMattLighting : kLighting);
    std::string main = kFragmentMain;
    replace(main, "COLOUR", isLit ? "litColour()" : "colourOfAll");
    replace(main, "TEXTURE", textureCode(shading.texture));
    replace(main, "FOG", fogCode(shading.fog));
    return GlProgram::build("shader of a geometry clipmap", head + kVertexShader, fragment + main,
                            {{"corner", kCornerAttribute}, {"patchRect", kPatchAttribute}, {"patchLevel", kLevelAttribute}});
}

std::string nameOf(const ClipmapShading& shading) {
    std::string name = "clipmap";
    for (const int part : {shading.lights, int(shading.isMatt), int(shading.twoSided), int(shading.clipPlanes), int(shading.fog),
                           int(shading.texture), int(shading.holes), int(shading.showLevels)})
        name += ' ' + std::to_string(part);
    return name;
}

}  // namespace terrain
