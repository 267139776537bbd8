// What is sent again holds what is new, in few pieces.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "gl/VertexRuns.h"

using namespace terrain;

namespace {

bool holds(const std::vector<VertexRun>& runs, std::uint32_t vertex)
{
    return std::any_of(runs.begin(), runs.end(), [vertex](const VertexRun& run) { return run.first <= vertex && vertex < run.end; });
}

}  // namespace

TEST(VertexRuns, AreExactlyTheVerticesWhereTheseLieInFewPieces)
{
    EXPECT_TRUE(vertexRuns({}, 0, 4).empty());
    EXPECT_EQ(vertexRuns(std::vector<std::uint32_t>{7}, 8, 1), std::vector<VertexRun>({{7, 8}}));
    EXPECT_EQ(vertexRuns(std::vector<std::uint32_t>{90, 91, 92, 10, 11, 20, 12, 13}, 100, 4), std::vector<VertexRun>({{10, 14}, {20, 21}, {90, 93}}));
    EXPECT_EQ(vertexRuns(std::vector<std::uint32_t>{5, 6, 3, 4}, 100, 2), std::vector<VertexRun>({{3, 7}})) << "neighbours are merged";
}

TEST(VertexRuns, HoldAllVerticesInNoMorePiecesThanAllowed)
{
    std::mt19937 random(3);
    for (int round = 0; round < 300; ++round) {
        const std::size_t pool = 1 + random() % 3000, most = 1 + random() % 40, count = random() % 200;
        std::vector<std::uint32_t> vertices(count);
        for (std::uint32_t& vertex : vertices) vertex = random() % pool;
        const std::vector<VertexRun> runs = vertexRuns(vertices, pool, most);
        ASSERT_LE(runs.size(), most);
        for (std::size_t i = 0; i < runs.size(); ++i) {
            ASSERT_LT(runs[i].first, runs[i].end);
            ASSERT_LE(runs[i].end, pool);
            if (i > 0) {
                ASSERT_GT(runs[i].first, runs[i - 1].end);
            }
        }
        for (const std::uint32_t vertex : vertices) ASSERT_TRUE(holds(runs, vertex));
    }
}
