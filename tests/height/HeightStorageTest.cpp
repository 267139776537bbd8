#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <sys/resource.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "height/HeightSource.h"
#include "height/ImageSource.h"
#include "height/RasterSource.h"

#ifdef HAVE_OPENIMAGEIO
#include <OpenImageIO/imageio.h>
#endif
#ifdef HAVE_GDAL
#include <gdal_priv.h>
#endif

using namespace terrain;

namespace {

constexpr int kColumns = 301;
constexpr int kRows = 197;

/// A folder of the test's own, which TMPDIR names while it runs.
class HeightStorageTest : public testing::Test {
protected:
    HeightStorageTest() : folder_(std::filesystem::temp_directory_path() / ("soterrain-storage-" + std::to_string(getpid()))) {
        std::filesystem::create_directories(folder_ / "scratch");
        if (const char* before = std::getenv("TMPDIR")) before_ = before;
        setenv("TMPDIR", (folder_ / "scratch").c_str(), 1);
    }
    ~HeightStorageTest() override {
        if (before_.empty())
            unsetenv("TMPDIR");
        else
            setenv("TMPDIR", before_.c_str(), 1);
        std::filesystem::remove_all(folder_);
    }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }

    std::string writeRaw(int columns, int rows) const {
        const std::string file = path("map.raw");
        std::ofstream out(file, std::ios::binary);
        for (const std::uint16_t word : words(columns, rows)) out << char(word & 255) << char(word >> 8);
        return file;
    }

    static HeightFileOptions rawOptions(int columns, int rows) {
        HeightFileOptions options;
        options.rawSize = {columns, rows};
        options.rawType = RawType::UInt16LittleEndian;
        return options;
    }

    static std::vector<std::uint16_t> words(int columns, int rows) {
        std::vector<std::uint16_t> words(std::size_t(columns) * std::size_t(rows));
        std::uint32_t state = 1;
        for (std::uint16_t& word : words) word = std::uint16_t((state = state * 1664525u + 1013904223u) >> 16);
        return words;
    }

    static std::string problemOf(const std::string& path, const HeightFileOptions& options) {
        const auto source = openHeightFile(path, options);
        return source ? "no error" : source.error().message();
    }

    /// Opens a file both ways, with holes and a scale, and compares everything.
    static void expectSameBothWays(const std::string& path, HeightFileOptions options) {
        options.noData = words(kColumns, kRows)[1000];
        options.heightScale = 0.37;
        options.heightOffset = -11.0;
        const auto inMemory = openHeightFile(path, options);
        ASSERT_TRUE(inMemory) << inMemory.error().message();
        options.samplesInMemory = std::uint64_t(kColumns) * kRows - 1;
        const auto spooled = openHeightFile(path, options);
        ASSERT_TRUE(spooled) << spooled.error().message();
        const HeightMap &expected = *inMemory.value()->map(), &found = *spooled.value()->map();
        ASSERT_FALSE(expected.heights.isMapped());
        ASSERT_TRUE(found.heights.isMapped());
        EXPECT_EQ(found.columns, kColumns);
        EXPECT_EQ(found.rows, kRows);
        EXPECT_EQ(found.spacing, expected.spacing);
        EXPECT_EQ(found.origin, expected.origin);
        EXPECT_EQ(found.projection, expected.projection);
        expectSameBits(found.heights, expected.heights);
        EXPECT_TRUE(std::any_of(found.heights.begin(), found.heights.end(), [](float height) { return std::isnan(height); }));
        EXPECT_GT(inMemory.value()->bytes(), sizeof(float) * kColumns * kRows);
        EXPECT_LT(spooled.value()->bytes(), 10000u);
    }

    static void expectSameBits(const HeightStorage& found, const HeightStorage& expected) {
        ASSERT_EQ(found.size(), expected.size());
        std::size_t different = 0;
        for (std::size_t i = 0; i < found.size(); ++i)
            different += std::bit_cast<std::uint32_t>(found[i]) != std::bit_cast<std::uint32_t>(expected[i]);
        EXPECT_EQ(different, 0u);
    }

    std::filesystem::path folder_;
    std::string before_;
};

/// Resident bytes of the mapping that holds an address.
std::size_t residentBytesAt(const void* address) {
    std::ifstream maps("/proc/self/smaps");
    bool isIt = false;
    for (std::string line; std::getline(maps, line);) {
        std::uintptr_t begin = 0, end = 0;
        char dash = 0;
        std::istringstream range(line);
        if (range >> std::hex >> begin >> dash >> end && dash == '-')
            isIt = begin <= std::uintptr_t(address) && std::uintptr_t(address) < end;
        if (isIt && line.starts_with("Rss:")) return std::size_t(std::atol(line.c_str() + 4)) * 1024;
    }
    ADD_FAILURE() << "no such mapping";
    return 0;
}

double sumOf(const HeightStorage& heights) {
    double sum = 0.0;
    for (const float height : heights) sum += height;
    return sum;
}

}  // namespace

