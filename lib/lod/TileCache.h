// Tiles in memory under a budget, built in the background in order of their errors on screen.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <tuple>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "lod/TileJobs.h"

namespace terrain {

/// Keeps tiles that were used lately and has missing ones built by a TaskRunner. A frame is
///
///     beginFrame();
///     ... find() what to draw, request() what is missing ...
///     endFrame();
///
/// Requests last one frame: what is not asked for again is not started. A worker that becomes free takes the most urgent request of
/// the last frame, so that late urgent ones overtake. Resident bytes plus those on their way (estimated by the mean of all tiles
/// built) keep within the budget; least recently used tiles make room. Tiles touched in a frame are not evicted at its end, even
/// over budget, and no job starts whose tile could then not be kept.
///
/// For use by one thread. Tile must have `std::size_t bytes() const`, cheap and constant for a tile.
template <class Tile>
class TileCache {
public:
    /// Builds a tile; null, or an exception, where that fails. Called from any thread, several at a time, and perhaps still for a
    /// moment after the cache is gone, so it must own all that it uses. A key must always give a tile of the same size.
    using Builder = typename TileJobs<Tile>::Builder;

    static constexpr std::size_t kDefaultBudget = std::size_t(256) << 20;
    /// So many jobs per worker are submitted per frame at most, and for so many tiles room is made by evicting others: enough to
    /// keep workers busy until the next frame at 0.1 ms a tile, few enough that a turn of the head does not cost all that was
    /// resident.
    static constexpr std::size_t kJobsPerWorker = 64;

    /// Without a runner TaskRunner::shared() is used.
    TileCache(std::shared_ptr<TaskRunner> runner, Builder builder)
        : runner_(runner ? std::move(runner) : TaskRunner::shared()), jobs_(std::make_shared<TileJobs<Tile>>(std::move(builder))) {}

    /// Does not wait for jobs that run: their results are dropped.
    ~TileCache() { jobs_->close(); }
    TileCache(const TileCache&) = delete;
    TileCache& operator=(const TileCache&) = delete;

    /// Bytes that tiles may take, from the next endFrame() on.
    void setBudget(std::size_t bytes) { budget_ = bytes; }
    std::size_t budget() const { return budget_; }

    void beginFrame() {
        ++frame_;
        touchedBytes_ = 0;
        wanted_.clear();
    }

    /// Asks for a tile; of several priorities given in a frame the largest counts. Touches a resident tile, and does nothing for
    /// one that has failed. The priority is an error on screen in pixels; what is not above 0 counts as 0. Of equals the coarser is
    /// first.
    void request(const TileKey& key, double priority) {
        if (find(key) || failed(key)) return;
        double& largest = wanted_.try_emplace(key, 0.0).first->second;
        largest = std::fmax(largest, priority);
    }

    /// A resident tile, or null. Touches it: the pointer holds until the endFrame() of a later frame.
    const Tile* find(const TileKey& key) {
        const auto found = places_.find(key);
        if (found == places_.end()) return nullptr;
        touch(found->second);
        return found->second->tile.get();
    }

    /// Builds a missing tile in the calling thread, or waits for the job that does, whatever the budget; touches it. Null: it
    /// failed.
    const Tile* buildNow(const TileKey& key) {
        if (const Tile* tile = find(key)) return tile;
        if (failed(key)) return nullptr;
        Finished built = jobs_->buildNow(key);
        if (!built.tile) {
            failed_.insert(key);
            return nullptr;
        }
        touch(insert(std::move(built), residents_.begin()));
        return residents_.front().tile.get();
    }

    /// Of these keys other tiles are built from now on: what is on its way is dropped, and what failed is tried again. Resident ones
    /// stay until replace() or remove().
    template <class IsOld>
    void forget(const IsOld& isOld) {
        jobs_->drop(isOld);
        std::erase_if(failed_, isOld);
        std::erase_if(sizes_, [&](const auto& entry) { return isOld(entry.first); });
    }

