#include "BenchRun.h"

#include <epoxy/gl.h>

#include <time.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <vector>

#include <Inventor/nodes/SoQuadMesh.h>
#include <Inventor/nodes/SoSeparator.h>
#include <SoTerrain/SoTerrainShape.h>
#include <nlohmann/json.hpp>

#include "BenchScene.h"
#include "Clock.h"
#include "ImageFile.h"
#include "MeasureError.h"
#include "Statistics.h"

namespace app {

using nlohmann::ordered_json;
using terrain::Error;
using terrain::Result;

namespace {

double threadCpuMs() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return double(now.tv_sec) * 1e3 + double(now.tv_nsec) * 1e-6;
}

// Resident set of this process; 0 where the system does not tell.
double residentBytes() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with("VmRSS:")) return 1024.0 * std::atof(line.c_str() + 6);
    }
    return 0.0;
}

ordered_json summary(const std::vector<double>& values) {
    const Summary s = summarize(values);
    return {{"median", s.median}, {"p95", s.p95}, {"worst", s.worst}, {"frames", values.size()}};
}

// Half as many pixels a side, each the mean of four.
terrain::Image halved(const terrain::Image& image) {
    terrain::Image half{image.width / 2, image.height / 2, image.channels, {}};
    const std::size_t channels = std::size_t(image.channels), line = std::size_t(image.width) * channels;
    half.pixels.reserve(std::size_t(half.width) * std::size_t(half.height) * channels);
    for (std::size_t y = 0; y < std::size_t(half.height); ++y)
        for (std::size_t x = 0; x < std::size_t(half.width); ++x)
            for (std::size_t c = 0; c < channels; ++c) {
                const std::uint8_t* pixel = image.pixels.data() + 2 * y * line + 2 * x * channels + c;
                half.pixels.push_back(std::uint8_t((pixel[0] + pixel[channels] + pixel[line] + pixel[line + channels] + 2) / 4));
            }
    return half;
}

class Bench {
public:
    explicit Bench(const BenchRequest& request) : request_(request), scene_(request) {}

    std::optional<Error> run(ordered_json& out);

private:
    void describe(ordered_json& out) const;
    void measureStart(ordered_json& out);
    void settle();
    void buildTiles();
    void measureFrames(ordered_json& out);
    void measureCpu(ordered_json& out);
    void measureTriangles(ordered_json& out);
    std::optional<Error> measureError(ordered_json& out);
    std::optional<Error> takePictures();
    template <class Frame>
    void fly(const Frame& each) const;

    const BenchRequest& request_;
    BenchScene scene_;
    ordered_json series_;
};

std::optional<Error> Bench::run(ordered_json& out) {
    if (auto problem = scene_.prepare()) return problem;
    describe(out);
    scene_.warmUp();
    measureStart(out);
    settle();
    buildTiles();
    measureFrames(out);
    if (!request_.framesOnly) {
        measureCpu(out);
        scene_.setBackground(false);
        measureTriangles(out);
        if (request_.errorEvery > 0)
            if (auto problem = measureError(out)) return problem;
    }
    if (!request_.pictures.empty())
        if (auto problem = takePictures()) return problem;
    if (request_.series) out["series"] = std::move(series_);
    return std::nullopt;
}

// Goes through the frames of the flight, each(i), until the time is over.
template <class Frame>
void Bench::fly(const Frame& each) const {
    constexpr int least = 3;
    const double start = nowMs();
    for (int i = 0; i < request_.frames; ++i) {
        if (request_.seconds > 0.0 && i >= least && nowMs() - start > 1000.0 * request_.seconds) return;
        each(i);
    }
}

void Bench::describe(ordered_json& out) const {
    out["class"] = request_.className;
    out["fields"] = request_.fields;
    out["renderer"] = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    out["gl_version"] = reinterpret_cast<const char*>(glGetString(GL_VERSION));
    out["samples"] = double(scene_.grid().columns) * scene_.grid().rows;
    out["columns"] = scene_.grid().columns;
    out["rows"] = scene_.grid().rows;
}

void Bench::measureStart(ordered_json& out) {
    const double before = residentBytes();
    const double first = scene_.frame(0), second = scene_.frame(0);
    out["start_ms"] = std::max(0.0, first - second);
    out["growth_bytes"] = std::max(0.0, residentBytes() - before);
}

void Bench::measureFrames(ordered_json& out) {
    std::vector<double> ms, sent;
    double bound = 0.0;
    int incomplete = 0;
    fly([&](int i) {
        ms.push_back(scene_.frame(i));
        if (!scene_.node()->isOfType(SoTerrainShape::getClassTypeId())) return;
        const SoTerrainStatistics statistics = static_cast<SoTerrainShape*>(scene_.node())->getStatistics();
        bound = std::max(bound, statistics.errorPixels);
        incomplete += statistics.converged ? 0 : 1;
        out["bound_px"] = bound;
        out["incomplete_frames"] = incomplete;
        out["memory_bytes"] = statistics.memoryBytes;
        out["buffer_bytes"] = statistics.bufferBytes;
        if (i > 0) sent.push_back(double(statistics.uploadedBytes));
    });
    out["frame_ms"] = summary(ms);
    if (!sent.empty()) out["sent_bytes"] = summarize(sent).mean;
    series_["frame_ms"] = ms;
}

