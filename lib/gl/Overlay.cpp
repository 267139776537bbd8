#include "gl/Overlay.h"

#include <algorithm>
#include <utility>

namespace terrain {

namespace {

// A border of one texel between glyphs is not needed: they are drawn at whole multiples of their size, and the nearest texel is
// taken.
constexpr int kGlyphsInRow = 16, kTextureWidth = 128, kTextureHeight = 256;
static_assert(kGlyphsInRow * kGlyphWidth <= kTextureWidth);
static_assert((kGlyphCount + kGlyphsInRow - 1) / kGlyphsInRow * kGlyphHeight <= kTextureHeight);

constexpr GLenum kMatrices[3] = {GL_MODELVIEW, GL_PROJECTION, GL_TEXTURE};
constexpr GLenum kMatrixNames[3] = {GL_MODELVIEW_MATRIX, GL_PROJECTION_MATRIX, GL_TEXTURE_MATRIX};

GLint integer(GLenum name) {
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value;
}

/// The lower left texel of a glyph.
glm::ivec2 placeOf(int glyph) {
    return {glyph % kGlyphsInRow * kGlyphWidth, glyph / kGlyphsInRow * kGlyphHeight};
}

bool hasFixedFunctions(int version) {
    if (!epoxy_is_desktop_gl()) return false;
    if (version >= 32) return (integer(GL_CONTEXT_PROFILE_MASK) & GL_CONTEXT_CORE_PROFILE_BIT) == 0;
    return version != 31 || epoxy_has_gl_extension("GL_ARB_compatibility");
}

bool hasRoomForState() {
    return integer(GL_ATTRIB_STACK_DEPTH) < integer(GL_MAX_ATTRIB_STACK_DEPTH) &&
           integer(GL_CLIENT_ATTRIB_STACK_DEPTH) < integer(GL_MAX_CLIENT_ATTRIB_STACK_DEPTH);
}

std::vector<std::uint8_t> fontTexels() {
    std::vector<std::uint8_t> texels(std::size_t(kTextureWidth) * kTextureHeight, 0);
    for (int glyph = 0; glyph < kGlyphCount; ++glyph) {
        const glm::ivec2 place = placeOf(glyph);
        for (int y = 0; y < kGlyphHeight; ++y)
            for (int x = 0; x < kGlyphWidth; ++x)
                if (glyphRows(glyph)[std::size_t(kGlyphHeight - 1 - y)] >> (kGlyphWidth - 1 - x) & 1)
                    texels[std::size_t((place.y + y) * kTextureWidth + place.x + x)] = 255;
    }
    return texels;
}

}  // namespace

void OverlayQuads::addRectangle(glm::vec2 low, glm::vec2 high, const OverlayColor& color) {
    vertices_.push_back({low.x, low.y, 0, 0, color});
    vertices_.push_back({high.x, low.y, 0, 0, color});
    vertices_.push_back({high.x, high.y, 0, 0, color});
    vertices_.push_back({low.x, high.y, 0, 0, color});
}

void OverlayQuads::addText(glm::vec2 place, std::basic_string_view<std::uint8_t> glyphs, const OverlayColor& color, int scale) {
    const float width = float(kGlyphWidth * scale), height = float(kGlyphHeight * scale);
    for (const std::uint8_t glyph : glyphs) {
        const glm::ivec2 texel = placeOf(glyph);
        const auto s = std::int16_t(texel.x), t = std::int16_t(texel.y);
        const auto right = std::int16_t(s + kGlyphWidth), upper = std::int16_t(t + kGlyphHeight);
        if (glyph != 0) {
            vertices_.push_back({place.x, place.y, s, t, color});
            vertices_.push_back({place.x + width, place.y, right, t, color});
            vertices_.push_back({place.x + width, place.y + height, right, upper, color});
            vertices_.push_back({place.x, place.y + height, s, upper, color});
        }
        place.x += width;
    }
}

GLuint OverlayResources::release() {
    isKnown_ = false;
    return std::exchange(font_, 0u);
}

void OverlayResources::find() {
    // Another context may have taken the id of one that went without notice.
    if (isKnown_ && (font_ == 0 || glIsTexture(font_))) return;
    isKnown_ = true;
    font_ = 0;
    abilities_.version = epoxy_gl_version();
    abilities_.fixedFunctions = hasFixedFunctions(abilities_.version);
    if (!abilities_.fixedFunctions) return;
    abilities_.assemblyPrograms =
        epoxy_has_gl_extension("GL_ARB_vertex_program") && epoxy_has_gl_extension("GL_ARB_fragment_program");
    abilities_.rectangles = abilities_.version >= 31 || epoxy_has_gl_extension("GL_ARB_texture_rectangle");
    abilities_.textureUnits = abilities_.version >= 13 ? integer(GL_MAX_TEXTURE_UNITS) : 1;
    abilities_.attributes = abilities_.version >= 20 ? integer(GL_MAX_VERTEX_ATTRIBS) : 0;
}

/// Pixel store, unpack buffer and the texture that was bound are the caller's to save.
void OverlayResources::makeFont() {
    glGenTextures(1, &font_);
    glBindTexture(GL_TEXTURE_2D, font_);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    const std::vector<std::uint8_t> texels = fontTexels();
    constexpr GLenum kUnpack[] = {GL_UNPACK_SWAP_BYTES, GL_UNPACK_LSB_FIRST, GL_UNPACK_ROW_LENGTH, GL_UNPACK_SKIP_ROWS,
                                  GL_UNPACK_SKIP_PIXELS};
    for (const GLenum name : kUnpack) glPixelStorei(name, 0);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_ALPHA8, kTextureWidth, kTextureHeight, 0, GL_ALPHA, GL_UNSIGNED_BYTE, texels.data());
}