    /// A resident tile becomes another one.
    void replace(const TileKey& key, std::shared_ptr<const Tile> tile) {
        Resident& resident = *places_.at(key);
        const std::size_t bytes = tile->bytes();
        residentBytes_ = residentBytes_ - resident.bytes + bytes;
        if (isTouched(resident)) touchedBytes_ = touchedBytes_ - resident.bytes + bytes;
        peakBytes_ = std::max(peakBytes_, residentBytes_);
        resident.bytes = bytes;
        resident.tile = std::move(tile);
    }

    /// A resident tile goes.
    void remove(const TileKey& key) {
        const auto found = places_.find(key);
        if (isTouched(*found->second)) touchedBytes_ -= found->second->bytes;
        residentBytes_ -= found->second->bytes;
        residents_.erase(found->second);
        places_.erase(found);
    }

    /// All that are resident.
    std::vector<TileKey> residentKeys() const {
        std::vector<TileKey> keys;
        for (const Resident& resident : residents_) keys.push_back(resident.key);
        return keys;
    }
    /// A resident tile, without touching it.
    const Tile& at(const TileKey& key) const { return *places_.at(key)->tile; }

    /// Takes in what was built, evicts, and lets workers start on this frame's requests instead of the last one's.
    void endFrame() {
        takeIn(jobs_->takeFinished());
        schedule();
    }

    /// Whether a tile is resident, without touching it.
    bool contains(const TileKey& key) const { return places_.contains(key); }
    /// Whether building a tile has failed. It is not tried again.
    bool failed(const TileKey& key) const { return failed_.contains(key); }

    std::size_t residentBytes() const { return residentBytes_; }
    std::size_t residentTiles() const { return residents_.size(); }
    /// Largest residentBytes() so far.
    std::size_t peakBytes() const { return peakBytes_; }
    /// Requests of the last frame that a worker will still take.
    std::size_t pending() const { return jobs_->counts().queued; }
    /// Requests of the last frame that are not worked on because the budget has no room for their tiles.
    std::size_t refused() const { return refused_; }
    /// Tiles that are being built, or are built and wait for endFrame().
    std::size_t inFlight() const {
        const auto counts = jobs_->counts();
        return counts.building + counts.finished;
    }
    /// Of those, tiles (and failures) that the next endFrame() takes in.
    std::size_t finished() const { return jobs_->counts().finished; }
    /// Tiles and failures that were taken in since the beginning, whether they could be kept or not.
    std::size_t arrived() const { return arrived_; }
    /// Tiles built since the beginning.
    std::size_t built() const { return jobs_->counts().built; }
    /// What that took, added up over all threads.
    double buildMilliseconds() const { return jobs_->counts().milliseconds; }
    /// Nothing is queued or in flight: another frame of the same requests would change nothing.
    bool isIdle() const {
        const auto counts = jobs_->counts();
        return counts.queued + counts.building + counts.finished == 0;
    }
    /// Waits for the jobs submitted so far; endFrame() then takes their tiles in. Not with a ManualRunner, whose jobs would never
    /// run.
    void wait() { jobs_->wait(); }

private:
    using Request = typename TileJobs<Tile>::Request;
    using Finished = typename TileJobs<Tile>::Finished;

    struct Resident {
        TileKey key;
        std::shared_ptr<const Tile> tile;
        std::size_t bytes = 0;
        std::uint64_t touched = 0;  ///< number of the frame
    };
    using Place = typename std::list<Resident>::iterator;

    bool isTouched(const Resident& resident) const { return resident.touched == frame_; }

    void touch(Place place) {
        residents_.splice(residents_.begin(), residents_, place);
        if (isTouched(*place)) return;
        place->touched = frame_;
        touchedBytes_ += place->bytes;
    }

    Place insert(Finished finished, Place before) {
        const Place place = residents_.insert(before, {finished.key, std::move(finished.tile), finished.bytes});
        places_.emplace(finished.key, place);
        residentBytes_ += finished.bytes;
        peakBytes_ = std::max(peakBytes_, residentBytes_);
        return place;
    }

    void evictDownTo(std::size_t bytes) {
        while (residentBytes_ > bytes && !isTouched(residents_.back())) {
            residentBytes_ -= residents_.back().bytes;
            places_.erase(residents_.back().key);
            residents_.pop_back();
        }
    }

    bool isWanted(const Finished& finished) const { return wanted_.contains(finished.key); }