// Draws until the node has what other threads compute of the whole map, such as the errors of clipmaps.
void Bench::settle() {
    constexpr double patienceMs = 60000.0;
    if (!scene_.node()->isOfType(SoTerrainShape::getClassTypeId())) return;
    const double start = nowMs();
    const auto* shape = static_cast<SoTerrainShape*>(scene_.node());
    while (!shape->getStatistics().converged && nowMs() - start < patienceMs) scene_.frame(0);
}

// Builds all tiles of the flight: frames with coarser ones in their place would be timed too well.
void Bench::buildTiles() {
    if (!scene_.node()->getField("background")) return;
    scene_.setBackground(false);
    fly([this](int i) { scene_.frame(i); });
    scene_.setBackground(true);
}

void Bench::measureCpu(ordered_json& out) {
    std::vector<double> ms;
    glEnable(GL_RASTERIZER_DISCARD);
    scene_.frame(0);
    fly([&](int i) {
        const double start = threadCpuMs();
        scene_.frame(i);
        ms.push_back(threadCpuMs() - start);
    });
    glDisable(GL_RASTERIZER_DISCARD);
    out["cpu_ms"] = summary(ms);
    series_["cpu_ms"] = ms;
}

void Bench::measureTriangles(ordered_json& out) {
    // GL counts a quad as one primitive.
    const double perPrimitive = scene_.node()->isOfType(SoQuadMesh::getClassTypeId()) ? 2.0 : 1.0;
    std::vector<double> triangles;
    GLuint query = 0;
    glGenQueries(1, &query);
    glEnable(GL_RASTERIZER_DISCARD);
    scene_.frame(0);
    fly([&](int i) {
        glBeginQuery(GL_PRIMITIVES_GENERATED, query);
        scene_.frame(i);
        glEndQuery(GL_PRIMITIVES_GENERATED);
        GLuint count = 0;
        glGetQueryObjectuiv(query, GL_QUERY_RESULT, &count);
        triangles.push_back(perPrimitive * count);
    });
    glDisable(GL_RASTERIZER_DISCARD);
    glDeleteQueries(1, &query);
    out["triangles"] = summarize(triangles).mean;
    series_["triangles"] = triangles;
}

std::optional<Error> Bench::measureError(ordered_json& out) {
    ErrorMeter meter(scene_.grid(), scene_.group(), scene_.node());
    ErrorSample all;
    std::optional<Error> problem;
    ordered_json& largest = series_["error_px"] = ordered_json::array();
    scene_.frame(0);
    fly([&](int i) {
        if (problem) return;
        scene_.frame(i);
        if (i % request_.errorEvery) return;
        const auto sample = meter.measure([this, i] { scene_.frame(i); });
        if (!sample) {
            problem = sample.error();
            return;
        }
        all.merge(sample.value());
        largest.push_back({i, sample.value().maximum()});
    });
    if (problem) return problem;
    if (all.samples() + all.missing == 0)
        return Error{request_.flight.empty() ? request_.map : request_.flight, "a flight that sees the map", "no sample in view"};
    out["error_px"] = {{"rms", all.rms()}, {"p999", all.quantile(0.999)}, {"max", all.maximum()}};
    out["samples_in_view"] = all.samples() + all.missing;
    out["not_drawn"] = all.missing;
    return std::nullopt;
}

// Where a third of the flight is over; half the size, for pages.
std::optional<Error> Bench::takePictures() {
    constexpr int quality = 85;
    const int place = request_.frames / 3;
    const auto write = [this](const char* name) {
        return writeImage(request_.pictures + name, halved(scene_.context().readColor()), quality);
    };
    scene_.frame(place);
    scene_.frame(place);
    if (auto problem = write("shaded.jpg")) return problem;
    scene_.wireframe(place);
    return write("lines.jpg");
}

}  // namespace

ordered_json toJson(const BenchRequest& r) {
    ordered_json json = {{"class", r.className},        {"fields", r.fields},          {"map", r.map},
                         {"texture", r.texture},        {"flight", r.flight},          {"frames", r.frames},
                         {"pixel_error", r.pixelError}, {"error_every", r.errorEvery}, {"decimate", r.decimate},
                         {"seconds", r.seconds},        {"series", r.series},          {"pictures", r.pictures},
                         {"frames_only", r.framesOnly}};
    if (r.spacing) json["spacing"] = {r.spacing->x, r.spacing->y};
    if (r.heightScale) json["height_scale"] = *r.heightScale;
    return json;
}

BenchRequest benchRequest(const ordered_json& json) {
    BenchRequest r;
    r.className = json.at("class");
    r.fields = json.at("fields");
    r.map = json.at("map");
    r.texture = json.at("texture");
    r.flight = json.at("flight");
    r.frames = json.at("frames");
    r.pixelError = json.at("pixel_error");
    r.errorEvery = json.at("error_every");
    r.decimate = json.at("decimate");
    r.seconds = json.at("seconds");
    r.series = json.at("series");
    r.pictures = json.at("pictures");
    r.framesOnly = json.at("frames_only");
    if (json.contains("spacing")) r.spacing = {json["spacing"][0].get<double>(), json["spacing"][1].get<double>()};
    if (json.contains("height_scale")) r.heightScale = json["height_scale"].get<double>();
    return r;
}

Result<ordered_json> runBench(const BenchRequest& request) {
    Bench bench(request);
    ordered_json out;
    if (auto problem = bench.run(out)) return *problem;
    return out;
}

}  // namespace app
