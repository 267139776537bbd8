#include "base/TaskRunner.h"

#include <algorithm>
#include <exception>
#include <utility>

namespace terrain {

namespace {

// By value: what the job holds is released before the runner looks for the next one.
void run(TaskRunner::Job job) {
    try {
        job();
    } catch (...) {
        // Nobody waits for a job's outcome who could be told.
    }
}

struct StopAtExit {
    ThreadPool& pool;
    ~StopAtExit() { pool.stop(); }
};

}  // namespace

std::shared_ptr<TaskRunner> TaskRunner::shared() {
    // The pool itself is never destroyed, so that this may be called while static objects go.
    static const auto* pool = new std::shared_ptr<ThreadPool>(std::make_shared<ThreadPool>());
    static const StopAtExit stop{**pool};
    return *pool;
}

unsigned ThreadPool::defaultWorkers() {
    return std::max(2u, std::thread::hardware_concurrency()) - 1;
}

ThreadPool::ThreadPool(unsigned workers) : workers_(std::max(1u, workers)) {}

void ThreadPool::submit(Job job) {
    {
        const std::lock_guard lock(mutex_);
        if (stopped_) return;
        if (startThreads()) jobs_.push_back(std::exchange(job, nullptr));
    }
    if (job) {
        run(std::move(job));
    } else {
        wake_.notify_one();
    }
}

bool ThreadPool::startThreads() {
    if (!threads_.empty()) return true;
    try {
        threads_.reserve(workers_);
        while (threads_.size() < workers_) threads_.emplace_back([this] { runJobs(); });
    } catch (const std::exception&) {
        // The system grants no more threads: those that there are do the work.
    }
    return !threads_.empty();
}

void ThreadPool::runJobs() {
    for (;;) {
        Job job;
        {
            std::unique_lock lock(mutex_);
            wake_.wait(lock, [this] { return stopped_ || !jobs_.empty(); });
            if (stopped_) return;
            job = std::move(jobs_.front());
            jobs_.pop_front();
        }
        run(std::move(job));
    }
}

void ThreadPool::stop() {
    std::vector<std::thread> threads;
    std::deque<Job> dropped;  // outside of the lock, for what goes with a job may call submit()
    {
        const std::lock_guard lock(mutex_);
        stopped_ = true;
        threads.swap(threads_);
        dropped.swap(jobs_);
    }
    wake_.notify_all();
    dropped.clear();
    for (std::thread& thread : threads) thread.join();
}

bool ManualRunner::runOne() {
    if (jobs_.empty()) return false;
    Job job = std::move(jobs_.front());
    jobs_.pop_front();
    run(std::move(job));
    return true;
}

std::size_t ManualRunner::runAll() {
    std::size_t count = 0;
    while (runOne()) ++count;
    return count;
}

}  // namespace terrain
