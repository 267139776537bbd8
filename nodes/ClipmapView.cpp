#include "ClipmapView.h"

#include <chrono>
#include <cmath>

#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/elements/SoGLShaderProgramElement.h>
#include <Inventor/elements/SoMultiTextureEnabledElement.h>
#include <Inventor/elements/SoMultiTextureMatrixElement.h>
#include <Inventor/elements/SoTextureCombineElement.h>
#include <Inventor/misc/SoState.h>

#include <SoTerrain/SoTerrainStatistics.h>

#include "ProgramPools.h"

#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>

namespace {

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start)
{
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

glm::dmat4 matrixOf(GLenum which)
{
    glm::dmat4 matrix;
    glGetDoublev(which, glm::value_ptr(matrix));
    return matrix;
}

bool isOn(GLenum which)
{
    GLboolean on = GL_FALSE;
    glGetBooleanv(which, &on);
    return on == GL_TRUE;
}

glm::vec3 lightColour(GLenum light, GLenum which)
{
    GLfloat colour[4];
    glGetLightfv(light, which, colour);
    return {colour[0], colour[1], colour[2]};
}

glm::vec3 materialColour(GLenum which)
{
    GLfloat colour[4];
    glGetMaterialfv(GL_FRONT, which, colour);
    return {colour[0], colour[1], colour[2]};
}

/// What directional lights do to matt ground, worked out once for all pixels. False where it takes more than that.
bool lightMatt(const glm::dmat3 & eyeFromNormal, terrain::ClipmapDrawing & drawing)
{
    // Of a matrix that turns only, or turns and scales evenly, normals keep their angles to lights.
    const double scale = glm::length(eyeFromNormal[0]);
    const glm::dmat3 square = glm::transpose(eyeFromNormal) * eyeFromNormal / (scale * scale);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (std::fabs(square[i][j] - (i == j ? 1.0 : 0.0)) > 1e-4) return false;
    const bool shines = materialColour(GL_SPECULAR) != glm::vec3(0.0f);
    GLfloat scene[4];
    glGetFloatv(GL_LIGHT_MODEL_AMBIENT, scene);
    const glm::vec3 ambient = materialColour(GL_AMBIENT);
    drawing.ambient = materialColour(GL_EMISSION) + ambient * glm::vec3(scene[0], scene[1], scene[2]);
    for (int i = 0; i < drawing.shading.lights; ++i) {
        const GLenum light = GLenum(GL_LIGHT0 + i);
        GLfloat position[4];
        glGetLightfv(light, GL_POSITION, position);
        if (position[3] != 0.0f || (shines && lightColour(light, GL_SPECULAR) != glm::vec3(0.0f))) return false;
        const glm::dvec3 direction = glm::normalize(glm::dvec3(position[0], position[1], position[2]));
        drawing.ambient += lightColour(light, GL_AMBIENT) * ambient;
        drawing.lightDirections.push_back(glm::vec3(glm::transpose(eyeFromNormal) * direction / scale));
        drawing.lightColours.push_back(lightColour(light, GL_DIFFUSE) * glm::vec3(drawing.colour));
    }
    return true;
}

bool hasClipPlanes()
{
    constexpr GLenum kMost = 6;
    for (GLenum plane = 0; plane < kMost; ++plane)
        if (glIsEnabled(GL_CLIP_PLANE0 + plane)) return true;
    return false;
}

/// What GL does with the texture of unit 0.
terrain::ClipmapShading::Texture textureModel()
{
    using Shading = terrain::ClipmapShading;
    GLint active = 0, mode = 0, alphaBits = 0;
    glGetIntegerv(GL_ACTIVE_TEXTURE, &active);
    glActiveTexture(GL_TEXTURE0);
    glGetTexEnviv(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, &mode);
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_ALPHA_SIZE, &alphaBits);
    glActiveTexture(GLenum(active));
    switch (mode) {
    case GL_DECAL: return Shading::Decal;
    case GL_BLEND: return Shading::Blend;
    case GL_REPLACE: return alphaBits > 0 ? Shading::ReplaceAlpha : Shading::Replace;
    default: return Shading::Modulate;
    }
}

/// Whether unit 0 is to draw a decal of luminance, which is up to the driver.
bool isUndefinedDecal()
{
    GLint active = 0, mode = 0, luminanceBits = 0;
    glGetIntegerv(GL_ACTIVE_TEXTURE, &active);
    glActiveTexture(GL_TEXTURE0);
    glGetTexEnviv(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, &mode);
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_LUMINANCE_SIZE, &luminanceBits);
    glActiveTexture(GLenum(active));
    return mode == GL_DECAL && luminanceBits > 0;
}

