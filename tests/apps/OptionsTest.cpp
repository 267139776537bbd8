// The command line means what the help says.
#include "Options.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

using app::Options;

terrain::Result<Options> parse(std::vector<std::string> words)
{
    words.insert(words.begin(), "SoTerrainTest");
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    return app::parseOptions(int(words.size()), arguments.data());
}

std::string refusal(const std::vector<std::string>& words)
{
    const auto result = parse(words);
    return result ? "" : result.error().message();
}

TEST(Options, EveryShortFlagHasItsMeaning)
{
    const auto result = parse({"-h", "m.png", "-t", "t.jpg", "-p", "p.csv", "-a", "roam", "-A", "5000", "-F", "20", "-e", "1.5", "-r",
                               "9000", "-g", "33", "-f", "-c", "-v", "-s"});
    ASSERT_TRUE(result) << result.error().message();
    const Options& o = result.value();
    EXPECT_EQ(o.heightMap, "m.png");
    EXPECT_EQ(o.texture, "t.jpg");
    EXPECT_EQ(o.profile, "p.csv");
    EXPECT_EQ(o.algorithm, app::findAlgorithm("roam"));
    EXPECT_EQ(o.animationTime, 5000.0);
    EXPECT_EQ(o.frameTime, 20.0);
    EXPECT_EQ(o.pixelError, 1.5);
    EXPECT_EQ(o.triangleCount, 9000);
    EXPECT_EQ(o.tileSize, 33);
    EXPECT_TRUE(o.fullScreen && o.frustumCulling && o.animate && o.synchronize);
}

TEST(Options, RepetitionsNeedAFlightWithAllOfItsFrames)
{
    const auto result = parse({"-h", "m.png", "--flight", "f.csv", "--repeat", "5", "--summary", "s.json"});
    ASSERT_TRUE(result) << result.error().message();
    EXPECT_EQ(result.value().repeat, 5);
    EXPECT_EQ(result.value().summary, "s.json");
    EXPECT_TRUE(result.value().replays());
    EXPECT_NE(refusal({"-h", "m.png", "--repeat", "5"}), "");
    EXPECT_NE(refusal({"-h", "m.png", "-v", "-s", "--repeat", "5"}), "");
    EXPECT_NE(refusal({"-h", "m.png", "-v", "--repeat", "0"}), "");
    EXPECT_NE(refusal({"-h", "m.png", "-v", "--repeat", "2", "--record", "r.csv"}), "");
    EXPECT_NE(refusal({"-h", "m.png", "--flight", "f.csv", "--record", "f.csv"}), "") << "the flight would be lost";
    EXPECT_FALSE(parse({"-h", "m.png", "--flight", "f.csv", "-s"}).value().replays()) << "frames that are left out depend on time";
}

TEST(Options, AFileAloneIsTheTerrain)
{
    const auto map = parse({"m.png", "-t", "t.jpg", "-c"});
    ASSERT_TRUE(map) << map.error().message();
    EXPECT_EQ(map.value().heightMap, "m.png");
    EXPECT_EQ(map.value().texture, "t.jpg");
    EXPECT_TRUE(map.value().frustumCulling);
    EXPECT_EQ(parse({"-v", "s.iv"}).value().scene, "s.iv");
    for (const auto& two : {std::vector<std::string>{"m.png", "-h", "n.png"}, {"m.png", "n.png"}, {"s.iv", "m.png"}, {"--scene", "s.iv", "m.png"}})
        EXPECT_NE(refusal(two).find("one terrain"), std::string::npos);
}

TEST(Options, SwitchesAreOffUnlessGiven)
{
    const auto result = parse({"-h", "m.png"});
    ASSERT_TRUE(result);
    const Options& o = result.value();
    EXPECT_FALSE(o.fullScreen || o.frustumCulling || o.animate || o.synchronize || o.stats || o.offscreen);
    EXPECT_FALSE(o.pixelError || o.triangleCount || o.tileSize || o.frames);
}

