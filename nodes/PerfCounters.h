// What is counted while frames are drawn, by name.
#ifndef SOTERRAIN_PERFCOUNTERS_H
#define SOTERRAIN_PERFCOUNTERS_H

#include <atomic>
#include <deque>
#include <mutex>
#include <string>
#include <string_view>

/// An amount only grows: who looks at it takes the difference to what it was, so any number may look. Any thread may count.
struct PerfCounter {
    enum Kind { NOTHING_YET, AMOUNT, VALUE };

    explicit PerfCounter(std::string_view n) : name(n) {}
    void count(double amount) { total.fetch_add(amount, std::memory_order_relaxed); }
    void set(double to) { value.store(to, std::memory_order_relaxed); }

    const std::string name;
    std::atomic<Kind> kind = NOTHING_YET;
    std::atomic<double> total = 0.0;
    std::atomic<double> value = 0.0;
};

/// The process's counters.
class PerfCounters {
public:
    /// Never deleted: nodes may outlive everything else of the library.
    static PerfCounters & instance();

    /// The counter of this name, made when it is new. It stays where it is.
    PerfCounter & find(std::string_view name);
    /// Says what a counter is. No unit leaves the one that it has.
    PerfCounter & declare(std::string_view name, PerfCounter::Kind kind, const char * unit);
    std::string unitOf(const PerfCounter & counter) const;
    /// Those that something counts by, with a comma between them.
    std::string names() const;

private:
    struct Entry {
        explicit Entry(std::string_view name) : counter(name) {}
        PerfCounter counter;
        std::string unit;
    };
    Entry & entryOf(std::string_view name);

    mutable std::mutex mutex_;
    std::deque<Entry> entries_;
};

/// One of several who make up a value together, such as the memory that each node holds.
class PerfShare {
public:
    explicit PerfShare(PerfCounter & counter) : counter_(counter) {}
    ~PerfShare() { set(0.0); }
    PerfShare(const PerfShare &) = delete;
    PerfShare & operator=(const PerfShare &) = delete;

    /// In whole numbers, so that sums stay exact.
    void set(double share)
    {
        if (share == share_) return;
        counter_.value.fetch_add(share - share_, std::memory_order_relaxed);
        share_ = share;
    }

private:
    PerfCounter & counter_;
    double share_ = 0.0;
};

#endif
