#include "gl/TextureClipmap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <glm/vec4.hpp>

namespace terrain {

namespace {

/// Layers that the shader has uniforms for.
constexpr int kMaximumLevels = 20;

using Window = TextureClipmap::Window;

Window intersection(const Window& a, const Window& b) {
    const Window both{std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
    return both.isEmpty() ? Window{} : both;
}

GLint limit(GLenum what) {
    GLint value = 0;
    glGetIntegerv(what, &value);
    return value;
}

}  // namespace

/// Lets textures be filled from packed rows in main memory, and gives everything back as it was.
class TextureClipmap::UploadScope {
public:
    UploadScope() {
        glPushClientAttrib(GL_CLIENT_PIXEL_STORE_BIT);
        glGetIntegerv(GL_PIXEL_UNPACK_BUFFER_BINDING, &buffer_);
        glGetIntegerv(GL_TEXTURE_BINDING_2D, &texture_);
        glGetIntegerv(GL_TEXTURE_BINDING_2D_ARRAY, &array_);
        glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
        for (const GLenum zero : {GL_UNPACK_SWAP_BYTES, GL_UNPACK_LSB_FIRST, GL_UNPACK_ROW_LENGTH, GL_UNPACK_IMAGE_HEIGHT,
                                  GL_UNPACK_SKIP_ROWS, GL_UNPACK_SKIP_PIXELS, GL_UNPACK_SKIP_IMAGES})
            glPixelStorei(zero, 0);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    }
    ~UploadScope() {
        glBindTexture(GL_TEXTURE_2D, GLuint(texture_));
        glBindTexture(GL_TEXTURE_2D_ARRAY, GLuint(array_));
        glBindBuffer(GL_PIXEL_UNPACK_BUFFER, GLuint(buffer_));
        glPopClientAttrib();
    }
    UploadScope(const UploadScope&) = delete;
    UploadScope& operator=(const UploadScope&) = delete;

private:
    GLint buffer_ = 0, texture_ = 0, array_ = 0;
};

TextureClipmap::TextureClipmap(std::shared_ptr<const TiledImage> image, int clipSize)
    : image_(std::move(image)), clipSize_(clipSize) {
    fitClipSize();
}

void TextureClipmap::fitClipSize() {
    int levels = 0;
    while (image_->size(levels).width > clipSize_ || image_->size(levels).height > clipSize_) ++levels;
    windows_.assign(std::size_t(levels), Window{});
    layer_ = {std::min(clipSize_, image_->size().width), std::min(clipSize_, image_->size().height)};
}

std::optional<Error> TextureClipmap::create() {
    if (epoxy_gl_version() < 30)
        return Error{"texture clipmap", "OpenGL 3.0 or newer", "OpenGL " + std::to_string(epoxy_gl_version() / 10.0)};
    const int largest = limit(GL_MAX_TEXTURE_SIZE);
    while (clipSize_ > largest) clipSize_ /= 2;
    fitClipSize();
    if (levels() > std::min(kMaximumLevels, limit(GL_MAX_ARRAY_TEXTURE_LAYERS)))
        return Error{image_->path(), "an image of at most " + std::to_string(kMaximumLevels) + " levels above the clip size",
                     std::to_string(levels()) + " of them"};
    if (auto problem = createArray()) return problem;
    return loadSmall();
}

std::optional<Error> TextureClipmap::createArray() {
    if (windows_.empty()) return std::nullopt;
    GLint width = 0;
    glTexImage3D(GL_PROXY_TEXTURE_2D_ARRAY, 0, GL_RGBA8, layer_.x, layer_.y, levels(), 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glGetTexLevelParameteriv(GL_PROXY_TEXTURE_2D_ARRAY, 0, GL_TEXTURE_WIDTH, &width);
    if (width == 0)
        return Error{"texture clipmap", "an OpenGL that has room for it",
                     "no room for " + std::to_string(levels()) + " layers of " + std::to_string(layer_.x) + "x" +
                         std::to_string(layer_.y)};
    glGenTextures(1, &array_);
    glBindTexture(GL_TEXTURE_2D_ARRAY, array_);
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        glTexParameteri(GL_TEXTURE_2D_ARRAY, filter, GL_LINEAR);
    // With wrapping a filter finds the neighbours of a texel in a window that goes over the layer's edge.
    for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) glTexParameteri(GL_TEXTURE_2D_ARRAY, wrap, GL_REPEAT);
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA8, layer_.x, layer_.y, levels(), 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    textureBytes_ += std::size_t(layer_.x) * std::size_t(layer_.y) * std::size_t(levels()) * 4;
    return std::nullopt;
}

std::optional<Error> TextureClipmap::loadSmall() {
    glGenTextures(1, &small_);
    glBindTexture(GL_TEXTURE_2D, small_);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, image_->levels() - 1 - levels());
    for (int level = levels(); level < image_->levels(); ++level) {
        const TiledImage::Size size = image_->size(level);
        const std::size_t bytes = std::size_t(size.width) * std::size_t(size.height) * 4;
        texels_.resize(bytes);
        const auto read = image_->read(level, 0, 0, size.width, size.height, texels_.data());
        if (!read) return read.error();
        glTexImage2D(GL_TEXTURE_2D, level - levels(), GL_RGBA8, size.width, size.height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                     texels_.data());
        textureBytes_ += bytes;
    }
    return std::nullopt;
}

Window TextureClipmap::wantedAround(int level, const Focus& focus) const {
    const TiledImage::Size size = image_->size(level);
    // Where an axis of the level is all there, its window never moves.
    const auto begin = [](double place, double lead, int window, int all) {
        const double middle = place * all + std::clamp(lead, -0.5, 0.5) * window;
        return std::clamp(int(std::floor(middle)) - window / 2, 0, all - window);
    };
    const int width = std::min(layer_.x, size.width), height = std::min(layer_.y, size.height);
    const int x = begin(focus.place.x, focus.lead.x, width, size.width),
              y = begin(focus.place.y, focus.lead.y, height, size.height);
    return {x, y, x + width, y + height};
}

std::optional<Error> TextureClipmap::load(int level, const Window& part) {
    texels_.resize(part.texels() * 4);
    const auto read = image_->read(level, part.x0, part.y0, part.width(), part.height(), texels_.data());
    if (!read) return read.error();
    glPixelStorei(GL_UNPACK_ROW_LENGTH, part.width());
    for (int y = part.y0; y < part.y1;) {
        const int row = y % layer_.y, rows = std::min(part.y1 - y, layer_.y - row);
        for (int x = part.x0; x < part.x1;) {
            const int column = x % layer_.x, columns = std::min(part.x1 - x, layer_.x - column);
            const std::size_t at = std::size_t(y - part.y0) * std::size_t(part.width()) + std::size_t(x - part.x0);
            glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, column, row, level, columns, rows, 1, GL_RGBA, GL_UNSIGNED_BYTE,
                            texels_.data() + at * 4);
            x += columns;
        }
        y += rows;
    }
    return std::nullopt;
}

