// Flies every node over a map and writes one page about it.
#include <getopt.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>

#include "BenchProcess.h"
#include "BenchScene.h"
#include "ChildProcess.h"
#include "ImageFile.h"
#include "Numbers.h"
#include "Report.h"
#include "ReportFiles.h"
#include "ShippedData.h"

namespace {

using terrain::Error;

const char* const usageText =
    "Usage: soterrain-report MAP -o FOLDER [option]...\n"
    "Flies every terrain node, and Coin's own shapes, over the map and writes what they took into the folder: report.html, one "
    "page\n"
    "with tables, plots and pictures; report.csv and report.json, the figures. No display is needed; plots need gnuplot.\n"
    "  -o, --output FOLDER    is made where it is missing\n"
    "  -t, --texture FILE     texture\n"
    "  --flight FILE          a flight that SoTerrainTest recorded over this map, instead of the standard one\n"
    "  --spacing X[,Y]        distance of samples, as SoTerrainTest has it\n"
    "  --height-scale S       factor on heights\n"
    "  --frames N             frames of the flight (60)\n"
    "  -e, --pixel-error PX   field pixelError of the nodes that have it (2)\n"
    "  --error-every K        measure the screen error every K frames (5)\n"
    "  --nodes LIST           node classes, with commas between, by default all\n"
    "  --minutes M            all is over by then; what there was no time for is left out (9)\n"
    "  --quick                fewer measurements: 12 frames, two sizes of the map, two errors\n"
    "  --help                 print this\n"
    "Exit status: 0; 1 when a node could not be measured or something not be written; 2 for a wrong command line; 130 when "
    "interrupted.\n";

enum Code { Flight = 1, Spacing, HeightScale, Frames, ErrorEvery, Nodes, Minutes, Quick, Help };

const option longOptions[] = {
    {"output", required_argument, nullptr, 'o'},
    {"texture", required_argument, nullptr, 't'},
    {"flight", required_argument, nullptr, Flight},
    {"spacing", required_argument, nullptr, Spacing},
    {"height-scale", required_argument, nullptr, HeightScale},
    {"frames", required_argument, nullptr, Frames},
    {"pixel-error", required_argument, nullptr, 'e'},
    {"error-every", required_argument, nullptr, ErrorEvery},
    {"nodes", required_argument, nullptr, Nodes},
    {"minutes", required_argument, nullptr, Minutes},
    {"quick", no_argument, nullptr, Quick},
    {"help", no_argument, nullptr, Help},
    {nullptr, 0, nullptr, 0},
};

struct Arguments {
    app::ReportOptions options;
    std::optional<int> frames;
    std::optional<int> errorEvery;
    bool help = false;
};

bool readCount(const char* text, int lowest, std::optional<int>& number) {
    int read = 0;
    if (!app::readNumber(text, lowest, 100000, read)) return false;
    number = read;
    return true;
}

bool take(int code, Arguments& arguments) {
    app::ReportOptions& options = arguments.options;
    switch (code) {
    case 'o':
        options.folder = optarg;
        return !options.folder.empty();
    case 't':
        options.request.texture = app::findShipped(optarg);
        return true;
    case 'e':
        return app::readNumber(optarg, 0.01, 1000.0, options.request.pixelError);
    case Flight:
        options.request.flight = optarg;
        return true;
    case Spacing:
        return app::readSpacing(optarg, options.request.spacing);
    case HeightScale:
        return app::readFactor(optarg, options.request.heightScale);
    case Frames:
        return readCount(optarg, 3, arguments.frames);
    case ErrorEvery:
        return readCount(optarg, 1, arguments.errorEvery);
    case Nodes:
        options.nodes = app::splitList(optarg);
        return !options.nodes.empty();
    case Minutes:
        return app::readNumber(optarg, 0.1, 1e5, options.minutes);
    case Quick:
        return options.quick = true;
    case Help:
        return arguments.help = true;
    default:
        return false;
    }
}

std::optional<Arguments> parse(int argc, char** argv) {
    Arguments arguments;
    int code = 0;
    while ((code = getopt_long(argc, argv, "o:t:e:", longOptions, nullptr)) != -1) {
        if (take(code, arguments)) continue;
        if (code != '?') std::fprintf(stderr, "soterrain-report: bad value \"%s\"\n", optarg);
        return std::nullopt;
    }
    if (arguments.help) return arguments;
    if (optind + 1 != argc || arguments.options.folder.empty()) {
        std::fprintf(stderr, "soterrain-report: expected a map and -o FOLDER\n");
        return std::nullopt;
    }
    app::ReportOptions& options = arguments.options;
    constexpr int quickFrames = 12, quickEvery = 4;
    options.request.map = app::findShipped(argv[optind]);
    options.request.frames = arguments.frames.value_or(options.quick ? quickFrames : options.request.frames);
    options.request.errorEvery = arguments.errorEvery.value_or(options.quick ? quickEvery : options.request.errorEvery);
    return arguments;
}

// Opens what is to be measured, so that what is wrong is said once and at once.
std::optional<Error> check(app::ReportOptions& options) {
    const auto map = app::openBenchMap(options.request);
    if (!map) return map.error();
    options.columns = map.value().grid.columns;
    options.rows = map.value().grid.rows;
    if (!options.request.flight.empty())
        if (const auto flight = app::readFlightFile(options.request.flight); !flight) return flight.error();
    if (!options.request.texture.empty())
        if (const auto texture = app::readImage(options.request.texture); !texture) return texture.error();
    const app::ProcessEnd plotter = app::runProcess({"gnuplot", "--version"});
    constexpr int notFound = 127;
    if (!plotter.succeeded())
        return Error{"gnuplot", "this program, to draw the plots (Debian: gnuplot-nox)",
                     plotter.status == notFound ? "none in PATH" : plotter.reason()};
    return std::nullopt;
}

int complain(const Error& problem) {
    std::fprintf(stderr, "soterrain-report: %s\n", problem.message().c_str());
    return EXIT_FAILURE;
}

// Measures, plots and writes; returns the exit status.
int report(app::ReportOptions& options) {
    const auto folder = app::ReportFolder::make(options.folder);
    if (!folder) return complain(folder.error());
    options.work = folder.value().work();
    app::ReportPlan plan = app::planReport(options);
    constexpr int interruptedStatus = 130;
    if (!app::measureReport(options, plan)) return interruptedStatus;
    const auto isMeasured = [](const app::Measurement& m) { return m.measured(); };
    if (std::none_of(plan.measurements.begin(), plan.measurements.end(), isMeasured))
        return complain({options.folder, "a report of at least one node", "none that could be measured, and nothing is written"});
    const auto plots = app::drawPlots(options, plan);
    if (app::interrupted()) return interruptedStatus;
    if (!plots) return complain(plots.error());
    if (const auto problem = folder.value().write({{"report.csv", app::reportTable(plan)},
                                                   {"report.json", app::reportJson(options, plan).dump(1) + '\n'},
                                                   {"report.html", app::reportPage(options, plan, plots.value())}}))
        return complain(*problem);
    std::printf("%s\n%s\n%s/report.html\n", app::summarySentence(plan).c_str(), app::errorSentence(options, plan).c_str(),
                options.folder.c_str());
    const auto isAsPlanned = [](const app::Measurement& m) { return m.measured() || (m.leftOut && m.rank > 0); };
    const bool complete = std::all_of(plan.measurements.begin(), plan.measurements.end(), isAsPlanned);
    return complete ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace

int main(int argc, char** argv) {
    if (const auto status = app::runBenchProcess(argc, argv, "soterrain-report")) return *status;
    std::optional<Arguments> arguments = parse(argc, argv);
    if (!arguments || arguments->help) {
        std::fputs(usageText, arguments ? stdout : stderr);
        return arguments ? EXIT_SUCCESS : 2;
    }
    app::catchInterrupts();
    if (const auto problem = check(arguments->options)) return complain(*problem);
    return report(arguments->options);
}
