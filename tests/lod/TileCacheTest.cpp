// What a tile cache builds, in which order, what it keeps, and that it goes away cleanly.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <future>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <random>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "TestTiles.h"

using namespace terrain;
using namespace terrain::test;

namespace {

/// A cache whose jobs run by hand and whose builder writes down what it builds.
class TileCacheByHand : public testing::Test {
protected:
    std::shared_ptr<const TestTile> build(const TileKey& key) {
        order.push_back(key.column);
        if (key.column < 0) return nullptr;
        return std::make_shared<TestTile>(TestTile{key.column, sizeOf(key.column)});
    }

    void frame(const std::vector<std::pair<int, double>>& requests, const std::vector<int>& found = {}) {
        cache.beginFrame();
        for (const auto& [number, priority] : requests) cache.request(key(number), priority);
        for (const int number : found) cache.find(key(number));
        cache.endFrame();
    }

    /// Frames of the same requests until nothing changes any more.
    void settle(const std::vector<std::pair<int, double>>& requests, const std::vector<int>& found = {}) {
        for (int i = 0; i < 1000; ++i) {
            frame(requests, found);
            if (cache.isIdle()) return;
            runner->runAll();
        }
        ADD_FAILURE() << "does not come to rest";
    }

    std::function<std::size_t(int)> sizeOf = [](int) { return 100; };
    std::vector<int> order;
    std::shared_ptr<ManualRunner> runner = std::make_shared<ManualRunner>();
    Cache cache{runner, [this](const TileKey& key) { return build(key); }};
};

using Numbers = std::vector<int>;

}  // namespace

TEST_F(TileCacheByHand, BuildsInOrderOfPriority)
{
    frame({{1, 3.0}, {2, 9.0}, {3, 1.0}, {4, 5.0}});
    EXPECT_TRUE(order.empty());
    runner->runAll();
    EXPECT_EQ(order, Numbers({2, 4, 1, 3}));
    EXPECT_EQ(cache.find(key(2)), nullptr) << "taken in before the end of a frame";
    frame({});
    for (const int number : {1, 2, 3, 4}) {
        const TestTile* tile = cache.find(key(number));
        ASSERT_NE(tile, nullptr);
        EXPECT_EQ(tile->number, number);
    }
    EXPECT_EQ(cache.built(), 4u);
    EXPECT_EQ(cache.residentBytes(), 400u);
}

TEST_F(TileCacheByHand, TheLargestPriorityOfAFrameCounts)
{
    frame({{1, 3.0}, {2, 2.0}, {2, 4.0}, {2, 1.0}});
    runner->runAll();
    EXPECT_EQ(order, Numbers({2, 1}));
}

TEST_F(TileCacheByHand, TakesPrioritiesThatAreNoNumbers)
{
    frame({{1, std::nan("")}, {2, -5.0}, {3, std::numeric_limits<double>::infinity()}, {4, 1.0}});
    runner->runAll();
    EXPECT_EQ(order, Numbers({3, 4, 1, 2}));
}

TEST_F(TileCacheByHand, TheCoarserOfEqualsIsFirst)
{
    cache.beginFrame();
    cache.request({.level = 1, .column = 1, .row = 0}, 2.0);
    cache.request({.level = 3, .column = 3, .row = 0}, 2.0);
    cache.request({.level = 2, .column = 2, .row = 0}, 2.0);
    cache.endFrame();
    runner->runAll();
    EXPECT_EQ(order, Numbers({3, 2, 1}));
}

TEST_F(TileCacheByHand, LateUrgentRequestsOvertake)
{
    frame({{1, 1.0}, {2, 2.0}});
    EXPECT_TRUE(runner->runOne());
    frame({{1, 1.0}, {2, 2.0}, {3, 8.0}});
    runner->runAll();
    EXPECT_EQ(order, Numbers({2, 3, 1}));
}

TEST_F(TileCacheByHand, DropsRequestsThatAreNotRepeated)
{
    frame({{1, 1.0}, {2, 2.0}});
    EXPECT_EQ(cache.pending(), 2u);
    frame({{1, 1.0}});
    EXPECT_EQ(cache.pending(), 1u);
    runner->runAll();
    EXPECT_EQ(order, Numbers({1}));
    frame({});
    EXPECT_TRUE(cache.isIdle());
}

