#include "Options.h"

#include <getopt.h>

#include <limits>
#include <string_view>
#include <vector>

#include "DebugViews.h"
#include "OptionChecks.h"
#include "OptionValues.h"

namespace app {

using terrain::Error;
using terrain::Result;

namespace {

// Long options without a short one get a number beyond the characters.
enum LongOption {
    Scene = 256,
    ClipmapSize,
    ClipmapLevels,
    DetailLevels,
    Offscreen,
    Output,
    Frames,
    FlightFile,
    Record,
    Spacing,
    HeightScale,
    Channel,
    RawSize,
    RawSamples,
    MeasureError,
    Repeat,
    Pick,
    ProfileLine,
    LineOut,
    MarkerAt,
    Stats,
    DebugView,
    Overlay,
    ShowMeters,
    FreezeAt,
    NoSettings,
    Summary,
    Help,
    Version
};

const option longOptions[] = {
    {"heightmap", required_argument, nullptr, 'h'},
    {"texture", required_argument, nullptr, 't'},
    {"profile", required_argument, nullptr, 'p'},
    {"algorithm", required_argument, nullptr, 'a'},
    {"animation-time", required_argument, nullptr, 'A'},
    {"frame-time", required_argument, nullptr, 'F'},
    {"pixel-error", required_argument, nullptr, 'e'},
    {"triangle-count", required_argument, nullptr, 'r'},
    {"tile-size", required_argument, nullptr, 'g'},
    {"full-screen", no_argument, nullptr, 'f'},
    {"culling", no_argument, nullptr, 'c'},
    {"animate", no_argument, nullptr, 'v'},
    {"synchronize", no_argument, nullptr, 's'},
    {"clipmap-size", required_argument, nullptr, ClipmapSize},
    {"levels", required_argument, nullptr, ClipmapLevels},
    {"detail", required_argument, nullptr, DetailLevels},
    {"scene", required_argument, nullptr, Scene},
    {"offscreen", optional_argument, nullptr, Offscreen},
    {"output", required_argument, nullptr, Output},
    {"frames", required_argument, nullptr, Frames},
    {"flight", required_argument, nullptr, FlightFile},
    {"record", required_argument, nullptr, Record},
    {"spacing", required_argument, nullptr, Spacing},
    {"height-scale", required_argument, nullptr, HeightScale},
    {"channel", required_argument, nullptr, Channel},
    {"raw-size", required_argument, nullptr, RawSize},
    {"raw-type", required_argument, nullptr, RawSamples},
    {"measure-error", required_argument, nullptr, MeasureError},
    {"repeat", required_argument, nullptr, Repeat},
    {"pick", required_argument, nullptr, Pick},
    {"profile-line", required_argument, nullptr, ProfileLine},
    {"line-out", required_argument, nullptr, LineOut},
    {"marker", required_argument, nullptr, MarkerAt},
    {"stats", no_argument, nullptr, Stats},
    {"debug-view", required_argument, nullptr, DebugView},
    {"overlay", no_argument, nullptr, Overlay},
    {"meters", no_argument, nullptr, ShowMeters},
    {"freeze-at", required_argument, nullptr, FreezeAt},
    {"no-settings", no_argument, nullptr, NoSettings},
    {"summary", required_argument, nullptr, Summary},
    {"help", no_argument, nullptr, Help},
    {"version", no_argument, nullptr, Version},
    {nullptr, 0, nullptr, 0},
};

std::string optionName(int code) {
    for (const option* known = longOptions; known->name; ++known) {
        if (known->val == code) return code < 256 ? std::string("-") + char(code) : std::string("--") + known->name;
    }
    return std::string("-") + char(code);
}

// Collects what getopt finds; the first complaint is kept.
class Reader {
public:
    void take(int code, const char* value);
    /// A file without an option before it.
    void takeTerrain(const std::string& file);
    void refuse(const std::string& subject, const std::string& expected, const std::string& found) {
        if (!problem) problem = Error{subject, expected, found};
    }