/// The program that GL's state asks for.
terrain::ClipmapShading shadingOf(const TerrainFrame & frame)
{
    using Shading = terrain::ClipmapShading;
    Shading shading;
    shading.lights = -1;
    if (glIsEnabled(GL_LIGHTING)) {
        constexpr int kMost = 8;
        shading.lights = 0;
        while (shading.lights < kMost && glIsEnabled(GLenum(GL_LIGHT0 + shading.lights))) ++shading.lights;
    }
    if (glIsEnabled(GL_FOG)) {
        GLint mode = 0;
        glGetIntegerv(GL_FOG_MODE, &mode);
        shading.fog = mode == GL_LINEAR ? Shading::LinearFog : mode == GL_EXP ? Shading::ExpFog : Shading::Exp2Fog;
    }
    SoState * state = frame.action->getState();
    if (frame.texture.clipmap) {
        shading.texture = Shading::TextureClipmapModulate;
    } else if (SoMultiTextureEnabledElement::get(state, 0)) {
        shading.texture = textureModel();
    }
    shading.holes = frame.data.model.boxes->hasHoles();
    return shading;
}

glm::mat3x2 textureFromSample(const TerrainFrame & frame)
{
    const terrain::SampleGrid & grid = frame.data.grid;
    const auto at = [&](int column, int row) {
        const SbVec2f place = frame.attributes.textureCoordinate(0, column, row);
        return glm::dvec2(place[0], place[1]);
    };
    const int columns = grid.columns() - 1, rows = grid.rows() - 1;
    const glm::dvec2 origin = at(0, 0);
    return glm::mat3x2(glm::vec2((at(columns, 0) - origin) / double(columns)), glm::vec2((at(0, rows) - origin) / double(rows)), glm::vec2(origin));
}

/// Eye coordinates of unit normals in the frame's axes.
glm::dmat3 eyeFromNormal(const glm::dmat4 & modelView, const glm::dmat4 & localFromFrame)
{
    glm::dmat3 axes;
    for (int i = 0; i < 3; ++i) axes[i] = glm::normalize(glm::dvec3(localFromFrame[i]));
    return glm::transpose(glm::inverse(glm::dmat3(modelView))) * axes;
}

}  // namespace

ClipmapView::ClipmapView(const TerrainFrame & frame, const terrain::ClipmapShape & shape, bool memoryFree,
                         std::shared_ptr<const terrain::SynthesisedDetail> detail)
    : shape_(shape), memoryFree_(memoryFree), detail_(std::move(detail)), clipmap_(terrain::ClipmapLayout(frame.data.grid.columns(), frame.data.grid.rows(), shape)),
      renderer_(clipmap_.layout(), memoryFree, programPoolOf(frame.action->getState()))
{
}

terrain::ClipmapDrawing ClipmapView::drawingOf(const TerrainFrame & frame, const ClipmapOptions & options)
{
    const glm::dmat4 & localFromFrame = frame.data.grid.localFromFrame();
    const glm::dmat4 modelView = matrixOf(GL_MODELVIEW_MATRIX);
    terrain::ClipmapDrawing drawing;
    drawing.shading = shadingOf(frame);
    drawing.shading.showLevels = options.showLevels;
    drawing.eyeFromFrame = modelView * localFromFrame;
    drawing.clipFromFrame = matrixOf(GL_PROJECTION_MATRIX) * drawing.eyeFromFrame;
    drawing.eyeFromNormal = eyeFromNormal(modelView, localFromFrame);
    drawing.textureFromSample = textureFromSample(frame);
    drawing.clockwise = frame.settings.clockwise;
    drawing.shading.twoSided = drawing.shading.lights >= 0 && isOn(GL_LIGHT_MODEL_TWO_SIDE);
    drawing.shading.clipPlanes = hasClipPlanes();
    glGetFloatv(GL_CURRENT_COLOR, glm::value_ptr(drawing.colour));
    if (drawing.shading.lights >= 0) drawing.shading.isMatt = lightMatt(drawing.eyeFromNormal, drawing);
    drawing.localViewer = isOn(GL_LIGHT_MODEL_LOCAL_VIEWER);
    drawing.blendNormals = options.blendNormals;
    drawing.texture = frame.texture.clipmap;
    return drawing;
}

