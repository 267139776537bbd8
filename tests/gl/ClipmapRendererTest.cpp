// Geometry clipmaps drawn by vertex textures: no crack, no shift and no jump wherever the viewer is, and only what is new is sent.
#include <gtest/gtest.h>

#include <epoxy/gl.h>

#include <cmath>
#include <memory>
#include <set>
#include <tuple>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>

#include "gl/ClipmapRenderer.h"
#include "gl/HeadlessContext.h"

#include "../lod/Maps.h"

using namespace terrain;
using namespace terrain::test;

namespace {

HeightMap plainMap(int columns, int rows, const HeightAt& height) {
    HeightMap map = mapOf(columns, rows, height);
    map.origin = {0.0, 0.0};
    map.spacing = {1.0, 1.0};
    return map;
}

HeightMap roughMap(int columns, int rows) {
    HeightMap map = fractalMap(columns, rows, 7);
    map.origin = {0.0, 0.0};
    map.spacing = {1.0, 1.0};
    return map;
}

/// A map of `levels` levels for a clipmap of size n, and not 2^k + 1.
int sideFor(int n, int levels) {
    return ((n + 1) / 2 - 2) * (1 << (levels - 1)) - 3;
}

/// More of the smallest, whose levels are narrow.
int levelsFor(int n) {
    return n == 15 ? 5 : 3;
}

View lookingDown(double column, double row, double height) {
    const glm::dmat4 projection = glm::perspective(1.0, 1.0, 0.1, 1000.0);
    return {projection * glm::lookAt(glm::dvec3(column, row, height), glm::dvec3(column, row + 1.0, height - 1.0),
                                     glm::dvec3(0.0, 0.0, 1.0)),
            {256.0, 256.0}};
}

/// One clipmap with its context.
class Stage {
public:
    Stage(const HeightMap& map, const ClipmapShape& shape, int width, int height, bool memoryFree = false,
          const SynthesisedDetail* detail = nullptr)
        : grid(map), boxes(grid), errors(grid, 20), detail_(detail), clipmap(ClipmapLayout(map.columns, map.rows, shape)),
          renderer(clipmap.layout(), memoryFree, programs) {
        auto created = HeadlessContext::create(width, height);
        EXPECT_TRUE(created) << created.error().message();
        context = std::move(created).value();
        settings.pixelError = 0.0f;
        settings.cull = false;
        settings.detail = detail;
    }
    ~Stage() {
        deleteNames(renderer.release());
        deleteNames(programs->release());
        EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
    }

    const Clipmap::Frame& select(const View& view) { return frame = &clipmap.select(grid, boxes, &errors, view, settings), *frame; }
    /// Draws what was selected, as `camera` sees it.
    ClipmapRenderer::Drawn draw(const glm::dmat4& camera, const ClipmapShading& shading = {}) {
        context->bindFramebuffer();
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_LEQUAL);
        glClearColor(1.0f, 0.0f, 1.0f, 1.0f);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        ClipmapDrawing drawing;
        drawing.shading = shading;
        drawing.shading.lights = -1;
        drawing.shading.holes = boxes.hasHoles();
        drawing.clipFromFrame = camera;
        drawing.colour = glm::vec4(0.2f, 0.8f, 0.3f, 1.0f);
        const auto drawn = renderer.draw(*frame, {grid, detail_, glm::vec2(1.0f), clipmap.valid()}, drawing);
        EXPECT_TRUE(drawn) << drawn.error().message();
        return drawn ? drawn.value() : ClipmapRenderer::Drawn{};
    }
    /// Straight down on [x0, x1] x [y0, y1] of the frame.
    static glm::dmat4 above(double x0, double y0, double x1, double y1) { return glm::ortho(x0, x1, y0, y1, -kDeep, kDeep); }
    /// Heights in a picture from above.
    std::vector<double> heights() const {
        std::vector<double> result;
        for (const float d : context->readDepth()) result.push_back(d < 1.0f ? kDeep - 2.0 * kDeep * double(d) : std::nan(""));
        return result;
    }
    int backgroundPixels() const {
        const Image image = context->readColor();
        int count = 0;
        for (std::size_t i = 0; i < image.pixels.size(); i += 3)
            count += image.pixels[i] == 255 && image.pixels[i + 1] == 0 && image.pixels[i + 2] == 255;
        return count;
    }
    /// Own and coarser heights in store, by texel, of one layer.
    std::vector<float> stored(int layer) const {
        const std::size_t pitch = std::size_t(clipmap.layout().pitch());
        GLint layers = 0;
        glBindTexture(GL_TEXTURE_2D_ARRAY, renderer.textures().heights());
        glGetTexLevelParameteriv(GL_TEXTURE_2D_ARRAY, 0, GL_TEXTURE_DEPTH, &layers);
        std::vector<float> all(pitch * pitch * 2 * std::size_t(layers));
        glGetTexImage(GL_TEXTURE_2D_ARRAY, 0, GL_RG, GL_FLOAT, all.data());
        glBindTexture(GL_TEXTURE_2D_ARRAY, 0);
        const auto begin = all.begin() + std::ptrdiff_t(pitch * pitch * 2 * std::size_t(layer));
        return {begin, begin + std::ptrdiff_t(pitch * pitch * 2)};
    }