OverlayScope::OverlayScope(OverlayResources& resources, int width, int height) : resources_(resources) {
    resources_.find();
    canDraw_ = resources_.abilities_.fixedFunctions && hasRoomForState();
    if (!canDraw_) return;
    glPushAttrib(GL_ENABLE_BIT | GL_CURRENT_BIT | GL_POLYGON_BIT | GL_LINE_BIT);
    if (resources_.abilities_.version >= 30) {
        // What is pushed are the arrays of the one that is bound.
        vertexArray_ = integer(GL_VERTEX_ARRAY_BINDING);
        glBindVertexArray(0);
    }
    glPushClientAttrib(GL_CLIENT_VERTEX_ARRAY_BIT | GL_CLIENT_PIXEL_STORE_BIT);
    matrixMode_ = integer(GL_MATRIX_MODE);
    saveBlending();
    switchOff();
    switchOffArrays();
    takeProgramAndTexture();
    for (int i = 0; i < 3; ++i) {
        glGetFloatv(kMatrixNames[i], matrices_[i]);
        glMatrixMode(kMatrices[i]);
        glLoadIdentity();
        if (kMatrices[i] == GL_PROJECTION) glOrtho(0.0, width, 0.0, height, -1.0, 1.0);
        if (kMatrices[i] == GL_TEXTURE) glScalef(1.0f / kTextureWidth, 1.0f / kTextureHeight, 1.0f);
    }
}

OverlayScope::~OverlayScope() {
    if (!canDraw_) return;
    const int version = resources_.abilities_.version;
    for (int i = 0; i < 3; ++i) {
        glMatrixMode(kMatrices[i]);
        glLoadMatrixf(matrices_[i]);
    }
    glMatrixMode(GLenum(matrixMode_));
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, environment_);
    glBindTexture(GL_TEXTURE_2D, GLuint(texture_));
    if (version >= 33) glBindSampler(0, GLuint(sampler_));
    if (version >= 13) glActiveTexture(GLenum(activeTexture_));
    if (version >= 20) glUseProgram(GLuint(program_));
    if (version >= 14) {
        glBlendFuncSeparate(GLenum(blending_[0]), GLenum(blending_[1]), GLenum(blending_[2]), GLenum(blending_[3]));
        if (version >= 20)
            glBlendEquationSeparate(GLenum(blending_[4]), GLenum(blending_[5]));
        else
            glBlendEquation(GLenum(blending_[4]));
    } else {
        glBlendFunc(GLenum(blending_[0]), GLenum(blending_[1]));
    }
    glPopClientAttrib();
    if (version >= 30) glBindVertexArray(GLuint(vertexArray_));
    glPopAttrib();
}

/// Not with GL_COLOR_BUFFER_BIT: giving back draw buffers makes drivers look at the whole frame buffer.
void OverlayScope::saveBlending() {
    const int version = resources_.abilities_.version;
    constexpr GLenum kNames[] = {GL_BLEND_SRC_RGB,   GL_BLEND_DST_RGB,      GL_BLEND_SRC_ALPHA,
                                 GL_BLEND_DST_ALPHA, GL_BLEND_EQUATION_RGB, GL_BLEND_EQUATION_ALPHA};
    const int count = version >= 20 ? 6 : 5;
    if (version >= 14) {
        for (int i = 0; i < count; ++i) blending_[i] = integer(kNames[i]);
    } else {
        blending_[0] = integer(GL_BLEND_SRC);
        blending_[1] = integer(GL_BLEND_DST);
    }
}

/// The scissor and the colour mask stay: they choose where to draw, as for a picture of one eye.
void OverlayScope::switchOff() const {
    constexpr GLenum kAll[] = {GL_ALPHA_TEST,      GL_CULL_FACE,      GL_DEPTH_TEST,     GL_FOG,
                               GL_LIGHTING,        GL_STENCIL_TEST,   GL_LINE_STIPPLE,   GL_LINE_SMOOTH,
                               GL_POLYGON_STIPPLE, GL_POLYGON_SMOOTH, GL_COLOR_LOGIC_OP, GL_POLYGON_OFFSET_FILL,
                               GL_CLIP_PLANE0,     GL_CLIP_PLANE1,    GL_CLIP_PLANE2,    GL_CLIP_PLANE3,
                               GL_CLIP_PLANE4,     GL_CLIP_PLANE5};
    for (const GLenum capability : kAll) glDisable(capability);
    const OverlayResources::Abilities& abilities = resources_.abilities_;
    if (abilities.version >= 14) glDisable(GL_COLOR_SUM);
    if (abilities.assemblyPrograms)
        for (const GLenum kind : {GL_VERTEX_PROGRAM_ARB, GL_FRAGMENT_PROGRAM_ARB}) glDisable(kind);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    if (abilities.version >= 14) {
        // What the picture covers it goes on covering, where it is kept with its opacity.
        glBlendEquation(GL_FUNC_ADD);
        glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    } else {
        glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    }
}

