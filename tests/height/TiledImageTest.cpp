#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <thread>

#include <unistd.h>

#include <gtest/gtest.h>

#include "height/TiledImage.h"

using namespace terrain;

#ifdef HAVE_OPENIMAGEIO

#include "TiledFiles.h"

using namespace terrain::test;

namespace {

class TiledImages : public testing::Test {
protected:
    TiledImages() : folder_(std::filesystem::temp_directory_path() / ("soterrain-tiled-" + std::to_string(getpid()))) {
        std::filesystem::create_directories(folder_);
    }
    ~TiledImages() override { std::filesystem::remove_all(folder_); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }

    std::shared_ptr<const TiledImage> open(const std::string& name, int megabytes = 64) const {
        auto opened = TiledImage::open(path(name), megabytes);
        if (!opened) {
            ADD_FAILURE() << opened.error().message();
            return nullptr;
        }
        return std::move(opened).value();
    }

    /// All of a level, or nothing after a failure.
    static std::vector<std::uint8_t> whole(const TiledImage& image, int level) {
        const TiledImage::Size size = image.size(level);
        std::vector<std::uint8_t> rgba(std::size_t(size.width) * std::size_t(size.height) * 4);
        const auto read = image.read(level, 0, 0, size.width, size.height, rgba.data());
        if (!read) {
            ADD_FAILURE() << read.error().message();
            return {};
        }
        EXPECT_EQ(read.value(), rgba.size() / 4);
        return rgba;
    }

    static void expectColours(const Texels& expected, const std::vector<std::uint8_t>& rgba, int tolerance) {
        ASSERT_EQ(rgba.size(), expected.bytes.size() / std::size_t(expected.channels) * 4);
        for (std::size_t i = 0; i < rgba.size() / 4; ++i)
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(rgba[i * 4 + std::size_t(c)], expected.bytes[i * std::size_t(expected.channels) + std::size_t(c)], tolerance)
                    << "texel " << i << " of " << expected.width << "x" << expected.height;
    }

    std::filesystem::path folder_;
};

}  // namespace

TEST_F(TiledImages, HaveLevelsDownToOneTexel) {
    writeLevels(path("plain.png"), {texelsOf(300, 130, 3, placeTexel)}, 0);
    const auto image = open("plain.png");
    ASSERT_TRUE(image);
    ASSERT_EQ(image->levels(), 9);
    for (int level = 0; level < 9; ++level) {
        EXPECT_EQ(image->size(level).width, std::max(1, 300 >> level));
        EXPECT_EQ(image->size(level).height, std::max(1, 130 >> level));
    }
}

TEST_F(TiledImages, GiveTheTexelsOfTheFilesOwnLevels) {
    // Levels that are no averages of each other, so that none can be taken for another.
    std::vector<Texels> levels;
    for (int size = 256; size >= 1; size /= 2)
        levels.push_back(texelsOf(size, size, 3, [size](int x, int y, int c) { return placeTexel(x + size, y, c); }));
    writeLevels(path("levels.tif"), levels, 64);
    const auto image = open("levels.tif");
    ASSERT_TRUE(image);
    ASSERT_EQ(image->levels(), int(levels.size()));
    for (int level = 0; level < image->levels(); ++level) expectColours(levels[std::size_t(level)], whole(*image, level), 0);
}

TEST_F(TiledImages, GiveAnyPartOfALevel) {
    const Texels all = texelsOf(200, 150, 3, placeTexel);
    writeLevels(path("part.tif"), {all}, 64);
    const auto image = open("part.tif");
    ASSERT_TRUE(image);
    std::vector<std::uint8_t> rgba(std::size_t(71 * 33 * 4));
    ASSERT_TRUE(image->read(0, 60, 61, 71, 33, rgba.data()));
    expectColours(texelsOf(71, 33, 3, [](int x, int y, int c) { return placeTexel(x + 60, y + 61, c); }), rgba, 0);
}

