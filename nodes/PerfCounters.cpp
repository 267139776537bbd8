#include "PerfCounters.h"

PerfCounters & PerfCounters::instance()
{
    static PerfCounters * const counters = new PerfCounters;
    return *counters;
}

PerfCounters::Entry & PerfCounters::entryOf(std::string_view name)
{
    for (Entry & entry : entries_)
        if (entry.counter.name == name) return entry;
    return entries_.emplace_back(name);
}

PerfCounter & PerfCounters::find(std::string_view name)
{
    const std::lock_guard lock(mutex_);
    return entryOf(name).counter;
}

PerfCounter & PerfCounters::declare(std::string_view name, PerfCounter::Kind kind, const char * unit)
{
    const std::lock_guard lock(mutex_);
    Entry & entry = entryOf(name);
    entry.counter.kind = kind;
    if (unit && entry.unit != unit) entry.unit = unit;
    return entry.counter;
}

std::string PerfCounters::unitOf(const PerfCounter & counter) const
{
    const std::lock_guard lock(mutex_);
    for (const Entry & entry : entries_)
        if (&entry.counter == &counter) return entry.unit;
    return {};
}

std::string PerfCounters::names() const
{
    const std::lock_guard lock(mutex_);
    std::string names;
    for (const Entry & entry : entries_) {
        if (entry.counter.kind == PerfCounter::NOTHING_YET) continue;
        if (!names.empty()) names += ", ";
        names += entry.counter.name;
    }
    return names;
}