    static constexpr double kDeep = 100.0;
    std::unique_ptr<HeadlessContext> context;
    SampleGrid grid;
    BoxPyramid boxes;
    ClipmapErrors errors;
    const SynthesisedDetail* detail_;
    Clipmap clipmap;
    std::shared_ptr<ProgramPool> programs = std::make_shared<ProgramPool>();
    ClipmapRenderer renderer;
    ClipmapSettings settings;
    const Clipmap::Frame* frame = nullptr;
};

class ClipmapSizes : public testing::TestWithParam<int> {
protected:
    /// Calls `check` with every place of the viewer in two whole periods of the coarsest level, in both directions, and half-way
    /// between samples.
    template <class Check>
    void everywhere(int side, int levels, const Check& check) {
        const int period = 2 << (levels - 1);
        const double begin = std::floor(side / 2.0) - period;
        for (int y = 0; y < 2 * period; ++y)
            for (int x = 0; x < 2 * period; ++x) check(begin + x + 0.5 * (y % 2), begin + y + 0.5 * (x % 2));
    }
};

}  // namespace

TEST_P(ClipmapSizes, DrawARampAsARampWhereverTheViewerIs) {
    // All levels of a ramp are the ramp: a level that is a vertex off, anywhere, is not.
    const int n = GetParam(), levels = levelsFor(n), side = sideFor(n, levels);
    const HeightMap map = plainMap(side, side, [](int column, int row) { return 0.0625f * float(column) - 0.125f * float(row); });
    const double low = 0.0, high = side - 1.0;
    Stage stage(map, {n, 0, 0, 0}, 192, 192);
    ASSERT_EQ(stage.clipmap.layout().levels(), levels);
    double largest = 0.0;
    int missing = 0, positions = 0;
    everywhere(side, levels, [&](double column, double row) {
        stage.settings.activeLevels = levels - positions++ % 2;
        stage.select(lookingDown(column, row, 30.0));
        stage.draw(Stage::above(low, low, high, high));
        const std::vector<double> heights = stage.heights();
        for (int y = 0; y < 192; ++y)
            for (int x = 0; x < 192; ++x) {
                const double h = heights[std::size_t(y * 192 + x)];
                if (std::isnan(h)) {
                    ++missing;
                    continue;
                }
                const double c = (x + 0.5) / 192.0 * high, r = (y + 0.5) / 192.0 * high;
                largest = std::max(largest, std::fabs(h - (0.0625 * c - 0.125 * r)));
            }
    });
    EXPECT_EQ(missing, 0);
    EXPECT_LT(largest, 2e-4) << "over " << positions << " positions";
    RecordProperty("largest", std::to_string(largest));
}

TEST_P(ClipmapSizes, ShowNoBackgroundThroughRoughGroundWhereverTheViewerIs) {
    const int n = GetParam(), levels = levelsFor(n), side = sideFor(n, levels);
    const HeightMap map = roughMap(side, side);
    constexpr int kPicture = 160;
    Stage stage(map, {n, 0, 0, 0}, kPicture, kPicture);
    const double highest = stage.boxes.all().high.z, lowest = stage.boxes.all().low.z;
    int background = 0, positions = 0;
    everywhere(side, levels, [&](double column, double row) {
        const glm::dvec3 eye(column, row, highest + 0.3 * side);
        stage.select(lookingDown(column, row, highest + 2.0));
        // From high enough, to a place near enough to the middle, for the window to end on the ground.
        const double angle = 2.399963 * positions++;
        const glm::dvec3 target(0.5 * side + 0.25 * side * std::cos(angle), 0.5 * side + 0.25 * side * std::sin(angle), lowest);
        const glm::dmat4 camera =
            glm::perspective(0.15, 1.0, 0.5, 4.0 * side) * glm::lookAt(eye, target, glm::dvec3(0.1, 0.2, 1.0));
        stage.draw(camera);
        background += stage.backgroundPixels();
    });
    EXPECT_EQ(background, 0) << "over " << positions << " pictures";
}

