// Memory of this process.
#pragma once

#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>

namespace app {

/// A line of /proc/self/status in bytes: "VmRSS:" is what is resident, "VmHWM:" the most that was. 0 where the system does not
/// tell.
inline double processBytes(std::string_view line) {
    std::ifstream status("/proc/self/status");
    for (std::string text; std::getline(status, text);) {
        if (text.starts_with(line)) return 1024.0 * std::atof(text.c_str() + line.size());
    }
    return 0.0;
}

}  // namespace app
