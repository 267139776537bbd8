// A clipmap drawn over the whole picture, against the same image as an ordinary mip-mapped texture.
#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include <gtest/gtest.h>

#ifdef HAVE_OPENIMAGEIO

#include <epoxy/gl.h>

#include <cmath>
#include <filesystem>
#include <random>

#include <unistd.h>

#include "../height/TiledFiles.h"
#include "gl/HeadlessContext.h"
#include "gl/TextureClipmap.h"

using namespace terrain;
using namespace terrain::test;
using Window = TextureClipmap::Window;

namespace {

constexpr int kPicture = 256;

GLuint programOf(const std::string& body) {
    const GLuint shader = glCreateShader(GL_FRAGMENT_SHADER), program = glCreateProgram();
    const char* text = body.c_str();
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    glAttachShader(program, shader);
    glLinkProgram(program);
    GLint linked = GL_FALSE;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    char log[1024] = "";
    glGetShaderInfoLog(shader, sizeof log, nullptr, log);
    EXPECT_TRUE(linked) << log;
    glDeleteShader(shader);
    return program;
}

class TextureClipmaps : public testing::Test {
protected:
    TextureClipmaps() : folder_(std::filesystem::temp_directory_path() / ("soterrain-clipmap-" + std::to_string(getpid()))) {
        std::filesystem::create_directories(folder_);
    }
    ~TextureClipmaps() override { std::filesystem::remove_all(folder_); }

    void SetUp() override {
        auto created = HeadlessContext::create(kPicture, kPicture);
        ASSERT_TRUE(created) << created.error().message();
        context_ = std::move(created).value();
        context_->bindFramebuffer();
        clipmapProgram_ = programOf(std::string("#version 130\n") + TextureClipmap::glsl() +
                                    "void main() { gl_FragColor = terrainTexture(gl_TexCoord[0].st); }\n");
        wholeProgram_ = programOf("#version 130\nuniform sampler2D whole; uniform vec2 size;\n"
                                  "void main() { vec2 st = gl_TexCoord[0].st, dx = dFdx(st) * size, dy = dFdy(st) * size;\n"
                                  "gl_FragColor = textureLod(whole, vec2(st.x, 1.0 - st.y), 0.5 * log2(max(dot(dx, dx), dot(dy, dy)))); }\n");
    }
    void TearDown() override {
        if (context_) {
            EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
        }
    }

    /// A file of all levels of an image, opened.
    std::shared_ptr<const TiledImage> fileOf(Texels image, int megabytes = 64) {
        levels_ = levelsOf(std::move(image));
        const std::string path = (folder_ / "image.tif").string();
        writeLevels(path, levels_, 64);
        auto opened = TiledImage::open(path, megabytes);
        EXPECT_TRUE(opened) << opened.error().message();
        return std::move(opened).value();
    }

    /// Draws texture coordinates from (s0, t0) to (s1, t1) all over the picture.
    Image drawn(double s0, double t0, double s1, double t1) {
        glBegin(GL_QUADS);
        glTexCoord2d(s0, t0);
        glVertex2d(-1.0, -1.0);
        glTexCoord2d(s1, t0);
        glVertex2d(1.0, -1.0);
        glTexCoord2d(s1, t1);
        glVertex2d(1.0, 1.0);
        glTexCoord2d(s0, t1);
        glVertex2d(-1.0, 1.0);
        glEnd();
        return context_->readColor();
    }
    Image drawn(const TextureClipmap& clipmap, double s0, double t0, double s1, double t1) {
        glUseProgram(clipmapProgram_);
        const TextureClipmap::Binding binding(clipmap, clipmapProgram_, TextureClipmap::lastUnits());
        return drawn(s0, t0, s1, t1);
    }
    Image drawnWhole(double s0, double t0, double s1, double t1) {
        GLuint texture = 0;
        glGenTextures(1, &texture);
        glBindTexture(GL_TEXTURE_2D, texture);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
        for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
        for (std::size_t level = 0; level < levels_.size(); ++level)
            glTexImage2D(GL_TEXTURE_2D, GLint(level), GL_RGB8, levels_[level].width, levels_[level].height, 0, GL_RGB, GL_UNSIGNED_BYTE,
                         levels_[level].bytes.data());
        glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
        glUseProgram(wholeProgram_);
        glUniform1i(glGetUniformLocation(wholeProgram_, "whole"), 0);
        glUniform2f(glGetUniformLocation(wholeProgram_, "size"), float(levels_[0].width), float(levels_[0].height));
        Image picture = drawn(s0, t0, s1, t1);
        glDeleteTextures(1, &texture);
        return picture;
    }
    static int largestDifference(const Image& a, const Image& b) {
        int largest = 0;
        for (std::size_t i = 0; i < a.pixels.size(); ++i) largest = std::max(largest, std::abs(int(a.pixels[i]) - int(b.pixels[i])));
        return largest;
    }