TEST_P(ClipmapSizes, HaveNoJumpAcrossBordersOfLevels) {
    // Between neighbouring pixels heights change by no more than the steepest slope allows, on any level.
    const int n = GetParam(), levels = levelsFor(n), side = sideFor(n, levels);
    const HeightMap map = roughMap(side, side);
    double steepest = 0.0;
    for (int row = 0; row < side; ++row)
        for (int column = 0; column + 1 < side; ++column) {
            steepest = std::max(steepest, double(std::fabs(map.at(column + 1, row) - map.at(column, row))));
            steepest = std::max(steepest, double(std::fabs(map.at(row, column + 1) - map.at(row, column))));
        }
    constexpr int kPicture = 256;
    Stage stage(map, {n, 0, 0, 0}, kPicture, kPicture);
    double largest = 0.0;
    int positions = 0;
    everywhere(side, levels, [&](double column, double row) {
        stage.select(lookingDown(column, row, 60.0));
        // A window of 16 cells over the corner of a level, 16 pixels a cell.
        const int level = positions++ % (levels - 1);
        const ClipRect place = stage.clipmap.layout().place(level, stage.frame->viewer);
        const glm::dvec2 corner = glm::dvec2(positions % 3 ? place.high : place.low) * double(1 << level);
        const glm::dvec2 begin = glm::clamp(corner - 8.0, glm::dvec2(0.0), glm::dvec2(side - 17.0));
        stage.draw(Stage::above(begin.x, begin.y, begin.x + 16.0, begin.y + 16.0));
        const std::vector<double> heights = stage.heights();
        for (int y = 0; y < kPicture; ++y)
            for (int x = 0; x + 1 < kPicture; ++x) {
                const std::size_t at = std::size_t(y * kPicture + x), across = std::size_t(x * kPicture + y);
                largest = std::max(largest, std::fabs(heights[at + 1] - heights[at]));
                largest = std::max(largest, std::fabs(heights[across + kPicture] - heights[across]));
                ASSERT_FALSE(std::isnan(heights[at])) << "background at " << x << ", " << y;
            }
    });
    // Vertices that are blended by different shares tilt a cell by as much again at the most.
    EXPECT_LT(largest, 2.0 * steepest / 16.0 + 1e-4) << "over " << positions << " positions; steepest " << steepest;
}

INSTANTIATE_TEST_SUITE_P(, ClipmapSizes, testing::Values(15, 63, 255),
                         [](const auto& info) { return "Of" + std::to_string(info.param); });

TEST(ClipmapRenderer, SendsWhatIsNewlyExposedAndNothingElse) {
    const HeightMap map = roughMap(300, 217);
    Stage stage(map, {31, 0, 0, 0}, 64, 64);
    stage.settings.updateBudget = 1 << 20;
    const ClipmapLayout& layout = stage.clipmap.layout();
    std::vector<std::set<std::pair<int, int>>> have(std::size_t(layout.levels()));
    for (int i = 0; i < 120; ++i) {
        // A flight, a jump, and a stop.
        const double t = i < 60 ? i * 0.9 : i < 100 ? 200.0 + i * 0.35 : 235.0;
        stage.select(lookingDown(20.0 + t, 30.0 + 0.6 * t, 40.0));
        std::size_t exposed = 0, whole = 0;
        for (int level = 0; level < layout.levels(); ++level) {
            // What a level holds, counted vertex by vertex: all that are in the grid, of the levels in use; others keep what
            // overlaps.
            const ClipRect now = layout.place(level, stage.frame->viewer).cutTo(layout.domain(level));
            std::set<std::pair<int, int>> next;
            for (int y = now.low.y; y <= now.high.y; ++y)
                for (int x = now.low.x; x <= now.high.x; ++x) {
                    const bool isThere = have[std::size_t(level)].count({x, y}) > 0;
                    if (level < stage.frame->finest && !isThere) continue;
                    exposed += !isThere;
                    next.insert({x, y});
                }
            whole += next.size();
            have[std::size_t(level)] = std::move(next);
        }
        const ClipmapRenderer::Drawn drawn = stage.draw(Stage::above(0.0, 0.0, 299.0, 216.0));
        EXPECT_EQ(drawn.uploadedBytes, exposed * ClipmapTextures::kBytesPerSample) << "frame " << i;
        if (i != 0 && i != 60 && i != 100) {
            EXPECT_LT(exposed, whole / 4) << "frame " << i;
        }
        EXPECT_LE(drawn.draws, 4u);
        EXPECT_GE(drawn.draws, 1u);
        if (i > 101) {
            EXPECT_EQ(drawn.uploadedBytes, 0u);
        }
    }
}

