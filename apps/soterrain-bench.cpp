// Compares node classes on the standard flight over one map: a table, and the same in JSON.
#include <getopt.h>
#include <sys/wait.h>
#include <unistd.h>

#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "BenchRun.h"
#include "CoinStart.h"
#include "ShippedData.h"

namespace {

using nlohmann::ordered_json;

const char* const usageText =
    "Usage: soterrain-bench --map FILE [--texture FILE] [--frames N] [--nodes CLASS,CLASS,...] [--pixel-error PX] [--json FILE]\n"
    "Flies the standard flight (1024x768) over the map with each node class, each in a process of its own, and prints a table.\n"
    "  --map FILE          height map\n"
    "  --texture FILE      texture\n"
    "  --frames N          frames of the flight (60)\n"
    "  --nodes LIST        node classes, by default Coin's SoIndexedFaceSet and SoQuadMesh and all of SoTerrain\n"
    "  --pixel-error PX    field pixelError of the nodes that have it (2)\n"
    "  --error-every K     measure the screen error every K frames (20)\n"
    "  --json FILE         write everything that was measured here too\n"
    "  --help              print this\n"
    "Exit status: 0, 1 when a node could not be measured, 2 for a wrong command line.\n";

struct Arguments {
    app::BenchRequest request;
    std::vector<std::string> nodes{"SoIndexedFaceSet", "SoQuadMesh",          "SoBruteForceTerrain",
                                   "SoROAMTerrain",    "SoChunkedLoDTerrain", "SoGeoMipmapTerrain",
                                   "SoGeometryClipmapTerrain"};
    std::string json;
    bool help = false;
    bool child = false;  ///< measure one class and print JSON
};

enum Code { Map = 1, Texture, Frames, Nodes, PixelError, ErrorEvery, Json, Child, Help };

const option longOptions[] = {
    {"map", required_argument, nullptr, Map},
    {"texture", required_argument, nullptr, Texture},
    {"frames", required_argument, nullptr, Frames},
    {"nodes", required_argument, nullptr, Nodes},
    {"pixel-error", required_argument, nullptr, PixelError},
    {"error-every", required_argument, nullptr, ErrorEvery},
    {"json", required_argument, nullptr, Json},
    {"child", required_argument, nullptr, Child},
    {"help", no_argument, nullptr, Help},
    {nullptr, 0, nullptr, 0},
};

template <class Number>
bool readNumber(const char* text, Number lowest, Number& number) {
    const char* end = text + std::strlen(text);
    const auto [stop, problem] = std::from_chars(text, end, number);
    return problem == std::errc() && stop == end && number >= lowest && number <= Number(1e6);
}

std::vector<std::string> split(std::string_view list) {
    std::vector<std::string> words;
    while (!list.empty()) {
        const std::size_t comma = std::min(list.find(','), list.size());
        if (comma > 0) words.emplace_back(list.substr(0, comma));
        list.remove_prefix(std::min(comma + 1, list.size()));
    }
    return words;
}

bool take(int code, Arguments& arguments) {
    app::BenchRequest& request = arguments.request;
    switch (code) {
    case Map:
        request.map = app::findShipped(optarg);
        return true;
    case Texture:
        request.texture = app::findShipped(optarg);
        return true;
    case Frames:
        return readNumber(optarg, 1, request.frames);
    case Nodes:
        arguments.nodes = split(optarg);
        return !arguments.nodes.empty();
    case PixelError:
        return readNumber(optarg, 0.0, request.pixelError);
    case ErrorEvery:
        return readNumber(optarg, 1, request.errorEvery);
    case Json:
        arguments.json = optarg;
        return true;
    case Child:
        arguments.child = true;
        request.className = optarg;
        return true;
    case Help:
        return arguments.help = true;
    default:
        return false;
    }
}

std::optional<Arguments> parse(int argc, char** argv) {
    Arguments arguments;
    int code = 0;
    while ((code = getopt_long(argc, argv, "", longOptions, nullptr)) != -1) {
        if (take(code, arguments)) continue;
        if (code != '?') std::fprintf(stderr, "soterrain-bench: bad value \"%s\"\n", optarg);
        return std::nullopt;
    }
    if (arguments.help) return arguments;
    if (optind == argc && !arguments.request.map.empty()) return arguments;
    std::fprintf(stderr, "soterrain-bench: expected --map FILE and options\n");
    return std::nullopt;
}

// Runs this program again for one class and returns what it prints, or nothing when it fails.
std::optional<ordered_json> measureInChild(const std::string& node, char** argv) {
    int ends[2];
    if (pipe(ends) != 0) return std::nullopt;
    const pid_t child = fork();
    if (child == 0) {
        dup2(ends[1], STDOUT_FILENO);
        close(ends[0]);
        close(ends[1]);
        std::vector<char*> arguments;
        for (char** argument = argv; *argument; ++argument) arguments.push_back(*argument);
        std::string name = "--child=" + node;
        arguments.push_back(name.data());
        arguments.push_back(nullptr);
        execv("/proc/self/exe", arguments.data());
        _exit(127);
    }
    close(ends[1]);
    std::string text;
    char buffer[4096];
    for (ssize_t count = 0; child > 0 && (count = read(ends[0], buffer, sizeof buffer)) > 0;)
        text.append(buffer, std::size_t(count));
    close(ends[0]);
    int status = -1;
    if (child < 0 || waitpid(child, &status, 0) != child || status != 0) return std::nullopt;
    ordered_json out = ordered_json::parse(text, nullptr, false);
    return out.is_discarded() ? std::nullopt : std::optional(out);
}

int runChild(const app::BenchRequest& request) {
    app::startCoin();
    const auto result = app::runBench(request);
    if (!result) {
        std::fprintf(stderr, "soterrain-bench: %s\n", result.error().message().c_str());
        return EXIT_FAILURE;
    }
    std::printf("%s\n", result.value().dump().c_str());
    return EXIT_SUCCESS;
}

void printRow(const ordered_json& r) {
    const auto perSample = [&r](const char* key) {
        char text[16] = "-";
        if (r.contains(key)) std::snprintf(text, sizeof text, "%.1f", r[key].get<double>() / r["samples"].get<double>());
        return std::string(text);
    };
    const ordered_json &frame = r["frame_ms"], &cpu = r["cpu_ms"], &error = r["error_px"];
    std::printf("%-22s %8.2f %8.2f %8.2f %8.2f %10.0f %7.3f %7.3f %7.3f %8s %8s %8s %9.1f\n", r["class"].get<std::string>().c_str(),
                frame["median"].get<double>(), frame["p95"].get<double>(), frame["worst"].get<double>(),
                cpu["median"].get<double>(), r["triangles"].get<double>(), error["rms"].get<double>(), error["p999"].get<double>(),
                error["max"].get<double>(), perSample("growth_bytes").c_str(), perSample("memory_bytes").c_str(),
                perSample("buffer_bytes").c_str(), r["start_ms"].get<double>());
    if (r["not_drawn"].get<double>() > 0)
        std::printf("%-22s %.0f samples in view were not drawn\n", "", r["not_drawn"].get<double>());
    if (const int incomplete = r.value("incomplete_frames", 0))
        std::printf("%-22s %d frames were timed before they were complete\n", "", incomplete);
    std::fflush(stdout);
}

void printHead(const app::BenchRequest& request) {
    std::printf("standard flight, %d frames, 1024x768, pixelError %g, %s\n", request.frames, request.pixelError,
                request.map.c_str());
    std::printf("%-22s %26s %8s %10s %23s %26s %9s\n", "", "frame ms", "CPU ms", "triangles", "screen error px", "bytes a sample",
                "start ms");
    std::printf("%-22s %8s %8s %8s %8s %10s %7s %7s %7s %8s %8s %8s\n", "node", "median", "p95", "worst", "median", "mean", "rms",
                "p99.9", "max", "growth", "memory", "buffers");
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    const std::optional<Arguments> arguments = parse(argc, argv);
    if (!arguments || arguments->help) {
        std::fputs(usageText, arguments ? stdout : stderr);
        return arguments ? EXIT_SUCCESS : 2;
    }
    if (arguments->child) return runChild(arguments->request);
    printHead(arguments->request);
    ordered_json all = ordered_json::array();
    bool complete = true;
    for (const std::string& node : arguments->nodes) {
        if (const auto result = measureInChild(node, argv)) {
            printRow(*result);
            all.push_back(*result);
        } else {
            std::printf("%-22s not measured\n", node.c_str());
            complete = false;
        }
    }
    if (!arguments->json.empty()) {
        std::ofstream file(arguments->json, std::ios::trunc);
        file << all.dump(2) << '\n';
        file.close();
        if (!file) std::fprintf(stderr, "soterrain-bench: %s: expected a file that can be written\n", arguments->json.c_str());
        complete = complete && file;
    }
    return complete ? EXIT_SUCCESS : EXIT_FAILURE;
}
