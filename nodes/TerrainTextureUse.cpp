#include "TerrainTextureUse.h"

#include <algorithm>

#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/elements/SoGLCacheContextElement.h>
#include <Inventor/elements/SoGLShaderProgramElement.h>
#include <Inventor/elements/SoMultiTextureEnabledElement.h>
#include <Inventor/elements/SoTextureQualityElement.h>
#include <Inventor/misc/SoContextHandler.h>
#include <Inventor/misc/SoState.h>

#include <SoTerrain/SoTerrainTextureElement.h>

#include "ElementAccess.h"
#include "StateAttributes.h"
#include "TextureFocus.h"

struct TerrainTextureUse::View {
    ViewKey key;
    std::unique_ptr<terrain::TextureClipmap> clipmap;
    std::shared_ptr<const terrain::TiledImage> image;
    int wantedClipSize = 0;
    bool isNew = true;      ///< nothing has been loaded yet
    std::string problem;    ///< why it can't be drawn, or empty
    GLuint program = 0;
    std::uint64_t lastFrame = 0;

    explicit View(const ViewKey & k) : key(k) {}
    std::string makeProgram();
};

namespace {

void deleteTexture(void * closure, uint32_t)
{
    const GLuint name = GLuint(reinterpret_cast<std::uintptr_t>(closure));
    glDeleteTextures(1, &name);
}

void deleteProgram(void * closure, uint32_t)
{
    glDeleteProgram(GLuint(reinterpret_cast<std::uintptr_t>(closure)));
}

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

std::string TerrainTextureUse::View::makeProgram()
{
    const GLuint shader = glCreateShader(GL_FRAGMENT_SHADER);
    const char * parts[] = {kBegin, terrain::TextureClipmap::glsl(), kMain};
    glShaderSource(shader, 3, parts, nullptr);
    glCompileShader(shader);
    program = glCreateProgram();
    glAttachShader(program, shader);
    glLinkProgram(program);
    GLint compiled = GL_FALSE, linked = GL_FALSE;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    char log[512] = "";
    if (!compiled)
        glGetShaderInfoLog(shader, sizeof log, nullptr, log);
    else
        glGetProgramInfoLog(program, sizeof log, nullptr, log);
    glDeleteShader(shader);
    if (linked) return {};
    return std::string("SoTerrainTexture: expected GLSL 1.30, found: ") + log;
}

TerrainTextureUse::TerrainTextureUse()
{
    SoContextHandler::addContextDestructionCallback(contextGoes, this);
}

TerrainTextureUse::~TerrainTextureUse()
{
    SoContextHandler::removeContextDestructionCallback(contextGoes, this);
    for (const auto & view : views) giveUp(*view);
}

void TerrainTextureUse::contextGoes(std::uint32_t context, void * closure)
{
    auto & views = static_cast<TerrainTextureUse *>(closure)->views;
    for (const auto & view : views) {
        if (view->key.context != context) continue;
        // Coin makes the context current before it tells.
        if (view->clipmap) {
            const std::vector<GLuint> names = view->clipmap->release();
            glDeleteTextures(GLsizei(names.size()), names.data());
        }
        if (view->program != 0) glDeleteProgram(view->program);
    }
    std::erase_if(views, [context](const auto & view) { return view->key.context == context; });
}

void TerrainTextureUse::giveUp(View & view)
{
    const auto later = [&view](SoScheduleDeleteCB * callback, GLuint name) {
        SoGLCacheContextElement::scheduleDeleteCallback(view.key.context, callback, reinterpret_cast<void *>(std::uintptr_t(name)));
    };
    if (view.clipmap)
        for (const GLuint name : view.clipmap->release()) later(deleteTexture, name);
    if (view.program != 0) later(deleteProgram, view.program);
}

TerrainTextureUse::View & TerrainTextureUse::find(const ViewKey & key, const SoTerrainTextureElement * element, std::uint64_t frame)
{
    // As in TerrainViews, age counts in rounds over all views; and what belongs to another texture is of no use any more.
    const std::uint64_t oldest = 32 * (views.size() + 1);
    std::erase_if(views, [&](const auto & view) {
        const bool isOther = view->image != element->getImage() || view->wantedClipSize != element->getClipSize();
        const bool goes = view->key == key ? isOther : frame - view->lastFrame > oldest;
        if (goes) giveUp(*view);
        return goes;
    });
    auto found = std::find_if(views.begin(), views.end(), [&key](const auto & view) { return view->key == key; });
    if (found == views.end()) {
        views.push_back(std::make_unique<View>(key));
        found = views.end() - 1;
        View & view = **found;
        view.image = element->getImage();
        view.wantedClipSize = element->getClipSize();
        view.clipmap = std::make_unique<terrain::TextureClipmap>(view.image, view.wantedClipSize);
    }
    (*found)->lastFrame = frame;
    return **found;
}

TerrainTextureUse::Frame TerrainTextureUse::update(SoGLRenderAction * action, const terrain::View & camera, const terrain::SampleGrid & grid,
                                                   const StateAttributes & attributes, std::uint64_t frameNumber)
{
    SoState * state = action->getState();
    Frame frame;
    if (!hasTerrainTexture(state)) return frame;
    if (SoGLShaderProgramElement::get(state)) {
        frame.problem = "SoTerrainTexture: expected no shader program, found an SoShaderProgram; the terrain is drawn without texture";
        return frame;
    }
    const SoTerrainTextureElement * element = SoTerrainTextureElement::getInstance(state);
    View & view = find(ViewKey(action), element, frameNumber);
    if (view.problem.empty()) {
        const terrain::TiledImage::Size size = view.image->size();
        const auto focus = findTextureFocus(state, camera, grid, attributes, {size.width, size.height});
        const auto progress = view.clipmap->update(focus, view.isNew ? 0 : element->getUpdateBudget());
        if (!progress) {
            view.problem = progress.error().message();
        } else {
            frame.converged = progress.value().complete;
            frame.uploadedBytes = progress.value().texels * 4;
        }
        if (view.isNew && view.problem.empty()) view.problem = view.makeProgram();
        view.isNew = false;
    }
    frame.problem = view.problem;
    if (!view.problem.empty()) return frame;
    if (hasFurtherTextures(state))
        frame.problem = "SoTerrainTexture: expected no texture on further units, found one; it is not drawn";
    frame.clipmap = view.clipmap.get();
    frame.program = view.program;
    return frame;
}

std::size_t TerrainTextureUse::memoryBytes() const
{
    // Views share images.
    std::vector<const terrain::TiledImage *> images;
    for (const auto & view : views) images.push_back(view->image.get());
    std::sort(images.begin(), images.end());
    images.erase(std::unique(images.begin(), images.end()), images.end());
    std::size_t total = 0;
    for (const terrain::TiledImage * image : images) total += image->cacheBytes();
    return total;
}

std::size_t TerrainTextureUse::textureBytes() const
{
    std::size_t total = 0;
    for (const auto & view : views) total += view->clipmap->textureBytes();
    return total;
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