TEST_F(HeightStorageTest, ARawFileInScratchSpaceHasTheSameHeightsBitForBit) {
    expectSameBothWays(writeRaw(kColumns, kRows), rawOptions(kColumns, kRows));
}

#ifdef HAVE_OPENIMAGEIO

TEST_F(HeightStorageTest, ImagesInScratchSpaceHaveTheSameHeightsBitForBit) {
    for (const auto& [name, tile] : {std::pair{"lines.png", 0}, {"lines.tif", 0}, {"tiles.tif", 64}}) {
        SCOPED_TRACE(name);
        const auto output = OIIO::ImageOutput::create(path(name));
        ASSERT_TRUE(output) << OIIO::geterror();
        OIIO::ImageSpec spec(kColumns, kRows, 1, OIIO::TypeDesc::UINT16);
        spec.tile_width = spec.tile_height = tile;
        ASSERT_TRUE(output->open(path(name), spec) && output->write_image(OIIO::TypeDesc::UINT16, words(kColumns, kRows).data()) &&
                    output->close())
            << output->geterror();
        expectSameBothWays(path(name), {});
    }
}

#endif

#ifdef HAVE_GDAL

TEST_F(HeightStorageTest, ARasterInScratchSpaceHasTheSameHeightsBitForBitWhicheverWayItsRowsRun) {
    GDALAllRegister();
    char tiled[] = "TILED=YES", wide[] = "BLOCKXSIZE=64", high[] = "BLOCKYSIZE=64";
    char* const tiles[] = {tiled, wide, high, nullptr};
    for (const double step : {-25.0, 25.0})
        for (char* const* layout : {static_cast<char* const*>(nullptr), tiles}) {
            SCOPED_TRACE(std::string(layout ? "tiles, " : "lines, ") + std::to_string(step));
            auto* dataset = GetGDALDriverManager()->GetDriverByName("GTiff")->Create(path("raster.tif").c_str(), kColumns, kRows, 1,
                                                                                     GDT_UInt16, const_cast<char**>(layout));
            ASSERT_NE(dataset, nullptr);
            double transform[] = {500000.0, 30.0, 0.0, 4000000.0, 0.0, step};
            dataset->SetGeoTransform(transform);
            auto samples = words(kColumns, kRows);
            ASSERT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, kColumns, kRows, samples.data(), kColumns, kRows,
                                                          GDT_UInt16, 0, 0, nullptr),
                      CE_None);
            GDALClose(dataset);
            expectSameBothWays(path("raster.tif"), {});
        }
}

#endif

TEST_F(HeightStorageTest, NothingIsLeftInTheDirectoryWhileTheMapIsInUse) {
    HeightFileOptions options = rawOptions(100, 100);
    options.samplesInMemory = 9999;
    const auto source = openHeightFile(writeRaw(100, 100), options);
    ASSERT_TRUE(source) << source.error().message();
    ASSERT_TRUE(source.value()->map()->heights.isMapped());
    EXPECT_TRUE(std::filesystem::is_empty(folder_ / "scratch"));
}

TEST_F(HeightStorageTest, AMapOfAsManySamplesAsTheLimitStaysInMemory) {
    HeightFileOptions options = rawOptions(100, 100);
    options.samplesInMemory = 10000;
    const auto source = openHeightFile(writeRaw(100, 100), options);
    ASSERT_TRUE(source) << source.error().message();
    EXPECT_FALSE(source.value()->map()->heights.isMapped());
}

TEST_F(HeightStorageTest, ADirectoryThatDoesNotExistIsOneClearError) {
    const std::string file = writeRaw(100, 100);
    setenv("TMPDIR", path("absent").c_str(), 1);
    HeightFileOptions options = rawOptions(100, 100);
    options.samplesInMemory = 100;
    const std::string problem = problemOf(file, options);
    EXPECT_NE(problem.find("map.raw"), std::string::npos) << problem;
    EXPECT_NE(problem.find("TMPDIR"), std::string::npos) << problem;
    EXPECT_NE(problem.find("40000 bytes"), std::string::npos) << problem;
    EXPECT_EQ(problem.find('\n'), std::string::npos) << problem;
    options.samplesInMemory = 10000;
    EXPECT_EQ(problemOf(file, options), "no error");
}

TEST_F(HeightStorageTest, MoreThanIsFreeIsAnErrorBeforeAnythingIsWritten) {
    const auto writer = ScratchWriter::create("huge", std::uint64_t(1) << 60);
    ASSERT_FALSE(writer);
    EXPECT_NE(writer.error().message().find(std::to_string(std::uint64_t(1) << 62)), std::string::npos) << writer.error().message();
}