    static TextureClipmap::Progress update(TextureClipmap& clipmap, glm::dvec2 place, std::size_t budget = 0, int finest = 0,
                                           glm::dvec2 lead = {0.0, 0.0}) {
        const auto done = clipmap.update({place, lead, finest}, budget);
        EXPECT_TRUE(done) << done.error().message();
        return done ? done.value() : TextureClipmap::Progress{};
    }

    /// Every texel that is resident is the one of the image. Takes the textures from the clipmap.
    void expectRightTexels(TextureClipmap& clipmap) {
        std::vector<Window> windows;
        for (int level = 0; level < clipmap.levels(); ++level) windows.push_back(clipmap.resident(level));
        const std::vector<GLuint> names = clipmap.release();
        ASSERT_EQ(names.size(), 2u);
        glBindTexture(GL_TEXTURE_2D_ARRAY, names[1]);
        GLint width = 0, height = 0, layers = 0;
        glGetTexLevelParameteriv(GL_TEXTURE_2D_ARRAY, 0, GL_TEXTURE_WIDTH, &width);
        glGetTexLevelParameteriv(GL_TEXTURE_2D_ARRAY, 0, GL_TEXTURE_HEIGHT, &height);
        glGetTexLevelParameteriv(GL_TEXTURE_2D_ARRAY, 0, GL_TEXTURE_DEPTH, &layers);
        ASSERT_EQ(layers, GLint(windows.size()));
        std::vector<std::uint8_t> rgba(std::size_t(width) * std::size_t(height) * std::size_t(layers) * 4);
        glGetTexImage(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
        glBindTexture(GL_TEXTURE_2D_ARRAY, 0);
        glDeleteTextures(2, names.data());
        for (int level = 0; level < layers; ++level)
            for (int y = windows[std::size_t(level)].y0; y < windows[std::size_t(level)].y1; ++y)
                for (int x = windows[std::size_t(level)].x0; x < windows[std::size_t(level)].x1; ++x) {
                    const std::size_t at = (std::size_t(level) * std::size_t(height) + std::size_t(y % height)) * std::size_t(width) + std::size_t(x % width);
                    for (int c = 0; c < 3; ++c)
                        ASSERT_EQ(rgba[at * 4 + std::size_t(c)], levels_[std::size_t(level)].at(x, y)[c])
                            << "level " << level << ", texel (" << x << ", " << y << ")";
                }
    }

    std::filesystem::path folder_;
    std::vector<Texels> levels_;
    std::unique_ptr<HeadlessContext> context_;
    GLuint clipmapProgram_ = 0, wholeProgram_ = 0;
};

std::size_t common(const Window& a, const Window& b) {
    return Window{std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)}.texels();
}

}  // namespace