std::optional<Error> TextureClipmap::moveWindow(int level, const Window& wanted, int focusRow, std::size_t budget,
                                                Progress& progress) {
    Window& window = windows_[std::size_t(level)];
    window = intersection(window, wanted);
    // How many of the lines that are missing on one side the budget allows.
    const auto lines = [&](int missing, int length) {
        const std::size_t left = budget > progress.texels ? budget - progress.texels : 0;
        const std::size_t allowed = std::max<std::size_t>(left / std::size_t(length), progress.texels == 0 ? 1 : 0);
        return int(std::min(std::size_t(missing), allowed));
    };
    const auto add = [&](const Window& part, const Window& grown) -> std::optional<Error> {
        if (part.isEmpty()) return std::nullopt;
        if (auto problem = load(level, part)) return problem;
        progress.texels += part.texels();
        window = grown;
        return std::nullopt;
    };
    if (window.isEmpty()) {
        // The rows around the focus come first.
        const int rows = lines(wanted.height(), wanted.width());
        const int first = std::clamp(focusRow - rows / 2, wanted.y0, wanted.y1 - rows);
        const Window band{wanted.x0, first, wanted.x1, first + rows};
        if (auto problem = add(band, band)) return problem;
    }
    if (!window.isEmpty()) {
        Window w = window;
        w.x0 -= lines(window.x0 - wanted.x0, window.height());
        if (auto problem = add({w.x0, w.y0, window.x0, w.y1}, w)) return problem;
        w.x1 += lines(wanted.x1 - window.x1, window.height());
        if (auto problem = add({window.x1, w.y0, w.x1, w.y1}, w)) return problem;
        w.y0 -= lines(window.y0 - wanted.y0, window.width());
        if (auto problem = add({w.x0, w.y0, w.x1, window.y0}, w)) return problem;
        w.y1 += lines(wanted.y1 - window.y1, window.width());
        if (auto problem = add({w.x0, window.y1, w.x1, w.y1}, w)) return problem;
    }
    progress.complete = progress.complete && window == wanted;
    return std::nullopt;
}

