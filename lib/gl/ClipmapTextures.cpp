#include "gl/ClipmapTextures.h"

#include <algorithm>
#include <string>

#include "base/ProfileScope.h"
#include "gl/DetailShader.h"
#include "lod/ClipmapSurface.h"

namespace terrain {

namespace {

// Units that no Coin node uses: updates happen between other drawing.
constexpr int kHeightUnit = 0, kNormalUnit = 1, kNoiseUnit = 2;

const char* const kVertexShader = R"(#version 130
in vec2 corner;
void main() { gl_Position = vec4(corner, 0.0, 1.0); }
)";

/// What passes share: which vertex of a level (or which half of one) a texel holds.
const char* const kAddress = R"(
uniform sampler2DArray heights;
uniform int mask, layer, coarserLayer;
uniform ivec2 low;

ivec2 addressOf(ivec2 begin, int wrap) { return begin + ((ivec2(gl_FragCoord.xy) - begin) & wrap); }
float heightAt(ivec2 v, int from) { return texelFetch(heights, ivec3(v & mask, from), 0).r; }
)";

const char* const kDetailShader = R"(
uniform ivec2 lastCoarser;
uniform int detailLevel;

float coarserHeightAt(ivec2 v) { return heightAt(v, coarserLayer); }

void main()
{
    ivec2 v = addressOf(low, mask);
    float height = detailHeight(v, detailLevel, lastCoarser);
    ivec2 a = v >> 1, odd = v & 1;
    // The middle of the coarser edge, or of its diagonal from (1, 0) to (0, 1).
    float coarser = 0.5 * (heightAt(a + ivec2(odd.x, 0), coarserLayer) + heightAt(a + ivec2(0, odd.y), coarserLayer));
    if (odd.x + odd.y == 0) coarser = height;
    gl_FragColor = vec4(height, isnan(coarser) ? height : coarser, 0.0, 1.0);
}
)";

const char* const kNormalShader = R"(
uniform sampler2DArray normals;
uniform ivec4 valid;
uniform vec2 slopeScale;
uniform bool coarsest;
uniform int normalMask;

float around(ivec2 v, float otherwise)
{
    float h = heightAt(clamp(v, valid.xy, valid.zw), layer);
    return isnan(h) ? otherwise : h;
}

// Slope along one axis at vertex v, or half-way to the next one.
float slope(ivec2 v, ivec2 axis, bool between)
{
    float middle = around(v, 0.0);
    float after = around(v + axis, middle);
    if (between) return after - middle;
    ivec2 at = clamp(v, valid.xy, valid.zw), low = max(at - axis, valid.xy), high = min(at + axis, valid.zw);
    int cells = abs(high.x - low.x) + abs(high.y - low.y);
    return cells == 0 ? 0.0 : (after - around(v - axis, middle)) / float(cells);
}

vec2 coarserAt(ivec2 h) { return texelFetch(normals, ivec3(h & normalMask, coarserLayer), 0).xy; }

void main()
{
    ivec2 h = addressOf(2 * low, normalMask), v = h >> 1, odd = h & 1;
    float x = slope(v, ivec2(1, 0), odd.x == 1), y = slope(v, ivec2(0, 1), odd.y == 1);
    // Half-way along the other axis the slope is the mean of both sides.
    if (odd.y == 1) x = 0.5 * (x + slope(v + ivec2(0, 1), ivec2(1, 0), odd.x == 1));
    if (odd.x == 1) y = 0.5 * (y + slope(v + ivec2(1, 0), ivec2(0, 1), odd.y == 1));
    vec2 n = normalize(vec3(-x * slopeScale.x, -y * slopeScale.y, 1.0)).xy;
    vec2 own = (127.0 * n + 128.0) / 255.0, other = own;
    if (!coarsest) {
        ivec2 a = h >> 1, o = h & 1;
        other = 0.25 * (coarserAt(a) + coarserAt(a + ivec2(o.x, 0)) + coarserAt(a + ivec2(0, o.y)) + coarserAt(a + o));
    }
    gl_FragColor = vec4(own, other);
}
)";

GLuint makeTexture(GLenum target, GLint internal, int size, int layers, GLint filter) {
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(target, texture);
    for (const GLenum which : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) glTexParameteri(target, which, filter);
    for (const GLenum which : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) glTexParameteri(target, which, GL_REPEAT);
    glTexParameteri(target, GL_TEXTURE_MAX_LEVEL, 0);
    if (target == GL_TEXTURE_2D)
        glTexImage2D(target, 0, internal, size, size, 0, GL_RGBA, GL_FLOAT, nullptr);
    else
        glTexImage3D(target, 0, internal, size, size, layers, 0, GL_RGBA, GL_FLOAT, nullptr);
    return texture;
}