TEST(ClipmapRenderer, TakesFourDrawsHoweverManyLevels) {
    for (const int detailLevels : {0, 2, 5}) {
        const HeightMap map = roughMap(257, 257);
        const SynthesisedDetail detail(SampleGrid(map), {detailLevels, 0.0f, 1});
        Stage stage(map, {15, 0, detailLevels, 0}, 64, 64, false, &detail);
        stage.settings.activeLevels = stage.clipmap.layout().levels();
        stage.select(lookingDown(100.0, 90.0, 60.0));
        EXPECT_EQ(stage.draw(Stage::above(0.0, 0.0, 256.0, 256.0)).draws, 4u) << stage.clipmap.layout().levels() << " levels";
        EXPECT_EQ(stage.backgroundPixels(), 0);
    }
}

TEST(ClipmapRenderer, MakesTheSameHeightsWithAndWithoutStore) {
    const HeightMap map = roughMap(150, 131);
    const SynthesisedDetail detail(SampleGrid(map), {3, 0.0f, 5});
    Stage kept(map, {31, 0, 3, 0}, 64, 64, false, &detail), made(map, {31, 0, 3, 0}, 64, 64, true, &detail);
    const ClipmapLayout& layout = kept.clipmap.layout();
    for (int i = 0; i < 24; ++i) {
        const View view = lookingDown(30.0 + 1.7 * i, 100.0 - 2.3 * i, 20.0);
        const int active = 1 + i % layout.levels();
        std::vector<std::vector<float>> stored, rebuilt;
        for (Stage* stage : {&kept, &made}) {
            stage->context->makeCurrent();
            stage->settings.activeLevels = active;
            stage->select(view);
            stage->draw(Stage::above(0.0, 0.0, 149.0, 130.0));
            // What memory-free drawing leaves behind is the finest two levels.
            for (int level = stage->frame->finest; level < std::min(stage->frame->finest + 2, layout.levels()); ++level)
                (stage == &kept ? stored : rebuilt).push_back(stage->stored(stage->renderer.textures().layerOf(level)));
        }
        for (std::size_t l = 0; l < stored.size(); ++l) {
            const int level = kept.frame->finest + int(l);
            const ClipRect there = kept.clipmap.valid()[std::size_t(level)];
            for (int y = there.low.y; y <= there.high.y; ++y)
                for (int x = there.low.x; x <= there.high.x; ++x) {
                    const std::size_t at =
                        2 * (std::size_t(layout.texel(y)) * std::size_t(layout.pitch()) + std::size_t(layout.texel(x)));
                    ASSERT_EQ(stored[l][at], rebuilt[l][at]) << "level " << level << " at " << x << ", " << y;
                    ASSERT_EQ(stored[l][at + 1], rebuilt[l][at + 1]) << "level " << level << " at " << x << ", " << y;
                }
        }
    }
    kept.context->makeCurrent();
    deleteNames(kept.renderer.release());
    made.context->makeCurrent();
}

TEST(ClipmapRenderer, StoresTheDetailThatTheProcessorComputes) {
    // Of a small grid all levels but one are detail.
    for (const auto& [columns, rows, size] : {std::tuple{90, 77, 31}, {20, 17, 255}, {2, 2, 15}}) {
        const HeightMap map = roughMap(columns, rows);
        const SynthesisedDetail detail(SampleGrid(map), {3, 0.3f, 9});
        Stage stage(map, {size, 0, 3, 0}, 64, 64, false, &detail);
        const ClipmapLayout& layout = stage.clipmap.layout();
        stage.settings.activeLevels = layout.levels();
        for (int i = 0; i < 20; ++i) {
            stage.select(lookingDown(2.0 + 0.37 * i, 3.0 + 0.21 * i, 20.0));
            stage.draw(Stage::above(0.0, 0.0, columns - 1.0, rows - 1.0));
        }
        for (int level = 0; level < 3; ++level) {
            const ClipRect there = stage.clipmap.valid()[std::size_t(level)];
            ASSERT_GE(there.samples(), 4);
            std::vector<float> expected(std::size_t(there.samples()));
            detail.fill(stage.grid, 3 - level, there, expected.data());
            const std::vector<float> stored = stage.stored(level);
            std::size_t i = 0;
            for (int y = there.low.y; y <= there.high.y; ++y)
                for (int x = there.low.x; x <= there.high.x; ++x, ++i)
                    ASSERT_NEAR(
                        stored[2 * (std::size_t(layout.texel(y)) * std::size_t(layout.pitch()) + std::size_t(layout.texel(x)))],
                        expected[i], 1e-5f)
                        << columns << " x " << rows << ", level " << level << " at " << x << ", " << y;
        }
    }
}

