// The algorithms of lib/lod over small maps of any kind, seen from anywhere: what they want drawn exists, and on ground and from
// cameras that are numbers of a common size it is whole and keeps its promise.
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "../lod/Maps.h"
#include "../lod/MeshCheck.h"
#include "../lod/Views.h"

#include "Input.h"
#include "height/HeightSource.h"
#include "lod/BruteForceMesh.h"
#include "lod/ChunkedLod.h"
#include "lod/ClipmapMesh.h"
#include "lod/DetailCast.h"
#include "lod/GeoMipmapMesh.h"
#include "lod/RayCast.h"
#include "lod/RoamMesh.h"

using namespace terrain;
using namespace terrain::test;

namespace {

enum Kind { BruteForce, Roam, GeoMipmap, Chunked, Clipmaps, kKinds };

/// What rounding positions to floats may add, in pixels.
constexpr double kRounding = 0.05;

struct Ground {
    Terrain terrain;
    bool isTame = true;  ///< every number of a size at which floats still tell neighbours apart
};

float heightOf(fuzz::Input& input, int kind, double column, double row, bool& tame) {
    switch (kind) {
    case 0:
        return float(5.0 * std::sin(0.3 * column) * std::cos(0.2 * row));
    case 1:
        return float(input.between(-20.0, 20.0));
    case 2:
        return input.between(0, 6) == 0 ? kHole : float(column - 0.5 * row);
    case 3:
        return input.between(0, 20) == 0 ? float(input.between(-300.0, 300.0)) : 0.0f;
    default: {
        const double number = input.number();
        if (!(std::abs(number) < 1e4) && std::isfinite(number)) tame = false;
        // Beyond what a float holds is a hole, as in files.
        return std::abs(number) <= 3.4e38 ? float(number) : kHole;
    }
    }
}

Ground groundOf(fuzz::Input& input) {
    const int columns = input.between(2, 40), rows = input.between(2, 40), kind = input.between(0, 4);
    const bool isCurved = input.between(0, 3) == 0;
    Ground ground{{"Fuzz", {columns, rows, {}, {}, {1.0, 1.0}, {}}, {}}, true};
    HeightMap& map = ground.terrain.map;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const float height = heightOf(input, kind, column, row, ground.isTame);
            if (!isCurved)
                map.heights.push_back(height);
            else
                ground.terrain.points.insert(ground.terrain.points.end(), {float(column + 0.3 * std::sin(0.7 * row)),
                                                                           float(row + 0.2 * std::cos(0.5 * column)), height});
        }
    if (input.between(0, 3) == 0) {
        map.spacing = {std::abs(input.finiteNumber()) + 1e-30, std::abs(input.finiteNumber()) + 1e-30};
        map.origin = {input.finiteNumber(), input.finiteNumber()};
        ground.isTame = false;
    }
    return ground;
}

/// A camera as scenes have them, or any sixteen numbers.
View viewOf(fuzz::Input& input, const Box& box, bool& tame) {
    std::mt19937 random(input.word());
    if (input.between(0, 4) > 0) return nextView(random, box, input.between(0, 40));
    tame = false;
    View view = randomView(random, box);
    for (int edits = input.between(1, 4); edits > 0; --edits)
        view.clipFromLocal[input.between(0, 3)][input.between(0, 3)] = input.number();
    if (input.flag()) view.viewportPixels = {input.finiteNumber(), input.finiteNumber()};
    return view;
}

LodSettings settingsOf(fuzz::Input& input) {
    std::mt19937 random(input.word());
    LodSettings settings = randomSettings(random);
    // The nodes let no other number through.
    if (input.between(0, 3) == 0) settings.pixelError = float(std::min(std::abs(input.finiteNumber()), 1e30));
    if (input.between(0, 3) == 0) settings.triangleBudget = input.word() >> input.between(0, 31);
    if (input.between(0, 3) == 0) settings.operationLimit = input.word() >> input.between(0, 31);
    if (input.between(0, 3) == 0) settings.memoryBudget = input.word() >> input.between(0, 31);
    if (input.between(0, 3) == 0) settings.uploadBudget = input.word() >> input.between(0, 31);
    settings.complete = true;
    return settings;
}

std::unique_ptr<LodAlgorithm> algorithmOf(fuzz::Input& input, Kind kind, const SampleGrid& grid, const TerrainModel& model) {
    switch (kind) {
    case BruteForce:
        return std::make_unique<BruteForceMesh>();
    case Roam:
        return std::make_unique<RoamMesh>(model, grid);
    case GeoMipmap:
        return std::make_unique<GeoMipmapMesh>(std::make_shared<GeoMipmapErrors>(grid, 2 << input.between(0, 6)));
    case Chunked:
        return std::make_unique<ChunkedLod>(model, grid, 8 << input.between(0, 4), nullptr);
    default:
        break;
    }
    ClipmapShape shape;
    shape.size = input.between(0, 3) == 0 ? 0 : ClipmapShape::validSize(8 << input.between(0, 3));
    shape.levels = input.flag() ? 0 : input.between(0, 31);
    shape.transitionWidth = input.flag() ? 0 : int(input.word() % (ClipmapShape::kLargest + 1));
    std::shared_ptr<const SynthesisedDetail> detail;
    if (grid.isRegular() && input.flag()) {
        const double amplitude = input.finiteNumber();
        const DetailShape made{input.between(1, 3), float(std::clamp(amplitude, -3.4e38, 3.4e38)), input.word()};
        detail = std::make_shared<SynthesisedDetail>(grid, made);
        if (detail->levels() == 0) detail.reset();
    }
    shape.detailLevels = detail ? detail->levels() : 0;
    ClipmapSettings settings;
    settings.activeLevels = input.flag() ? 0 : input.between(0, 64);
    settings.updateBudget = input.flag() ? 0 : int(input.word() >> input.between(2, 31));
    std::shared_ptr<const ClipmapErrors> errors;
    if (input.flag())
        errors = std::make_shared<ClipmapErrors>(grid, ClipmapLayout(grid.columns(), grid.rows(), {15, 0, 0, 0}).levels());
    return std::make_unique<ClipmapMesh>(
        grid.columns(), grid.rows(), shape, settings, model.boxes, [errors](const SampleGrid&) { return errors; }, detail);
}