TEST(Options, ATerrainIsMissedWhereNoWindowCanAskForOne)
{
    EXPECT_TRUE(parse({}));
    EXPECT_TRUE(parse({"-a", "clipmap", "-f"}));
    for (const char* word : {"--offscreen", "--stats", "--frames=3", "--measure-error=2", "--record=f.csv", "--profile=p.csv"})
        EXPECT_NE(refusal({word}).find("-h heightmap"), std::string::npos) << word;
}

TEST(Options, LongAndShortNamesAgree)
{
    const auto result = parse({"--heightmap", "m.png", "--algorithm=bruteforce", "--pixel-error", "3", "--culling", "--animate",
                               "--synchronize", "--full-screen", "--tile-size=17", "--triangle-count=5"});
    ASSERT_TRUE(result) << result.error().message();
    EXPECT_EQ(result.value().heightMap, "m.png");
    EXPECT_EQ(result.value().algorithm, app::findAlgorithm("bruteforce"));
    EXPECT_EQ(result.value().pixelError, 3.0);
    EXPECT_TRUE(result.value().frustumCulling && result.value().animate && result.value().synchronize && result.value().fullScreen);
    EXPECT_EQ(result.value().tileSize, 17);
    EXPECT_EQ(result.value().triangleCount, 5);
}

TEST(Options, ClipmapsHaveTheirOwn)
{
    const auto result = parse({"-h", "m.png", "-a", "clipmap", "--clipmap-size", "127", "--levels", "4", "--detail=2"});
    ASSERT_TRUE(result) << result.error().message();
    EXPECT_EQ(result.value().clipmapSize, 127);
    EXPECT_EQ(result.value().clipmapLevels, 4);
    EXPECT_EQ(result.value().detailLevels, 2);
    EXPECT_FALSE(parse({"-h", "m.png"}).value().clipmapSize);
    for (const char* bad : {"--clipmap-size=-1", "--levels=x", "--detail=1.5"}) EXPECT_NE(refusal({"-h", "m", bad}), "") << bad;
}

TEST(Options, OffscreenTakesASizeOrItsDefault)
{
    EXPECT_EQ(parse({"-h", "m", "--offscreen"}).value().offscreen, glm::ivec2(1024, 768));
    EXPECT_EQ(parse({"-h", "m", "--offscreen=64x48"}).value().offscreen, glm::ivec2(64, 48));
    for (const char* bad : {"--offscreen=", "--offscreen=64", "--offscreen=0x5", "--offscreen=5x-5", "--offscreen=1.5x2", "--offscreen=axb"}) {
        EXPECT_NE(refusal({"-h", "m", bad}), "") << bad;
    }
}

TEST(Options, SpacingTakesOneOrTwoNumbersAboveZero)
{
    EXPECT_EQ(parse({"-h", "m", "--spacing", "10"}).value().spacing, glm::dvec2(10.0, 10.0));
    EXPECT_EQ(parse({"-h", "m", "--spacing", "10,5"}).value().spacing, glm::dvec2(10.0, 5.0));
    for (const char* bad : {"0", "-1", "1,0", "1,2,3", "nan", ""}) EXPECT_NE(refusal({"-h", "m", "--spacing", bad}), "") << bad;
}

TEST(Options, RawSizeAndTypeAndChannelSayHowAFileIsRead)
{
    const auto result = parse({"-h", "m.raw", "--channel", "2", "--raw-size", "129x65", "--raw-type", "uint16be"});
    ASSERT_TRUE(result) << result.error().message();
    EXPECT_EQ(result.value().channel, 2);
    EXPECT_EQ(result.value().rawSize, glm::ivec2(129, 65));
    EXPECT_EQ(result.value().rawType, terrain::RawType::UInt16BigEndian);
    EXPECT_EQ(parse({"-h", "m", "--raw-type", "uint16le"}).value().rawType, terrain::RawType::UInt16LittleEndian);
    EXPECT_EQ(parse({"-h", "m", "--raw-type", "uint8"}).value().rawType, terrain::RawType::UInt8);
}