TEST(ClipmapRenderer, EndsExactlyAtTheLastSamples) {
    const HeightMap map = roughMap(101, 58);
    Stage stage(map, {15, 0, 0, 0}, 240, 160);
    const double places[][2] = {{50.0, 30.0}, {0.0, 0.0}, {100.0, 57.0}, {-400.0, 20.0}, {60.0, 900.0}, {99.5, -3.0}};
    for (const auto& [column, row] : places) {
        stage.select(lookingDown(column, row, 30.0));
        // Two pixels a cell, ten cells around the map.
        stage.draw(Stage::above(-10.0, -10.0, 110.0, 70.0));
        const std::vector<double> heights = stage.heights();
        for (int y = 0; y < 160; ++y)
            for (int x = 0; x < 240; ++x) {
                const double c = (x + 0.5) / 2.0 - 10.0, r = (y + 0.5) / 2.0 - 10.0;
                const bool inside = c > 0.0 && c < 100.0 && r > 0.0 && r < 57.0;
                ASSERT_EQ(!std::isnan(heights[std::size_t(y * 240 + x)]), inside)
                    << c << ", " << r << " with the viewer at " << column << ", " << row;
            }
    }
}

TEST(ClipmapRenderer, LeavesOutCellsOfTheFinestLevelThatLackACorner) {
    const HeightMap map = punched(roughMap(25, 25), [](int column, int row) { return std::hypot(column - 12.0, row - 9.0) < 3.0; });
    Stage stage(map, {63, 0, 0, 0}, 240, 240);
    stage.select(lookingDown(12.0, 12.0, 30.0));
    stage.draw(Stage::above(0.0, 0.0, 24.0, 24.0));
    const std::vector<double> heights = stage.heights();
    const auto isMissing = [&](int c, int r) { return std::isnan(map.at(c, r)); };
    for (int y = 0; y < 240; ++y)
        for (int x = 0; x < 240; ++x) {
            const int c = x / 10, r = y / 10;
            const bool hole = isMissing(c, r) || isMissing(c + 1, r) || isMissing(c, r + 1) || isMissing(c + 1, r + 1);
            ASSERT_EQ(std::isnan(heights[std::size_t(y * 240 + x)]), hole) << x << ", " << y;
        }
}

TEST(ClipmapRenderer, RestoresTheStateOfGl) {
    const HeightMap map = roughMap(60, 60);
    const SynthesisedDetail detail(SampleGrid(map), {2, 0.0f, 1});
    Stage stage(map, {15, 0, 2, 0}, 64, 64, false, &detail);
    stage.settings.activeLevels = stage.clipmap.layout().levels();
    stage.context->bindFramebuffer();
    glEnable(GL_BLEND);
    glEnable(GL_RASTERIZER_DISCARD);
    glActiveTexture(GL_TEXTURE1);
    const auto state = [] {
        std::vector<GLint> all;
        for (const GLenum which :
             {GL_CURRENT_PROGRAM, GL_VERTEX_ARRAY_BINDING, GL_ARRAY_BUFFER_BINDING, GL_DRAW_FRAMEBUFFER_BINDING,
              GL_READ_FRAMEBUFFER_BINDING, GL_ACTIVE_TEXTURE, GL_BLEND, GL_SCISSOR_TEST, GL_FRONT_FACE, GL_RASTERIZER_DISCARD,
              GL_UNPACK_ROW_LENGTH, GL_ELEMENT_ARRAY_BUFFER_BINDING}) {
            all.push_back(0);
            glGetIntegerv(which, &all.back());
        }
        GLint viewport[4];
        glGetIntegerv(GL_VIEWPORT, viewport);
        all.insert(all.end(), viewport, viewport + 4);
        for (int unit = 0; unit < 8; ++unit) {
            glActiveTexture(GLenum(GL_TEXTURE0 + unit));
            for (const GLenum which : {GL_TEXTURE_BINDING_2D, GL_TEXTURE_BINDING_2D_ARRAY}) {
                all.push_back(0);
                glGetIntegerv(which, &all.back());
            }
        }
        glActiveTexture(GL_TEXTURE1);
        return all;
    };
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    const std::vector<GLint> before = state();
    stage.select(lookingDown(30.0, 30.0, 20.0));
    stage.draw(Stage::above(0.0, 0.0, 59.0, 59.0));
    EXPECT_EQ(state(), before);
    glDisable(GL_RASTERIZER_DISCARD);
}
