// New files take nobody's place.
#include "NumberedFile.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <utility>

#include <unistd.h>

namespace {

class NumberedFile : public testing::Test {
protected:
    void SetUp() override
    {
        folder_ = std::filesystem::temp_directory_path() / ("numbered-" + std::to_string(getpid()));
        std::filesystem::create_directory(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::string at(const std::string& name) const { return (folder_ / name).string(); }
    void make(const std::string& name) const { std::ofstream(at(name)) << "x"; }

private:
    std::filesystem::path folder_;
};

TEST_F(NumberedFile, FreeStemAvoidsEveryEnding)
{
    EXPECT_EQ(app::freeStem(at("run"), {".csv", ".json"}), at("run"));
    make("run.json");
    EXPECT_EQ(app::freeStem(at("run"), {".csv", ".json"}), at("run-2"));
    make("run-2.csv");
    make("run-3.csv");
    EXPECT_EQ(app::freeStem(at("run"), {".csv", ".json"}), at("run-4"));
    EXPECT_EQ(app::freeStem(at("run"), {".txt"}), at("run"));
}

TEST_F(NumberedFile, FreeStemAvoidsALinkThatLeadsNowhere)
{
    std::filesystem::create_symlink(at("nowhere"), at("run.csv"));
    EXPECT_EQ(app::freeStem(at("run"), {".csv"}), at("run-2"));
}

TEST_F(NumberedFile, LatestFileWasWrittenLast)
{
    EXPECT_FALSE(app::latestFile(at("run"), ".csv"));
    const auto now = std::filesystem::file_time_type::clock::now();
    for (const auto& [name, age] : {std::pair("run.csv", 30), {"run-2.csv", 10}, {"run-3.csv", 20}, {"run-other.csv", 1}, {"runs.csv", 1}}) {
        make(name);
        std::filesystem::last_write_time(at(name), now - std::chrono::seconds(age));
    }
    EXPECT_EQ(app::latestFile(at("run"), ".csv"), at("run-2.csv"));
    EXPECT_FALSE(app::latestFile(at("nowhere/run"), ".csv"));
}

}  // namespace