void OverlayScope::switchOffArrays() const {
    const int version = resources_.abilities_.version;
    if (version >= 15) glBindBuffer(GL_ARRAY_BUFFER, 0);
    if (version >= 21) glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    for (const GLenum array : {GL_NORMAL_ARRAY, GL_INDEX_ARRAY, GL_EDGE_FLAG_ARRAY}) glDisableClientState(array);
    if (version >= 14)
        for (const GLenum array : {GL_FOG_COORD_ARRAY, GL_SECONDARY_COLOR_ARRAY}) glDisableClientState(array);
    for (int i = 0; i < resources_.abilities_.attributes; ++i) glDisableVertexAttribArray(GLuint(i));
}

void OverlayScope::takeProgramAndTexture() {
    const OverlayResources::Abilities& abilities = resources_.abilities_;
    if (abilities.version >= 20) {
        program_ = integer(GL_CURRENT_PROGRAM);
        glUseProgram(0);
    }
    if (abilities.version >= 13) activeTexture_ = integer(GL_ACTIVE_TEXTURE);
    for (int unit = abilities.textureUnits - 1; unit >= 0; --unit) {
        if (abilities.version >= 13) {
            glActiveTexture(GLenum(GL_TEXTURE0 + unit));
            glClientActiveTexture(GLenum(GL_TEXTURE0 + unit));
            glDisable(GL_TEXTURE_CUBE_MAP);
        }
        if (abilities.rectangles) glDisable(GL_TEXTURE_RECTANGLE);
        if (abilities.version >= 12) glDisable(GL_TEXTURE_3D);
        for (const GLenum kind : {GL_TEXTURE_1D, GL_TEXTURE_2D}) glDisable(kind);
        glDisableClientState(GL_TEXTURE_COORD_ARRAY);
    }
    for (const GLenum made : {GL_TEXTURE_GEN_S, GL_TEXTURE_GEN_T, GL_TEXTURE_GEN_R, GL_TEXTURE_GEN_Q}) glDisable(made);
    texture_ = integer(GL_TEXTURE_BINDING_2D);
    glGetTexEnviv(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, &environment_);
    if (abilities.version >= 33) {
        sampler_ = integer(GL_SAMPLER_BINDING);
        glBindSampler(0, 0);
    }
    if (resources_.font_ == 0) resources_.makeFont();
    glBindTexture(GL_TEXTURE_2D, resources_.font_);
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_MODULATE);
}

/// What is no text is drawn without the texture: blending large rectangles takes most of the time.
void OverlayScope::setArrays(std::span<const OverlayVertex> vertices, bool isText) {
    const OverlayVertex* first = vertices.data();
    glEnableClientState(GL_VERTEX_ARRAY);
    glEnableClientState(GL_COLOR_ARRAY);
    glVertexPointer(2, GL_FLOAT, sizeof(OverlayVertex), &first->x);
    glColorPointer(4, GL_UNSIGNED_BYTE, sizeof(OverlayVertex), first->color.data());
    if (isText) {
        glEnable(GL_TEXTURE_2D);
        glEnableClientState(GL_TEXTURE_COORD_ARRAY);
        glTexCoordPointer(2, GL_SHORT, sizeof(OverlayVertex), &first->s);
    } else {
        glDisable(GL_TEXTURE_2D);
        glDisableClientState(GL_TEXTURE_COORD_ARRAY);
    }
}

void OverlayScope::drawQuads(std::span<const OverlayVertex> vertices, bool isText) const {
    if (!canDraw_ || vertices.empty()) return;
    setArrays(vertices, isText);
    glEnable(GL_BLEND);
    glDrawArrays(GL_QUADS, 0, GLsizei(vertices.size()));
}

void OverlayScope::drawLines(std::span<const OverlayVertex> vertices, std::span<const GLsizei> lengths, float width) const {
    if (!canDraw_ || vertices.empty()) return;
    setArrays(vertices, false);
    glDisable(GL_BLEND);
    glLineWidth(width);
    std::vector<GLint> firsts;
    GLint first = 0;
    for (const GLsizei length : lengths) {
        firsts.push_back(first);
        first += length;
    }
    // A call takes longer than the lines do.
    if (resources_.abilities_.version >= 14)
        glMultiDrawArrays(GL_LINE_STRIP, firsts.data(), lengths.data(), GLsizei(lengths.size()));
    else
        for (std::size_t i = 0; i < lengths.size(); ++i) glDrawArrays(GL_LINE_STRIP, firsts[i], lengths[i]);
}

}  // namespace terrain
