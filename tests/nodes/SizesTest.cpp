// Grids of every size look like the same grid drawn by Coin's own shape.
#include "Scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace test;

namespace {

constexpr float kHole = std::numeric_limits<float>::quiet_NaN();

struct Size {
    const char* name;
    int columns;
    int rows;
    double amplitude;
};

class GridSizes : public testing::TestWithParam<Size> {};

}  // namespace

TEST_P(GridSizes, LookLikeCoinsOwnShape) {
    const auto [name, columns, rows, amplitude] = GetParam();
    const Surface surface = surfaceOf(fractalMap(columns, rows, amplitude));
    const auto camera = [&] { return columns == 3 ? cameraAt({-4.0f, -8.0f, 6.0f}, {1.0f, 12.0f, 0.5f}, 1.0f, 1500.0f) : nullptr; };
    Stage stage;
    const auto draw = [&](Kind kind, const ShapeOptions& options, const Dressing& dress) {
        return stage.render(sceneOf(kind, surface, options, dress, camera()).get());
    };
    const auto lit = draw(Kind::Reference, {}, {}), textured = draw(Kind::Reference, {}, unlitTexture);
    const auto bruteForce = draw(Kind::BruteForce, {}, {});
    expectAlike(lit, bruteForce, 0.1, "brute force");
    std::vector<terrain::Image> pictures{lit, textured, bruteForce};
    for (const Kind kind : kLodKinds) {
        pictures.push_back(draw(kind, {.pixelError = 0.0f}, {}));
        // Bisection cuts every other cell along the other diagonal, the only one of 2 x 2 samples as well.
        expectAlike(lit, pictures.back(), 2.0, (std::string(nameOf(kind)) + " in full detail").c_str());
        pictures.push_back(draw(kind, {}, unlitTexture));
        expectAlike(textured, pictures.back(), columns == 2 ? 8.0 : 2.0, nameOf(kind));
    }
    savePicture(std::string("size_") + name, pictures);
}

INSTANTIATE_TEST_SUITE_P(, GridSizes,
                         testing::Values(Size{"2x2", 2, 2, 0.3}, Size{"3x1000", 3, 1000, 1.0}, Size{"257x129", 257, 129, 40.0},
                                         Size{"300x300", 300, 300, 60.0}, Size{"1025x1025", 1025, 1025, 200.0}),
                         [](const auto& info) { return std::string("Of") + info.param.name; });

TEST(Holes, ShowTheBackgroundAsInCoinsOwnShape) {
    auto map = fractalMap(129, 129, 25.0);
    for (int row = 0; row < 129; ++row)
        for (int column = 0; column < 129; ++column)
            if (std::hypot(column - 40.0, row - 40.0) < 15.0 || (column > 90 && row > 80) || column == 100) map.heights[std::size_t(row * 129 + column)] = kHole;
    expectLikeReference("holes", surfaceOf(map), {}, unlitTexture, 0.1, 3.0);
}

TEST(Holes, OfSingleSamplesStayHoles) {
    auto map = fractalMap(33, 33, 5.0);
    for (const auto& [column, row] : {std::pair{5, 5}, {16, 16}, {20, 7}, {31, 31}, {0, 32}}) map.heights[std::size_t(row * 33 + column)] = kHole;
    expectLikeReference("holes_single", surfaceOf(map), {}, {}, 0.1, 6.0);
}

TEST(Holes, EverywhereDrawNothing) {
    const Surface surface = surfaceOf(mapOf(9, 9, [](double, double) { return kHole; }));
    SbBox3f box(0.0f, 0.0f, 0.0f, 8.0f, 8.0f, 1.0f);
    Stage stage;
    for (const Kind kind : kOurKinds)
        EXPECT_EQ(coveredPixels(stage.render(sceneOf(kind, surface, {}, {}, cameraFor(box)).get())), 0) << nameOf(kind);
}
