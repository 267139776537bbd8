// What a tile cache shares with the jobs that build its tiles.
#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "base/TaskRunner.h"
#include "height/HeightSource.h"

namespace terrain {

struct TileKeyHash {
    std::size_t operator()(const TileKey& key) const {
        std::uint64_t hash = 0;
        for (const int part : {key.level, key.column, key.row, key.cells})
            hash = (hash ^ std::uint32_t(part)) * 0x9e3779b97f4a7c15u, hash ^= hash >> 29;
        return std::size_t(hash);
    }
};

/// Queue, work in progress and results of a TileCache. A job names no tile: when a worker is free it takes the request that is most
/// urgent by then. Jobs keep this object alive, so the cache may go while they run. Every member may be called from any thread.
template <class Tile>
class TileJobs : public std::enable_shared_from_this<TileJobs<Tile>> {
public:
    /// Returns null, or throws, where a tile cannot be built.
    using Builder = std::function<std::shared_ptr<const Tile>(const TileKey&)>;

    struct Request {
        TileKey key;
        double priority = 0.0;
        std::size_t bytes = 0;  ///< what the tile will take; 0: not known
    };

    struct Finished {
        TileKey key;
        std::shared_ptr<const Tile> tile;  ///< null: the builder failed
        std::size_t bytes = 0;
        double milliseconds = 0.0;  ///< that building it took its thread
    };

    /// What is on its way.
    struct Load {
        std::vector<TileKey> keys;  ///< of tiles that are being built, or are built and wait to be taken
        std::size_t bytes = 0;      ///< of those tiles; estimated for the unfinished ones
        std::size_t meanBytes = 1;  ///< of all tiles built so far; 1 before the first
    };

    struct Counts {
        std::size_t queued = 0;
        std::size_t building = 0;
        std::size_t finished = 0;
        std::size_t built = 0;      ///< since the beginning, without failures
        double milliseconds = 0.0;  ///< of all threads, for those
    };

    explicit TileJobs(Builder builder) : builder_(std::move(builder)) {}

    /// Submits jobs, at most `count`, until that many wait or run.
    void submitUpTo(std::size_t count, TaskRunner& runner) {
        // A runner may run or drop a job at once, so the number to submit is settled before.
        for (std::size_t missing = count - std::min(count, jobCount()); missing; --missing) {
            auto job = std::make_shared<Job>(this->shared_from_this());
            runner.submit([job = std::move(job)] { job->jobs->buildMostUrgent(); });
        }
    }

    /// Takes the finished tiles, and empties the queue: nothing is started until publish().
    std::vector<Finished> takeFinished() {
        std::vector<Finished> taken;
        const std::lock_guard lock(mutex_);
        queue_.clear();
        taken.swap(finished_);
        return taken;
    }

    Load load() const {
        const std::lock_guard lock(mutex_);
        Load load{{}, reservedBytes(), meanBytes()};
        for (const auto& [key, bytes] : building_) load.keys.push_back(key);
        for (const Finished& finished : finished_) load.keys.push_back(finished.key);
        return load;
    }

    /// Sets the queue, most urgent last, and how many bytes may be on their way at once.
    void publish(std::vector<Request> queue, std::size_t roomBytes) {
        const std::lock_guard lock(mutex_);
        queue_.swap(queue);
        roomBytes_ = roomBytes;
    }