TEST_F(TextureClipmaps, ShowWhatAWholeTextureShowsWhereTheyAreComplete) {
    TextureClipmap clipmap(fileOf(texelsOf(1024, 1024, 3, placeTexel)), 256);
    for (const glm::dvec2 focus : {glm::dvec2(0.5, 0.5), glm::dvec2(0.3, 0.71), glm::dvec2(0.0, 1.0), glm::dvec2(0.93, 0.02)}) {
        EXPECT_TRUE(update(clipmap, focus).complete);
        // From magnified to minified, as much as the windows cover without their borders.
        for (const double half : {0.02, 0.05, 0.09}) {
            const auto low = [&](double middle) { return std::clamp(middle - half, 0.0, 1.0); };
            const auto high = [&](double middle) { return std::clamp(middle + half, 0.0, 1.0); };
            const Image found = drawn(clipmap, low(focus.x), low(focus.y), high(focus.x), high(focus.y));
            const Image whole = drawnWhole(low(focus.x), low(focus.y), high(focus.x), high(focus.y));
            EXPECT_LE(largestDifference(found, whole), 3) << focus.x << ", " << focus.y << " half " << half;
        }
        const Image found = drawn(clipmap, 0.0, 0.0, 1.0, 1.0), whole = drawnWhole(0.0, 0.0, 1.0, 1.0);
        EXPECT_LE(largestDifference(found, whole), 3) << "all of the image, smaller than the windows";
    }
    for (const GLuint name : clipmap.release()) glDeleteTextures(1, &name);
}

TEST_F(TextureClipmaps, ShowNoLineAtTheBordersOfLevels) {
    TextureClipmap clipmap(fileOf(texelsOf(2048, 1536, 3, smoothTexel)), 128);
    std::mt19937 random(7);
    for (int i = 0; i < 20; ++i) {
        const glm::dvec2 focus(double(random() % 1000) / 999.0, double(random() % 1000) / 999.0);
        // Half-filled windows have borders too.
        const std::size_t budget = i % 2 ? 3000 : 0;
        update(clipmap, focus, budget, 0, {0.2, -0.3});
        // Magnified, so that everywhere the finest level is asked for, and drawn as coarse as is there.
        const double half = 0.06 * (1 + i % 4);
        const auto low = [&](double middle) { return std::clamp(middle - half, 0.0, 1.0 - half); };
        const double s = low(focus.x), t = low(focus.y);
        const Image found = drawn(clipmap, s, t, s + half, t + half), whole = drawnWhole(s, t, s + half, t + half);
        ASSERT_LE(largestDifference(found, whole), 14) << "focus " << focus.x << ", " << focus.y << " half " << half;
        // Neighbouring pixels differ no more than the waves do.
        int jump = 0, waves = 0;
        for (std::size_t p = 3; p < found.pixels.size(); ++p) {
            if (p % (kPicture * 3) < 3) continue;
            jump = std::max(jump, std::abs(int(found.pixels[p]) - int(found.pixels[p - 3])));
            waves = std::max(waves, std::abs(int(whole.pixels[p]) - int(whole.pixels[p - 3])));
        }
        EXPECT_LE(jump, waves + 2) << "focus " << focus.x << ", " << focus.y << " half " << half;
    }
    for (const GLuint name : clipmap.release()) glDeleteTextures(1, &name);
}

TEST_F(TextureClipmaps, LoadExactlyWhatAMoveExposes) {
    constexpr int kClip = 64;
    TextureClipmap clipmap(fileOf(texelsOf(700, 500, 3, placeTexel)), kClip);
    glm::dvec2 focus(0.4, 0.6);
    update(clipmap, focus);
    ASSERT_EQ(clipmap.levels(), 4);
    std::mt19937 random(3);
    for (int step = 0; step < 200; ++step) {
        std::vector<Window> before;
        for (int level = 0; level < clipmap.levels(); ++level) before.push_back(clipmap.resident(level));
        const double far = step % 20 == 0 ? 0.5 : 0.03;
        focus += glm::dvec2(far * (double(random() % 1000) / 500.0 - 1.0), far * (double(random() % 1000) / 500.0 - 1.0));
        focus = {std::clamp(focus.x, 0.0, 1.0), std::clamp(focus.y, 0.0, 1.0)};
        const auto progress = update(clipmap, focus);
        std::size_t exposed = 0;
        for (int level = 0; level < clipmap.levels(); ++level) {
            const Texels& all = levels_[std::size_t(level)];
            const auto begin = [](double place, int size) { return std::clamp(int(std::floor(place * size)) - kClip / 2, 0, std::max(0, size - kClip)); };
            const int x = begin(focus.x, all.width), y = begin(1.0 - focus.y, all.height);
            const Window expected{x, y, std::min(x + kClip, all.width), std::min(y + kClip, all.height)};
            EXPECT_EQ(clipmap.resident(level), expected) << "level " << level;
            exposed += expected.texels() - common(before[std::size_t(level)], expected);
        }
        EXPECT_EQ(progress.texels, exposed) << "step " << step;
        EXPECT_EQ(update(clipmap, focus).texels, 0u) << "nothing is new where nothing moved";
    }
    expectRightTexels(clipmap);
}