TEST_F(TiledImages, WithoutLevelsGiveAverages) {
    const std::vector<Texels> levels = levelsOf(texelsOf(512, 256, 3, smoothTexel));
    writeLevels(path("plain.png"), {levels[0]}, 0);
    const auto image = open("plain.png");
    ASSERT_TRUE(image);
    for (int level = 0; level < image->levels(); ++level) expectColours(levels[std::size_t(level)], whole(*image, level), 2 + level);
}

TEST_F(TiledImages, GoOnHalvingWhereTheFileEnds) {
    const std::vector<Texels> levels = levelsOf(texelsOf(301, 203, 3, placeTexel));
    writeLevels(path("few.tif"), {levels[0], levels[1], levels[2]}, 64);
    const auto image = open("few.tif");
    ASSERT_TRUE(image);
    ASSERT_EQ(image->levels(), int(levels.size()));
    for (int level = 0; level < image->levels(); ++level) expectColours(levels[std::size_t(level)], whole(*image, level), 0);
}

TEST_F(TiledImages, MakeColoursOfAnyNumberOfChannels) {
    for (int channels = 1; channels <= 4; ++channels) {
        const std::string name = "channels" + std::to_string(channels) + ".png";
        writeLevels(path(name), {texelsOf(40, 30, channels, placeTexel)}, 0);
        const auto image = open(name);
        ASSERT_TRUE(image);
        const auto rgba = whole(*image, 0);
        ASSERT_FALSE(rgba.empty());
        for (int i = 0; i < 40 * 30; ++i)
            for (int c = 0; c < 4; ++c) {
                const bool grey = channels < 3, hasAlpha = channels == 2 || channels == 4;
                const int from = c < 3 ? (grey ? 0 : c) : channels - 1;
                const int expected = c == 3 && !hasAlpha ? 255 : placeTexel(i % 40, i / 40, from);
                ASSERT_EQ(rgba[std::size_t(i * 4 + c)], expected) << channels << " channels, texel " << i << ", component " << c;
            }
    }
}

TEST_F(TiledImages, KeepTheirTilesWithinTheBudget) {
    writeLevels(path("big.tif"), {texelsOf(2048, 2048, 3, placeTexel)}, 64);
    const auto image = open("big.tif", 2);
    ASSERT_TRUE(image);
    std::vector<std::uint8_t> rgba(2048 * 64 * 4);
    for (int round = 0; round < 2; ++round)
        for (int y = 0; y < 2048; y += 64) {
            ASSERT_TRUE(image->read(0, 0, y, 2048, 64, rgba.data()));
            // A tile may come in before another one goes.
            ASSERT_LE(image->cacheBytes(), (2u << 20) + 2 * 64 * 64 * 4) << "after row " << y;
        }
    EXPECT_GT(image->cacheBytes(), 1u << 20);
}

TEST_F(TiledImages, MayBeReadByManyThreads) {
    const Texels all = texelsOf(1024, 1024, 3, placeTexel);
    writeLevels(path("shared.tif"), {all}, 64);
    const auto image = open("shared.tif", 1);
    ASSERT_TRUE(image);
    std::atomic<int> wrong{0};
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&, t] {
            std::vector<std::uint8_t> rgba(100 * 100 * 4);
            for (int i = 0; i < 40; ++i) {
                const int x = (i * 97 + t * 31) % 924, y = (i * 53 + t * 71) % 924;
                if (!image->read(0, x, y, 100, 100, rgba.data())) ++wrong;
                for (int k = 0; k < 100 * 100; ++k)
                    if (rgba[std::size_t(k) * 4] != placeTexel(x + k % 100, y + k / 100, 0)) ++wrong;
            }
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(wrong, 0);
}

