#include "TerrainTextureUse.h"

#include <utility>

#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/elements/SoGLShaderProgramElement.h>
#include <Inventor/elements/SoMultiTextureEnabledElement.h>
#include <Inventor/elements/SoTextureQualityElement.h>
#include <Inventor/misc/SoState.h>

#include <SoTerrain/SoTerrainTextureElement.h>

#include "ElementAccess.h"
#include "ProgramPools.h"
#include "StateAttributes.h"
#include "TextureFocus.h"

namespace {

/// Fixed function until the fragment: what it would do there, with the texture's colour.
constexpr const char * kBegin = "#version 130\n";
constexpr const char * kMain = R"(
uniform int terrainTextureFog;

void main()
{
    vec4 colour = gl_Color;
    colour.rgb *= terrainTexture(gl_TexCoord[0].st / gl_TexCoord[0].q).rgb;
    float distance = abs(gl_FogFragCoord), seen = 1.0;
    if (terrainTextureFog == 1) seen = (gl_Fog.end - distance) * gl_Fog.scale;
    if (terrainTextureFog == 2) seen = exp(-gl_Fog.density * distance);
    if (terrainTextureFog == 3) seen = exp(-gl_Fog.density * distance * gl_Fog.density * distance);
    gl_FragColor = vec4(mix(gl_Fog.color.rgb, colour.rgb, clamp(seen, 0.0, 1.0)), colour.a);
}
)";

int fogNow()
{
    if (!glIsEnabled(GL_FOG)) return 0;
    GLint mode = 0;
    glGetIntegerv(GL_FOG_MODE, &mode);
    return mode == GL_LINEAR ? 1 : mode == GL_EXP ? 2 : 3;
}

terrain::Result<terrain::GlProgram> buildProgram()
{
    return terrain::GlProgram::build("SoTerrainTexture", std::string(), std::string(kBegin) + terrain::TextureClipmap::glsl() + kMain, {});
}

bool hasFurtherTextures(SoState * state)
{
    int last = -1;
    const SbBool * enabled = SoMultiTextureEnabledElement::getEnabledUnits(state, last);
    for (int unit = 1; unit <= last && enabled; ++unit)
        if (enabled[unit]) return true;
    return false;
}

}  // namespace

bool hasTerrainTexture(SoState * state)
{
    const SoTerrainTextureElement * element = SoTerrainTextureElement::getInstance(state);
    // Whatever texture was last set on unit 0 bears its own node's id there.
    return element->getImage() && SoTextureQualityElement::get(state) > 0.0f &&
           TextureImageElementAccess::unitId(state, 0) == element->getNodeId();
}

std::vector<terrain::GlName> TerrainTextureUse::release()
{
    std::vector<terrain::GlName> names;
    if (clipmap_)
        for (const GLuint name : clipmap_->release()) names.push_back({terrain::GlName::Texture, name});
    isNew_ = true;
    problem_.clear();
    return names;
}

TerrainTextureUse::Frame TerrainTextureUse::update(SoGLRenderAction * action, const terrain::View & camera, const terrain::SampleGrid & grid,
                                                   const StateAttributes & attributes)
{
    SoState * state = action->getState();
    Frame frame;
    const SoTerrainTextureElement * element = SoTerrainTextureElement::getInstance(state);
    if (!element->getImage() && image_) {
        terrain::deleteNames(release());
        clipmap_.reset();
        image_.reset();
    }
    if (!hasTerrainTexture(state)) return frame;
    if (SoGLShaderProgramElement::get(state)) {
        frame.problem = "SoTerrainTexture: expected no shader program, found an SoShaderProgram; the terrain is drawn without texture";
        return frame;
    }
    if (image_ != element->getImage() || wantedClipSize_ != element->getClipSize()) {
        terrain::deleteNames(release());
        image_ = element->getImage();
        wantedClipSize_ = element->getClipSize();
        clipmap_ = std::make_unique<terrain::TextureClipmap>(image_, wantedClipSize_);
    }
    if (problem_.empty()) {
        const terrain::TiledImage::Size size = image_->size();
        const auto focus = findTextureFocus(state, camera, grid, attributes, {size.width, size.height});
        const auto progress = clipmap_->update(focus, isNew_ ? 0 : element->getUpdateBudget());
        if (!progress) {
            problem_ = progress.error().message();
        } else {
            frame.converged = progress.value().complete;
            frame.uploadedBytes = progress.value().texels * 4;
        }
        isNew_ = false;
    }
    if (problem_.empty()) {
        const auto program = programPoolOf(state)->find("terrain texture", buildProgram);
        if (program)
            frame.program = program.value()->name();
        else
            problem_ = program.error().message();
    }
    frame.problem = problem_;
    if (!problem_.empty()) return frame;
    if (hasFurtherTextures(state))
        frame.problem = "SoTerrainTexture: expected no texture on further units, found one; it is not drawn";
    frame.clipmap = clipmap_.get();
    return frame;
}

TerrainTextureUse::FixedFunction::FixedFunction(const Frame & frame)
{
    if (!frame.clipmap) return;
    glGetIntegerv(GL_CURRENT_PROGRAM, &before);
    glUseProgram(frame.program);
    binding = std::make_unique<terrain::TextureClipmap::Binding>(*frame.clipmap, frame.program, terrain::TextureClipmap::lastUnits());
    glUniform1i(glGetUniformLocation(frame.program, "terrainTextureFog"), fogNow());
}

TerrainTextureUse::FixedFunction::~FixedFunction()
{
    if (!binding) return;
    glUseProgram(GLuint(before));
}
