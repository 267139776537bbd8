#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <unistd.h>

#include <gtest/gtest.h>

#include "height/HeightSource.h"
#include "height/RasterSource.h"

#ifdef HAVE_GDAL
#include <gdal_priv.h>
#endif

using namespace terrain;

namespace {

class RasterSource : public testing::Test {
protected:
    RasterSource() : folder_(std::filesystem::temp_directory_path() / ("soterrain-raster-" + std::to_string(getpid()))) {
        std::filesystem::create_directories(folder_);
    }
    ~RasterSource() override { std::filesystem::remove_all(folder_); }

    void SetUp() override {
        if (!hasRasterReader()) GTEST_SKIP() << "built without GDAL";
    }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }

    static HeightMap read(const std::string& path, const HeightFileOptions& options = {}) {
        const auto source = openHeightFile(path, options);
        EXPECT_TRUE(source) << source.error().message();
        return source ? *source.value()->map() : HeightMap{};
    }

    static std::string problemOf(const std::string& path, const HeightFileOptions& options = {}) {
        const auto source = openHeightFile(path, options);
        return source ? "no error" : source.error().message();
    }

    std::string writeGrid(const std::string& rows) const {
        std::ofstream(path("grid.asc")) << "ncols 3\nnrows 2\nxllcorner 1000\nyllcorner 2000\ncellsize 10\nNODATA_value -9999\n"
                                        << rows;
        return path("grid.asc");
    }

    std::filesystem::path folder_;
};

}  // namespace

TEST_F(RasterSource, AnAsciiGridHasItsPlaceSpacingAndHoles) {
    const HeightMap map = read(writeGrid("1 2 3\n4 -9999 6.5\n"));
    EXPECT_EQ(map.columns, 3);
    EXPECT_EQ(map.rows, 2);
    EXPECT_EQ(map.spacing, glm::dvec2(10.0, 10.0));
    EXPECT_EQ(map.origin, glm::dvec2(1005.0, 2005.0));
    EXPECT_EQ(map.at(0, 1), 1.0f);
    EXPECT_EQ(map.at(2, 1), 3.0f);
    EXPECT_EQ(map.at(0, 0), 4.0f);
    EXPECT_TRUE(std::isnan(map.at(1, 0)));
    EXPECT_EQ(map.at(2, 0), 6.5f);
}

TEST_F(RasterSource, OptionsOverrideTheFilesPlaceAndAddToItsHoles) {
    HeightFileOptions options;
    options.noData = 3.0;
    options.heightScale = 2.0;
    options.heightOffset = -1.0;
    options.spacing = glm::dvec2(1.0, 2.0);
    options.origin = glm::dvec2(7.0, 8.0);
    const HeightMap map = read(writeGrid("1 2 3\n4 -9999 6.5\n"), options);
    EXPECT_EQ(map.spacing, glm::dvec2(1.0, 2.0));
    EXPECT_EQ(map.origin, glm::dvec2(7.0, 8.0));
    EXPECT_TRUE(std::isnan(map.at(2, 1)));
    EXPECT_TRUE(std::isnan(map.at(1, 0)));
    EXPECT_EQ(map.at(2, 0), 12.0f);
}