std::optional<terrain::Error> ClipmapView::render(const TerrainFrame & frame, const ClipmapOptions & options, const terrain::ClipmapErrors * errors,
                                                  SoTerrainStatistics & statistics)
{
    const terrain::SampleGrid & grid = frame.data.grid;
    const terrain::ClipmapDrawing drawing = drawingOf(frame, options);
    if (problem_ && problemShading_ == drawing.shading) return problem_;
    problem_.reset();
    const Clock::time_point start = Clock::now();
    const terrain::Clipmap::Frame & chosen = options.freeze && hasFrame_
                                                 ? clipmap_.again()
                                                 : clipmap_.select(grid, *frame.data.model.boxes, errors, frame.camera, options.settings);
    hasFrame_ = true;
    statistics.selectMilliseconds = millisecondsSince(start);

    const Clock::time_point selected = Clock::now();
    const glm::dmat4 & localFromFrame = grid.localFromFrame();
    const auto length = [&](int axis) { return glm::length(glm::dvec3(localFromFrame[axis])); };
    const terrain::ClipmapTextures::Source source{grid, detail_.get(), glm::vec2(length(2) / length(0), length(2) / length(1)), clipmap_.valid()};
    const auto drawn = renderer_.draw(chosen, source, drawing);
    if (!drawn) {
        terrain::deleteNames(release());
        hasFrame_ = false;
        problemShading_ = drawing.shading;
        return problem_ = drawn.error();
    }
    statistics.drawMilliseconds = millisecondsSince(selected);
    statistics.uploadedBytes = drawn.value().uploadedBytes;
    statistics.drawCalls = std::uint32_t(drawn.value().draws);
    statistics.triangles = std::uint32_t(drawn.value().triangles);
    statistics.patches = chosen.report.patches;
    frame.view.report = chosen.report;
    return std::nullopt;
}

std::vector<terrain::GlName> ClipmapView::release()
{
    // What is drawn with it again has to be brought again.
    clipmap_.forget();
    return renderer_.release();
}

namespace {

/// Whether the matrix of unit 0 divides what it gives.
bool hasProjectiveTextureMatrix(SoState * state)
{
    const SbMatrix & m = SoMultiTextureMatrixElement::get(state, 0);
    return m[0][3] != 0.0f || m[1][3] != 0.0f || m[3][3] != 1.0f;
}

std::string whyNotTextured(const TerrainFrame & frame)
{
    SoState * state = frame.action->getState();
    int last = -1;
    const SbBool * enabled = SoMultiTextureEnabledElement::getEnabledUnits(state, last);
    for (int unit = 1; unit <= last && enabled; ++unit)
        if (enabled[unit]) return "texture unit " + std::to_string(unit) + " is in use";
    const bool hasTexture = last >= 0 && enabled && enabled[0];
    if (!hasTexture && !frame.texture.clipmap) return std::string();
    if (frame.attributes.hasTextureFunction(0)) return "texture coordinates come from a function";
    if (hasProjectiveTextureMatrix(state)) return "the texture matrix is a perspective one";
    if (frame.texture.clipmap) return std::string();
    if (SoMultiTextureEnabledElement::getMode(state, 0) != SoMultiTextureEnabledElement::TEXTURE2D) return "the texture is not two-dimensional";
    if (!SoTextureCombineElement::isDefault(state, 0)) return "an SoTextureCombine is active";
    if (isUndefinedDecal()) return "GL does not define DECAL for textures of one or two components";
    return std::string();
}

}  // namespace

std::string whyNotOnGpu(const TerrainFrame & frame, const terrain::ClipmapLayout & layout, bool isAffine)
{
    SoState * state = frame.action->getState();
    if (!frame.data.grid.isRegular()) return "the coordinates are no regular grid";
    if (SoGLShaderProgramElement::get(state)) return "an SoShaderProgram is active";
    if (frame.attributes.format().colours) return "there is a material for each vertex, face or row";
    if (frame.attributes.hasOverallNormal()) return "there is one normal for all";
    if (glIsEnabled(GL_FRAGMENT_PROGRAM_ARB)) return "the transparency type draws by a fragment program";
    if (const std::string reason = whyNotTextured(frame); !reason.empty()) return reason;
    if (!isAffine) return "texture coordinates are no linear function of columns and rows";
    if (const auto missing = terrain::ClipmapRenderer::whatIsMissing(layout)) return missing->message();
    return std::string();
}