/// Calls `part(first, count)` for the pieces of [first, last] that lie in one round of `pitch`.
template <class Part>
void forEachRound(int first, int last, int pitch, const Part& part) {
    while (first <= last) {
        const int texel = first & (pitch - 1), count = std::min(last - first + 1, pitch - texel);
        part(first, count);
        first += count;
    }
}

}  // namespace

TextureUnitScope::TextureUnitScope(int unit, GLenum target, GLuint texture) : unit_(unit), target_(target) {
    glGetIntegerv(GL_ACTIVE_TEXTURE, &active_);
    glActiveTexture(GLenum(GL_TEXTURE0 + unit));
    glGetIntegerv(target == GL_TEXTURE_2D ? GL_TEXTURE_BINDING_2D : GL_TEXTURE_BINDING_2D_ARRAY, &before_);
    glBindTexture(target, texture);
    glActiveTexture(GLenum(active_));
}

TextureUnitScope::~TextureUnitScope() {
    glActiveTexture(GLenum(GL_TEXTURE0 + unit_));
    glBindTexture(target_, GLuint(before_));
    glActiveTexture(GLenum(active_));
}

/// State in which passes write to textures exactly what they compute; as it was, afterwards.
class ClipmapTextures::PassScope {
public:
    explicit PassScope(const GlBuffer& triangle) {
        glGetIntegerv(GL_CURRENT_PROGRAM, &program_);
        glGetIntegerv(GL_ARRAY_BUFFER_BINDING, &buffer_);
        triangle.bind(GL_ARRAY_BUFFER);
        glEnableVertexAttribArray(0);
        glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
        for (const GLenum off : {GL_DEPTH_TEST, GL_STENCIL_TEST, GL_BLEND, GL_ALPHA_TEST, GL_CULL_FACE, GL_COLOR_LOGIC_OP,
                                 GL_DITHER, GL_POLYGON_STIPPLE, GL_MULTISAMPLE})
            glDisable(off);
        for (GLenum plane = 0; plane < 6; ++plane) glDisable(GL_CLIP_PLANE0 + plane);
        // No attribute group has it.
        discards_ = glIsEnabled(GL_RASTERIZER_DISCARD);
        glDisable(GL_RASTERIZER_DISCARD);
        glEnable(GL_SCISSOR_TEST);
        glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        glClampColor(GL_CLAMP_FRAGMENT_COLOR, GL_FALSE);
    }
    ~PassScope() {
        glBindBuffer(GL_ARRAY_BUFFER, GLuint(buffer_));
        glUseProgram(GLuint(program_));
        if (discards_) glEnable(GL_RASTERIZER_DISCARD);
    }
    PassScope(const PassScope&) = delete;
    PassScope& operator=(const PassScope&) = delete;

private:
    struct Attributes {
        Attributes() { glPushAttrib(GL_ALL_ATTRIB_BITS); }
        ~Attributes() { glPopAttrib(); }
    };
    // In this order: what is read and drawn to belongs to the frame buffer, which must be bound again when attributes come back.
    Attributes attributes_;
    FramebufferScope framebuffer_;
    VertexArrayScope vertexArray_;
    GLint program_ = 0, buffer_ = 0;
    GLboolean discards_ = GL_FALSE;
};

std::optional<Error> ClipmapTextures::create() {
    if (heights_) return std::nullopt;
    GLint largest = 0, layersThere = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &layersThere);
    const int pitch = layout_.pitch(), layers = memoryFree_ ? 2 : layout_.levels();
    if (2 * pitch > largest || layers > layersThere)
        return Error{"geometry clipmap",
                     "textures of " + std::to_string(2 * pitch) + " texels a side and " + std::to_string(layers) + " layers",
                     "an OpenGL with " + std::to_string(largest) + " and " + std::to_string(layersThere)};
    GLint array = 0, flat = 0, buffer = 0;
    glGetIntegerv(GL_TEXTURE_BINDING_2D_ARRAY, &array);
    glGetIntegerv(GL_TEXTURE_BINDING_2D, &flat);
    glGetIntegerv(GL_ARRAY_BUFFER_BINDING, &buffer);
    heights_ = makeTexture(GL_TEXTURE_2D_ARRAY, GL_RG32F, pitch, layers, GL_NEAREST);
    normals_ = makeTexture(GL_TEXTURE_2D_ARRAY, GL_RGBA8, 2 * pitch, layers, GL_LINEAR);
    if (layout_.detailLevels() > 0) heightTarget_ = makeTexture(GL_TEXTURE_2D, GL_RG32F, pitch, 1, GL_NEAREST);
    normalTarget_ = makeTexture(GL_TEXTURE_2D, GL_RGBA8, 2 * pitch, 1, GL_NEAREST);
    const std::size_t texels = std::size_t(pitch) * std::size_t(pitch);
    bytes_ = texels * (std::size_t(layers) * 24 + 16 + (heightTarget_ ? 8 : 0));
    glBindTexture(GL_TEXTURE_2D_ARRAY, GLuint(array));
    glBindTexture(GL_TEXTURE_2D, GLuint(flat));

    constexpr float kTriangle[6] = {-1.0f, -1.0f, 3.0f, -1.0f, -1.0f, 3.0f};
    triangle_.fill(GL_ARRAY_BUFFER, kTriangle, sizeof kTriangle, GL_STATIC_DRAW);
    glBindBuffer(GL_ARRAY_BUFFER, GLuint(buffer));
    return std::nullopt;
}