    /// Builds a tile in the calling thread, or waits for the job that is building it. The tile counts as taken.
    Finished buildNow(const TileKey& key) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return !building_.contains(key); });
        const auto found = std::find_if(finished_.begin(), finished_.end(), [&](const Finished& f) { return f.key == key; });
        if (found != finished_.end()) {
            Finished taken = std::move(*found);
            finished_.erase(found);
            return taken;
        }
        std::erase_if(queue_, [&](const Request& request) { return request.key == key; });
        lock.unlock();
        Finished built = build(key);
        lock.lock();
        count(built);
        return built;
    }

    /// Drops results of these keys, those included that are still to come.
    template <class IsOld>
    void drop(const IsOld& isOld) {
        std::vector<Finished> dropped;
        const std::lock_guard lock(mutex_);
        const auto old = std::partition(finished_.begin(), finished_.end(), [&](const Finished& f) { return !isOld(f.key); });
        std::move(old, finished_.end(), std::back_inserter(dropped));
        finished_.erase(old, finished_.end());
        for (const auto& [key, bytes] : building_)
            if (isOld(key)) old_.insert(key);
    }

    /// Drops queue and results, those included that are still to come. Does not wait.
    void close() {
        std::vector<Finished> dropped;
        const std::lock_guard lock(mutex_);
        closed_ = true;
        queue_.clear();
        dropped.swap(finished_);
    }

    /// Waits until every job submitted so far has run or has been dropped by its runner.
    void wait() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return jobs_ == 0; });
    }

    Counts counts() const {
        const std::lock_guard lock(mutex_);
        return {queue_.size(), building_.size(), finished_.size(), built_, milliseconds_};
    }

private:
    std::size_t jobCount() const {
        const std::lock_guard lock(mutex_);
        return jobs_;
    }

    /// Exists for as long as its job waits or runs, so that jobs are counted right even if a runner drops them.
    struct Job {
        explicit Job(std::shared_ptr<TileJobs> owner) : jobs(std::move(owner)) {
            const std::lock_guard lock(jobs->mutex_);
            ++jobs->jobs_;
        }
        Job(const Job&) = delete;
        Job& operator=(const Job&) = delete;
        ~Job() {
            const std::lock_guard lock(jobs->mutex_);
            --jobs->jobs_;
            jobs->changed_.notify_all();
        }
        const std::shared_ptr<TileJobs> jobs;
    };

    void buildMostUrgent() {
        const std::optional<TileKey> key = take();
        if (!key) return;
        Finished built = build(*key);
        const std::lock_guard lock(mutex_);
        building_.erase(*key);
        count(built);
        if (old_.erase(*key) == 0 && !closed_) finished_.push_back(std::move(built));
        changed_.notify_all();
    }

    /// The most urgent request for which there is room moves from the queue to what is being built.
    std::optional<TileKey> take() {
        const std::lock_guard lock(mutex_);
        const std::size_t reserved = reservedBytes(), mean = meanBytes();
        for (std::size_t i = queue_.size(); i-- > 0;) {
            const std::size_t bytes = queue_[i].bytes ? queue_[i].bytes : mean;
            if (reserved > roomBytes_ || bytes > roomBytes_ - reserved) continue;
            const TileKey key = queue_[i].key;
            queue_.erase(queue_.begin() + std::ptrdiff_t(i));
            building_.emplace(key, bytes);
            return key;
        }
        return std::nullopt;
    }

    Finished build(const TileKey& key) const {
        try {
            const auto start = std::chrono::steady_clock::now();
            std::shared_ptr<const Tile> tile = builder_(key);
            const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
            const std::size_t bytes = tile ? tile->bytes() : 0;
            return {key, std::move(tile), bytes, taken.count()};
        } catch (...) {
            return {key, nullptr, 0};
        }
    }

    void count(const Finished& built) {
        if (!built.tile) return;
        ++built_;
        builtBytes_ += built.bytes;
        milliseconds_ += built.milliseconds;
    }

    std::size_t reservedBytes() const {
        std::size_t bytes = 0;
        for (const auto& [key, estimate] : building_) bytes += estimate;
        for (const Finished& finished : finished_) bytes += finished.bytes;
        return bytes;
    }

    std::size_t meanBytes() const { return built_ ? std::max<std::size_t>(1, (builtBytes_ + built_ - 1) / built_) : 1; }

    const Builder builder_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<Request> queue_;                                      ///< most urgent last
    std::unordered_map<TileKey, std::size_t, TileKeyHash> building_;  ///< with the estimate of its bytes
    std::unordered_set<TileKey, TileKeyHash> old_;                    ///< of building_: to be dropped
    std::vector<Finished> finished_;
    std::size_t roomBytes_ = 0;
    std::size_t jobs_ = 0;
    std::size_t built_ = 0;
    std::size_t builtBytes_ = 0;
    double milliseconds_ = 0.0;
    bool closed_ = false;
};

}  // namespace terrain