TEST_F(TileCacheByHand, StartsNothingTwiceThatIsInFlightOrResident)
{
    for (int i = 0; i < 5; ++i) frame({{1, 1.0}, {2, 2.0}});
    EXPECT_EQ(runner->runAll(), 2u);
    EXPECT_EQ(cache.inFlight(), 2u);
    EXPECT_EQ(cache.finished(), 2u);
    EXPECT_FALSE(cache.isIdle());
    for (int i = 0; i < 5; ++i) {
        frame({{1, 1.0}, {2, 2.0}});
        runner->runAll();
    }
    EXPECT_EQ(order.size(), 2u);
    EXPECT_TRUE(cache.isIdle());
}

TEST_F(TileCacheByHand, KeepsAFinishedTileThatNobodyWantsAnyMoreWhereThereIsRoom)
{
    cache.setBudget(250);
    frame({{1, 1.0}, {2, 1.0}});
    runner->runAll();
    frame({{2, 1.0}});
    EXPECT_TRUE(cache.contains(key(1)));
    frame({{3, 1.0}}, {2});
    runner->runAll();
    frame({}, {2});
    EXPECT_TRUE(cache.contains(key(3)));
    EXPECT_TRUE(cache.contains(key(2)));
    EXPECT_FALSE(cache.contains(key(1)));
}

TEST_F(TileCacheByHand, EvictsTheLeastRecentlyUsed)
{
    cache.setBudget(300);
    settle({{1, 1.0}, {2, 1.0}, {3, 1.0}});
    frame({}, {2});
    frame({}, {1});
    settle({{4, 1.0}});
    EXPECT_FALSE(cache.contains(key(3)));
    settle({{5, 1.0}}, {4});
    EXPECT_FALSE(cache.contains(key(2)));
    EXPECT_TRUE(cache.contains(key(1)));
    EXPECT_EQ(cache.residentBytes(), 300u);
}

TEST_F(TileCacheByHand, TouchedTilesSurviveALoweredBudget)
{
    settle({{1, 1.0}, {2, 1.0}, {3, 1.0}});
    cache.setBudget(50);
    frame({}, {1, 3});
    EXPECT_EQ(cache.residentBytes(), 200u);
    EXPECT_TRUE(cache.contains(key(1)));
    EXPECT_TRUE(cache.contains(key(3)));
    frame({{1, 1.0}, {2, 7.0}});
    runner->runAll();
    EXPECT_EQ(cache.residentBytes(), 100u) << "a request touches what is resident";
    frame({});
    EXPECT_EQ(cache.residentBytes(), 0u);
    EXPECT_EQ(order.size(), 3u) << "built without room to keep it";
}

TEST_F(TileCacheByHand, RefusesWhatCouldNotBeKeptAndComesToRest)
{
    cache.setBudget(350);
    settle({{1, 9.0}, {2, 8.0}, {3, 7.0}, {4, 6.0}, {5, 5.0}});
    EXPECT_EQ(cache.refused(), 2u);
    EXPECT_EQ(cache.pending(), 0u);
    EXPECT_EQ(cache.residentBytes(), 300u);
    for (const int number : {1, 2, 3}) EXPECT_TRUE(cache.contains(key(number)));
    const std::size_t built = order.size();
    for (int i = 0; i < 10; ++i) settle({{1, 9.0}, {2, 8.0}, {3, 7.0}, {4, 6.0}, {5, 5.0}});
    EXPECT_EQ(order.size(), built);
    cache.setBudget(500);
    settle({{1, 9.0}, {2, 8.0}, {3, 7.0}, {4, 6.0}, {5, 5.0}});
    EXPECT_EQ(cache.refused(), 0u);
    EXPECT_EQ(order.size(), 5u);
}

TEST_F(TileCacheByHand, ATileLargerThanExpectedIsNotBuiltAgainAndAgain)
{
    sizeOf = [](int number) { return number == 9 ? 1000u : 10u; };
    cache.setBudget(500);
    settle({{1, 9.0}, {2, 8.0}});
    for (int i = 0; i < 10; ++i) settle({{1, 9.0}, {2, 8.0}, {9, 20.0}});
    EXPECT_EQ(order, Numbers({1, 2, 9}));
    EXPECT_LE(cache.peakBytes(), 500u);
    cache.setBudget(2000);
    settle({{1, 9.0}, {2, 8.0}, {9, 20.0}});
    EXPECT_TRUE(cache.contains(key(9)));
}

TEST_F(TileCacheByHand, AnEvictedTileIsBuiltAgainWhenItIsWanted)
{
    cache.setBudget(100);
    settle({{1, 1.0}});
    settle({{2, 1.0}});
    EXPECT_FALSE(cache.contains(key(1)));
    settle({{1, 1.0}});
    EXPECT_TRUE(cache.contains(key(1)));
    EXPECT_EQ(order, Numbers({1, 2, 1}));
}