TEST_F(TextureClipmaps, KeepTheBudgetFromCoarseToFine) {
    TextureClipmap clipmap(fileOf(texelsOf(1000, 1000, 3, placeTexel)), 64);
    constexpr std::size_t kBudget = 1500;
    std::size_t total = 0;
    bool complete = false;
    for (int frame = 0; frame < 100 && !complete; ++frame) {
        const auto progress = update(clipmap, {0.5, 0.5}, kBudget);
        EXPECT_LE(progress.texels, kBudget);
        total += progress.texels;
        complete = progress.complete;
        for (int level = 0; level + 1 < clipmap.levels(); ++level)
            if (!clipmap.resident(level).isEmpty()) {
                EXPECT_EQ(clipmap.resident(level + 1).texels(), 64u * 64u) << "level " << level << " came before a coarser one was complete";
            }
    }
    EXPECT_TRUE(complete);
    EXPECT_EQ(total, std::size_t(clipmap.levels()) * 64 * 64) << "each texel once";
    // On the way, with a focus that never rests, what is resident is right all the same.
    std::mt19937 random(5);
    for (int frame = 0; frame < 60; ++frame) EXPECT_LE(update(clipmap, {double(random() % 100) / 99.0, double(random() % 100) / 99.0}, kBudget).texels, kBudget);
    expectRightTexels(clipmap);
}

TEST_F(TextureClipmaps, LoadALineWhateverTheBudget) {
    TextureClipmap clipmap(fileOf(texelsOf(300, 300, 3, placeTexel)), 64);
    std::size_t frames = 0;
    while (!update(clipmap, {0.5, 0.5}, 1).complete && frames < 1000) ++frames;
    EXPECT_LT(frames, 1000u);
}

TEST_F(TextureClipmaps, LeaveLevelsThatAreNotNeededAsTheyAre) {
    TextureClipmap clipmap(fileOf(texelsOf(1000, 1000, 3, placeTexel)), 64);
    update(clipmap, {0.5, 0.5}, 0, 2);
    EXPECT_TRUE(clipmap.resident(0).isEmpty());
    EXPECT_TRUE(clipmap.resident(1).isEmpty());
    EXPECT_EQ(clipmap.resident(2).texels(), 64u * 64u);
    update(clipmap, {0.5, 0.5});
    const Window finest = clipmap.resident(0);
    update(clipmap, {0.1, 0.1}, 0, 1);
    EXPECT_EQ(clipmap.resident(0), finest);
    EXPECT_EQ(update(clipmap, {0.1, 0.1}).texels, 64u * 64u);
}

TEST_F(TextureClipmaps, LieAheadOfTheFocus) {
    TextureClipmap clipmap(fileOf(texelsOf(1024, 1024, 3, placeTexel)), 128);
    update(clipmap, {0.5, 0.5}, 0, 0, {0.25, 0.5});
    EXPECT_EQ(clipmap.resident(0), (Window{512 - 32, 512 - 128, 512 + 96, 512})) << "t grows upwards, rows downwards";
}

TEST_F(TextureClipmaps, HoldAllOfASmallImage) {
    TextureClipmap clipmap(fileOf(texelsOf(200, 100, 3, placeTexel)), 256);
    EXPECT_EQ(update(clipmap, {0.2, 0.9}).texels, 0u);
    EXPECT_EQ(clipmap.levels(), 0);
    EXPECT_LE(largestDifference(drawn(clipmap, 0.0, 0.0, 1.0, 1.0), drawnWhole(0.0, 0.0, 1.0, 1.0)), 2);
    EXPECT_LE(largestDifference(drawn(clipmap, -2.0, -1.0, 3.0, 2.0), drawnWhole(-2.0, -1.0, 3.0, 2.0)), 2) << "clamped outside";
}

