#include "BenchRun.h"

#include <epoxy/gl.h>

#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <vector>

#include <Inventor/SbViewportRegion.h>
#include <Inventor/SoDB.h>
#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/elements/SoGLCacheContextElement.h>
#include <Inventor/fields/SoSFBool.h>
#include <Inventor/fields/SoSFFloat.h>
#include <Inventor/fields/SoSFInt32.h>
#include <Inventor/nodes/SoCoordinate3.h>
#include <Inventor/nodes/SoDirectionalLight.h>
#include <Inventor/nodes/SoIndexedFaceSet.h>
#include <Inventor/nodes/SoIndexedTriangleStripSet.h>
#include <Inventor/nodes/SoNormal.h>
#include <Inventor/nodes/SoNormalBinding.h>
#include <Inventor/nodes/SoPerspectiveCamera.h>
#include <Inventor/nodes/SoQuadMesh.h>
#include <Inventor/nodes/SoSeparator.h>
#include <Inventor/nodes/SoTexture2.h>
#include <Inventor/nodes/SoTextureCoordinate2.h>
#include <Inventor/sensors/SoSensorManager.h>
#include <SoTerrain/SoTerrainShape.h>
#include <nlohmann/json.hpp>

#include "Clock.h"
#include "Flight.h"
#include "MeasureError.h"
#include "NodePtr.h"
#include "Statistics.h"
#include "TerrainGrid.h"
#include "Texture.h"
#include "gl/HeadlessContext.h"

namespace app {

using nlohmann::ordered_json;
using terrain::Error;
using terrain::HeadlessContext;
using terrain::Result;

namespace {

constexpr int width = 1024;
constexpr int height = 768;

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

// The map with its rows in the order of the file.
Result<TerrainGrid> openTopFirst(const std::string& path) {
    auto source = terrain::openHeightFile(path, {});
    if (!source) return source.error();
    const terrain::HeightMap* resident = source.value()->map();
    if (!resident) return Error{path, "a map that fits into memory", "a larger one"};
    terrain::HeightMap map = *resident;
    for (int row = 0; row < map.rows / 2; ++row) {
        const auto first = map.heights.begin() + std::ptrdiff_t(row) * map.columns;
        std::swap_ranges(first, first + map.columns, map.heights.end() - std::ptrdiff_t(row + 1) * map.columns);
    }
    // The standard flight is over the unit square, whatever the file says about itself.
    map.spacing = {1.0, 1.0};
    map.projection.clear();
    auto mirrored = terrain::makeMapSource(std::move(map));
    if (!mirrored) return mirrored.error();
    return placeGrid(std::move(mirrored).value(), std::nullopt, std::nullopt);
}

class Bench {
public:
    explicit Bench(const BenchRequest& request) : request_(request), action_(SbViewportRegion(width, height)), flight_(circle()) {}

    std::optional<Error> prepare();
    double samples() const { return double(grid_.columns) * grid_.rows; }
    void warmUp();
    void measureStart(ordered_json& out);
    void measureFrames(ordered_json& out);
    void measureCpu(ordered_json& out);
    void setBackground(bool on);
    void buildTiles();
    void measureTriangles(ordered_json& out);
    std::optional<Error> measureError(ordered_json& out);

private:
    static Flight circle() { return standardFlight({}, 1.0); }
    std::optional<Error> addData();
    std::optional<Error> makeNode();
    double frame(int i);

