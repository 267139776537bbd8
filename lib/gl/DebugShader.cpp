#include "gl/DebugShader.h"

#include <algorithm>
#include <utility>

#include <glm/gtc/type_ptr.hpp>

#include "lod/DebugColours.h"

namespace terrain {

namespace {

const std::vector<std::pair<const char*, GLuint>> kAttributes = {{"corner", GLuint(DebugAttribute::Corner)},
                                                                 {"base", GLuint(DebugAttribute::Base)},
                                                                 {"offset", GLuint(DebugAttribute::Offset)},
                                                                 {"shade", GLuint(DebugAttribute::Shade)}};

// ftransform() gives the depth that fixed functions give.
constexpr const char* kErrorVertex = R"(#version 130
in vec3 base;
in vec3 offset;
in float shade;
flat out vec3 from;
smooth out vec3 way;
smooth out float brightness;

void main()
{
    from = base;
    way = offset;
    brightness = shade;
    gl_Position = ftransform();
    gl_ClipVertex = gl_ModelViewMatrix * gl_Vertex;
}
)";

constexpr const char* kErrorFragment = R"(#version 130
uniform sampler2D heights;
uniform ivec2 lastCell;
uniform vec2 halfViewport, viewportCentre;
uniform vec3 clipPerHeight;  // x, y and w that a unit of height adds in clip space
uniform float allowed, rounding;
uniform vec3 ramp[5], broken;
flat in vec3 from;
smooth in vec3 way;
smooth in float brightness;

float heightAt(ivec2 vertex)
{
    return texelFetch(heights, vertex, 0).r;
}

// From the drawn surface to the cell cut along either diagonal.
float deviation()
{
    vec2 place = from.xy + way.xy;
    ivec2 cell = clamp(ivec2(floor(place)), ivec2(0), lastCell);
    vec2 at = (from.xy - vec2(cell)) + way.xy;
    float a = heightAt(cell), b = heightAt(cell + ivec2(1, 0)), c = heightAt(cell + ivec2(0, 1)), d = heightAt(cell + ivec2(1, 1));
    float one = at.x + at.y <= 1.0 ? a + (b - a) * at.x + (c - a) * at.y : d + (c - d) * (1.0 - at.x) + (b - d) * (1.0 - at.y);
    float other = at.x >= at.y ? a + (b - a) * at.x + (d - b) * at.y : a + (d - c) * at.x + (c - a) * at.y;
    float below = (min(one, other) - from.z) - way.z, above = (max(one, other) - from.z) - way.z;
    return below > 0.0 ? below : above < 0.0 ? above : 0.0;
}

vec3 colourOf(float part)
{
    if (!(part <= 1.0 + rounding)) return broken;
    float at = clamp(part, 0.0, 1.0) * 4.0;
    int first = min(int(at), 3);
    return mix(ramp[first], ramp[first + 1], at - float(first));
}

void main()
{
    float e = deviation();
    vec2 here = (gl_FragCoord.xy - viewportCentre) / halfViewport;
    float depth = 1.0 / gl_FragCoord.w + e * clipPerHeight.z;
    vec2 shown = halfViewport * (clipPerHeight.xy - here * clipPerHeight.z) * (e / depth);
    float part = depth > 0.0 || e == 0.0 ? length(shown) / allowed : 2.0;
    gl_FragColor = vec4(colourOf(part) * brightness, 1.0);
}
)";

constexpr const char* kEdgeVertex = R"(#version 130
in float corner;
smooth out vec3 share;
smooth out vec3 colour;

void main()
{
    share = vec3(equal(ivec3(0, 1, 2), ivec3(int(corner + 0.5))));
    colour = gl_Color.rgb;
    gl_Position = ftransform();
    vec4 eye = gl_ModelViewMatrix * gl_Vertex;
    gl_ClipVertex = eye;
    gl_FogFragCoord = abs(eye.z);
}
)";

constexpr const char* kEdgeFragment = R"(#version 130
uniform int fog;
smooth in vec3 share;
smooth in vec3 colour;

