// Measurements in processes of their own, so that none finds what another one left.
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "BenchRun.h"

namespace app {

/// What runBench() gave, or why it gave nothing.
struct BenchOutcome {
    nlohmann::ordered_json result;  ///< null when it failed
    std::string problem;
    bool late = false;  ///< it was ended because its time was over
};

/// Runs this program again, to measure; at most so many seconds, unless 0. Passes on what it writes to stderr when `talk` is set.
BenchOutcome benchInProcess(const BenchRequest& request, double seconds = 0.0, bool talk = true);

/// First in main() of programs that call benchInProcess(): in a process that was started by it, measures and returns the exit
/// status.
std::optional<int> runBenchProcess(int argc, char** argv, const char* program);

}  // namespace app