TEST_F(TextureClipmaps, TakeMemoryByTheirClipSizeNotByTheImage) {
    std::vector<Texels> levels{texelsOf(4096, 4096, 3, placeTexel)};
    const auto image = fileOf(std::move(levels[0]), 8);
    constexpr std::size_t kClip = 256;
    TextureClipmap clipmap(image, int(kClip));
    for (int step = 0; step <= 20; ++step) {
        update(clipmap, {step / 20.0, 0.3 + step / 40.0});
        ASSERT_LE(image->cacheBytes(), (8u << 20) + 64 * 64 * 4 * 2);
    }
    ASSERT_EQ(clipmap.levels(), 4);
    EXPECT_LE(clipmap.textureBytes(), (4 * kClip * kClip + kClip * kClip * 4 / 3 + 2) * 4);
    EXPECT_GE(clipmap.textureBytes(), 5 * kClip * kClip * 4);
    expectRightTexels(clipmap);
    EXPECT_EQ(clipmap.textureBytes(), 0u);
}

TEST_F(TextureClipmaps, GiveGlStateBack) {
    TextureClipmap clipmap(fileOf(texelsOf(500, 500, 3, placeTexel)), 64);
    GLuint textures[3] = {}, buffer = 0;
    glGenTextures(3, textures);
    glGenBuffers(1, &buffer);
    glActiveTexture(GL_TEXTURE1);
    glBindTexture(GL_TEXTURE_2D, textures[0]);
    glBindTexture(GL_TEXTURE_2D_ARRAY, textures[1]);
    glActiveTexture(GLenum(GL_TEXTURE0 + TextureClipmap::lastUnits()));
    glBindTexture(GL_TEXTURE_2D, textures[2]);
    glActiveTexture(GL_TEXTURE1);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 17);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glUseProgram(clipmapProgram_);
    update(clipmap, {0.3, 0.3});
    { const TextureClipmap::Binding binding(clipmap, clipmapProgram_, TextureClipmap::lastUnits()); }
    const auto value = [](GLenum what) {
        GLint found = 0;
        glGetIntegerv(what, &found);
        return found;
    };
    EXPECT_EQ(value(GL_ACTIVE_TEXTURE), GL_TEXTURE1);
    EXPECT_EQ(value(GL_TEXTURE_BINDING_2D), GLint(textures[0]));
    EXPECT_EQ(value(GL_TEXTURE_BINDING_2D_ARRAY), GLint(textures[1]));
    EXPECT_EQ(value(GL_PIXEL_UNPACK_BUFFER_BINDING), GLint(buffer));
    EXPECT_EQ(value(GL_UNPACK_ROW_LENGTH), 17);
    EXPECT_EQ(value(GL_UNPACK_ALIGNMENT), 1);
    glActiveTexture(GLenum(GL_TEXTURE0 + TextureClipmap::lastUnits()));
    EXPECT_EQ(value(GL_TEXTURE_BINDING_2D), GLint(textures[2]));
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    expectRightTexels(clipmap);
}

TEST_F(TextureClipmaps, OfADamagedFileSaySo) {
    const std::string path = (folder_ / "damaged.ppm").string();
    writeLevels(path, {texelsOf(512, 512, 3, placeTexel)}, 0);
    std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
    const auto image = TiledImage::open(path, 16);
    ASSERT_TRUE(image) << "its header is sound: " << image.error().message();
    TextureClipmap clipmap(image.value(), 64);
    const auto done = clipmap.update({}, 0);
    ASSERT_FALSE(done);
    EXPECT_NE(done.error().message().find(path + ": expected a complete image, found"), std::string::npos) << done.error().message();
    for (const GLuint name : clipmap.release()) glDeleteTextures(1, &name);
}

#endif
