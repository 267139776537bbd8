// The arithmetic of diamonds and the table that finds them.
#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "lod/DiamondTable.h"
#include "lod/DiamondTopology.h"

using namespace terrain;

namespace {

constexpr int kExponent = 5, kSide = 1 << kExponent;

bool inSquare(glm::ivec2 p)
{
    return p.x >= 0 && p.y >= 0 && p.x <= kSide && p.y <= kSide;
}

/// Every vertex of the square but its corners is the centre of a diamond.
std::vector<DiamondShape> allDiamonds()
{
    std::vector<DiamondShape> diamonds;
    for (int y = 0; y <= kSide; ++y)
        for (int x = 0; x <= kSide; ++x)
            if (x % kSide != 0 || y % kSide != 0) diamonds.emplace_back(glm::ivec2(x, y));
    return diamonds;
}

long cross(glm::ivec2 a, glm::ivec2 b)
{
    return long(a.x) * b.y - long(a.y) * b.x;
}

}  // namespace

TEST(DiamondShape, CornersStandCounterClockwiseAroundTheMiddleOfTheLongestEdge)
{
    for (const DiamondShape& d : allDiamonds()) {
        ASSERT_EQ(d.corner[0] + d.corner[2], 2 * d.centre);
        ASSERT_EQ(d.corner[1] + d.corner[3], 2 * d.centre);
        for (std::size_t i = 0; i < 4; ++i) {
            const glm::ivec2 edge = d.corner[(i + 1) % 4] - d.corner[i], next = d.corner[(i + 2) % 4] - d.corner[(i + 1) % 4];
            ASSERT_GT(cross(edge, next), 0) << d.centre.x << ", " << d.centre.y;
            ASSERT_EQ(edge.x * next.x + edge.y * next.y, 0) << "a right angle at every corner";
        }
        ASSERT_EQ(cross(d.corner[1] - d.corner[0], d.corner[2] - d.corner[0]), (d.isSquare ? 4l : 2l) * d.size * d.size);
    }
}

TEST(DiamondShape, ApexesAreTheParentsAndSidesTheChildren)
{
    for (const DiamondShape& d : allDiamonds()) {
        if (d.isFinest()) continue;
        for (int side = 0; side < 4; ++side) {
            const glm::ivec2 centre = d.child(side);
            if (!inSquare(centre)) continue;
            const DiamondShape child(centre);
            ASSERT_TRUE(child.corner[1] == d.centre || child.corner[3] == d.centre) << centre.x << ", " << centre.y;
        }
    }
}

TEST(DiamondShape, LevelsIncreaseByOneFromParentToChild)
{
    EXPECT_EQ(DiamondShape(glm::ivec2(kSide / 2)).level(kExponent), 0);
    for (const DiamondShape& d : allDiamonds()) {
        ASSERT_EQ(d.isFinest(), d.level(kExponent) == 2 * kExponent - 1);
        for (int side = 0; side < 4 && !d.isFinest(); ++side)
            if (inSquare(d.child(side))) {
                ASSERT_EQ(DiamondShape(d.child(side)).level(kExponent), d.level(kExponent) + 1);
            }
    }
}

TEST(DiamondShape, EveryVertexButTheCornersIsReachedFromTheRoot)
{
    const auto less = [](glm::ivec2 a, glm::ivec2 b) { return std::pair(a.x, a.y) < std::pair(b.x, b.y); };
    std::set<glm::ivec2, decltype(less)> reached(less);
    std::vector<glm::ivec2> open{glm::ivec2(kSide / 2)};
    while (!open.empty()) {
        const glm::ivec2 centre = open.back();
        open.pop_back();
        if (!inSquare(centre) || !reached.insert(centre).second) continue;
        const DiamondShape d(centre);
        for (int side = 0; side < 4 && !d.isFinest(); ++side) open.push_back(d.child(side));
    }
    EXPECT_EQ(reached.size(), allDiamonds().size());
}

TEST(DiamondShape, ChildrenLieWithinTheirParents)
{
    // What is known of both parents is taken to be known of the child.
    for (const DiamondShape& d : allDiamonds()) {
        for (int half = 0; half < 2; ++half) {
            const glm::ivec2 apex = d.corner[half ? 3 : 1];
            if (!inSquare(apex) || d.level(kExponent) == 0) continue;
            const DiamondShape parent(apex);
            for (const glm::ivec2 corner : {d.corner[0], apex, d.corner[2]})
                for (std::size_t i = 0; i < 4; ++i)
                    ASSERT_GE(cross(parent.corner[(i + 1) % 4] - parent.corner[i], corner - parent.corner[i]), 0);
        }
    }
}

TEST(DiamondTable, HoldsWhatAMapHoldsUnderRandomInsertionAndErasure)
{
    std::mt19937 random(11);
    DiamondTable table;
    std::map<std::pair<int, int>, std::uint32_t> expected;
    std::vector<glm::ivec2> centres;
    std::vector<std::uint32_t> free;
    for (int step = 0; step < 200000; ++step) {
        // First it grows past several doublings, then it shrinks, then it stays.
        const bool growing = step < 60000 || (step > 120000 && step % 2 == 0);
        const glm::ivec2 centre(int(random() % 128), int(random() % 64));
        const auto found = expected.find({centre.x, centre.y});
        const std::uint32_t number = table.find(centre);
        ASSERT_EQ(number, found == expected.end() ? DiamondTable::kNone : found->second) << "step " << step;
        if (growing && number == DiamondTable::kNone) {
            std::uint32_t chosen = std::uint32_t(centres.size());
            if (free.empty())
                centres.push_back(centre);
            else {
                chosen = free.back();
                free.pop_back();
                centres[chosen] = centre;
            }
            table.insert(centre, chosen);
            expected[{centre.x, centre.y}] = chosen;
        } else if (!growing && number != DiamondTable::kNone) {
            table.erase(centre);
            free.push_back(number);
            expected.erase(found);
        }
    }
    for (const auto& [centre, number] : expected) ASSERT_EQ(table.find({centre.first, centre.second}), number);
}

TEST(DiamondTable, DoesNotGrowWhenDiamondsComeAndGo)
{
    DiamondTable table;
    std::vector<glm::ivec2> centres(500);
    const std::size_t before = table.bytes();
    std::mt19937 random(3);
    for (int round = 0; round < 100; ++round) {
        for (std::uint32_t number = 0; number < centres.size(); ++number) {
            centres[number] = {int(random() % 4096), int(number)};
            table.insert(centres[number], number);
        }
        for (std::uint32_t number = 0; number < centres.size(); ++number) table.erase(centres[number]);
    }
    EXPECT_EQ(table.bytes(), before);
    EXPECT_EQ(table.find({1, 1}), DiamondTable::kNone);
}