    const BenchRequest& request_;
    std::unique_ptr<HeadlessContext> context_;
    SoGLRenderAction action_;
    Flight flight_;
    NodePtr<SoSeparator> root_;
    SoSeparator* group_ = nullptr;
    SoPerspectiveCamera* camera_ = nullptr;
    SoNormalBinding* binding_ = nullptr;
    NodePtr<SoNode> node_;
    TerrainGrid grid_;
};

std::optional<Error> Bench::prepare() {
    auto grid = openTopFirst(request_.map);
    if (!grid) return grid.error();
    grid_ = std::move(grid).value();
    if (double(grid_.columns) * grid_.rows > maxCoinSamples) return Error{request_.map, "at most 250 million samples", "more"};
    auto context = HeadlessContext::create(width, height);
    if (!context) return context.error();
    context_ = std::move(context).value();
    action_.setCacheContext(SoGLCacheContextElement::getUniqueCacheContext());
    glEnable(GL_DEPTH_TEST);
    glClearColor(0.45f, 0.6f, 0.85f, 1.0f);
    if (auto problem = addData()) return problem;
    return makeNode();
}

std::optional<Error> Bench::addData() {
    root_ = NodePtr(new SoSeparator);
    root_->renderCaching = SoSeparator::OFF;
    root_->addChild(group_ = new SoSeparator);
    camera_ = new SoPerspectiveCamera;
    camera_->heightAngle = std::numbers::pi_v<float> / 4.0f;
    camera_->aspectRatio = float(width) / float(height);
    camera_->nearDistance = 0.001f;
    camera_->farDistance = 3.0f;
    auto* light = new SoDirectionalLight;
    light->direction.setValue(0.5f, 0.5f, -1.0f);
    group_->addChild(camera_);
    group_->addChild(light);
    if (!request_.texture.empty()) {
        auto texture = loadTexture(request_.texture, true);
        if (!texture) return texture.error();
        group_->addChild(texture.value());
    }
    SoCoordinate3* coordinates = makeCoordinates(grid_);
    binding_ = new SoNormalBinding;
    binding_->value = SoNormalBinding::PER_VERTEX_INDEXED;
    group_->addChild(makeTextureCoordinates(grid_.columns, grid_.rows, grid_.spacing));
    group_->addChild(coordinates);
    group_->addChild(makeNormals(*coordinates, grid_.columns, grid_.rows));
    group_->addChild(binding_);
    return std::nullopt;
}

std::optional<Error> Bench::makeNode() {
    const std::string& name = request_.className;
    if (name == "SoIndexedFaceSet") {
        node_ = NodePtr<SoNode>(makeFaceSet(grid_));
    } else {
        const SoType type = SoType::fromName(name.c_str());
        if (!type.isDerivedFrom(SoNode::getClassTypeId()) || !type.canCreateInstance()) {
            return Error{name, "a node class of Coin or this build", "none of this name"};
        }
        node_ = NodePtr(static_cast<SoNode*>(type.createInstance()));
    }
    if (name == "SoQuadMesh") binding_->value = SoNormalBinding::PER_VERTEX;
    const auto set = [this](const char* field, int value) {
        if (auto* number = dynamic_cast<SoSFInt32*>(node_->getField(field))) number->setValue(value);
    };
    set("verticesPerRow", grid_.columns);
    set("verticesPerColumn", grid_.rows);
    if (auto* error = dynamic_cast<SoSFFloat*>(node_->getField("pixelError"))) error->setValue(float(request_.pixelError));
    return std::nullopt;
}

// Draws frame i of the flight; returns milliseconds until GL has finished.
double Bench::frame(int i) {
    const Pose pose = flight_.at(double(i) / request_.frames);
    const double start = nowMs();
    camera_->position = pose.position;
    camera_->orientation = pose.orientation;
    SoDB::getSensorManager()->processDelayQueue(TRUE);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    action_.apply(root_.get());
    glFinish();
    return nowMs() - start;
}

// Two triangles over the same state, so that the texture's upload and the driver's start are not the node's.
void Bench::warmUp() {
    auto* triangles = new SoIndexedTriangleStripSet;
    const int32_t corners[] = {0, grid_.columns - 1, grid_.columns * (grid_.rows - 1), SO_END_STRIP_INDEX};
    triangles->coordIndex.setValues(0, 4, corners);
    group_->addChild(triangles);
    frame(0);
    frame(0);
    group_->removeChild(triangles);
    group_->addChild(node_.get());
}

void Bench::measureStart(ordered_json& out) {
    const double before = residentBytes();
    const double first = frame(0), second = frame(0);
    out["start_ms"] = std::max(0.0, first - second);
    out["growth_bytes"] = std::max(0.0, residentBytes() - before);
}

ordered_json toJson(const std::vector<double>& values) {
    const Summary s = summarize(values);
    return {{"median", s.median}, {"p95", s.p95}, {"worst", s.worst}};
}

void Bench::measureFrames(ordered_json& out) {
    std::vector<double> ms;
    double bound = 0.0;
    int incomplete = 0;
    for (int i = 0; i < request_.frames; ++i) {
        ms.push_back(frame(i));
        if (!node_->isOfType(SoTerrainShape::getClassTypeId())) continue;
        const SoTerrainStatistics statistics = static_cast<SoTerrainShape*>(node_.get())->getStatistics();
        bound = std::max(bound, statistics.errorPixels);
        incomplete += statistics.converged ? 0 : 1;
        out["bound_px"] = bound;
        out["incomplete_frames"] = incomplete;
        out["memory_bytes"] = statistics.memoryBytes;
        out["buffer_bytes"] = statistics.bufferBytes;
    }
    out["frame_ms"] = toJson(ms);
}

// Whether tiles may be built while coarser ones stand in, or each frame is complete.
void Bench::setBackground(bool on) {
    if (auto* background = dynamic_cast<SoSFBool*>(node_->getField("background"))) background->setValue(on);
}

// Builds all tiles of the flight: frames with coarser ones in their place would be timed too well.
void Bench::buildTiles() {
    if (!node_->getField("background")) return;
    setBackground(false);
    for (int i = 0; i < request_.frames; ++i) frame(i);
    setBackground(true);
}

void Bench::measureCpu(ordered_json& out) {
    std::vector<double> ms;
    glEnable(GL_RASTERIZER_DISCARD);
    frame(0);
    for (int i = 0; i < request_.frames; ++i) {
        const double start = threadCpuMs();
        frame(i);
        ms.push_back(threadCpuMs() - start);
    }
    glDisable(GL_RASTERIZER_DISCARD);
    out["cpu_ms"] = toJson(ms);
}

void Bench::measureTriangles(ordered_json& out) {
    // GL counts a quad as one primitive.
    const double perPrimitive = node_->isOfType(SoQuadMesh::getClassTypeId()) ? 2.0 : 1.0;
    std::vector<double> triangles;
    GLuint query = 0;
    glGenQueries(1, &query);
    glEnable(GL_RASTERIZER_DISCARD);
    frame(0);
    for (int i = 0; i < request_.frames; ++i) {
        glBeginQuery(GL_PRIMITIVES_GENERATED, query);
        frame(i);
        glEndQuery(GL_PRIMITIVES_GENERATED);
        GLuint count = 0;
        glGetQueryObjectuiv(query, GL_QUERY_RESULT, &count);
        triangles.push_back(perPrimitive * count);
    }
    glDisable(GL_RASTERIZER_DISCARD);
    glDeleteQueries(1, &query);
    out["triangles"] = summarize(triangles).mean;
}

std::optional<Error> Bench::measureError(ordered_json& out) {
    ErrorMeter meter(grid_, group_, node_.get());
    ErrorSample all;
    frame(0);
    for (int i = 0; i < request_.frames; ++i) {
        frame(i);
        if (i % request_.errorEvery) continue;
        const auto sample = meter.measure([this, i] { frame(i); });
        if (!sample) return sample.error();
        all.merge(sample.value());
    }
    out["error_px"] = {{"rms", all.rms()}, {"p999", all.quantile(0.999)}, {"max", all.maximum()}};
    out["samples_in_view"] = all.samples() + all.missing;
    out["not_drawn"] = all.missing;
    return std::nullopt;
}

}  // namespace

Result<ordered_json> runBench(const BenchRequest& request) {
    Bench bench(request);
    if (auto problem = bench.prepare()) return *problem;
    ordered_json out;
    out["class"] = request.className;
    out["renderer"] = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    out["samples"] = bench.samples();
    bench.warmUp();
    bench.measureStart(out);
    bench.buildTiles();
    bench.measureFrames(out);
    bench.measureCpu(out);
    bench.setBackground(false);
    bench.measureTriangles(out);
    if (auto problem = bench.measureError(out)) return *problem;
    return out;
}

}  // namespace app