void main()
{
    // Height of each corner over the opposite side, and the distance to that side, in pixels.
    vec3 high = 1.0 / max(sqrt(dFdx(share) * dFdx(share) + dFdy(share) * dFdy(share)), vec3(1e-6));
    vec3 away = share * high;
    float line = 1.0 - min(min(away.x, away.y), away.z);
    if (line <= 0.0) discard;
    // Where triangles are hardly wider than lines these would hide all.
    float least = min(min(high.x, high.y), high.z);
    float strength = mix(0.25, 0.8, smoothstep(2.0, 8.0, least));
    float far = gl_FogFragCoord, seen = 1.0;
    if (fog == 1) seen = (gl_Fog.end - far) * gl_Fog.scale;
    if (fog == 2) seen = exp(-gl_Fog.density * far);
    if (fog == 3) seen = exp(-gl_Fog.density * far * gl_Fog.density * far);
    gl_FragColor = vec4(colour, min(line, 1.0) * strength * clamp(seen, 0.0, 1.0));
}
)";

}  // namespace

Result<GlProgram> buildErrorProgram() {
    return GlProgram::build("debugView ERRORS", kErrorVertex, kErrorFragment, kAttributes);
}

Result<GlProgram> buildEdgeProgram() {
    return GlProgram::build("wireframeOverlay", kEdgeVertex, kEdgeFragment, kAttributes);
}

void setErrorUniforms(GlProgram& program, const SampleGrid& grid, const View& view, float allowedPixels, int unit) {
    const glm::dvec4 perHeight = view.clipFromLocal * grid.localFromFrame()[2];
    GLint viewport[4];
    glGetIntegerv(GL_VIEWPORT, viewport);
    const float halfWidth = 0.5f * float(viewport[2]), halfHeight = 0.5f * float(viewport[3]);
    glUniform1i(program["heights"], unit);
    glUniform2i(program["lastCell"], grid.columns() - 2, grid.rows() - 2);
    glUniform2f(program["halfViewport"], halfWidth, halfHeight);
    glUniform2f(program["viewportCentre"], float(viewport[0]) + halfWidth, float(viewport[1]) + halfHeight);
    glUniform3f(program["clipPerHeight"], float(perHeight.x), float(perHeight.y), float(perHeight.w));
    glUniform1f(program["allowed"], allowedPixels);
    glUniform1f(program["rounding"], kRounding);
    glUniform3fv(program["ramp"], GLsizei(errorRamp().size()), glm::value_ptr(errorRamp()[0]));
    glUniform3fv(program["broken"], 1, glm::value_ptr(kBrokenColour));
}

std::optional<Error> HeightTexture::whyNot(const SampleGrid& grid) {
    if (!grid.isRegular()) return Error{"debugView ERRORS", "a regular grid", "curved coordinates"};
    GLint most = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
    const std::string size = std::to_string(grid.columns()) + " x " + std::to_string(grid.rows());
    if (grid.columns() > most || grid.rows() > most)
        return Error{"debugView ERRORS", "at most " + std::to_string(most) + " samples along a side", size};
    if (std::size_t(grid.columns()) * std::size_t(grid.rows()) > kMostSamples)
        return Error{"debugView ERRORS", "at most " + std::to_string(kMostSamples) + " samples", size};
    return std::nullopt;
}

void HeightTexture::bind(const SampleGrid& grid, std::uint64_t version) {
    const bool isNew = name_ == 0;
    if (isNew) glGenTextures(1, &name_);
    glBindTexture(GL_TEXTURE_2D, name_);
    if (isNew || version != version_) send(grid);
    version_ = version;
}

void HeightTexture::send(const SampleGrid& grid) {
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    glPushClientAttrib(GL_CLIENT_PIXEL_STORE_BIT);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    glPixelStorei(GL_UNPACK_SKIP_PIXELS, 0);
    glPixelStorei(GL_UNPACK_SKIP_ROWS, 0);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R32F, grid.columns(), grid.rows(), 0, GL_RED, GL_FLOAT, nullptr);
    std::vector<float> row(std::size_t(grid.columns()));
    for (int y = 0; y < grid.rows(); ++y) {
        const float* heights = grid.heightRow(y);
        for (std::size_t x = 0; x < row.size(); ++x) row[x] = heights[x * grid.heightStride()];
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, y, grid.columns(), 1, GL_RED, GL_FLOAT, row.data());
        grid.releaseRows(y, 1);
    }
    glPopClientAttrib();
    bytes_ = std::size_t(grid.columns()) * std::size_t(grid.rows()) * sizeof(float);
}

}  // namespace terrain