/// Of any mesh, however wild the numbers.
void checkIndices(const SampleGrid& grid, const DrawList& list) {
    const std::size_t samples = std::size_t(grid.columns()) * std::size_t(grid.rows());
    const std::size_t vertices = list.wholeGrid ? samples : list.positions.size();
    fuzz::check(list.indices.size() % 3 == 0 && list.seamIndices <= list.indices.size(), "indices that are no triangles");
    fuzz::check(list.indices.empty() || list.indices.size() == 3 * std::size_t(list.report.triangles), "triangles are miscounted");
    fuzz::check(list.wholeGrid || list.samples.size() == vertices, "a vertex without a sample");
    fuzz::check(list.places.empty() || list.places.size() == vertices, "a vertex without a place");
    for (const std::uint32_t vertex : list.newVertices) fuzz::check(vertex < vertices, "a new vertex that does not exist");
    for (const std::uint32_t vertex : list.indices) {
        fuzz::check(vertex < vertices, "an index of no vertex");
        if (!list.wholeGrid) fuzz::check(list.samples[vertex] < samples, "a vertex of no sample");
    }
    fuzz::check(!(list.report.errorPixels < 0.0f) && !std::isnan(list.report.errorPixels), "an error that is no number");
}

/// Of what has diamonds or blocks over tame ground.
void checkShape(const SampleGrid& grid, const DrawList& list, const View& view, const LodSettings& settings, Kind kind,
                bool limited) {
    if (kind == Chunked || kind == Clipmaps || !list.indicesChanged) return;
    // A limit that stops refinement leaves holes covered, and says so by an infinite error.
    if (limited && !std::isfinite(list.report.errorPixels)) return;
    const std::vector<GridTriangle> triangles = trianglesOf(grid, list);
    std::string problem;
    if (list.wholeGrid)
        problem = overlapProblem(grid, triangles) + completenessProblem(grid, triangles);
    else
        problem = meshProblem(grid, list, view, settings.clockwise, !settings.cull);
    constexpr const char* kNames[] = {"brute force", "ROAM", "Geo Mip-Mapping", "Chunked LoD", "clipmap"};
    const auto fail = [&](const std::string& what) {
        fuzz::fail(std::string(kNames[kind]) + ", " + std::to_string(grid.columns()) + " x " + std::to_string(grid.rows()) +
                   (grid.isRegular() ? "" : " curved") + (settings.geomorph ? ", morphed: " : ": ") + what);
    };
    if (!problem.empty()) fail(problem);
    if (list.wholeGrid || !std::isfinite(list.report.errorPixels)) return;
    const double worst = worstScreenError(grid, list, triangles, view);
    if (worst > list.report.errorPixels * 1.001 + kRounding)
        fail("drawn " + std::to_string(worst) + " pixels off, " + std::to_string(list.report.errorPixels) + " promised");
    if (!limited && list.report.errorPixels > settings.pixelError * 1.0001f)
        fail("an error of " + std::to_string(list.report.errorPixels) + " pixels for one of " +
             std::to_string(settings.pixelError));
}

void checkRays(fuzz::Input& input, const SampleGrid& grid, const BoxPyramid& boxes) {
    const glm::dvec3 origin(input.number(), input.number(), input.number()),
        direction(input.number(), input.number(), input.number());
    for (const RayHit& hit : castRay(grid, boxes, origin, direction, -1e30, 1e30))
        fuzz::check(hit.column >= 0 && hit.row >= 0 && hit.column < grid.columns() - 1 && hit.row < grid.rows() - 1,
                    "a hit beyond the grid");
    if (grid.isRegular()) surfaceAt(grid, glm::dvec2(input.number(), input.number()));
}

}  // namespace

int LLVMFuzzerInitialize(int*, char***) {
    std::mt19937 random(7);
    for (int seed = 0; seed < 32; ++seed) {
        std::string bytes{char(seed)};
        for (int i = 0; i < 64 << seed % 5; ++i) bytes += char(random());
        fuzz::writeSeed("map" + std::to_string(seed), bytes);
    }
    return 0;
}

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::Input input(data, size);
    const Kind kind = Kind(input.byte() % kKinds);
    const std::uint8_t steps = input.byte() % 6;
    const Ground ground = groundOf(input);
    const SampleGrid grid = ground.terrain.grid();
    TerrainModel model{std::make_shared<BoxPyramid>(grid), nullptr, nullptr};
    if (kind == Roam) model.errors = std::make_shared<ErrorHierarchy>(grid);
    const auto algorithm = algorithmOf(input, kind, grid, model);
    const Box box = ground.isTame ? ground.terrain.box() : Box{glm::vec3(0.0f), glm::vec3(20.0f)};
    checkRays(input, grid, *model.boxes);
    for (int step = 0; step <= steps; ++step) {
        bool tame = ground.isTame;
        const View view = viewOf(input, box, tame);
        const LodSettings settings = settingsOf(input);
        const DrawList list = algorithm->select(grid, view, settings);
        checkIndices(grid, list);
        const bool limited = settings.triangleBudget != 0 || settings.operationLimit != 0;
        if (tame) checkShape(grid, list, view, settings, kind, limited && kind == Roam);
    }
    return 0;
}
