#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include <unistd.h>

#include <gtest/gtest.h>

#include "height/HeightSource.h"
#include "height/ImageSource.h"
#include "height/RasterSource.h"

#ifdef HAVE_OPENIMAGEIO
#include <OpenImageIO/imageio.h>
#endif

using namespace terrain;

namespace {

class ImageSource : public testing::Test {
protected:
    ImageSource() : folder_(std::filesystem::temp_directory_path() / ("soterrain-image-" + std::to_string(getpid()))) {
        std::filesystem::create_directories(folder_);
    }
    ~ImageSource() override { std::filesystem::remove_all(folder_); }

    void SetUp() override {
        if (!hasImageReader()) GTEST_SKIP() << "built without OpenImageIO";
    }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }

    static std::string problemOf(const std::string& path, const HeightFileOptions& options = {}) {
        const auto source = openHeightFile(path, options);
        return source ? "no error" : source.error().message();
    }

    std::filesystem::path folder_;
};

}  // namespace

TEST_F(ImageSource, AMissingFileIsReportedAsSuch) {
    EXPECT_NE(problemOf(path("absent.png")).find("no such file"), std::string::npos);
}

TEST_F(ImageSource, AFileOfNonsenseIsAnErrorWithAReason) {
    for (const char* name : {"nonsense.png", "nonsense.tif", "nonsense", "nonsense.jpg", "empty.exr"}) {
        std::ofstream(path(name)) << (std::string(name) == "empty.exr" ? "" : "these are no heights at all");
        const std::string problem = problemOf(path(name));
        EXPECT_GT(problem.size(), path(name).size() + 20) << problem;
        EXPECT_NE(problem, "no error") << name;
    }
}

#ifdef HAVE_OPENIMAGEIO

namespace {

using OIIO::TypeDesc;

/// An image of T written as it is.
template <class T>
void writeImage(const std::string& path, int width, int height, int channels, TypeDesc type, const std::vector<T>& pixels,
                int tile = 0) {
    const QuietRasterLibrary quiet;
    const auto output = OIIO::ImageOutput::create(path);
    ASSERT_TRUE(output) << OIIO::geterror();
    OIIO::ImageSpec spec(width, height, channels, type);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    if (tile > 0) spec.tile_width = spec.tile_height = tile;
    ASSERT_TRUE(output->open(path, spec)) << output->geterror();
    ASSERT_TRUE(output->write_image(OIIO::BaseTypeFromC<T>::value, pixels.data())) << output->geterror();
    ASSERT_TRUE(output->close()) << output->geterror();
}

HeightMap read(const std::string& path, const HeightFileOptions& options = {}) {
    const auto source = openHeightFile(path, options);
    EXPECT_TRUE(source) << source.error().message();
    return source ? *source.value()->map() : HeightMap{};
}

/// Noise that does not compress, so that half of a file is half of an image.
template <class T>
std::vector<T> noise(std::size_t count) {
    std::vector<T> values(count);
    std::uint32_t state = 1;
    for (T& value : values) value = T((state = state * 1664525u + 1013904223u) >> 16);
    return values;
}

void truncate(const std::string& path, double part) {
    std::filesystem::resize_file(path, std::uintmax_t(double(std::filesystem::file_size(path)) * part));
}

}  // namespace

TEST_F(ImageSource, TheTopRowIsTheNorthernmost) {
    writeImage<std::uint8_t>(path("a.png"), 3, 2, 1, TypeDesc::UINT8, {1, 2, 3, 4, 5, 6});
    const HeightMap map = read(path("a.png"));
    EXPECT_EQ(map.columns, 3);
    EXPECT_EQ(map.rows, 2);
    EXPECT_EQ(map.heights, (std::vector<float>{4, 5, 6, 1, 2, 3}));
    EXPECT_EQ(map.spacing, glm::dvec2(1.0, 1.0));
    EXPECT_EQ(map.origin, glm::dvec2(0.0, 0.0));
}

