// Jobs run once, in order, on the threads that were asked for, and go away cleanly.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "base/TaskRunner.h"

using namespace terrain;

TEST(ManualRunner, RunsJobsInOrderInTheCallingThreadWhenTold)
{
    ManualRunner runner;
    std::vector<int> ran;
    for (int i = 0; i < 3; ++i)
        runner.submit([&ran, i, caller = std::this_thread::get_id()] {
            ran.push_back(std::this_thread::get_id() == caller ? i : -1);
        });
    EXPECT_TRUE(ran.empty());
    EXPECT_EQ(runner.waiting(), 3u);
    EXPECT_TRUE(runner.runOne());
    EXPECT_EQ(ran, std::vector<int>({0}));
    EXPECT_EQ(runner.runAll(), 2u);
    EXPECT_EQ(ran, std::vector<int>({0, 1, 2}));
    EXPECT_FALSE(runner.runOne());
}

TEST(ManualRunner, RunsWhatJobsSubmit)
{
    ManualRunner runner;
    int depth = 0;
    std::function<void()> job = [&] {
        if (++depth < 5) runner.submit(job);
    };
    runner.submit(job);
    EXPECT_EQ(runner.runAll(), 5u);
    EXPECT_EQ(depth, 5);
}

TEST(ManualRunner, SurvivesAJobThatThrows)
{
    ManualRunner runner;
    bool ran = false;
    runner.submit([] { throw std::runtime_error("job"); });
    runner.submit([&] { ran = true; });
    EXPECT_EQ(runner.runAll(), 2u);
    EXPECT_TRUE(ran);
}

TEST(ThreadPool, HasAtLeastOneWorker)
{
    EXPECT_GE(ThreadPool::defaultWorkers(), 1u);
    EXPECT_EQ(ThreadPool(0).workers(), 1u);
    EXPECT_EQ(ThreadPool(3).workers(), 3u);
    EXPECT_EQ(ThreadPool().workers(), ThreadPool::defaultWorkers());
}

TEST(ThreadPool, RunsEachJobOnceOffTheCallingThread)
{
    ThreadPool pool(3);
    std::mutex mutex;
    std::multiset<int> ran;
    bool onCaller = false;
    std::promise<void> all;
    for (int i = 0; i < 500; ++i)
        pool.submit([&, i, caller = std::this_thread::get_id()] {
            const std::lock_guard lock(mutex);
            onCaller |= std::this_thread::get_id() == caller;
            ran.insert(i);
            if (ran.size() == 500) all.set_value();
        });
    ASSERT_EQ(all.get_future().wait_for(std::chrono::minutes(1)), std::future_status::ready);
    const std::lock_guard lock(mutex);
    EXPECT_FALSE(onCaller);
    for (int i = 0; i < 500; ++i) EXPECT_EQ(ran.count(i), 1u) << i;
}

TEST(ThreadPool, OneWorkerKeepsTheOrder)
{
    std::vector<int> ran;
    std::promise<void> last;
    {
        ThreadPool pool(1);
        for (int i = 0; i < 100; ++i) pool.submit([&, i] { ran.push_back(i); });
        pool.submit([&] { last.set_value(); });
        last.get_future().wait();
    }
    ASSERT_EQ(ran.size(), 100u);
    EXPECT_TRUE(std::is_sorted(ran.begin(), ran.end()));
}

TEST(ThreadPool, RunsAsManyJobsAtOnceAsItHasWorkers)
{
    // Each job waits for all others, so fewer threads would time out.
    ThreadPool pool(4);
    std::vector<std::promise<void>> arrived(4);
    std::vector<std::shared_future<void>> others;
    for (auto& promise : arrived) others.push_back(promise.get_future().share());
    std::atomic<int> met = 0;
    std::vector<std::promise<void>> done(4);
    for (int i = 0; i < 4; ++i)
        pool.submit([&, i] {
            arrived[i].set_value();
            bool all = true;
            for (const auto& other : others) all &= other.wait_for(std::chrono::minutes(1)) == std::future_status::ready;
            met += all;
            done[i].set_value();
        });
    for (auto& promise : done) promise.get_future().wait();
    EXPECT_EQ(met, 4);
}

TEST(ThreadPool, SurvivesAJobThatThrows)
{
    ThreadPool pool(1);
    std::promise<void> after;
    pool.submit([] { throw std::runtime_error("job"); });
    pool.submit([&] { after.set_value(); });
    EXPECT_EQ(after.get_future().wait_for(std::chrono::minutes(1)), std::future_status::ready);
}

TEST(ThreadPool, DestructionEndsRunningJobsAndDropsQueuedOnes)
{
    std::atomic<int> ended = 0, queuedRan = 0;
    const auto held = std::make_shared<int>(1);
    std::promise<void> running, release;
    auto pool = std::make_unique<ThreadPool>(1);
    pool->submit([&, released = release.get_future().share()] {
        running.set_value();
        released.wait();
        ++ended;
    });
    for (int i = 0; i < 10; ++i) pool->submit([&queuedRan, held] { ++queuedRan; });
    running.get_future().wait();
    std::thread destroyer([&] { pool.reset(); });
    // The pool lets go of what is queued while the first job still runs.
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (held.use_count() > 1 && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
    EXPECT_EQ(held.use_count(), 1);
    EXPECT_EQ(ended, 0);
    release.set_value();
    destroyer.join();
    EXPECT_EQ(ended, 1);
    EXPECT_EQ(queuedRan, 0);
}

TEST(ThreadPool, DropsWhatIsSubmittedAfterTheStop)
{
    ThreadPool pool(2);
    pool.submit([] {});
    pool.stop();
    const auto held = std::make_shared<int>(1);
    pool.submit([held] { ADD_FAILURE() << "ran"; });
    EXPECT_EQ(held.use_count(), 1);
    pool.stop();
}

TEST(ThreadPool, ManyPoolsComeAndGoWhileTheyAreFed)
{
    std::atomic<int> ran = 0;
    for (int i = 0; i < 200; ++i) {
        ThreadPool pool(unsigned(i % 4));
        for (int job = 0; job < i % 7; ++job)
            pool.submit([&] {
                ++ran;
                pool.submit([&] { ++ran; });
            });
    }
    EXPECT_LE(ran, 2 * 200 * 6);
}

TEST(TaskRunner, TheSharedOneIsTheSameForAll)
{
    const auto runner = TaskRunner::shared();
    ASSERT_TRUE(runner);
    EXPECT_EQ(runner, TaskRunner::shared());
    std::promise<void> ran;
    runner->submit([&] { ran.set_value(); });
    EXPECT_EQ(ran.get_future().wait_for(std::chrono::minutes(1)), std::future_status::ready);
}

TEST(TaskRunner, TheSharedOneIsStoppedBeforeStaticObjectsGo)
{
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(
        {
            // What the job uses goes at exit; by then the job must have ended.
            static struct Used {
                std::atomic<bool> ended{false};
                ~Used() {
                    if (!ended) std::_Exit(7);
                }
            } used;
            static std::promise<void> running;
            TaskRunner::shared()->submit([] {
                running.set_value();
                std::this_thread::sleep_for(std::chrono::milliseconds(100));
                used.ended = true;
            });
            running.get_future().wait();
            std::exit(0);
        },
        testing::ExitedWithCode(0), "");
}
