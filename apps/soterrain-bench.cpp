// Compares node classes on the standard flight over one map: a table, and the same in JSON.
#include <getopt.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "BenchProcess.h"
#include "Numbers.h"
#include "ShippedData.h"

namespace {

using nlohmann::ordered_json;

const char* const usageText =
    "Usage: soterrain-bench --map FILE [option]...\n"
    "Flies one flight (1024x768) over the map with each node class, each in a process of its own, and prints a table.\n"
    "  --map FILE          height map\n"
    "  --texture FILE      texture\n"
    "  --flight FILE       a flight that SoTerrainTest recorded over this map, instead of the standard one\n"
    "  --spacing X[,Y]     distance of samples, as SoTerrainTest has it\n"
    "  --height-scale S    factor on heights\n"
    "  --frames N          frames of the flight (60)\n"
    "  --nodes LIST        node classes, by default Coin's SoIndexedFaceSet and SoQuadMesh and all of SoTerrain\n"
    "  --pixel-error PX    field pixelError of the nodes that have it (2)\n"
    "  --fields TEXT       further fields of the nodes, as an .iv file has them, such as \"clipmapSize 127\"\n"
    "  --error-every K     measure the screen error every K frames (5)\n"
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
};

enum Code { Map = 1, Texture, Flight, Spacing, HeightScale, Frames, Nodes, PixelError, ErrorEvery, Json, Fields, Help };

const option longOptions[] = {
    {"map", required_argument, nullptr, Map},
    {"texture", required_argument, nullptr, Texture},
    {"flight", required_argument, nullptr, Flight},
    {"spacing", required_argument, nullptr, Spacing},
    {"height-scale", required_argument, nullptr, HeightScale},
    {"frames", required_argument, nullptr, Frames},
    {"nodes", required_argument, nullptr, Nodes},
    {"pixel-error", required_argument, nullptr, PixelError},
    {"error-every", required_argument, nullptr, ErrorEvery},
    {"json", required_argument, nullptr, Json},
    {"fields", required_argument, nullptr, Fields},
    {"help", no_argument, nullptr, Help},
    {nullptr, 0, nullptr, 0},
};

bool take(int code, Arguments& arguments) {
    constexpr int most = 1000000;
    app::BenchRequest& request = arguments.request;
    switch (code) {
    case Map:
        request.map = app::findShipped(optarg);
        return true;
    case Texture:
        request.texture = app::findShipped(optarg);
        return true;
    case Flight:
        request.flight = optarg;
        return true;
    case Spacing:
        return app::readSpacing(optarg, request.spacing);
    case HeightScale:
        return app::readFactor(optarg, request.heightScale);
    case Frames:
        return app::readNumber(optarg, 1, most, request.frames);
    case Nodes:
        arguments.nodes = app::splitList(optarg);
        return !arguments.nodes.empty();
    case PixelError:
        return app::readNumber(optarg, 0.0, double(most), request.pixelError);
    case ErrorEvery:
        return app::readNumber(optarg, 1, most, request.errorEvery);
    case Json:
        arguments.json = optarg;
        return true;
    case Fields:
        request.fields = optarg;
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
    std::printf("%s, %d frames, 1024x768, pixelError %g, %s\n", request.flight.empty() ? "standard flight" : request.flight.c_str(),
                request.frames, request.pixelError, request.map.c_str());
    std::printf("%-22s %26s %8s %10s %23s %26s %9s\n", "", "frame ms", "CPU ms", "triangles", "screen error px", "bytes a sample",
                "start ms");
    std::printf("%-22s %8s %8s %8s %8s %10s %7s %7s %7s %8s %8s %8s\n", "node", "median", "p95", "worst", "median", "mean", "rms",
                "p99.9", "max", "growth", "memory", "buffers");
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    if (const auto status = app::runBenchProcess(argc, argv, "soterrain-bench")) return *status;
    const std::optional<Arguments> arguments = parse(argc, argv);
    if (!arguments || arguments->help) {
        std::fputs(usageText, arguments ? stdout : stderr);
        return arguments ? EXIT_SUCCESS : 2;
    }
    printHead(arguments->request);
    ordered_json all = ordered_json::array();
    bool complete = true;
    app::BenchRequest request = arguments->request;
    for (const std::string& node : arguments->nodes) {
        request.className = node;
        if (const app::BenchOutcome outcome = app::benchInProcess(request); !outcome.result.is_null()) {
            printRow(outcome.result);
            all.push_back(outcome.result);
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
