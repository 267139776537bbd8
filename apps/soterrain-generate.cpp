// Makes a terrain: fractal heights, eroded, as a 16-bit image, and a colour texture that fits them.
#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include <getopt.h>

#include "EnlargedMap.h"
#include "HeightFileOutput.h"
#include "height/Erosion.h"
#include "height/FractalSource.h"

#ifdef HAVE_OPENIMAGEIO
#include <OpenImageIO/imageio.h>
#endif

#ifndef PACKAGE_VERSION
#define PACKAGE_VERSION "unknown"
#endif

namespace {

using terrain::Error;
using terrain::HeightMap;
using terrain::Result;

struct Settings {
    terrain::FractalParameters fractal;
    terrain::RiverParameters rivers;
    terrain::DropletParameters droplets;
    terrain::ThermalParameters thermal;
    std::string output;
    std::string texture;
    int textureSize = 1024;
    int enlarge = 1;
    int tile = 0;
};

const char usage[] = "Usage: soterrain-generate --output FILE.png [option]...\n"
                     "Makes a terrain from a fractal by erosion, and a colour texture for it.\n"
                     "\n"
                     "  --output FILE             heights, 16-bit grey, stretched to 0..65535\n"
                     "  --texture FILE            colours by height and slope\n"
                     "  --texture-size N          its columns and rows (1024)\n"
                     "  --size N                  columns and rows of the heights (1025)\n"
                     "  --enlarge K               writes K x K cells for each, with smaller relief in them (1); memory and time are\n"
                     "                            those of --size: 2049 by 8 makes 16385 x 16385 samples\n"
                     "  --tile N                  writes tiles of N x N, a multiple of 16, to a format that has them (0: lines)\n"
                     "  --seed N                  another number, another terrain (1)\n"
                     "  --roughness R             displacement from level to level, 0 to 1 (0.5)\n"
                     "  --filter-passes N         runs of the smoothing filter over the fractal (0)\n"
                     "  --filter-coefficient K    its strength, 0.6 strong to 0.9 weak (0.8)\n"
                     "  --relief H                height of the fractal, in cells (120)\n"
                     "  --rivers N                steps of river erosion (80)\n"
                     "  --uplift U                rise of the mountains in such a step, in cells (1)\n"
                     "  --creep D                 soil that creeps in such a step, in square cells; more makes valleys wider (4)\n"
                     "  --droplets N              droplets of rain (100000)\n"
                     "  --thermal N               steps of sliding slopes (10)\n"
                     "  --talus S                 steepest slope that stays, rise over run (0.8)\n"
                     "  --help, --version\n";

[[noreturn]] void failUsage(const std::string& message) {
    if (!message.empty()) std::fprintf(stderr, "soterrain-generate: %s\n", message.c_str());
    std::fputs(usage, stderr);
    std::exit(2);
}

double numberOf(const char* option, const char* text) {
    char* end = nullptr;
    const double value = std::strtod(text, &end);
    if (end == text || *end != '\0' || !std::isfinite(value))
        failUsage(std::string("--") + option + ": expected a number, found '" + text + "'");
    return value;
}

std::int64_t wholeOf(const char* option, const char* text, std::int64_t most) {
    const double value = numberOf(option, text);
    if (value < 0.0 || value > double(most) || value != std::floor(value))
        failUsage(std::string("--") + option + ": expected a whole number from 0 to " + std::to_string(most) + ", found '" + text +
                  "'");
    return std::int64_t(value);
}

/// An option with a value, and what it does.
struct Option {
    const char* name;
    std::function<void(const char*)> apply;
};

std::vector<Option> optionsFor(Settings& s) {
    const auto whole = [](const char* name, int& target) {
        return Option{name, [name, &target](const char* text) { target = int(wholeOf(name, text, 1000000000)); }};
    };
    const auto number = [](const char* name, double& target) {
        return Option{name, [name, &target](const char* text) { target = numberOf(name, text); }};
    };
    return {
        {"output", [&s](const char* text) { s.output = text; }},
        {"texture", [&s](const char* text) { s.texture = text; }},
        {"size", [&s](const char* text) { s.fractal.columns = s.fractal.rows = int(wholeOf("size", text, 32769)); }},
        {"seed", [&s](const char* text) { s.fractal.seed = s.droplets.seed = std::uint32_t(wholeOf("seed", text, 4294967295)); }},
        {"talus", [&s](const char* text) { s.thermal.talus = s.rivers.talus = numberOf("talus", text); }},
        whole("texture-size", s.textureSize),
        whole("enlarge", s.enlarge),
        whole("tile", s.tile),
        number("roughness", s.fractal.roughness),
        whole("filter-passes", s.fractal.filterPasses),
        number("filter-coefficient", s.fractal.filterCoefficient),
        number("relief", s.fractal.amplitude),
        whole("rivers", s.rivers.steps),
        number("uplift", s.rivers.uplift),
        number("creep", s.rivers.creep),
        whole("droplets", s.droplets.droplets),
        whole("thermal", s.thermal.iterations)};
}

Settings parse(int argc, char** argv) {
    Settings settings;
    settings.fractal.amplitude = 120.0;
    settings.rivers.steps = 80;
    settings.rivers.uplift = 1.0;
    settings.rivers.creep = 4.0;
    settings.droplets.droplets = 100000;
    settings.thermal.talus = settings.rivers.talus = 0.8;
    const std::vector<Option> options = optionsFor(settings);
    std::vector<option> table;
    for (const Option& each : options) table.push_back({each.name, required_argument, nullptr, 0});
    table.push_back({"help", no_argument, nullptr, 'h'});
    table.push_back({"version", no_argument, nullptr, 'v'});
    table.push_back({nullptr, 0, nullptr, 0});
    int index = 0;
    for (int found; (found = getopt_long(argc, argv, "", table.data(), &index)) != -1;) {
        if (found == 'h') {
            std::fputs(usage, stdout);
            std::exit(0);
        }
        if (found == 'v') {
            std::puts("soterrain-generate " PACKAGE_VERSION);
            std::exit(0);
        }
        if (found != 0) failUsage("");
        options[std::size_t(index)].apply(optarg);
    }
    if (optind < argc) failUsage(std::string("unexpected argument '") + argv[optind] + "'");
    if (settings.output.empty()) failUsage("--output is missing");
    if (settings.textureSize < 1 || settings.textureSize > 32768) failUsage("--texture-size: expected 1 to 32768");
    if (settings.enlarge < 1 || settings.enlarge > 64) failUsage("--enlarge: expected 1 to 64");
    if (settings.tile % 16 != 0 || settings.tile > 4096) failUsage("--tile: expected a multiple of 16 up to 4096, or 0");
    return settings;
}

/// Height between samples; (x, y) in samples, clamped to the map.
float sampleAt(const HeightMap& map, double x, double y) {
    x = std::clamp(x, 0.0, double(map.columns - 1));
    y = std::clamp(y, 0.0, double(map.rows - 1));
    const int column = std::min(int(x), map.columns - 2);
    const int row = std::min(int(y), map.rows - 2);
    const double u = x - column;
    const double v = y - row;
    return float((map.at(column, row) * (1 - u) + map.at(column + 1, row) * u) * (1 - v) +
                 (map.at(column, row + 1) * (1 - u) + map.at(column + 1, row + 1) * u) * v);
}

/// Every stride-th sample of a map.
HeightMap thinned(const HeightMap& map, int stride) {
    HeightMap thin;
    thin.columns = (map.columns - 2) / stride + 2;
    thin.rows = (map.rows - 2) / stride + 2;
    thin.spacing = map.spacing * double(stride);
    for (int row = 0; row < thin.rows; ++row)
        for (int column = 0; column < thin.columns; ++column) thin.heights.push_back(sampleAt(map, column * stride, row * stride));
    return thin;
}

double smoothStep(double low, double high, double value) {
    const double t = std::clamp((value - low) / (high - low), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

/// 0 along the border of the map, 1 inside: there rivers end on level ground, and no wall stands around the terrain.
double inside(const HeightMap& map, int column, int row) {
    const double x = 2.0 * column / (map.columns - 1) - 1.0;
    const double y = 2.0 * row / (map.rows - 1) - 1.0;
    return (1.0 - x * x) * (1.0 - y * y);
}

/// `value(height, column, row)` of every sample.
template <class Value>
HeightMap mapped(HeightMap map, Value value) {
    for (int row = 0; row < map.rows; ++row)
        for (int column = 0; column < map.columns; ++column) {
            float& height = map.heights[std::size_t(row) * std::size_t(map.columns) + std::size_t(column)];
            height = float(value(double(height), column, row));
        }
    return map;
}

/// Where mountains rise: the high parts of the coarse fractal.
HeightMap upliftOf(const HeightMap& fractal, double relief) {
    return mapped(fractal, [&](double height, int column, int row) {
        return 0.03 + 0.97 * smoothStep(0.2, 0.85, height / relief) * smoothStep(0.0, 0.4, inside(fractal, column, row));
    });
}

/// Doubles the resolution of `coarse` and adds a part of what the finer fractal has beyond the coarser one. The coarse map is bent
/// on the way by smooth noise: its rivers follow its few grid directions, those of nature do not.
Result<HeightMap> refined(const HeightMap& coarse, const HeightMap& coarseFractal, const HeightMap& fineFractal,
                          std::uint32_t seed) {
    terrain::FractalParameters bend;
    bend.columns = bend.rows = fineFractal.columns;
    bend.filterPasses = 2;
    bend.filterCoefficient = 0.6;
    bend.amplitude = 0.12 * coarse.columns;
    bend.seed = 2 * seed;
    const auto bendX = makeFractalMap(bend);
    bend.seed = 2 * seed + 1;
    const auto bendY = makeFractalMap(bend);
    if (!bendX || !bendY) return bendX ? bendY.error() : bendX.error();
    return mapped(fineFractal, [&](double height, int column, int row) {
        const double inner = smoothStep(0.0, 0.3, inside(fineFractal, column, row));
        const double x = 0.5 * column + inner * (bendX.value().at(column, row) - 0.5 * bend.amplitude);
        const double y = 0.5 * row + inner * (bendY.value().at(column, row) - 0.5 * bend.amplitude);
        return sampleAt(coarse, x, y) + 0.25 * inner * (height - sampleAt(coarseFractal, 0.5 * column, 0.5 * row));
    });
}

/// Rivers carve the terrain from a coarse grid to the finest: great valleys need many steps and few samples.
Result<HeightMap> carve(const HeightMap& fractal, const Settings& settings) {
    int stride = 1;
    while (stride < 8 && (fractal.columns - 1) / (2 * stride) >= 64) stride *= 2;
    HeightMap shape = thinned(fractal, stride);
    HeightMap map = mapped(shape, [&](double height, int column, int row) {
        return 0.4 * height * (0.3 + 0.7 * smoothStep(0.0, 0.5, inside(shape, column, row)));
    });
    terrain::RiverParameters rivers = settings.rivers;
    for (;; stride /= 2) {
        auto carved = erodeByRivers(std::move(map), upliftOf(shape, settings.fractal.amplitude), rivers);
        if (!carved || stride == 1) return carved;
        HeightMap finer = thinned(fractal, stride / 2);
        auto refinedMap = refined(carved.value(), shape, finer, settings.fractal.seed + std::uint32_t(stride));
        if (!refinedMap) return refinedMap;
        map = std::move(refinedMap).value();
        shape = std::move(finer);
        rivers.steps = (rivers.steps + 2) / 3;
        rivers.creep *= 0.5;
    }
}

Result<HeightMap> makeTerrain(const Settings& settings) {
    auto map = makeFractalMap(settings.fractal);
    if (map && settings.rivers.steps > 0) map = carve(map.value(), settings);
    if (map) map = erodeByDroplets(std::move(map).value(), settings.droplets);
    // The heaps that droplets leave in valleys are washed out again, and creep smooths what is left.
    if (map && settings.rivers.steps > 0) {
        terrain::RiverParameters rivers = settings.rivers;
        rivers.steps = 2;
        rivers.uplift = 0.0;
        rivers.creep *= 0.25;
        const HeightMap level = mapped(map.value(), [](double, int, int) { return 0.0; });
        map = erodeByRivers(std::move(map).value(), level, rivers);
    }
    if (map) map = erodeThermally(std::move(map).value(), settings.thermal);
    return map;
}

app::EnlargedMap enlarged(const HeightMap& map, const Settings& settings) {
    // What the fractal's next level of displacement would be.
    const terrain::FractalParameters& fractal = settings.fractal;
    const double relief = 0.5 * fractal.amplitude * std::pow(fractal.roughness, std::log2(double(map.columns)));
    return {map, settings.enlarge, relief, fractal.roughness, fractal.seed};
}

#ifdef HAVE_OPENIMAGEIO

using Color = std::array<double, 3>;

Color blend(const Color& a, const Color& b, double t) {
    return {a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t};
}

/// Height, slope and curvature of a place decide what grows there; `noise` in [0, 1] makes the borders ragged.
Color colorAt(double height, double slope, double hollow, double noise) {
    const Color sand{0.55, 0.52, 0.36}, grass{0.37, 0.43, 0.20}, forest{0.15, 0.25, 0.11}, meadow{0.45, 0.45, 0.25};
    const Color rock{0.42, 0.38, 0.34}, scree{0.52, 0.48, 0.43}, snow{0.95, 0.96, 0.98};
    const double h = height + 0.10 * (noise - 0.5);
    Color color = blend(sand, grass, smoothStep(-0.05, 0.06, h));
    color = blend(color, forest, smoothStep(0.08, 0.16, h) * smoothStep(0.25, 0.6, noise + 0.5 * hollow));
    color = blend(color, meadow, smoothStep(0.38, 0.52, h));
    color = blend(color, scree, smoothStep(0.48, 0.62, h));
    color = blend(color, rock, smoothStep(0.45, 0.75, slope + 0.2 * (noise - 0.5)) * smoothStep(0.1, 0.4, h));
    color = blend(color, snow, smoothStep(0.58, 0.72, h + 0.05 * hollow) * (1.0 - smoothStep(0.6, 0.95, slope)));
    const double light =
        (0.94 + 0.12 * noise) * (1.0 - 0.12 * smoothStep(0.2, 1.0, slope)) * (1.0 - 0.10 * std::clamp(hollow, -1.0, 1.0));
    return {color[0] * light, color[1] * light, color[2] * light};
}

std::vector<std::uint8_t> paint(const HeightMap& map, const HeightMap& noise, int size) {
    const auto [low, high] = std::minmax_element(map.heights.begin(), map.heights.end());
    const double range = std::max(double(*high) - *low, 1e-30);
    std::vector<std::uint8_t> pixels;
    pixels.reserve(std::size_t(size) * std::size_t(size) * 3);
    for (int row = size - 1; row >= 0; --row)
        for (int column = 0; column < size; ++column) {
            // Pixel centres: the texture spans the map from its first sample to its last.
            const double x = (column + 0.5) / size * (map.columns - 1);
            const double y = (row + 0.5) / size * (map.rows - 1);
            const double h = sampleAt(map, x, y);
            const double dx = 0.5 * (sampleAt(map, x + 1, y) - sampleAt(map, x - 1, y));
            const double dy = 0.5 * (sampleAt(map, x, y + 1) - sampleAt(map, x, y - 1));
            const double around =
                0.25 * (sampleAt(map, x + 4, y) + sampleAt(map, x - 4, y) + sampleAt(map, x, y + 4) + sampleAt(map, x, y - 4));
            const double speckle =
                sampleAt(noise, (column + 0.5) / size * (noise.columns - 1), (row + 0.5) / size * (noise.rows - 1));
            for (double part :
                 colorAt((h - *low) / range, std::sqrt(dx * dx + dy * dy), std::clamp(around - h, -1.0, 1.0), speckle))
                pixels.push_back(std::uint8_t(std::clamp(part, 0.0, 1.0) * 255.0 + 0.5));
        }
    return pixels;
}

/// Nothing when all went well.
std::string writeTexture(const std::string& path, int size, const std::vector<std::uint8_t>& pixels) {
    const auto output = OIIO::ImageOutput::create(path);
    if (!output) return path + ": " + OIIO::geterror();
    OIIO::ImageSpec spec(size, size, 3, OIIO::TypeDesc::UINT8);
    spec.attribute("compression", "jpeg:90");
    spec.attribute("png:compressionLevel", 9);
    if (!output->open(path, spec) || !output->write_image(OIIO::TypeDesc::UINT8, pixels.data()) || !output->close())
        return path + ": " + output->geterror();
    return {};
}

std::string write(const HeightMap& map, const Settings& settings) {
    const std::string problem = app::writeHeights(enlarged(map, settings), settings.output, settings.tile);
    if (!problem.empty() || settings.texture.empty()) return problem;
    terrain::FractalParameters speckle;
    speckle.seed = settings.fractal.seed + 1;
    speckle.roughness = 0.75;
    const auto noise = makeFractalMap(speckle);
    if (!noise) return noise.error().message();
    return writeTexture(settings.texture, settings.textureSize, paint(map, noise.value(), settings.textureSize));
}

#else

std::string write(const HeightMap& map, const Settings& settings) {
    const std::string path = settings.output.substr(0, settings.output.rfind(".png")) + ".raw";
    std::fprintf(stderr,
                 "soterrain-generate: built without OpenImageIO: %s gets 16-bit little-endian samples, and no texture is made\n",
                 path.c_str());
    return app::writeHeights(enlarged(map, settings), path, settings.tile);
}

#endif

}  // namespace

int main(int argc, char** argv) {
    const Settings settings = parse(argc, argv);
    const auto map = makeTerrain(settings);
    const std::string problem = map ? write(map.value(), settings) : map.error().message();
    if (problem.empty()) return 0;
    std::fprintf(stderr, "soterrain-generate: %s\n", problem.c_str());
    return 1;
}
