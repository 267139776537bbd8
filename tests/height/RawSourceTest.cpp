#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include <unistd.h>

#include <gtest/gtest.h>

#include "height/HeightSource.h"

using namespace terrain;

namespace {

class RawSource : public testing::Test {
protected:
    RawSource() : folder_(std::filesystem::temp_directory_path() / ("soterrain-raw-" + std::to_string(getpid()))) {
        std::filesystem::create_directories(folder_);
    }
    ~RawSource() override { std::filesystem::remove_all(folder_); }

    std::string write(const std::string& bytes, const std::string& name = "map.raw") const {
        const std::string path = (folder_ / name).string();
        std::ofstream(path, std::ios::binary) << bytes;
        return path;
    }

    static HeightFileOptions sized(int columns, int rows, RawType type = RawType::UInt8) {
        HeightFileOptions options;
        options.rawSize = {columns, rows};
        options.rawType = type;
        return options;
    }

    static std::string problemOf(const std::string& path, const HeightFileOptions& options) {
        const auto source = openHeightFile(path, options);
        return source ? "no error" : source.error().message();
    }

private:
    std::filesystem::path folder_;
};

const std::string sixBytes("\x00\x01\x02\xFD\xFE\xFF", 6);

}  // namespace

TEST_F(RawSource, TheFirstRowOfTheFileIsTheNorthernmost) {
    const auto source = openHeightFile(write(sixBytes), sized(3, 2));
    ASSERT_TRUE(source) << source.error().message();
    EXPECT_EQ(source.value()->map()->heights, (std::vector<float>{253, 254, 255, 0, 1, 2}));
}

TEST_F(RawSource, SixteenBitsComeInEitherByteOrder) {
    const std::string bytes("\x01\x02\xFF\xFF\x00\x80\x34\x12", 8);
    const std::string path = write(bytes);
    const auto little = openHeightFile(path, sized(2, 2, RawType::UInt16LittleEndian));
    const auto big = openHeightFile(path, sized(2, 2, RawType::UInt16BigEndian));
    ASSERT_TRUE(little && big);
    EXPECT_EQ(little.value()->map()->heights, (std::vector<float>{0x8000, 0x1234, 0x0201, 65535}));
    EXPECT_EQ(big.value()->map()->heights, (std::vector<float>{0x0080, 0x3412, 0x0102, 65535}));
}

TEST_F(RawSource, WithoutASizeTheFileIsASquare) {
    const auto bytes = openHeightFile(write(std::string(49, 'a')), {});
    ASSERT_TRUE(bytes) << bytes.error().message();
    EXPECT_EQ(bytes.value()->extent().columns, 7);
    EXPECT_EQ(bytes.value()->extent().rows, 7);
    const auto words = openHeightFile(write(std::string(18, 'a')), sized(0, 0, RawType::UInt16BigEndian));
    ASSERT_TRUE(words) << words.error().message();
    EXPECT_EQ(words.value()->extent().columns, 3);
}

TEST_F(RawSource, ALengthThatIsNoSquareIsAnError) {
    EXPECT_NE(problemOf(write(std::string(50, 'a')), {}).find("50 bytes"), std::string::npos);
    EXPECT_NE(problemOf(write(std::string(9, 'a')), sized(0, 0, RawType::UInt16BigEndian)).find("9 bytes"), std::string::npos);
    EXPECT_NE(problemOf(write(""), {}), "no error");
    EXPECT_NE(problemOf(write("a"), {}), "no error");
}

TEST_F(RawSource, ALengthOtherThanThatOfTheSizeIsAnErrorWithBothNumbers) {
    for (const std::string& bytes : {sixBytes.substr(1), sixBytes + "x"}) {
        const std::string problem = problemOf(write(bytes), sized(3, 2));
        EXPECT_NE(problem.find("6 bytes"), std::string::npos) << problem;
        EXPECT_NE(problem.find(std::to_string(bytes.size()) + " bytes"), std::string::npos) << problem;
    }
}