Result<TextureClipmap::Progress> TextureClipmap::update(const Focus& focus, std::size_t texelBudget) {
    const UploadScope scope;
    if (small_ == 0)
        if (auto problem = create()) return *problem;
    Progress progress;
    if (windows_.empty()) return progress;
    const auto sane = [](double value, double low, double high) {
        return std::isfinite(value) ? std::clamp(value, low, high) : 0.5 * (low + high);
    };
    // Rows count from the top.
    const Focus turned{{sane(focus.place.x, 0.0, 1.0), 1.0 - sane(focus.place.y, 0.0, 1.0)},
                       {sane(focus.lead.x, -0.5, 0.5), -sane(focus.lead.y, -0.5, 0.5)},
                       focus.finestLevel};
    const std::size_t budget = texelBudget > 0 ? texelBudget : std::numeric_limits<std::size_t>::max();
    glBindTexture(GL_TEXTURE_2D_ARRAY, array_);
    wanted_.assign(windows_.size(), {});
    for (int level = levels() - 1; level >= std::max(0, focus.finestLevel); --level) {
        const int row = int(turned.place.y * image_->size(level).height);
        const Window wanted = wantedAround(level, turned);
        wanted_[std::size_t(level)] = wanted;
        if (auto problem = moveWindow(level, wanted, row, budget, progress)) return *problem;
    }
    return progress;
}

bool TextureClipmap::isMissing(glm::dvec2 place) const {
    for (std::size_t level = 0; level < std::min(wanted_.size(), windows_.size()); ++level) {
        const auto size = image_->size(int(level));
        const int x = int(std::floor(place.x * size.width)), y = int(std::floor((1.0 - place.y) * size.height));
        const auto holds = [x, y](const Window& window) { return x >= window.x0 && x < window.x1 && y >= window.y0 && y < window.y1; };
        if (holds(wanted_[level]) && !holds(windows_[level])) return true;
    }
    return false;
}

std::vector<GLuint> TextureClipmap::release() {
    std::vector<GLuint> names;
    for (GLuint* name : {&small_, &array_}) {
        if (*name != 0) names.push_back(*name);
        *name = 0;
    }
    textureBytes_ = 0;
    fitClipSize();
    return names;
}