std::optional<Error> ClipmapTextures::findPrograms() {
    const auto normals = programs_->find("clipmap normals", [] {
        const std::string head = std::string("#version 130\n") + kAddress;
        return GlProgram::build("normals of a geometry clipmap", kVertexShader, head + kNormalShader, {{"corner", 0}});
    });
    if (!normals) return normals.error();
    normalProgram_ = normals.value();
    if (layout_.detailLevels() == 0) return std::nullopt;
    const auto detail = programs_->find("clipmap detail", [] {
        const std::string head = std::string("#version 130\n") + kAddress;
        return GlProgram::build("detail of a geometry clipmap", kVertexShader, head + detailShaderSource() + kDetailShader,
                                {{"corner", 0}});
    });
    if (!detail) return detail.error();
    detailProgram_ = detail.value();
    return std::nullopt;
}

/// Draws texels of the target and copies them to the same place of a layer: a texture can't be read and written at once.
void ClipmapTextures::draw(GLuint target, int pitch, const ClipRect& texels, GLuint array, int layer) const {
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target, 0);
    glDrawBuffer(GL_COLOR_ATTACHMENT0);
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glViewport(0, 0, pitch, pitch);
    glBindTexture(GL_TEXTURE_2D_ARRAY, array);
    forEachRound(texels.low.y, texels.high.y, pitch, [&](int firstRow, int rows) {
        forEachRound(texels.low.x, texels.high.x, pitch, [&](int firstColumn, int columns) {
            const int x = firstColumn & (pitch - 1), y = firstRow & (pitch - 1);
            glScissor(x, y, columns, rows);
            glDrawArrays(GL_TRIANGLES, 0, 3);
            glCopyTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, x, y, layer, x, y, columns, rows);
        });
    });
}

void ClipmapTextures::send(const ClipmapUpdates::Update& update, const SampleGrid& grid) {
    const ClipRect& rect = update.rect;
    pairs_.resize(2 * std::size_t(rect.samples()));
    fillLevel(grid, layout_.sourceLevel(update.level), rect, pairs_.data());
    if (update.level + 1 == layout_.levels())
        for (std::size_t i = 0; i < pairs_.size(); i += 2) pairs_[i + 1] = pairs_[i];
    glPushClientAttrib(GL_CLIENT_PIXEL_STORE_BIT);
    GLint buffer = 0;
    glGetIntegerv(GL_PIXEL_UNPACK_BUFFER_BINDING, &buffer);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    for (const GLenum zero : {GL_UNPACK_SWAP_BYTES, GL_UNPACK_LSB_FIRST, GL_UNPACK_IMAGE_HEIGHT, GL_UNPACK_SKIP_ROWS,
                              GL_UNPACK_SKIP_PIXELS, GL_UNPACK_SKIP_IMAGES})
        glPixelStorei(zero, 0);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, rect.columns());
    GLint before = 0;
    glGetIntegerv(GL_TEXTURE_BINDING_2D_ARRAY, &before);
    glBindTexture(GL_TEXTURE_2D_ARRAY, heights_);
    const int pitch = layout_.pitch();
    forEachRound(rect.low.y, rect.high.y, pitch, [&](int firstRow, int rows) {
        forEachRound(rect.low.x, rect.high.x, pitch, [&](int firstColumn, int columns) {
            const std::size_t at =
                std::size_t(firstRow - rect.low.y) * std::size_t(rect.columns()) + std::size_t(firstColumn - rect.low.x);
            glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, layout_.texel(firstColumn), layout_.texel(firstRow), layerOf(update.level),
                            columns, rows, 1, GL_RG, GL_FLOAT, pairs_.data() + 2 * at);
        });
    });
    glBindTexture(GL_TEXTURE_2D_ARRAY, GLuint(before));
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, GLuint(buffer));
    glPopClientAttrib();
}

