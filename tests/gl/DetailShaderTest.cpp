// The same detail from a fragment shader as from the CPU.
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <epoxy/gl.h>

#include "gl/DetailShader.h"
#include "gl/HeadlessContext.h"

#include "../lod/Maps.h"

using namespace terrain;
using namespace terrain::test;

namespace {

constexpr int kSize = 64;

GLuint compile(GLenum stage, const std::string& source)
{
    const GLuint shader = glCreateShader(stage);
    const char* text = source.c_str();
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    char log[2000] = "";
    glGetShaderInfoLog(shader, sizeof log, nullptr, log);
    GLint compiled = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    EXPECT_TRUE(compiled) << log;
    return shader;
}

/// Draws kSize x kSize floats, one for each vertex from `low` on.
class DetailShader : public testing::Test {
protected:
    void SetUp() override
    {
        auto created = HeadlessContext::create(kSize, kSize);
        ASSERT_TRUE(created) << created.error().message();
        context = std::move(created).value();
        const std::string version = "#version 130\n";
        program = glCreateProgram();
        glAttachShader(program, compile(GL_VERTEX_SHADER, version + "void main() { gl_Position = gl_Vertex; }"));
        glAttachShader(program, compile(GL_FRAGMENT_SHADER, version + detailShaderSource() + R"(
uniform sampler2D coarser;
uniform ivec2 low, coarserLow, lastCoarser;
uniform int level, what;
float coarserHeightAt(ivec2 vertex) { return texelFetch(coarser, vertex - coarserLow, 0).r; }
void main()
{
    ivec2 vertex = low + ivec2(gl_FragCoord.xy);
    gl_FragColor = vec4(what == 0 ? detailNoise(vertex, level) : detailHeight(vertex, level, lastCoarser));
}
)"));
        glLinkProgram(program);
        glUseProgram(program);
        glGenFramebuffers(1, &framebuffer);
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
        target = texture(kSize, kSize, nullptr);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target, 0);
        ASSERT_EQ(glCheckFramebufferStatus(GL_FRAMEBUFFER), GLenum(GL_FRAMEBUFFER_COMPLETE));
        glViewport(0, 0, kSize, kSize);
        glDisable(GL_BLEND);
        glClampColor(GL_CLAMP_FRAGMENT_COLOR, GL_FALSE);
        glClampColor(GL_CLAMP_READ_COLOR, GL_FALSE);
    }

    static GLuint texture(int columns, int rows, const float* values)
    {
        GLuint name = 0;
        glGenTextures(1, &name);
        glBindTexture(GL_TEXTURE_2D, name);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_R32F, columns, rows, 0, GL_RED, GL_FLOAT, values);
        return name;
    }

    void set(const char* uniform, glm::ivec2 v) { glUniform2i(glGetUniformLocation(program, uniform), v.x, v.y); }
    void set(const char* uniform, int v) { glUniform1i(glGetUniformLocation(program, uniform), v); }

    std::vector<float> draw(const SynthesisedDetail& detail, int level, glm::ivec2 low, bool heights)
    {
        glActiveTexture(GL_TEXTURE1);
        const GLuint table = makeNoiseTexture(detail);
        setDetailUniforms(program, detail, 1);
        set("coarser", 0);
        set("low", low);
        set("level", level);
        set("what", heights ? 1 : 0);
        glRectf(-1.0f, -1.0f, 1.0f, 1.0f);
        std::vector<float> drawn(kSize * kSize);
        glReadPixels(0, 0, kSize, kSize, GL_RED, GL_FLOAT, drawn.data());
        glDeleteTextures(1, &table);
        EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
        return drawn;
    }

    std::unique_ptr<HeadlessContext> context;
    GLuint program = 0, framebuffer = 0, target = 0;
};

bool sameBits(float a, float b)
{
    return std::memcmp(&a, &b, sizeof a) == 0 || (std::isnan(a) && std::isnan(b));
}

/// Of heights of a level in the grid, from a texture of the coarser level's.
::testing::AssertionResult agrees(const SampleGrid& grid, const SynthesisedDetail& detail, int level, const ClipRect& rect,
                                  const std::vector<float>& drawn)
{
    std::vector<float> expected(std::size_t(rect.samples()));
    detail.fill(grid, level, rect, expected.data());
    for (int y = 0; y < rect.rows(); ++y)
        for (int x = 0; x < rect.columns(); ++x) {
            const float a = drawn[std::size_t(y * kSize + x)], b = expected[std::size_t(y * rect.columns() + x)];
            if (!sameBits(a, b))
                return ::testing::AssertionFailure()
                       << "level " << level << ", " << rect.low.x + x << ", " << rect.low.y + y << ": " << a << " drawn, " << b;
        }
    return ::testing::AssertionSuccess();
}

}  // namespace

TEST_F(DetailShader, MakesTheNoiseOfTheCpuBitForBit)
{
    const Terrain terrain = fractal(40, 23);
    for (const std::uint32_t seed : {0u, 1u, 0xDEADBEEFu}) {
        const SynthesisedDetail detail(terrain.grid(), {8, 1.7f, seed});
        for (int level = 1; level <= 8; ++level)
            for (const glm::ivec2 low : {glm::ivec2(0), glm::ivec2(1234567, 89), glm::ivec2(1 << 29, 1 << 29)}) {
                const std::vector<float> drawn = draw(detail, level, low, false);
                for (int y = 0; y < kSize; ++y)
                    for (int x = 0; x < kSize; ++x)
                        ASSERT_TRUE(sameBits(drawn[std::size_t(y * kSize + x)], detail.noise(low + glm::ivec2(x, y), level)))
                            << "seed " << seed << ", level " << level << ", " << x << ", " << y;
            }
    }
}

TEST_F(DetailShader, MakesTheHeightsOfTheCpuBitForBit)
{
    for (const Terrain& terrain : {fractal(40, 23), fractal(2, 2), fractal(3, 50), spike(33), withDisc(40, 33), withBorderStrip(33),
                                   withCheckerboard(25)}) {
        const SampleGrid grid = terrain.grid();
        for (const float amplitude : {0.0f, 0.37f, -1.0f}) {
            const SynthesisedDetail detail(grid, {8, amplitude, 5});
            for (int level = 1; level <= 8; ++level) {
                const glm::ivec2 last = SynthesisedDetail::lastVertex(grid, level);
                // The first corner, the last one, and an odd place between.
                for (const glm::ivec2 wanted : {glm::ivec2(0), last - (kSize - 1), (last - kSize) / 2 | 1}) {
                    const glm::ivec2 low = glm::max(wanted, glm::ivec2(0));
                    const ClipRect rect{low, glm::min(low + (kSize - 1), last)};
                    const ClipRect coarser = SynthesisedDetail::coarserNeeded(grid, level, rect);
                    std::vector<float> heights(std::size_t(coarser.samples()));
                    detail.fill(grid, level - 1, coarser, heights.data());
                    glActiveTexture(GL_TEXTURE0);
                    const GLuint from = texture(coarser.columns(), coarser.rows(), heights.data());
                    set("coarserLow", coarser.low);
                    set("lastCoarser", SynthesisedDetail::lastVertex(grid, level - 1));
                    const std::vector<float> drawn = draw(detail, level, rect.low, true);
                    glDeleteTextures(1, &from);
                    ASSERT_TRUE(agrees(grid, detail, level, rect, drawn)) << terrain.name << ", amplitude " << amplitude;
                }
            }
        }
    }
}
