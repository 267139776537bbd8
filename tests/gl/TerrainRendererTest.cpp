// A grid seen from straight above, so that each pixel says which cells were drawn.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include <gtest/gtest.h>

#include <epoxy/gl.h>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/geometric.hpp>

#include "gl/HeadlessContext.h"
#include "gl/TerrainRenderer.h"
#include "lod/BruteForceMesh.h"
#include "lod/ClipmapMesh.h"
#include "lod/RoamMesh.h"

#include "../lod/Maps.h"

using namespace terrain;
using namespace terrain::test;

namespace {

constexpr int kSide = 17, kPixelsPerCell = 8, kPicture = (kSide - 1) * kPixelsPerCell;

/// Colours by column and row, normals up, and on two texture units the place in the grid.
class ColouredSamples : public VertexSource {
public:
    explicit ColouredSamples(bool withAll)
    {
        format_.colours = true;
        format_.normals = withAll;
        if (withAll) format_.textureUnits = {0, 1};
    }
    const VertexFormat& format() const override { return format_; }
    std::uint64_t version() const override { return version_; }
    void write(std::uint32_t sample, std::uint8_t* out) const override
    {
        if (format_.normals) {
            const float normal[3] = {0.0f, 0.0f, 1.0f};
            std::memcpy(out, normal, sizeof normal);
            out += sizeof normal;
        }
        const std::uint8_t colour[4] = {blue_ ? std::uint8_t(0) : std::uint8_t(200), std::uint8_t(sample % kSide * 8), std::uint8_t(blue_ ? 250 : 0), 255};
        std::memcpy(out, colour, sizeof colour);
        out += sizeof colour;
        for (std::size_t i = 0; i < format_.textureUnits.size(); ++i, out += 8) {
            const float at[2] = {float(sample % kSide), float(sample / kSide)};
            std::memcpy(out, at, sizeof at);
        }
    }
    void turnBlue()
    {
        blue_ = true;
        ++version_;
    }

private:
    VertexFormat format_;
    std::uint64_t version_ = 1;
    bool blue_ = false;
};

class TerrainRendererDraws : public testing::Test {
protected:
    HeightMap map = punched(mapOf(kSide, kSide, [](int column, int row) { return 0.1f * float((column * row) % 5); }),
                            [](int column, int row) { return column == 4 && row == 11; });
    Terrain terrain{"Holed", map, {}};
    SampleGrid grid = terrain.grid();
    std::unique_ptr<HeadlessContext> context;
    View view;
    TerrainRenderer renderer;

    void SetUp() override
    {
        auto created = HeadlessContext::create(kPicture, kPicture);
        ASSERT_TRUE(created) << created.error().message();
        context = std::move(created).value();
        view = {glm::ortho(-10.0, -10.0 + kSide - 1, 7.0, 7.0 + 1.5 * (kSide - 1), -50.0, 50.0), {kPicture, kPicture}};
        context->bindFramebuffer();
        glMatrixMode(GL_PROJECTION);
        glLoadMatrixd(&view.clipFromLocal[0][0]);
        glMatrixMode(GL_MODELVIEW);
        glLoadIdentity();
        glDisable(GL_LIGHTING);
    }
    void TearDown() override
    {
        for (const GLuint name : renderer.release()) glDeleteBuffers(1, &name);
        EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
    }
    Image picture()
    {
        glClearColor(0.0f, 0.0f, 0.0f, 1.0f);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        renderer.draw();
        return context->readColor();
    }
    /// Red (or blue) where cells are, black in the hole, green growing with the column.
    void expectCells(const Image& image, int channel) const
    {
        for (int y = 0; y < kPicture; ++y)
            for (int x = 0; x < kPicture; ++x) {
                const std::uint8_t* pixel = image.pixels.data() + (std::size_t(kPicture - 1 - y) * kPicture + std::size_t(x)) * 3;
                const bool solid = !isCellHole(grid, x / kPixelsPerCell, y / kPixelsPerCell);
                ASSERT_EQ(pixel[channel] > 0, solid) << x << ", " << y;
                if (solid) {
                    ASSERT_NEAR(pixel[1], (x + 0.5) / kPixelsPerCell * 8.0, 1.5);
                }
            }
    }
};

}  // namespace

TEST_F(TerrainRendererDraws, EveryCellOfAWholeGridAndNothingInItsHole)
{
    BruteForceMesh mesh;
    const ColouredSamples source(false);
    const std::size_t bytes = renderer.upload(mesh.select(grid, view, {}), grid, source);
    EXPECT_EQ(renderer.triangles(), 2u * (16 * 16 - 4));
    EXPECT_EQ(bytes, kSide * kSide * (12u + 4u) + renderer.triangles() * 12u);
    EXPECT_EQ(renderer.bufferBytes(), bytes);
    expectCells(picture(), 0);
}