    void takeIn(std::vector<Finished> finished) {
        arrived_ += finished.size();
        for (const Finished& f : finished)
            if (!f.tile) failed_.insert(f.key);
        std::erase_if(finished, [](const Finished& f) { return !f.tile; });
        // What is wanted comes first and may displace others; what nobody wants any more is kept where there is room.
        const auto unwanted = std::partition(finished.begin(), finished.end(), [this](const Finished& f) { return isWanted(f); });
        std::sort(finished.begin(), unwanted,
                  [this](const Finished& a, const Finished& b) { return isMoreUrgent(requestOf(a.key), requestOf(b.key)); });
        for (auto f = finished.begin(); f != finished.end(); ++f) {
            const std::size_t taken = f < unwanted ? touchedBytes_ : residentBytes_;
            if (taken > budget_ || f->bytes > budget_ - taken) {
                // Without its size it would be built again and again, as its estimate fits.
                sizes_[f->key] = f->bytes;
                continue;
            }
            evictDownTo(budget_ - f->bytes);
            const Place place = insert(std::move(*f), residents_.end());
            if (f < unwanted) touch(place);
        }
    }

    Request requestOf(const TileKey& key) const {
        const auto size = sizes_.find(key);
        return {key, wanted_.at(key), size == sizes_.end() ? 0 : size->second};
    }

    static bool isMoreUrgent(const Request& a, const Request& b) {
        const auto rank = [](const Request& r) {
            return std::tuple(r.priority, r.key.level, -r.key.row, -r.key.column, r.key.cells);
        };
        return rank(a) > rank(b);
    }

    /// What this frame asked for and nothing is being done about, most urgent first.
    std::vector<Request> openRequests(const std::vector<TileKey>& inFlight) const {
        const std::unordered_set<TileKey, TileKeyHash> busy(inFlight.begin(), inFlight.end());
        std::vector<Request> open;
        for (const auto& [key, priority] : wanted_)
            if (!places_.contains(key) && !failed_.contains(key) && !busy.contains(key)) open.push_back(requestOf(key));
        std::sort(open.begin(), open.end(), isMoreUrgent);
        return open;
    }

    /// Publishes the requests whose tiles could be kept, and evicts down to the budget less the room that the first of them need.
    void schedule() {
        const auto load = jobs_->load();
        const std::size_t startable = kJobsPerWorker * runner_->workers();
        const std::size_t occupied = std::min(budget_, touchedBytes_ + load.bytes);
        std::size_t free = budget_ - occupied, soon = 0;
        std::vector<Request> queue;
        refused_ = 0;
        for (const Request& request : openRequests(load.keys)) {
            const std::size_t bytes = request.bytes ? request.bytes : load.meanBytes;
            if (bytes > free) {
                ++refused_;
                continue;
            }
            free -= bytes;
            if (queue.size() < startable) soon += bytes;
            queue.push_back(request);
        }
        evictDownTo(budget_ - std::min(budget_, load.bytes + soon));
        std::reverse(queue.begin(), queue.end());
        const std::size_t jobs = std::min(startable, queue.size());
        jobs_->publish(std::move(queue), budget_ - std::min(budget_, residentBytes_));
        jobs_->submitUpTo(jobs, *runner_);
    }

    const std::shared_ptr<TaskRunner> runner_;
    const std::shared_ptr<TileJobs<Tile>> jobs_;
    std::size_t budget_ = kDefaultBudget;
    std::uint64_t frame_ = 1;
    std::unordered_map<TileKey, double, TileKeyHash> wanted_;      ///< missing tiles asked for in this frame
    std::list<Resident> residents_;                                ///< most recently used first
    std::unordered_map<TileKey, Place, TileKeyHash> places_;       ///< in residents_
    std::unordered_set<TileKey, TileKeyHash> failed_;              ///< the builder gave null
    std::unordered_map<TileKey, std::size_t, TileKeyHash> sizes_;  ///< of tiles that were built and could not be kept
    std::size_t residentBytes_ = 0;
    std::size_t touchedBytes_ = 0;  ///< of tiles touched in this frame
    std::size_t peakBytes_ = 0;
    std::size_t refused_ = 0;
    std::size_t arrived_ = 0;
};

}  // namespace terrain
