// A tile cache under random use, beside a model of what it may do.
#include <algorithm>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "TestTiles.h"

using namespace terrain;
using namespace terrain::test;

namespace {

/// Random use of a cache beside the plainest description of what must hold.
class RandomUse {
public:
    RandomUse(unsigned seed, bool varied) : random_(seed), varied_(varied) {}

    void run() {
        cache_.setBudget(1000);
        for (frame_ = 0; frame_ < 300 && !testing::Test::HasFailure(); ++frame_) {
            if (uniform(0, 15) == 0) cache_.setBudget(std::size_t(uniform(0, 600) * (1 + frame_ / 30)));
            cache_.beginFrame();
            touched_.clear();
            wanted_.clear();
            use();
            for (int jobs = uniform(0, 3); jobs--;) runner_->runOne();
            cache_.endFrame();
            check();
            started_ = wanted_;
            for (int jobs = uniform(0, 6); jobs--;) runner_->runOne();
        }
        EXPECT_GT(builds_, 50);
    }

private:
    static constexpr int kTiles = 60;
    int uniform(int low, int high) { return std::uniform_int_distribution(low, high)(random_); }
    std::size_t sizeOf(int number) const { return varied_ ? std::size_t(50 + number * 37 % 400) : 200; }
    static bool fails(int number) { return number % 17 == 5; }

    std::shared_ptr<const TestTile> build(int number, bool now) {
        ++builds_;
        EXPECT_FALSE(cache_.contains(key(number))) << "built though resident, frame " << frame_;
        EXPECT_TRUE(tried_.insert(number).second || !fails(number)) << "failure tried again";
        EXPECT_TRUE(now || started_.contains(number)) << "built though nobody asked in the last frame";
        if (fails(number)) return nullptr;
        return std::make_shared<TestTile>(TestTile{number, sizeOf(number)});
    }

    void use() {
        const int centre = uniform(0, kTiles - 1);
        for (int i = uniform(0, 20); i--;) {
            const int number = (centre + uniform(0, 15)) % kTiles;
            const bool resident = cache_.contains(key(number));
            if (resident) touched_.insert(number);
            if (uniform(0, 2)) {
                cache_.request(key(number), uniform(0, 100));
                if (!resident) wanted_.insert(number);
            } else {
                EXPECT_EQ(cache_.find(key(number)) != nullptr, resident);
            }
        }
        if (uniform(0, 9)) return;
        now_ = true;
        const TestTile* tile = cache_.buildNow(key(centre));
        now_ = false;
        EXPECT_EQ(tile == nullptr, fails(centre));
        if (tile) touched_.insert(centre);
        largest_ = std::max(largest_, cache_.residentBytes());
    }

    void check() {
        std::size_t resident = 0, touched = 0;
        for (int number = 0; number < kTiles; ++number)
            if (cache_.contains(key(number))) resident += sizeOf(number);
        for (const int number : touched_) {
            EXPECT_TRUE(cache_.contains(key(number))) << "touched but evicted, frame " << frame_;
            touched += sizeOf(number);
        }
        EXPECT_EQ(cache_.residentBytes(), resident);
        EXPECT_LE(resident, std::max(cache_.budget(), touched)) << "frame " << frame_;
        EXPECT_GE(cache_.peakBytes(), resident);
        largest_ = std::max({largest_, cache_.budget(), touched});
        EXPECT_LE(cache_.peakBytes(), largest_) << "frame " << frame_;
    }

    std::mt19937 random_;
    const bool varied_;
    std::shared_ptr<ManualRunner> runner_ = std::make_shared<ManualRunner>(2);
    Cache cache_{runner_, [this](const TileKey& key) { return build(key.column, now_); }};
    std::set<int> wanted_, started_, touched_, tried_;
    std::size_t largest_ = 0;  ///< what resident bytes may have reached so far
    bool now_ = false;
    int frame_ = 0, builds_ = 0;
};

}  // namespace

class TileCacheRandomly : public testing::TestWithParam<unsigned> {};

TEST_P(TileCacheRandomly, KeepsItsBudgetAndRebuildsNothingResident)
{
    RandomUse(GetParam(), false).run();
}

TEST_P(TileCacheRandomly, KeepsItsBudgetWithTilesOfAllSizes)
{
    RandomUse(GetParam(), true).run();
}

INSTANTIATE_TEST_SUITE_P(Seeds, TileCacheRandomly, testing::Range(1u, 21u));