TEST_F(TiledImages, ThatCanNotBeOpenedSayWhy) {
    const auto missing = TiledImage::open(path("absent.tif"), 16);
    ASSERT_FALSE(missing);
    EXPECT_NE(missing.error().message().find(path("absent.tif") + ": expected an image that OpenImageIO reads, found"), std::string::npos)
        << missing.error().message();
    std::ofstream(path("nonsense.tif")) << "no image at all";
    const auto nonsense = TiledImage::open(path("nonsense.tif"), 16);
    ASSERT_FALSE(nonsense);
    EXPECT_EQ(nonsense.error().message().find('\n'), std::string::npos);
}

TEST_F(TiledImages, ThatEndTooEarlyAreAnError) {
    writeLevels(path("whole.tif"), levelsOf(texelsOf(512, 512, 3, placeTexel)), 64);
    const auto size = std::filesystem::file_size(path("whole.tif"));
    for (const double part : {0.9, 0.5, 0.01}) {
        std::filesystem::copy_file(path("whole.tif"), path("cut.tif"), std::filesystem::copy_options::overwrite_existing);
        std::filesystem::resize_file(path("cut.tif"), std::uintmax_t(double(size) * part));
        const auto opened = TiledImage::open(path("cut.tif"), 16);
        if (!opened) continue;
        std::vector<std::uint8_t> rgba(512 * 512 * 4);
        bool failed = false;
        for (int level = 0; level < opened.value()->levels(); ++level) {
            const TiledImage::Size all = opened.value()->size(level);
            failed = failed || !opened.value()->read(level, 0, 0, all.width, all.height, rgba.data());
        }
        EXPECT_TRUE(failed) << part;
    }
}

TEST_F(TiledImages, OfSizesThatNothingCanHaveAreAnError) {
    // A DPX file states the size of the original, of which the picture may be a part. OpenImageIO's cache ends the program over this one.
    const auto output = OIIO::ImageOutput::create(path("part.dpx"));
    if (!output) GTEST_SKIP() << "OpenImageIO without DPX";
    const std::vector<std::uint8_t> texels(19 * 17 * 3, 100);
    ASSERT_TRUE(output->open(path("part.dpx"), OIIO::ImageSpec(19, 17, 3, OIIO::TypeDesc::UINT8)));
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::UINT8, texels.data()));
    output->close();
    ASSERT_TRUE(open("part.dpx"));
    std::fstream file(path("part.dpx"), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(1424);
    const std::string size(4, '\x7f');
    file << size << size;
    file.close();
    const auto opened = TiledImage::open(path("part.dpx"), 16);
    ASSERT_FALSE(opened);
    EXPECT_NE(opened.error().message().find("19x17x1 texels of 2139062143x2139062143x1"), std::string::npos) << opened.error().message();
}

TEST_F(TiledImages, RefuseWhatLiesOutside) {
    writeLevels(path("small.tif"), {texelsOf(100, 50, 3, placeTexel)}, 0);
    const auto image = open("small.tif");
    ASSERT_TRUE(image);
    std::vector<std::uint8_t> rgba(100 * 100 * 4, 7);
    const auto refused = [&](int level, int x, int y, int width, int height) { return !image->read(level, x, y, width, height, rgba.data()); };
    EXPECT_TRUE(refused(-1, 0, 0, 1, 1));
    EXPECT_TRUE(refused(image->levels(), 0, 0, 1, 1));
    EXPECT_TRUE(refused(0, -1, 0, 2, 2));
    EXPECT_TRUE(refused(0, 99, 0, 2, 1));
    EXPECT_TRUE(refused(0, 0, 49, 1, 2));
    EXPECT_TRUE(refused(0, 0, 0, 0, 1));
    EXPECT_TRUE(refused(0, 2147483647, 0, 2147483647, 1));
    EXPECT_TRUE(refused(1, 0, 0, 51, 1));
    EXPECT_EQ(rgba[0], 7);
}

#else

TEST(TiledImages, NeedOpenImageIO) {
    const auto opened = TiledImage::open("any.tif", 16);
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().message(), "any.tif: expected a build with OpenImageIO, found one that lacks it");
}

#endif