TEST_F(TileCacheByHand, ASharpTurnDoesNotEvictMoreThanCanBeReplacedSoon)
{
    constexpr std::size_t soon = TileCache<TestTile>::kJobsPerWorker, all = 4 * soon;
    cache.setBudget(100 * all);
    std::vector<std::pair<int, double>> before, after;
    for (int i = 0; i < int(all); ++i) before.push_back({i, 1.0}), after.push_back({1000 + i, 1.0});
    settle(before);
    ASSERT_EQ(cache.residentTiles(), all);
    frame(after);
    EXPECT_GE(cache.residentTiles(), all - soon - 2);
    settle(after);
    EXPECT_TRUE(cache.contains(key(1000 + int(all) - 1)));
    EXPECT_EQ(cache.peakBytes(), 100 * all);
}

TEST_F(TileCacheByHand, RemembersFailuresAndDoesNotRetryThem)
{
    settle({{-1, 5.0}, {1, 1.0}});
    EXPECT_TRUE(cache.failed(key(-1)));
    EXPECT_FALSE(cache.failed(key(1)));
    EXPECT_FALSE(cache.failed(key(2)));
    for (int i = 0; i < 5; ++i) settle({{-1, 5.0}, {1, 1.0}});
    EXPECT_EQ(cache.buildNow(key(-1)), nullptr);
    EXPECT_EQ(order, Numbers({-1, 1}));
    EXPECT_EQ(cache.built(), 1u);
    EXPECT_EQ(cache.buildNow(key(-2)), nullptr);
    EXPECT_TRUE(cache.failed(key(-2)));
}

TEST_F(TileCacheByHand, TakesAnExceptionForAFailure)
{
    sizeOf = [](int) -> std::size_t { throw std::runtime_error("size"); };
    settle({{1, 1.0}});
    EXPECT_TRUE(cache.failed(key(1)));
    EXPECT_EQ(cache.buildNow(key(2)), nullptr);
    EXPECT_TRUE(cache.failed(key(2)));
}

TEST_F(TileCacheByHand, BuildsAtOnceWhenAskedTo)
{
    const TestTile* root = cache.buildNow(key(7));
    ASSERT_NE(root, nullptr);
    EXPECT_EQ(root->number, 7);
    EXPECT_EQ(cache.buildNow(key(7)), root);
    EXPECT_EQ(order, Numbers({7}));

    frame({{1, 2.0}, {2, 3.0}});
    ASSERT_NE(cache.buildNow(key(1)), nullptr) << "a queued one";
    runner->runOne();
    ASSERT_NE(cache.buildNow(key(2)), nullptr) << "one that is finished";
    runner->runAll();
    EXPECT_EQ(order, Numbers({7, 1, 2}));
    frame({});
    EXPECT_EQ(cache.residentTiles(), 3u);
    EXPECT_TRUE(cache.isIdle());
}

TEST_F(TileCacheByHand, WhatIsBuiltAtOnceSurvivesItsFrame)
{
    cache.setBudget(10);
    cache.beginFrame();
    const TestTile* root = cache.buildNow(key(7));
    cache.endFrame();
    EXPECT_EQ(cache.find(key(7)), root);
    frame({});
    EXPECT_EQ(cache.residentBytes(), 0u);
}

namespace {

/// Small work of random length, so that cache and jobs meet in many orders.
std::shared_ptr<const TestTile> work(const TileKey& key) {
    std::atomic<int> spin = 0;
    while (spin < key.column % 13 * 300) ++spin;
    if (key.column % 19 == 7) return nullptr;
    return std::make_shared<TestTile>(TestTile{key.column, std::size_t(100 + key.column % 5 * 50)});
}

void randomFrame(Cache& cache, std::mt19937& random) {
    const int centre = int(random() % 500);
    cache.beginFrame();
    for (int i = 0; i < 12; ++i) {
        const TileKey wanted = key(centre + int(random() % 40));
        if (const TestTile* tile = cache.find(wanted))
            EXPECT_EQ(tile->number, wanted.column);
        else
            cache.request(wanted, double(random() % 100));
    }
    cache.endFrame();
}

}  // namespace

TEST(TileCache, ComesToRestOnThreads)
{
    Cache cache(std::make_shared<ThreadPool>(3), work);
    cache.setBudget(5000);
    for (int frame = 0; frame < 1000 && (frame == 0 || !cache.isIdle()); ++frame) {
        cache.beginFrame();
        for (int number = 0; number < 100; ++number) cache.request(key(number), 100.0 - number);
        cache.endFrame();
        cache.wait();
    }
    EXPECT_TRUE(cache.isIdle());
    EXPECT_GT(cache.refused(), 0u);
    EXPECT_LE(cache.peakBytes(), 5000u);
    EXPECT_GT(cache.residentBytes(), 4000u);
    EXPECT_TRUE(cache.failed(key(7)));
    for (const int number : {0, 1, 2, 3, 4, 5}) EXPECT_TRUE(cache.contains(key(number))) << number;
}