void ClipmapTextures::synthesise(const ClipmapUpdates::Update& update, const Source& source) {
    const int level = update.level, d = layout_.detailLevels() - level;
    GlProgram& program = *detailProgram_;
    program.use();
    setDetailUniforms(program.name(), *source.detail, kNoiseUnit);
    const ClipRect coarser = layout_.domain(level + 1);
    glUniform1i(program["heights"], kHeightUnit);
    glUniform1i(program["mask"], layout_.size());
    glUniform1i(program["coarserLayer"], layerOf(level + 1));
    glUniform2i(program["low"], update.rect.low.x, update.rect.low.y);
    glUniform2i(program["lastCoarser"], coarser.high.x, coarser.high.y);
    glUniform1i(program["detailLevel"], d);
    draw(heightTarget_, layout_.pitch(), update.rect, heights_, layerOf(level));
}

/// Normals of the vertices and of what lies behind each half-way to the next one.
void ClipmapTextures::makeNormals(int level, const ClipRect& vertices, const Source& source) {
    const ClipRect& valid = source.valid[std::size_t(level)];
    GlProgram& program = *normalProgram_;
    program.use();
    glUniform1i(program["heights"], kHeightUnit);
    glUniform1i(program["normals"], kNormalUnit);
    glUniform1i(program["mask"], layout_.size());
    glUniform1i(program["normalMask"], 2 * layout_.pitch() - 1);
    glUniform1i(program["layer"], layerOf(level));
    glUniform1i(program["coarserLayer"], layerOf(level + 1));
    glUniform2i(program["low"], vertices.low.x, vertices.low.y);
    glUniform4i(program["valid"], valid.low.x, valid.low.y, valid.high.x, valid.high.y);
    const float cells = float(1.0 / layout_.spacing(level));
    glUniform2f(program["slopeScale"], source.slopeScale.x * cells, source.slopeScale.y * cells);
    glUniform1i(program["coarsest"], level + 1 == layout_.levels());
    draw(normalTarget_, 2 * layout_.pitch(), {vertices.low * 2, vertices.high * 2 + 1}, normals_, layerOf(level));
}

/// The table of noise, once for each amplitude.
void ClipmapTextures::makeNoise(const SynthesisedDetail& detail) {
    if (noise_ && noiseAmplitude_ == detail.amplitude()) return;
    if (noise_) glDeleteTextures(1, &noise_);
    const TextureUnitScope keeps(kNoiseUnit, GL_TEXTURE_2D, 0);
    GLint active = 0;
    glGetIntegerv(GL_ACTIVE_TEXTURE, &active);
    glActiveTexture(GL_TEXTURE0 + kNoiseUnit);
    noise_ = makeNoiseTexture(detail);
    glActiveTexture(GLenum(active));
    noiseAmplitude_ = detail.amplitude();
}

Result<std::size_t> ClipmapTextures::update(std::span<const ClipmapUpdates::Update> updates, const Source& source) {
    if (updates.empty()) return std::size_t(0);
    const ProfileScope scope("clipmap: update");
    if (auto problem = findPrograms()) return *problem;
    if (auto problem = create()) return *problem;
    if (source.detail && layout_.detailLevels() > 0) makeNoise(*source.detail);
    const PassScope pass(triangle_);
    const TextureUnitScope noise(kNoiseUnit, GL_TEXTURE_2D, noise_), normals(kNormalUnit, GL_TEXTURE_2D_ARRAY, normals_),
        heights(kHeightUnit, GL_TEXTURE_2D_ARRAY, heights_);
    // draw() binds what it copies to.
    constexpr int kCopyUnit = 3;
    const TextureUnitScope copies(kCopyUnit, GL_TEXTURE_2D_ARRAY, 0);
    glActiveTexture(GL_TEXTURE0 + kCopyUnit);
    std::size_t sent = 0;
    for (const ClipmapUpdates::Update& update : updates) {
        if (layout_.sourceLevel(update.level) < 0) {
            synthesise(update, source);
        } else {
            send(update, source.grid);
            sent += std::size_t(update.rect.samples()) * kBytesPerSample;
        }
        // Slopes look one vertex around.
        const ClipRect around{update.rect.low - 2, update.rect.high + 2};
        makeNormals(update.level, around.cutTo(source.valid[std::size_t(update.level)]), source);
    }
    return sent;
}

std::vector<GlName> ClipmapTextures::release() {
    std::vector<GlName> names;
    const auto take = [&names](GlName::Kind kind, GLuint& name) {
        if (name) names.push_back({kind, std::exchange(name, 0u)});
    };
    for (GLuint* texture : {&heights_, &normals_, &heightTarget_, &normalTarget_, &noise_}) take(GlName::Texture, *texture);
    if (GLuint buffer = triangle_.release()) take(GlName::Buffer, buffer);
    bytes_ = 0;
    return names;
}

}  // namespace terrain
