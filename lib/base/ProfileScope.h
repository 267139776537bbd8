// Time spent in named scopes, for builds configured --with-profile.
#pragma once

#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include <cstdint>
#include <string>
#include <vector>

namespace terrain {

/// Sum over all passes through one scope.
struct ScopeTotal {
    std::string name;
    std::uint64_t count = 0;
    double milliseconds = 0.0;
};

/// Totals of all scopes since the program started, in order of first use; empty unless the library was configured --with-profile.
/// Scopes are counted in the thread that traverses the scene.
std::vector<ScopeTotal> profileTotals();

#ifdef SOTERRAIN_PROFILE

/// Adds its lifetime to the total of its name, which must be a string literal.
class ProfileScope {
public:
    explicit ProfileScope(const char* name);
    ~ProfileScope();
    ProfileScope(const ProfileScope&) = delete;
    ProfileScope& operator=(const ProfileScope&) = delete;

private:
    const char* name_;
    std::uint64_t start_;
};

#else

/// Nothing, in builds that do not measure finer scopes.
struct ProfileScope {
    explicit ProfileScope(const char*) {}
};

#endif

}  // namespace terrain