TEST_F(RawSource, ImpossibleSizesAreErrors) {
    constexpr int huge = std::numeric_limits<int>::max();
    const std::string path = write(sixBytes);
    for (const auto& [columns, rows] : {std::pair{-3, -2}, {6, 1}, {0, 6}, {huge, huge}, {1 << 16, 1 << 16}})
        EXPECT_NE(problemOf(path, sized(columns, rows, RawType::UInt16BigEndian)), "no error") << columns << " x " << rows;
}

TEST_F(RawSource, TheExtensionCountsInAnyCase) {
    EXPECT_TRUE(openHeightFile(write(sixBytes, "MAP.RAW"), sized(2, 3)));
}

TEST_F(RawSource, AMissingFileIsReportedAsSuch) {
    const std::string problem = problemOf("/no/such/folder/map.raw", {});
    EXPECT_NE(problem.find("no such file"), std::string::npos) << problem;
    EXPECT_NE(problem.find("/no/such/folder/map.raw"), std::string::npos) << problem;
}

TEST_F(RawSource, AFolderIsAnError) {
    EXPECT_NE(problemOf(std::filesystem::temp_directory_path().string(), {}), "no error");
}

TEST_F(RawSource, ScaleOffsetAndNoDataApplyToTheRawSample) {
    HeightFileOptions options = sized(3, 2);
    options.heightScale = 0.5;
    options.heightOffset = 10.0;
    options.noData = 254.0;
    options.spacing = glm::dvec2(30.0, 40.0);
    options.origin = glm::dvec2(-1.0, -2.0);
    const auto source = openHeightFile(write(sixBytes), options);
    ASSERT_TRUE(source) << source.error().message();
    const HeightMap& map = *source.value()->map();
    EXPECT_EQ(map.at(0, 0), 136.5f);
    EXPECT_TRUE(std::isnan(map.at(1, 0)));
    EXPECT_EQ(map.at(2, 1), 11.0f);
    EXPECT_EQ(map.spacing, glm::dvec2(30.0, 40.0));
    EXPECT_EQ(map.origin, glm::dvec2(-1.0, -2.0));
}

TEST_F(RawSource, HeightsBeyondFloatAreHoles) {
    HeightFileOptions options = sized(3, 2);
    options.heightScale = 1e38;
    const auto source = openHeightFile(write(sixBytes), options);
    ASSERT_TRUE(source);
    EXPECT_EQ(source.value()->map()->at(1, 1), 1e38f);
    EXPECT_TRUE(std::isnan(source.value()->map()->at(0, 0)));
}

TEST_F(RawSource, OptionsThatAreNoNumbersAreErrors) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::string path = write(sixBytes);
    HeightFileOptions options = sized(3, 2);
    options.spacing = glm::dvec2(0.0, 1.0);
    EXPECT_NE(problemOf(path, options).find("spacing"), std::string::npos);
    options = sized(3, 2);
    options.heightScale = nan;
    EXPECT_NE(problemOf(path, options), "no error");
    options = sized(3, 2);
    options.origin = glm::dvec2(nan, 0.0);
    EXPECT_NE(problemOf(path, options), "no error");
}

TEST_F(RawSource, ProgressGoesFromNothingToAllAndACancelledReadingIsAnError) {
    const std::string path = write(std::string(64 * 64, 'a'));
    ReadProgress progress;
    HeightFileOptions options;
    options.progress = &progress;
    EXPECT_LT(progress.part, 0.0f);
    EXPECT_TRUE(openHeightFile(path, options));
    EXPECT_EQ(progress.part, 1.0f);

    ReadProgress cancelled;
    cancelled.isCancelled = true;
    options.progress = &cancelled;
    const auto source = openHeightFile(path, options);
    ASSERT_FALSE(source);
    EXPECT_NE(source.error().message().find("cancelled"), std::string::npos) << source.error().message();
    EXPECT_LT(cancelled.part, 0.1f) << "it went on after it was cancelled";
}