TEST_F(HeightStorageTest, ALimitOnTheSizeOfFilesIsAnErrorAndNoSignal) {
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
    const std::string file = writeRaw(100, 100);
    auto writer = ScratchWriter::create("map", 10000);
    ASSERT_TRUE(writer) << writer.error().message();
    HeightFileOptions options = rawOptions(100, 100);
    options.samplesInMemory = 100;

    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{20000, before.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    const std::string early = problemOf(file, options);
    // The space was there when it was asked for, and is gone when it is used.
    const std::vector<float> row(100, 1.0f);
    EXPECT_FALSE(writer.value().write(0, row.data(), row.size()));
    const auto late = writer.value().write(9900, row.data(), row.size());
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);

    EXPECT_NE(early.find("20000 bytes"), std::string::npos) << early;
    ASSERT_TRUE(late);
    EXPECT_NE(late->message().find("File too large"), std::string::npos) << late->message();
}

TEST_F(HeightStorageTest, AnUnfinishedFileIsAnErrorInsteadOfAMapping) {
    auto writer = ScratchWriter::create("map", 10000);
    ASSERT_TRUE(writer) << writer.error().message();
    const std::vector<float> row(100, 1.0f);
    EXPECT_FALSE(writer.value().write(0, row.data(), row.size()));
    const auto heights = std::move(writer).value().finish();
    ASSERT_FALSE(heights);
    EXPECT_NE(heights.error().message().find("400 bytes written"), std::string::npos) << heights.error().message();
}

TEST_F(HeightStorageTest, ReleasedPagesAreNotResidentAndKeepTheirHeights) {
    HeightFileOptions options = rawOptions(1024, 4096);
    options.samplesInMemory = 0;
    const auto source = openHeightFile(writeRaw(1024, 4096), options);
    ASSERT_TRUE(source) << source.error().message();
    const HeightMap& map = *source.value()->map();
    constexpr std::size_t kBytes = std::size_t(1024) * 4096 * sizeof(float);
    EXPECT_LT(residentBytesAt(map.heights.data()), kBytes / 100) << "after reading";
    const double sum = sumOf(map.heights);
    EXPECT_EQ(residentBytesAt(map.heights.data()), kBytes);
    map.releaseRows(0, 2048);
    EXPECT_EQ(residentBytesAt(map.heights.data()), kBytes / 2);
    map.releaseRows(2048, 2048);
    EXPECT_EQ(residentBytesAt(map.heights.data()), 0u);
    EXPECT_EQ(sumOf(map.heights), sum);
    map.heights.limitResident(std::size_t(1) << 40);
    EXPECT_EQ(residentBytesAt(map.heights.data()), kBytes);
    map.heights.limitResident(kBytes / 2);
    EXPECT_EQ(residentBytesAt(map.heights.data()), 0u);
    EXPECT_EQ(sumOf(map.heights), sum);
}

TEST_F(HeightStorageTest, PagesThatAreReleasedWhileOthersReadThemKeepTheirHeights) {
    HeightFileOptions options = rawOptions(1024, 1024);
    options.samplesInMemory = 0;
    const auto source = openHeightFile(writeRaw(1024, 1024), options);
    ASSERT_TRUE(source) << source.error().message();
    const HeightMap& map = *source.value()->map();
    const double sum = sumOf(map.heights);
    std::vector<std::thread> readers;
    std::vector<double> sums(2);
    for (double& found : sums)
        readers.emplace_back([&map, &found] {
            for (int pass = 0; pass < 5; ++pass) found = sumOf(map.heights);
        });
    for (int row = 0; row < 20 * 1024; ++row) map.releaseRows(row % 1024, 1);
    for (std::thread& reader : readers) reader.join();
    for (const double found : sums) EXPECT_EQ(found, sum);
}

TEST_F(HeightStorageTest, ACopyThatChangesLeavesTheOriginalAsItIs) {
    HeightFileOptions options = rawOptions(50, 40);
    options.samplesInMemory = 0;
    const auto source = openHeightFile(writeRaw(50, 40), options);
    ASSERT_TRUE(source) << source.error().message();
    const HeightMap& map = *source.value()->map();
    HeightMap copy = map;
    EXPECT_TRUE(copy.heights.isMapped());
    EXPECT_EQ(std::as_const(copy).heights.data(), map.heights.data());
    const float before = map.heights[7];
    copy.heights[7] += 1.0f;
    EXPECT_FALSE(copy.heights.isMapped());
    EXPECT_EQ(map.heights[7], before);
    copy.heights[7] = before;
    EXPECT_EQ(copy.heights, map.heights);
}

TEST_F(HeightStorageTest, MappedHeightsOutliveTheSourceThatTheyCameFrom) {
    HeightFileOptions options = rawOptions(50, 40);
    options.samplesInMemory = 0;
    auto source = openHeightFile(writeRaw(50, 40), options);
    ASSERT_TRUE(source) << source.error().message();
    const HeightStorage copy = source.value()->map()->heights;
    const double sum = sumOf(copy);
    source = Error{"", "", ""};
    EXPECT_EQ(sumOf(copy), sum);
}
