// Keeps edits of samples apart from threads that read them.
#pragma once

#include <mutex>
#include <shared_mutex>

namespace terrain {

/// Threads other than the one that edits hold it shared for as long as one piece of work takes; an edit holds it alone. An edit
/// that waits goes before readers that come later, so that it waits for the pieces in progress only.
class SampleGate {
public:
    class Reading {
    public:
        explicit Reading(SampleGate& gate) : gate_(gate) {
            const std::lock_guard entry(gate_.entry_);
            gate_.samples_.lock_shared();
        }
        ~Reading() { gate_.samples_.unlock_shared(); }
        Reading(const Reading&) = delete;
        Reading& operator=(const Reading&) = delete;

    private:
        SampleGate& gate_;
    };

    class Editing {
    public:
        explicit Editing(SampleGate& gate) : entry_(gate.entry_), samples_(gate.samples_) {}

    private:
        std::unique_lock<std::mutex> entry_;
        std::unique_lock<std::shared_mutex> samples_;
    };

private:
    std::mutex entry_;
    std::shared_mutex samples_;
};

}  // namespace terrain
