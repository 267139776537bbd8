#include "BenchProcess.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "ChildProcess.h"
#include "CoinStart.h"

namespace app {

using nlohmann::ordered_json;

namespace {

constexpr const char* flag = "--measure-here";

}  // namespace

BenchOutcome benchInProcess(const BenchRequest& request, double seconds, bool talk) {
    const ProcessEnd end = runProcess({"/proc/self/exe", flag, toJson(request).dump()}, {}, seconds);
    if (talk) std::fputs(end.err.c_str(), stderr);
    if (!end.succeeded()) return {nullptr, end.reason(), end.late};
    ordered_json result = ordered_json::parse(end.out, nullptr, false);
    if (result.is_discarded() || !result.is_object()) return {nullptr, "its answer can't be read", false};
    return {std::move(result), {}, false};
}

std::optional<int> runBenchProcess(int argc, char** argv, const char* program) {
    if (argc != 3 || std::strcmp(argv[1], flag) != 0) return std::nullopt;
    const ordered_json request = ordered_json::parse(argv[2], nullptr, false);
    if (request.is_discarded()) return 2;
    startCoin();
    const auto result = runBench(benchRequest(request));
    if (!result) {
        std::fprintf(stderr, "%s: %s\n", program, result.error().message().c_str());
        return EXIT_FAILURE;
    }
    std::printf("%s\n", result.value().dump().c_str());
    return EXIT_SUCCESS;
}

}  // namespace app