TEST_F(ImageSource, IntegerSamplesKeepTheirValues) {
    writeImage<std::uint8_t>(path("8.png"), 2, 2, 1, TypeDesc::UINT8, {0, 1, 254, 255});
    EXPECT_EQ(read(path("8.png")).heights, (std::vector<float>{254, 255, 0, 1}));
    writeImage<std::uint16_t>(path("16.png"), 2, 2, 1, TypeDesc::UINT16, {0, 257, 40000, 65535});
    EXPECT_EQ(read(path("16.png")).heights, (std::vector<float>{40000, 65535, 0, 257}));
    writeImage<std::uint16_t>(path("16.tif"), 2, 2, 1, TypeDesc::UINT16, {0, 257, 40000, 65535});
    EXPECT_EQ(read(path("16.tif")).heights, (std::vector<float>{40000, 65535, 0, 257}));
    writeImage<std::int16_t>(path("s16.tif"), 2, 2, 1, TypeDesc::INT16, {-32768, -1, 0, 32767});
    EXPECT_EQ(read(path("s16.tif")).heights, (std::vector<float>{0, 32767, -32768, -1}));
    writeImage<std::uint32_t>(path("32.tif"), 2, 2, 1, TypeDesc::UINT32, {0, 16777215, 65536, 4294967040u});
    EXPECT_EQ(read(path("32.tif")).heights, (std::vector<float>{65536, 4294967040.0f, 0, 16777215}));
    writeImage<std::int32_t>(path("s32.tif"), 2, 2, 1, TypeDesc::INT32, {-5, 16777215, 65536, -2147483647 - 1});
    EXPECT_EQ(read(path("s32.tif")).heights, (std::vector<float>{65536, -2147483648.0f, -5, 16777215}));
}

TEST_F(ImageSource, LargeIntegersKeepTheirDigitsUntilTheyAreScaled) {
    writeImage<std::uint32_t>(path("32.tif"), 2, 2, 1, TypeDesc::UINT32, {4000000001u, 4000000002u, 4000000003u, 4000000004u});
    HeightFileOptions options;
    options.heightOffset = -4000000000.0;
    options.noData = 4000000004.0;
    const HeightMap map = read(path("32.tif"), options);
    EXPECT_EQ(map.at(0, 1), 1.0f);
    EXPECT_EQ(map.at(1, 1), 2.0f);
    EXPECT_EQ(map.at(0, 0), 3.0f);
    EXPECT_TRUE(std::isnan(map.at(1, 0)));
}

TEST_F(ImageSource, FloatingPointSamplesKeepTheirValues) {
    const std::vector<float> values{-1234.5f, 0.0f, 65504.0f, 0.25f};
    const std::vector<float> flipped{65504.0f, 0.25f, -1234.5f, 0.0f};
    writeImage<float>(path("f.tif"), 2, 2, 1, TypeDesc::FLOAT, values);
    EXPECT_EQ(read(path("f.tif")).heights, flipped);
    writeImage<double>(path("d.tif"), 2, 2, 1, TypeDesc::DOUBLE, {-1234.5, 0.0, 65504.0, 0.25});
    EXPECT_EQ(read(path("d.tif")).heights, flipped);
    if (!OIIO::ImageOutput::create(path("f.exr"))) GTEST_SKIP() << "OpenImageIO without OpenEXR";
    writeImage<float>(path("f.exr"), 2, 2, 1, TypeDesc::FLOAT, values);
    EXPECT_EQ(read(path("f.exr")).heights, flipped);
    writeImage<float>(path("h.exr"), 2, 2, 1, TypeDesc::HALF, values);
    EXPECT_EQ(read(path("h.exr")).heights, (std::vector<float>{65504.0f, 0.25f, -1234.0f, 0.0f}));
}

TEST_F(ImageSource, InfiniteAndMissingSamplesAreHoles) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    writeImage<float>(path("f.tif"), 2, 2, 1, TypeDesc::FLOAT, {infinity, -9999.9f, std::nanf(""), 3.0f});
    HeightFileOptions options;
    options.noData = -9999.9;
    const HeightMap map = read(path("f.tif"), options);
    EXPECT_TRUE(std::isnan(map.at(0, 1)));
    EXPECT_TRUE(std::isnan(map.at(1, 1)));
    EXPECT_TRUE(std::isnan(map.at(0, 0)));
    EXPECT_EQ(map.at(1, 0), 3.0f);
}