TEST(TileCache, WaitsForATileThatAJobIsBuildingAndBuildsItOnce)
{
    std::promise<void> building, release;
    std::atomic<int> builds = 0;
    Cache cache(std::make_shared<ThreadPool>(1), [&, released = release.get_future().share()](const TileKey& key) {
        if (++builds == 1) building.set_value();
        released.wait();
        return work(key);
    });
    for (int frame = 0; frame < 3; ++frame) {
        cache.beginFrame();
        cache.request(key(3), 1.0);
        cache.endFrame();
        if (frame == 0) building.get_future().wait();
    }
    EXPECT_EQ(cache.inFlight(), 1u);
    EXPECT_EQ(cache.pending(), 0u);
    std::thread releaser([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        release.set_value();
    });
    EXPECT_NE(cache.buildNow(key(3)), nullptr);
    releaser.join();
    EXPECT_EQ(builds, 1);
    EXPECT_TRUE(cache.isIdle());
}

TEST(TileCache, GoesWithoutWaitingAndDropsWhatArrivesLater)
{
    std::promise<void> building, release;
    const auto source = std::make_shared<int>(1);
    std::weak_ptr<const TestTile> late;
    auto pool = std::make_shared<ThreadPool>(1);
    auto cache = std::make_unique<Cache>(pool, [&, source, released = release.get_future().share()](const TileKey& key) {
        building.set_value();
        released.wait();
        auto tile = work(key);
        late = tile;
        return tile;
    });
    cache->beginFrame();
    cache->request(key(3), 1.0);
    cache->request(key(4), 0.5);
    cache->endFrame();
    building.get_future().wait();
    cache.reset();
    EXPECT_GT(source.use_count(), 1) << "the job still needs it";
    release.set_value();
    std::promise<void> last;
    pool->submit([&] { last.set_value(); });
    last.get_future().wait();
    pool.reset();
    EXPECT_TRUE(late.expired());
    EXPECT_EQ(source.use_count(), 1);
}

TEST(TileCache, DoesNotWaitForEverForJobsThatItsRunnerDropped)
{
    const auto pool = std::make_shared<ThreadPool>(1);
    Cache cache(pool, work);
    pool->stop();
    cache.beginFrame();
    cache.request(key(3), 1.0);
    cache.endFrame();
    cache.wait();
    EXPECT_NE(cache.buildNow(key(3)), nullptr);
}

TEST(TileCache, AThousandCachesComeAndGoWithJobsInFlight)
{
    const auto pool = std::make_shared<ThreadPool>(3);
    std::mt19937 random(5);
    std::size_t inFlight = 0;
    std::unique_ptr<Cache> other;
    for (int i = 0; i < 1000; ++i) {
        auto cache = std::make_unique<Cache>(pool, work);
        cache->setBudget(3000);
        for (int frame = int(random() % 4); frame >= 0; --frame) {
            randomFrame(*cache, random);
            if (other) randomFrame(*other, random);
        }
        if (random() % 4 == 0) cache->buildNow(key(int(random() % 500)));
        inFlight += cache->pending() + cache->inFlight();
        if (random() % 2) other.swap(cache);
    }
    EXPECT_GT(inFlight, 1000u) << "nothing was in flight, so nothing was tested";
}

TEST(TileCache, PoolsComeAndGoWithTheirCaches)
{
    std::mt19937 random(6);
    for (int i = 0; i < 200; ++i) {
        Cache cache(std::make_shared<ThreadPool>(2), work);
        for (int frame = int(random() % 4); frame >= 0; --frame) randomFrame(cache, random);
    }
}

TEST(TileCache, JumpsStayWithinTheBudgetOnThreads)
{
    const std::size_t budget = 4000;
    Cache cache(std::make_shared<ThreadPool>(3), work);
    cache.setBudget(budget);
    std::mt19937 random(8);
    for (int i = 0; i < 2000; ++i) {
        randomFrame(cache, random);
        ASSERT_LE(cache.residentBytes(), budget);
        if (i % 50 == 0) cache.wait();
    }
    EXPECT_LE(cache.peakBytes(), budget);
    EXPECT_GT(cache.built(), 50u);
}