TEST(Options, BadRawSizesTypesAndChannelsAreRefusedByName)
{
    for (const char* bad : {"", "65", "1x65", "65x-65", "6.5x65", "65x65x65", "99999999999x2", "axb"}) {
        EXPECT_NE(refusal({"-h", "m", "--raw-size", bad}).find("--raw-size"), std::string::npos) << bad;
    }
    for (const char* bad : {"", "uint16", "UINT8", "float"}) {
        EXPECT_NE(refusal({"-h", "m", "--raw-type", bad}).find("uint16le"), std::string::npos) << bad;
    }
    for (const char* bad : {"", "-1", "1.5", "red"}) {
        EXPECT_NE(refusal({"-h", "m", "--channel", bad}).find("--channel"), std::string::npos) << bad;
    }
    EXPECT_NE(refusal({"--scene", "s.iv", "--channel", "0"}).find("--channel"), std::string::npos);
}

TEST(Options, NumbersThatAreNoneAreRefusedByName)
{
    for (const char* flag : {"-e", "-r", "-g", "-A", "-F", "--frames", "--measure-error", "--height-scale"}) {
        for (const char* bad : {"", "x", "nan", "inf", "-1", "1x", "1e999"}) {
            const std::string message = refusal({"-h", "m", flag, bad});
            EXPECT_NE(message.find(flag), std::string::npos) << flag << " " << bad << ": " << message;
        }
    }
    for (const char* flag : {"-r", "-g", "--frames"}) EXPECT_NE(refusal({"-h", "m", flag, "99999999999"}), "") << flag;
}

TEST(Options, UnknownAlgorithmListsTheKnownOnes)
{
    const std::string message = refusal({"-h", "m", "-a", "magic"});
    for (const app::Algorithm& algorithm : app::algorithms()) EXPECT_NE(message.find(algorithm.name), std::string::npos) << message;
    EXPECT_NE(message.find("magic"), std::string::npos);
}

TEST(Options, FormerSpellingOfBruteForceStillWorks)
{
    EXPECT_EQ(parse({"-h", "m", "-a", "brutalforce"}).value().algorithm, app::findAlgorithm("bruteforce"));
}

TEST(Options, WrongLinesAreRefused)
{
    EXPECT_NE(refusal({"-h"}), "");
    EXPECT_NE(refusal({"-x"}).find("-x"), std::string::npos);
    EXPECT_NE(refusal({"--unknown"}).find("--unknown"), std::string::npos);
    EXPECT_NE(refusal({"--stats=1", "-h", "m"}).find("--stats"), std::string::npos);
    EXPECT_NE(refusal({"-h", "m", "stray"}).find("stray"), std::string::npos);
    EXPECT_NE(refusal({"-h", "m", "--scene", "s.iv"}), "");
    EXPECT_NE(refusal({"--scene", "s.iv", "--spacing", "1"}), "");
    EXPECT_NE(refusal({"-h", "m", "--output", "f.png"}).find("--offscreen"), std::string::npos);
}

TEST(Options, SeveralFramesNeedANumberInTheirName)
{
    EXPECT_NE(refusal({"-h", "m", "--offscreen", "-v", "--output", "f.png"}), "");
    EXPECT_NE(refusal({"-h", "m", "--offscreen", "--frames", "2", "--output", "f.png"}), "");
    EXPECT_EQ(refusal({"-h", "m", "--offscreen", "--output", "f.png"}), "");
    EXPECT_EQ(refusal({"-h", "m", "--offscreen", "-v", "--output", "f%d.png"}), "");
    EXPECT_NE(refusal({"-h", "m", "--offscreen", "--output", "f%s.png"}), "");
}

TEST(Options, HelpNeedsNothingElse)
{
    EXPECT_TRUE(parse({"--help"}).value().help);
    EXPECT_TRUE(parse({"--version"}).value().version);
}

TEST(Options, HelpNamesEveryAlgorithm)
{
    for (const app::Algorithm& algorithm : app::algorithms()) EXPECT_NE(app::help().find(algorithm.name), std::string::npos);
}

}  // namespace