TEST_F(RasterSource, ATruncatedAsciiGridIsAnErrorAndSilent) {
    const std::string file = writeGrid("1 2 3\n4");
    testing::internal::CaptureStderr();
    EXPECT_NE(problemOf(file), "no error");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

#ifdef HAVE_GDAL

namespace {

struct Tiff {
    GDALDataType type = GDT_Int16;
    int columns = 3;
    int rows = 2;
    int bands = 1;
    std::array<double, 6> transform{500000.0, 30.0, 0.0, 4000000.0, 0.0, -25.0};
    std::vector<double> samples{1, 2, 3, 4, 5, 6};  ///< of every band, rows as in the file
    bool georeferenced = true;
};

/// Writes it and hands the data set to `more` before it is closed.
template <class More>
void writeTiff(const std::string& path, Tiff tiff, More more) {
    GDALAllRegister();
    auto* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    ASSERT_NE(driver, nullptr);
    auto* dataset = driver->Create(path.c_str(), tiff.columns, tiff.rows, tiff.bands, tiff.type, nullptr);
    ASSERT_NE(dataset, nullptr);
    if (tiff.georeferenced) dataset->SetGeoTransform(tiff.transform.data());
    for (int band = 1; band <= tiff.bands; ++band) {
        ASSERT_EQ(dataset->GetRasterBand(band)->RasterIO(GF_Write, 0, 0, tiff.columns, tiff.rows, tiff.samples.data(), tiff.columns,
                                                         tiff.rows, GDT_Float64, 0, 0, nullptr),
                  CE_None);
        for (double& sample : tiff.samples) sample += 100.0;
    }
    more(*dataset);
    GDALClose(dataset);
}

void writeTiff(const std::string& path, const Tiff& tiff) {
    writeTiff(path, tiff, [](GDALDataset&) {});
}

}  // namespace

TEST_F(RasterSource, AGeoTiffHasItsPlaceAndProjection) {
    writeTiff(path("utm.tif"), {}, [](GDALDataset& dataset) {
        OGRSpatialReference reference;
        reference.SetWellKnownGeogCS("WGS84");
        reference.SetUTM(33, TRUE);
        dataset.SetSpatialRef(&reference);
    });
    const HeightMap map = read(path("utm.tif"));
    EXPECT_EQ(map.heights, (std::vector<float>{4, 5, 6, 1, 2, 3}));
    EXPECT_EQ(map.spacing, glm::dvec2(30.0, 25.0));
    EXPECT_EQ(map.origin, glm::dvec2(500015.0, 4000000.0 - 37.5));
    EXPECT_NE(map.projection.find("UTM"), std::string::npos) << map.projection;
}

TEST_F(RasterSource, RowsFromSouthAndColumnsFromEastAreTurned) {
    Tiff tiff;
    tiff.transform = {100.0, -10.0, 0.0, 50.0, 0.0, 20.0};
    writeTiff(path("turned.tif"), tiff);
    const HeightMap map = read(path("turned.tif"));
    EXPECT_EQ(map.heights, (std::vector<float>{3, 2, 1, 6, 5, 4}));
    EXPECT_EQ(map.spacing, glm::dvec2(10.0, 20.0));
    EXPECT_EQ(map.origin, glm::dvec2(75.0, 60.0));
}

TEST_F(RasterSource, NoDataIsComparedBeforeTheBandsScaleApplies) {
    writeTiff(path("scaled.tif"), {}, [](GDALDataset& dataset) {
        dataset.GetRasterBand(1)->SetNoDataValue(5.0);
        dataset.GetRasterBand(1)->SetScale(0.5);
        dataset.GetRasterBand(1)->SetOffset(100.0);
    });
    const HeightMap map = read(path("scaled.tif"));
    EXPECT_EQ(map.at(0, 0), 102.0f);
    EXPECT_TRUE(std::isnan(map.at(1, 0)));
    EXPECT_EQ(map.at(0, 1), 100.5f);
}

TEST_F(RasterSource, AFloatRasterFindsItsNoDataInSpiteOfRounding) {
    Tiff tiff;
    tiff.type = GDT_Float32;
    tiff.samples = {-9999.9, 2.25, -3.4028234663852886e38, 4, 5, 6};
    writeTiff(path("float.tif"), tiff,
              [](GDALDataset& dataset) { dataset.GetRasterBand(1)->SetNoDataValue(-3.4028234663852886e38); });
    HeightFileOptions options;
    options.noData = -9999.9;
    const HeightMap map = read(path("float.tif"), options);
    EXPECT_TRUE(std::isnan(map.at(0, 1)));
    EXPECT_EQ(map.at(1, 1), 2.25f);
    EXPECT_TRUE(std::isnan(map.at(2, 1)));
}

TEST_F(RasterSource, ARotatedRasterIsAnError) {
    Tiff tiff;
    tiff.transform = {0.0, 10.0, 1.0, 0.0, 1.0, -10.0};
    writeTiff(path("rotated.tif"), tiff);
    EXPECT_NE(problemOf(path("rotated.tif")).find("rotated"), std::string::npos);
}

TEST_F(RasterSource, ThreeBandsNeedAChoice) {
    Tiff tiff;
    tiff.bands = 3;
    writeTiff(path("bands.tif"), tiff);
    EXPECT_NE(problemOf(path("bands.tif")).find("3 channels"), std::string::npos);
    HeightFileOptions options;
    options.channel = 1;
    EXPECT_EQ(read(path("bands.tif"), options).heights, (std::vector<float>{104, 105, 106, 101, 102, 103}));
    options.channel = 3;
    EXPECT_NE(problemOf(path("bands.tif"), options), "no error");
}

TEST_F(RasterSource, ComplexNumbersAreAnError) {
    Tiff tiff;
    tiff.type = GDT_CFloat32;
    writeTiff(path("complex.tif"), tiff);
    EXPECT_NE(problemOf(path("complex.tif")).find("complex"), std::string::npos);
}

TEST_F(RasterSource, ATiffWithoutAPlaceIsReadAllTheSame) {
    Tiff tiff;
    tiff.georeferenced = false;
    writeTiff(path("plain.tif"), tiff);
    const HeightMap map = read(path("plain.tif"));
    EXPECT_EQ(map.heights, (std::vector<float>{4, 5, 6, 1, 2, 3}));
    EXPECT_EQ(map.spacing, glm::dvec2(1.0, 1.0));
}

TEST_F(RasterSource, AnHgtFileIsReadInDegrees) {
    const int side = 1201;
    std::string bytes(std::size_t(side) * side * 2, '\0');
    bytes[1] = 77;          // the north-western sample: 77 in big endian
    bytes[2] = char(0x80);  // its eastern neighbour: -32768, no data
    std::ofstream(path("N50E015.hgt"), std::ios::binary) << bytes;
    const HeightMap map = read(path("N50E015.hgt"));
    ASSERT_EQ(map.columns, side);
    ASSERT_EQ(map.rows, side);
    EXPECT_EQ(map.at(0, side - 1), 77.0f);
    EXPECT_TRUE(std::isnan(map.at(1, side - 1)));
    EXPECT_NEAR(map.spacing.x, 1.0 / 1200.0, 1e-9);
    EXPECT_NEAR(map.origin.x, 15.0, 1e-9);
    EXPECT_NEAR(map.origin.y, 50.0, 1e-9);
}

TEST_F(RasterSource, ATruncatedGeoTiffIsAnErrorAndSilent) {
    Tiff tiff;
    tiff.columns = tiff.rows = 300;
    tiff.samples.assign(300 * 300, 1.0);
    for (std::size_t i = 0; i < tiff.samples.size(); ++i) tiff.samples[i] = double(i % 1000);
    for (double part : {0.9, 0.5, 0.05}) {
        writeTiff(path("cut.tif"), tiff);
        std::filesystem::resize_file(path("cut.tif"), std::uintmax_t(double(std::filesystem::file_size(path("cut.tif"))) * part));
        testing::internal::CaptureStderr();
        EXPECT_NE(problemOf(path("cut.tif")), "no error") << part;
        EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << part;
    }
}

TEST_F(RasterSource, FilesOpenInSeveralThreadsAtOnce) {
    writeTiff(path("a.tif"), {});
    std::vector<std::thread> threads;
    std::array<bool, 4> good{};
    for (std::size_t i = 0; i < good.size(); ++i)
        threads.emplace_back([&, i] {
            good[i] = true;
            for (int round = 0; round < 20; ++round) {
                const auto source = openHeightFile(path("a.tif"), {});
                good[i] = good[i] && source && source.value()->map()->at(2, 0) == 6.0f && !openHeightFile(path("absent.tif"), {});
            }
        });
    for (std::thread& thread : threads) thread.join();
    for (bool each : good) EXPECT_TRUE(each);
}

#endif
