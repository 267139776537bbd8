// Flies, switches, edits, opens and closes at random for as long as it is told, and says whether memory and GL objects stay flat.
#include <epoxy/gl.h>

#include <epoxy/egl.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include <Inventor/SoDB.h>
#include <Inventor/SoInteraction.h>
#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/elements/SoGLCacheContextElement.h>
#include <Inventor/errors/SoDebugError.h>
#include <Inventor/errors/SoReadError.h>
#include <Inventor/misc/SoContextHandler.h>
#include <Inventor/nodes/SoDirectionalLight.h>
#include <Inventor/nodes/SoSeparator.h>

#include <SoTerrain/SoTerrain.h>

#include "Meters.h"
#include "World.h"

namespace {

struct Options {
    double minutes = 1.0 / 3.0;
    std::uint32_t seed = 1;
    int legFrames = 30;
    bool shares = true;
    std::string csv, plot;
};

constexpr const char* kUsage =
    "Usage: test_soak [--minutes M] [--seed N] [--leg FRAMES] [--share 0|1] [--csv FILE] [--plot FILE.svg|FILE.png]\n"
    "  --minutes M   how long, default 1/3\n"
    "  --seed N      which deeds; the same number does the same, default 1\n"
    "  --leg FRAMES  after so many frames all is deleted and memory is read, default 30\n"
    "  --share 0     no windows share their GL objects, default 1: some do, as those of SoQt\n"
    "  --csv FILE    readings, some each second\n"
    "  --plot FILE   drawn by gnuplot, where it is installed; takes --csv\n"
    "Exit status: 0 flat, 1 something grew or went wrong, 2 usage, 77 no EGL.\n";

bool parse(int argc, char** argv, Options& options) {
    for (int i = 1; i < argc; i += 2) {
        const std::string name = argv[i];
        if (i + 1 == argc) return false;
        const char* value = argv[i + 1];
        if (name == "--minutes")
            options.minutes = std::atof(value);
        else if (name == "--seed")
            options.seed = std::uint32_t(std::strtoul(value, nullptr, 10));
        else if (name == "--leg")
            options.legFrames = std::atoi(value);
        else if (name == "--share")
            options.shares = std::atoi(value) != 0;
        else if (name == "--csv")
            options.csv = value;
        else if (name == "--plot")
            options.plot = value;
        else
            return false;
    }
    return options.minutes > 0.0 && options.legFrames > 0;
}

const void* currentContext() {
    return eglGetCurrentContext();
}

/// Megabytes that stay allocated when a context goes that showed no terrain: Coin 4.0.0 makes a table of GL's functions for each
/// and never frees it, whether it is told that the context goes or not.
double keptOfContext() {
    constexpr std::size_t kRounds = 41;
    const app::NodePtr<SoSeparator> scene(new SoSeparator);
    scene->addChild(new SoDirectionalLight);
    const std::uint32_t id = SoGLCacheContextElement::getUniqueCacheContext();
    std::vector<double> kept;
    while (kept.size() < kRounds) {
        const double before = soak::readProcess(false).heapMegabytes;
        {
            const auto made = terrain::HeadlessContext::create(320, 240);
            if (!made) return 0.0;
            SoGLRenderAction action(SbViewportRegion(320, 240));
            action.setCacheContext(id);
            action.apply(scene.get());
            SoContextHandler::destructingContext(id);
        }
        kept.push_back(soak::readProcess(false).heapMegabytes - before);
    }
    // Now and then a table grows.
    std::nth_element(kept.begin(), kept.begin() + kRounds / 2, kept.end());
    return std::max(0.0, kept[kRounds / 2]);
}

/// Refused values of fields are part of the soak.
void ignore(const SoError*, void*) {}

class Soak {
public:
    Soak(const Options& options, const std::string& folder)
        : options_(options), ledger_(currentContext), table_(options.csv, kinds()),
          world_(options.seed, folder, ledger_, options.shares) {}

    int run() {
        if (!table_.isGood()) {
            std::fprintf(stderr, "%s: expected a file that can be written\n", options_.csv.c_str());
            return EXIT_FAILURE;
        }
        double lastRow = 0.0;
        // A leg to its end, so that all readings at rest are of equal states.
        while (seconds() < options_.minutes * 60.0) {
            for (int frame = 0; frame < options_.legFrames; ++frame) {
                times_.push_back(world_.frame());
                if (seconds() - lastRow < 1.0) continue;
                lastRow = seconds();
                row(false);
            }
            world_.end();
            row(true);
        }
        table_.plot(options_.plot);
        int grew = 0;
        const std::string found = soak::verdict(atRest_, kinds(), grew);
        std::printf("%.1f minutes, seed %u: %s\nof each of %zu contexts that went Coin keeps %.1f KB, which are not counted\n"
                    "%zu times all was deleted; from there on, after a quarter of it:\n%s",
                    seconds() / 60.0, options_.seed, world_.report().c_str(), world_.contexts(), 1024.0 * kept_, atRest_.size(),
                    found.c_str());
        const bool isFlat = grew == 0 && world_.problems() == 0;
        std::printf("%s%s\n", isFlat ? "FLAT" : "NOT FLAT",
                    world_.problems() > 0 ? (", " + std::to_string(world_.problems()) + " problems").c_str() : "");
        return isFlat ? EXIT_SUCCESS : EXIT_FAILURE;
    }

private:
    using Clock = std::chrono::steady_clock;

    static std::vector<std::string> kinds() {
        std::vector<std::string> names;
        for (std::size_t kind = 0; kind < test::GlLedger::kKinds; ++kind) names.push_back(test::GlLedger::nameOf(kind));
        return names;
    }
    double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
    void row(bool atRest) {
        soak::Reading reading = soak::readProcess(atRest);
        reading.seconds = seconds();
        reading.atRest = atRest;
        reading.coinMegabytes = kept_ * double(world_.contexts());
        reading.glMegabytes = double(world_.glBytes()) / (1 << 20);
        const auto counts = ledger_.all();
        reading.glObjects.assign(counts.begin(), counts.end());
        for (const double time : times_) {
            reading.meanFrameMilliseconds += time / double(times_.size());
            reading.longestFrameMilliseconds = std::max(reading.longestFrameMilliseconds, time);
        }
        times_.clear();
        table_.add(reading);
        if (atRest) atRest_.push_back(reading);
    }

    Options options_;
    double kept_ = keptOfContext();
    test::GlLedger ledger_;
    soak::Table table_;
    soak::World world_;
    Clock::time_point start_ = Clock::now();
    std::vector<double> times_;
    std::vector<soak::Reading> atRest_;
};

}  // namespace

int main(int argc, char** argv) {
    Options options;
    if (!parse(argc, argv, options)) {
        std::fputs(kUsage, stderr);
        return 2;
    }
    if (const auto context = terrain::HeadlessContext::create(8, 8); !context) {
        std::printf("skipped: %s\n", context.error().message().c_str());
        return 77;
    }
    SoDB::init();
    SoInteraction::init();
    SoTerrain::init();
    SoDebugError::setHandlerCallback(ignore, nullptr);
    SoReadError::setHandlerCallback(ignore, nullptr);
    std::string folder = (std::filesystem::temp_directory_path() / "soterrain-soak-XXXXXX").string();
    if (!mkdtemp(folder.data()) || !soak::World::makeFiles(folder)) {
        std::fprintf(stderr, "%s: expected a folder that can be written\n", folder.c_str());
        return EXIT_FAILURE;
    }
    const int status = Soak(options, folder).run();
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
    return status;
}