    Options options;
    std::optional<Error> problem;

private:
    void takeFlag(int code);
    void takeFile(int code, const char* value);
    void takeNumber(int code, const char* value);
    void takeAlgorithm(const char* value);
    void takeDebugView(const char* value);
    void takeSpacing(const char* value);
    void takeSize(int code, const char* value);
    void takeRawType(const char* value);
    void takePlaces(int code, const char* value);
    void number(int code, const char* value, double lowest, bool exclusive, std::optional<double>& target);
    void whole(int code, const char* value, int lowest, std::optional<int>& target);
};

void Reader::take(int code, const char* value) {
    switch (code) {
    case 'h':
    case 't':
    case 'p':
    case Scene:
    case Output:
    case FlightFile:
    case Record:
    case Summary:
    case LineOut:
        takeFile(code, value);
        break;
    case 'A':
    case 'F':
    case 'e':
    case 'r':
    case 'g':
    case FreezeAt:
    case ClipmapSize:
    case ClipmapLevels:
    case DetailLevels:
    case Frames:
    case HeightScale:
    case Channel:
    case MeasureError:
    case Repeat:
        takeNumber(code, value);
        break;
    case Offscreen:
    case RawSize:
        takeSize(code, value);
        break;
    case DebugView:
        takeDebugView(value);
        break;
    case Spacing:
        takeSpacing(value);
        break;
    case RawSamples:
        takeRawType(value);
        break;
    case Pick:
    case ProfileLine:
    case MarkerAt:
        takePlaces(code, value);
        break;
    case 'a':
        takeAlgorithm(value);
        break;
    default:
        takeFlag(code);
        break;
    }
}

void Reader::takeTerrain(const std::string& file) {
    if (options.namesTerrain()) return refuse("command line", "one terrain", "\"" + file + "\" besides");
    (file.ends_with(".iv") ? options.scene : options.heightMap) = file;
}

void Reader::takeFlag(int code) {
    switch (code) {
    case 'f':
        options.fullScreen = true;
        break;
    case 'c':
        options.frustumCulling = true;
        break;
    case 'v':
        options.animate = true;
        break;
    case 's':
        options.synchronize = true;
        break;
    case Stats:
        options.stats = true;
        break;
    case ShowMeters:
        options.meters = true;
        break;
    case Overlay:
        options.overlay = true;
        break;
    case NoSettings:
        options.noSettings = true;
        break;
    case Help:
        options.help = true;
        break;
    case Version:
        options.version = true;
        break;
    default:
        break;
    }
}

void Reader::takeFile(int code, const char* value) {
    if (!*value) return refuse(optionName(code), "a file name", "nothing");
    switch (code) {
    case 'h':
        options.heightMap = value;
        break;
    case 't':
        options.texture = value;
        break;
    case 'p':
        options.profile = value;
        break;
    case Scene:
        options.scene = value;
        break;
    case FlightFile:
        options.flight = value;
        break;
    case Record:
        options.record = value;
        break;
    case Summary:
        options.summary = value;
        break;
    case LineOut:
        options.lineOut = value;
        break;
    default:
        options.output = value;
        break;
    }
}

void Reader::takeNumber(int code, const char* value) {
    switch (code) {
    case 'A':
        number(code, value, 0.0, true, options.animationTime);
        break;
    case 'F':
        number(code, value, 0.0, true, options.frameTime);
        break;
    case 'e':
        number(code, value, 0.0, false, options.pixelError);
        break;
    case HeightScale:
        number(code, value, 0.0, true, options.heightScale);
        break;
    case FreezeAt:
        number(code, value, 0.0, false, options.freezeAt);
        break;
    case 'r':
        whole(code, value, 0, options.triangleCount);
        break;
    case 'g':
        whole(code, value, 2, options.tileSize);
        break;
    case Channel:
        whole(code, value, 0, options.channel);
        break;
    case ClipmapSize:
        whole(code, value, 0, options.clipmapSize);
        break;
    case ClipmapLevels:
        whole(code, value, 0, options.clipmapLevels);
        break;
    case DetailLevels:
        whole(code, value, 0, options.detailLevels);
        break;
    case Frames:
        whole(code, value, 1, options.frames);
        break;
    case Repeat:
        whole(code, value, 1, options.repeat);
        break;
    default:
        whole(code, value, 1, options.measureError);
        break;
    }
}

void Reader::number(int code, const char* value, double lowest, bool exclusive, std::optional<double>& target) {
    target = readNumber<double>(value);
    if (target && (exclusive ? *target > lowest : *target >= lowest)) return;
    refuse(optionName(code), exclusive ? "a number above 0" : "a number of at least 0", std::string("\"") + value + "\"");
}

void Reader::whole(int code, const char* value, int lowest, std::optional<int>& target) {
    target = readNumber<int>(value);
    if (target && *target >= lowest) return;
    refuse(optionName(code), "a whole number of at least " + std::to_string(lowest), std::string("\"") + value + "\"");
}

void Reader::takeAlgorithm(const char* value) {
    options.algorithm = findAlgorithm(value);
    if (!options.algorithm) refuse("-a", "one of " + algorithmNames(), std::string("\"") + value + "\"");
}

void Reader::takeDebugView(const char* value) {
    options.debugPicture = findDebugPicture(value);
    if (options.debugPicture) return;
    std::string known;
    for (const DebugPicture& picture : debugPictures()) known += (known.empty() ? "" : ", ") + std::string(picture.name);
    refuse("--debug-view", "one of " + known, std::string("\"") + value + "\"");
}

void Reader::takeSpacing(const char* value) {
    options.spacing = readPair(value, ',');
    if (options.spacing && options.spacing->x > 0.0 && options.spacing->y > 0.0) return;
    refuse("--spacing", "X or X,Y above 0", std::string("\"") + value + "\"");
}

void Reader::takeSize(int code, const char* value) {
    if (code == RawSize) {
        options.rawSize = readSize(value, 2, std::numeric_limits<int>::max());
        if (!options.rawSize) refuse("--raw-size", "COLUMNSxROWS of at least 2x2", std::string("\"") + value + "\"");
        return;
    }
    options.offscreen = value ? readSize(value, 1, 32767) : glm::ivec2(1024, 768);
    if (!options.offscreen) refuse("--offscreen", "WIDTHxHEIGHT in pixels", std::string("\"") + value + "\"");
}

void Reader::takeRawType(const char* value) {
    options.rawType = findRawType(value);
    if (options.rawType) return;
    refuse("--raw-type", "one of " + rawTypeNames(), std::string("\"") + value + "\"");
}

void Reader::takePlaces(int code, const char* value) {
    const std::string found = std::string("\"") + value + "\"";
    if (code == MarkerAt) {
        const auto marker = readMarker(value);
        if (!marker) return refuse("--marker", "X,Y or X,Y,NAME", found);
        options.markers.push_back(*marker);
        return;
    }
    const auto places = readPlaces(value);
    if (code == Pick) {
        if (!places || places->size() != 1) return refuse("--pick", "X,Y", found);
        options.picks.push_back(places->front());
        return;
    }
    if (!places || places->size() < 2) return refuse("--profile-line", "X0,Y0,X1,Y1 and more pairs", found);
    options.profileLine = *places;
}

// What getopt found wrong at its current place.
void refuseOption(Reader& reader, int code, char* const argv[]) {
    const std::string word = optind > 0 ? argv[optind - 1] : "";
    if (code == ':')
        reader.refuse(optopt < 256 ? std::string("-") + char(optopt) : word, "a value", "the end of the line");
    else if (optopt == 0)
        reader.refuse(word, "a known option", "an unknown or ambiguous one");
    else if (optopt >= 256 || word.starts_with("--"))
        reader.refuse(word, "no value", "one");
    else
        reader.refuse(std::string("-") + char(optopt), "a known option", "an unknown one");
}

}  // namespace

Error missingTerrain() {
    return {"terrain", "-h heightmap or --scene file.iv", "neither"};
}

Result<Options> parseOptions(int argc, char* const argv[]) {
    Reader reader;
    optind = 0;  // 0 makes glibc start afresh, also within one process
    opterr = 0;
    std::vector<std::string> files;  // without an option before them
    while (!reader.problem) {
        const int code = getopt_long(argc, argv, "+:h:t:p:a:A:F:e:r:g:fcvs", longOptions, nullptr);
        if (code == '?' || code == ':')
            refuseOption(reader, code, argv);
        else if (code != -1)
            reader.take(code, optarg);
        else if (optind < argc)
            files.push_back(argv[optind++]);
        else
            break;
    }
    for (const std::string& file : files) reader.takeTerrain(file);
    if (!reader.problem && !reader.options.help && !reader.options.version) reader.problem = checkCombination(reader.options);
    if (reader.problem) return *reader.problem;
    return reader.options;
}

std::string usage() {
    return "Usage: SoTerrainTest -h heightmap [-t texture] [-p profile_file] [-a algorithm] [-A animation_time]\n"
           "         [-F frame_time] [-e pixel_error] [-r triangle_count] [-g tile_size] [-f] [-c] [-v] [-s] [long options]\n"
           "       SoTerrainTest --scene file.iv [options]\n"
           "       SoTerrainTest heightmap|file.iv [options]\n"
           "       SoTerrainTest [window options]\n"
           "       SoTerrainTest --help | --version\n";
}

}  // namespace app
