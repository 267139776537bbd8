// Runs jobs: on threads in programs, by hand in tests and in programs without threads.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace terrain {

/// Takes jobs and runs each of them once, or destroys it without running it. What a job throws is swallowed. A job must not own its
/// runner, which could then be destroyed by the job that it is running.
class TaskRunner {
public:
    using Job = std::function<void()>;

    virtual ~TaskRunner() = default;

    /// Hands over a job. Jobs begin in the order of submission; a job may submit further ones.
    virtual void submit(Job job) = 0;
    /// How many jobs can run at once, at least 1.
    virtual unsigned workers() const = 0;

    /// The threads that the whole process shares. Before static objects go at exit they are stopped and joined, whoever still
    /// holds the runner; jobs submitted later are dropped.
    static std::shared_ptr<TaskRunner> shared();
};

/// A fixed number of threads, started at the first submit(). submit() may be called from any thread. Where the system grants no
/// thread at all, submit() runs the job itself.
class ThreadPool final : public TaskRunner {
public:
    /// One less than the machine's processors, at least 1: one is left to the thread that draws.
    static unsigned defaultWorkers();

    explicit ThreadPool(unsigned workers = defaultWorkers());
    ~ThreadPool() override { stop(); }
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;

    void submit(Job job) override;
    unsigned workers() const override { return workers_; }

    /// Waits for the jobs that run, drops those that wait and all later ones. Not to be called by a job.
    void stop();

private:
    bool startThreads();
    void runJobs();

    const unsigned workers_;
    std::mutex mutex_;
    std::condition_variable wake_;
    std::deque<Job> jobs_;
    std::vector<std::thread> threads_;
    bool stopped_ = false;
};

/// Runs jobs in the calling thread, in order, when told to. For use by one thread.
class ManualRunner final : public TaskRunner {
public:
    explicit ManualRunner(unsigned workers = 1) : workers_(workers ? workers : 1) {}

    void submit(Job job) override { jobs_.push_back(std::move(job)); }
    unsigned workers() const override { return workers_; }

    /// Runs the oldest job; false when there is none.
    bool runOne();
    /// Runs jobs until none is left, those included that they submit; how many ran.
    std::size_t runAll();
    std::size_t waiting() const { return jobs_.size(); }

private:
    const unsigned workers_;
    std::deque<Job> jobs_;
};

}  // namespace terrain