TEST_F(ImageSource, TiledAndTallImagesAreReadWhole) {
    const int width = 100, height = 150;
    const auto pixels = noise<std::uint16_t>(std::size_t(width * height));
    writeImage(path("tiled.tif"), width, height, 1, TypeDesc::UINT16, pixels, 32);
    writeImage(path("tall.png"), width, height, 1, TypeDesc::UINT16, pixels);
    for (const char* name : {"tiled.tif", "tall.png"}) {
        const HeightMap map = read(path(name));
        ASSERT_EQ(map.heights.size(), pixels.size());
        for (int row = 0; row < height; ++row)
            for (int column = 0; column < width; ++column)
                ASSERT_EQ(map.at(column, height - 1 - row), float(pixels[std::size_t(row * width + column)])) << name;
    }
}

TEST_F(ImageSource, AlphaDoesNotTouchTheHeights) {
    writeImage<std::uint8_t>(path("ga.png"), 2, 2, 2, TypeDesc::UINT8, {10, 0, 20, 128, 30, 255, 40, 1});
    EXPECT_EQ(read(path("ga.png")).heights, (std::vector<float>{30, 40, 10, 20}));
    HeightFileOptions options;
    options.channel = 1;
    EXPECT_EQ(read(path("ga.png"), options).heights, (std::vector<float>{255, 1, 0, 128}));
}

TEST_F(ImageSource, ThreeChannelsNeedAChoice) {
    writeImage<std::uint8_t>(path("rgb.png"), 2, 2, 3, TypeDesc::UINT8, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});
    const std::string problem = problemOf(path("rgb.png"));
    EXPECT_NE(problem.find("3 channels"), std::string::npos) << problem;
    EXPECT_NE(problem.find("option channel"), std::string::npos) << problem;
    HeightFileOptions options;
    options.channel = 2;
    EXPECT_EQ(read(path("rgb.png"), options).heights, (std::vector<float>{9, 12, 3, 6}));
    for (int channel : {3, -2, 1000000}) {
        options.channel = channel;
        EXPECT_NE(problemOf(path("rgb.png"), options).find(std::to_string(channel)), std::string::npos);
    }
}

TEST_F(ImageSource, ATruncatedImageIsAnError) {
    const auto pixels = noise<std::uint8_t>(200 * 200);
    HeightFileOptions options;
    options.channel = 0;
    for (const char* name : {"t.png", "t.tif", "t.jpg", "t.exr", "t.bmp"})
        for (double part : {0.9, 0.5, 0.1, 0.01}) {
            writeImage(path(name), 200, 200, 1, TypeDesc::UINT8, pixels);
            ASSERT_EQ(problemOf(path(name), options), "no error") << name;
            truncate(path(name), part);
            EXPECT_NE(problemOf(path(name), options), "no error") << name << " cut to " << part;
        }
}

TEST_F(ImageSource, ATruncatedSixteenBitImageIsAnError) {
    const auto pixels = noise<std::uint16_t>(200 * 200);
    for (const char* name : {"t16.png", "t16.tif"})
        for (double part : {0.99, 0.6}) {
            writeImage(path(name), 200, 200, 1, TypeDesc::UINT16, pixels);
            truncate(path(name), part);
            EXPECT_NE(problemOf(path(name)), "no error") << name << " cut to " << part;
        }
}

TEST_F(ImageSource, ATruncatedTiffSaysSoInItsMessageAlone) {
    // Rasters open first, so that their library has taken over the error output of the shared TIFF library.
    writeImage(path("whole.tif"), 200, 200, 1, TypeDesc::UINT16, noise<std::uint16_t>(200 * 200));
    ASSERT_EQ(problemOf(path("whole.tif")), "no error");
    truncate(path("whole.tif"), 0.6);
    testing::internal::CaptureStderr();
    EXPECT_NE(problemOf(path("whole.tif")), "no error");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(ImageSource, AnImageOfOneRowIsAnError) {
    writeImage<std::uint8_t>(path("line.png"), 4, 1, 1, TypeDesc::UINT8, {1, 2, 3, 4});
    EXPECT_NE(problemOf(path("line.png")).find("4 x 1"), std::string::npos);
}

TEST_F(ImageSource, ContentCountsAndNotTheExtension) {
    writeImage<std::uint8_t>(path("a.png"), 2, 2, 1, TypeDesc::UINT8, {1, 2, 3, 4});
    std::filesystem::rename(path("a.png"), path("a.tif"));
    EXPECT_EQ(read(path("a.tif")).heights, (std::vector<float>{3, 4, 1, 2}));
}

#endif