TEST_F(TerrainRendererDraws, TheSameFromAPoolOfVertices)
{
    RoamMesh mesh(terrain.model(), grid);
    LodSettings settings;
    settings.pixelError = 0.5f;
    const ColouredSamples source(false);
    EXPECT_GT(renderer.upload(mesh.select(grid, view, settings), grid, source), 0u);
    expectCells(picture(), 0);
    EXPECT_EQ(renderer.upload(mesh.select(grid, view, settings), grid, source), 0u) << "nothing has changed";
    expectCells(picture(), 0);
}

TEST_F(TerrainRendererDraws, WhatVerticesBetweenSamplesCarry)
{
    /// Green grows with the place; `write` would be wrong.
    class Between : public ColouredSamples {
    public:
        Between() : ColouredSamples(false) {}
        void write(std::uint32_t, std::uint8_t* out) const override { std::memset(out, 0, 4); }
        void writeAt(glm::vec2 place, std::uint32_t nearest, std::uint8_t* out) const override
        {
            EXPECT_LE(glm::length(place - glm::vec2(nearest % kSide, nearest / kSide)), 0.75f);
            const std::uint8_t colour[4] = {200, std::uint8_t(std::lround(place.x * 8.0f)), 0, 255};
            std::memcpy(out, colour, sizeof colour);
        }
    };
    ClipmapSettings options;
    options.activeLevels = 100;
    const auto detail = std::make_shared<SynthesisedDetail>(grid, DetailShape{2, 0.0f, 1});
    ClipmapMesh mesh(kSide, kSide, {63, 0, 2, 0}, options, terrain.model().boxes, {}, detail);
    const Between source;
    const DrawList list = mesh.select(grid, view, {});
    EXPECT_GT(list.report.triangles, 4u * 2 * (16 * 16 - 4));
    renderer.upload(list, grid, source);
    expectCells(picture(), 0);
}

TEST_F(TerrainRendererDraws, AMeshThatChangesFromFrameToFrame)
{
    RoamMesh mesh(terrain.model(), grid);
    const ColouredSamples source(false);
    for (const float pixelError : {50.0f, 0.0f, 3.0f, 50.0f, 0.5f}) {
        LodSettings settings;
        settings.pixelError = pixelError;
        renderer.upload(mesh.select(grid, view, settings), grid, source);
        expectCells(picture(), 0);
    }
}

TEST_F(TerrainRendererDraws, NewAttributesWhenTheirVersionChanges)
{
    for (const bool pool : {false, true}) {
        std::unique_ptr<LodAlgorithm> mesh;
        if (pool)
            mesh = std::make_unique<RoamMesh>(terrain.model(), grid);
        else
            mesh = std::make_unique<BruteForceMesh>();
        ColouredSamples source(false);
        TerrainRenderer own;
        std::swap(own, renderer);
        renderer.upload(mesh->select(grid, view, {}), grid, source);
        expectCells(picture(), 0);
        source.turnBlue();
        renderer.upload(mesh->select(grid, view, {}), grid, source);
        expectCells(picture(), 2);
        std::swap(own, renderer);
        for (const GLuint name : own.release()) glDeleteBuffers(1, &name);
    }
}

TEST_F(TerrainRendererDraws, FromAttributesOfWhichOnlyNewOnesWereSent)
{
    // A pool that grows and changes its samples here and there.
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> samples;
    const ColouredSamples source(true);
    const std::size_t stride = source.format().stride();
    std::mt19937 random(8);
    for (int frame = 0; frame < 60; ++frame) {
        std::vector<std::uint32_t> fresh;
        if (frame % 10 == 0)
            for (std::uint32_t i = 0, count = 100 + random() % 500; i < count; ++i) {
                fresh.push_back(std::uint32_t(samples.size()));
                samples.push_back(0);
                positions.emplace_back(0.0f);
            }
        for (int piece = int(random() % 4); piece > 0; --piece) {
            const std::uint32_t first = random() % std::uint32_t(samples.size());
            for (std::uint32_t i = first; i < std::min<std::uint32_t>(first + 20, std::uint32_t(samples.size())); ++i) fresh.push_back(i);
        }
        std::sort(fresh.begin(), fresh.end());
        fresh.erase(std::unique(fresh.begin(), fresh.end()), fresh.end());
        for (const std::uint32_t vertex : fresh) samples[vertex] = random() % (kSide * kSide);
        DrawList list;
        list.positions = positions;
        list.samples = samples;
        list.newVertices = fresh;
        list.positionsChanged = !fresh.empty();
        const std::size_t sent = renderer.upload(list, grid, source, true);
        const std::size_t news = frame == 0 ? samples.size() : fresh.size();
        ASSERT_EQ(renderer.newVertexBytes(), news * (12 + stride)) << "frame " << frame;
        ASSERT_EQ(sent, (fresh.empty() ? 0 : positions.size() * 12) + news * stride) << "frame " << frame;
    }
    const std::vector<GLuint> names = renderer.release();
    std::vector<std::uint8_t> held(samples.size() * stride), expected(held.size());
    glBindBuffer(GL_ARRAY_BUFFER, names.back());
    glGetBufferSubData(GL_ARRAY_BUFFER, 0, GLsizeiptr(held.size()), held.data());
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    for (std::size_t i = 0; i < samples.size(); ++i) source.write(samples[i], expected.data() + i * stride);
    EXPECT_EQ(held, expected);
    glDeleteBuffers(GLsizei(names.size()), names.data());
}

