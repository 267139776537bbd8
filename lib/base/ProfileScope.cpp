#include "base/ProfileScope.h"

#include <chrono>
#include <cstring>

namespace terrain {

#ifdef SOTERRAIN_PROFILE

namespace {

std::uint64_t nanoseconds() {
    return std::uint64_t(std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count());
}

struct Total {
    const char* name;
    std::uint64_t count = 0;
    std::uint64_t nanoseconds = 0;
};

std::vector<Total>& totals() {
    thread_local std::vector<Total> all;
    return all;
}

}  // namespace

ProfileScope::ProfileScope(const char* name) : name_(name), start_(nanoseconds()) {}

ProfileScope::~ProfileScope() {
    const std::uint64_t spent = nanoseconds() - start_;
    for (Total& total : totals())
        if (std::strcmp(total.name, name_) == 0) {
            ++total.count;
            total.nanoseconds += spent;
            return;
        }
    totals().push_back({name_, 1, spent});
}

std::vector<ScopeTotal> profileTotals() {
    std::vector<ScopeTotal> result;
    for (const Total& total : totals()) result.push_back({total.name, total.count, double(total.nanoseconds) * 1e-6});
    return result;
}

#else

std::vector<ScopeTotal> profileTotals() {
    return {};
}

#endif

}  // namespace terrain