const char* TextureClipmap::glsl() {
    // Where a window ends at the image's edge its uniform lies far beyond, so that there is no border to blend over.
    return R"(
uniform sampler2D terrainTextureSmall;
uniform sampler2DArray terrainTextureLayers;
uniform int terrainTextureLevels;
uniform vec2 terrainTextureLayerSize;
uniform float terrainTextureBlend;
uniform vec2 terrainTextureSize[20];
uniform vec4 terrainTextureWindow[20];
uniform vec2 terrainTextureImage;

vec4 terrainTexture(vec2 st)
{
    vec2 dx = dFdx(st) * terrainTextureImage, dy = dFdy(st) * terrainTextureImage;
    float lod = 0.5 * log2(max(max(dot(dx, dx), dot(dy, dy)), 1e-12));
    vec2 p = clamp(vec2(st.x, 1.0 - st.y), 0.0, 1.0);
    vec4 colour = vec4(0.0);
    float open = 1.0;
    for (int i = int(clamp(floor(lod), 0.0, float(terrainTextureLevels))); i < terrainTextureLevels; ++i) {
        vec2 at = clamp(p * terrainTextureSize[i], vec2(0.5), terrainTextureSize[i] - 0.5);
        vec2 inside = min(at - terrainTextureWindow[i].xy, terrainTextureWindow[i].zw - at);
        float share = clamp((min(inside.x, inside.y) - 0.5) * terrainTextureBlend, 0.0, 1.0) * clamp(float(i + 1) - lod, 0.0, 1.0);
        if (share > 0.0) {
            colour += open * share * textureLod(terrainTextureLayers, vec3(at / terrainTextureLayerSize, float(i)), 0.0);
            open *= 1.0 - share;
            if (open < 0.001) break;
        }
    }
    if (open >= 0.001) colour += open * textureLod(terrainTextureSmall, p, lod - float(terrainTextureLevels));
    return vec4(colour.rgb, 1.0);
}
)";
}

int TextureClipmap::lastUnits() {
    return limit(GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS) - kUnits;
}

TextureClipmap::Binding::Binding(const TextureClipmap& clipmap, GLuint program, int firstUnit) : firstUnit_(firstUnit) {
    glGetIntegerv(GL_ACTIVE_TEXTURE, &active_);
    glActiveTexture(GLenum(GL_TEXTURE0 + firstUnit));
    glGetIntegerv(GL_TEXTURE_BINDING_2D, &small_);
    glBindTexture(GL_TEXTURE_2D, clipmap.small_);
    glActiveTexture(GLenum(GL_TEXTURE0 + firstUnit + 1));
    glGetIntegerv(GL_TEXTURE_BINDING_2D_ARRAY, &array_);
    glBindTexture(GL_TEXTURE_2D_ARRAY, clipmap.array_);
    glActiveTexture(GLenum(active_));

    const auto place = [program](const char* name) { return glGetUniformLocation(program, name); };
    const int levels = clipmap.levels();
    constexpr float kFar = 1e30f;
    std::vector<glm::vec2> sizes;
    std::vector<glm::vec4> windows;
    for (int level = 0; level < levels; ++level) {
        const TiledImage::Size size = clipmap.image().size(level);
        const Window& window = clipmap.resident(level);
        sizes.emplace_back(size.width, size.height);
        if (window.isEmpty())
            windows.emplace_back(kFar, kFar, -kFar, -kFar);
        else
            windows.emplace_back(window.x0 == 0 ? -kFar : float(window.x0), window.y0 == 0 ? -kFar : float(window.y0),
                                 window.x1 == size.width ? kFar : float(window.x1),
                                 window.y1 == size.height ? kFar : float(window.y1));
    }
    glUniform1i(place("terrainTextureSmall"), firstUnit);
    glUniform1i(place("terrainTextureLayers"), firstUnit + 1);
    glUniform1i(place("terrainTextureLevels"), levels);
    glUniform2f(place("terrainTextureLayerSize"), float(clipmap.layer_.x), float(clipmap.layer_.y));
    glUniform1f(place("terrainTextureBlend"), 16.0f / float(clipmap.clipSize()));
    glUniform2f(place("terrainTextureImage"), float(clipmap.image().size().width), float(clipmap.image().size().height));
    if (levels == 0) return;
    glUniform2fv(place("terrainTextureSize"), levels, &sizes[0].x);
    glUniform4fv(place("terrainTextureWindow"), levels, &windows[0].x);
}

TextureClipmap::Binding::~Binding() {
    GLint active = 0;
    glGetIntegerv(GL_ACTIVE_TEXTURE, &active);
    glActiveTexture(GLenum(GL_TEXTURE0 + firstUnit_));
    glBindTexture(GL_TEXTURE_2D, GLuint(small_));
    glActiveTexture(GLenum(GL_TEXTURE0 + firstUnit_ + 1));
    glBindTexture(GL_TEXTURE_2D_ARRAY, GLuint(array_));
    glActiveTexture(GLenum(active));
}

}  // namespace terrain