TEST_F(TerrainRendererDraws, WithoutTouchingClientState)
{
    RoamMesh mesh(terrain.model(), grid);
    const ColouredSamples source(true);
    renderer.upload(mesh.select(grid, view, {}), grid, source);
    GLuint theirs = 0;
    glGenBuffers(1, &theirs);
    glClientActiveTexture(GL_TEXTURE1);
    glEnableClientState(GL_NORMAL_ARRAY);
    glBindBuffer(GL_ARRAY_BUFFER, theirs);
    glNormalPointer(GL_FLOAT, 24, nullptr);
    glBindBuffer(GL_ARRAY_BUFFER, 0);

    expectCells(picture(), 0);

    EXPECT_TRUE(glIsEnabled(GL_NORMAL_ARRAY));
    EXPECT_FALSE(glIsEnabled(GL_VERTEX_ARRAY));
    EXPECT_FALSE(glIsEnabled(GL_COLOR_ARRAY));
    GLint unit = 0, stride = 0, owner = 0, bound = 1, elements = 1;
    glGetIntegerv(GL_CLIENT_ACTIVE_TEXTURE, &unit);
    glGetIntegerv(GL_NORMAL_ARRAY_STRIDE, &stride);
    glGetIntegerv(GL_NORMAL_ARRAY_BUFFER_BINDING, &owner);
    glGetIntegerv(GL_ARRAY_BUFFER_BINDING, &bound);
    glGetIntegerv(GL_ELEMENT_ARRAY_BUFFER_BINDING, &elements);
    EXPECT_EQ(unit, GL_TEXTURE1);
    EXPECT_EQ(stride, 24);
    EXPECT_EQ(owner, GLint(theirs));
    EXPECT_EQ(bound, 0);
    EXPECT_EQ(elements, 0);
    for (const GLenum texture : {GL_TEXTURE0, GL_TEXTURE1}) {
        glClientActiveTexture(texture);
        EXPECT_FALSE(glIsEnabled(GL_TEXTURE_COORD_ARRAY));
    }
    glClientActiveTexture(GL_TEXTURE0);
    glDisableClientState(GL_NORMAL_ARRAY);
    glDeleteBuffers(1, &theirs);
}

TEST_F(TerrainRendererDraws, NothingAfterItsBuffersWereReleasedAndAllAgainOnceUploaded)
{
    BruteForceMesh mesh;
    const ColouredSamples source(true);
    renderer.upload(mesh.select(grid, view, {}), grid, source);
    const std::vector<GLuint> names = renderer.release();
    EXPECT_EQ(names.size(), 3u);
    for (const GLuint name : names) {
        EXPECT_TRUE(glIsBuffer(name)) << "they are the caller's to delete";
        glDeleteBuffers(1, &name);
    }
    EXPECT_TRUE(renderer.release().empty());
    EXPECT_EQ(renderer.triangles(), 0u);
    EXPECT_EQ(renderer.bufferBytes(), 0u);
    for (const std::uint8_t value : picture().pixels) ASSERT_EQ(value, 0);

    BruteForceMesh fresh;
    renderer.upload(fresh.select(grid, view, {}), grid, source);
    expectCells(picture(), 0);
}

TEST_F(TerrainRendererDraws, NothingOfAGridOfHoles)
{
    const Terrain holes = allHoles(kSide);
    const SampleGrid none = holes.grid();
    RoamMesh mesh(holes.model(), none);
    const ColouredSamples source(false);
    renderer.upload(mesh.select(none, view, {}), none, source);
    for (const std::uint8_t value : picture().pixels) ASSERT_EQ(value, 0);
}
