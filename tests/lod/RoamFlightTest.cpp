// Cameras that move a little from frame to frame, the case for which work is put off until it may matter: nothing may show of that.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "lod/RoamMesh.h"

#include "Maps.h"
#include "MeshCheck.h"
#include "Views.h"

using namespace terrain;
using namespace terrain::test;

namespace {

constexpr double kRounding = 0.03;

/// A camera by position, heading and pitch, over a terrain.
struct Walker {
    Box box;
    glm::dvec3 eye;
    double heading = 0.5, pitch = -0.4;
    bool orthographic = false;

    explicit Walker(const Box& over) : box(over), eye(glm::dvec3(over.centre) + glm::dvec3(0.0, 0.0, over.half.z + 0.1 * reach())) {}

    double reach() const { return std::max(box.half.x, box.half.y); }
    View view() const
    {
        const glm::dvec3 ahead(std::cos(heading) * std::cos(pitch), std::sin(heading) * std::cos(pitch), std::sin(pitch));
        const glm::dmat4 camera = glm::lookAt(eye, eye + ahead, glm::dvec3(0.0, 0.0, 1.0));
        const double half = 0.5 * reach();
        const glm::dmat4 projection = orthographic ? glm::ortho(-half, half, -half, half, -6.0 * reach(), 6.0 * reach())
                                                   : glm::perspective(0.9, 4.0 / 3.0, 0.01 * reach(), 6.0 * reach());
        return {projection * camera, {1024.0, 768.0}};
    }
};

/// The ways in which people move: steadily, ever faster, by turning, with halts, with jerks, and all at once.
void step(Walker& walker, int motion, int frame)
{
    const double pace = 0.002 * walker.reach();
    const glm::dvec3 ahead(std::cos(walker.heading), std::sin(walker.heading), 0.0);
    switch (motion) {
    case 0: walker.eye += ahead * pace; break;
    case 1: walker.eye += ahead * (pace * 0.05 * frame); break;
    case 2: walker.heading += 0.004; break;
    case 3: walker.eye += frame % 20 < 10 ? glm::dvec3(0.0) : glm::dvec3(0.0, 0.0, frame % 40 < 20 ? pace : -pace); break;
    case 4:
        walker.eye += ahead * pace;
        if (frame % 25 == 24) walker.heading += 1.0;
        break;
    default:
        walker.heading += 0.01;
        walker.pitch = -0.4 + 0.3 * std::sin(0.05 * frame);
        walker.eye += ahead * (2.0 * pace);
    }
}

class RoamFlightOver : public testing::TestWithParam<Terrain> {
protected:
    const SampleGrid grid = GetParam().grid();
    const TerrainModel model = GetParam().model();
    const Box box = GetParam().box();
    const int every = grid.columns() * grid.rows() > 10000 ? 13 : 6;  ///< frames from check to check
};

}  // namespace

TEST_P(RoamFlightOver, KeepsShapeAndPromiseInEveryFrame)
{
    for (int motion = 0; motion < 6; ++motion) {
        RoamMesh mesh(model, grid);
        Walker walker(box);
        walker.orthographic = motion == 3;
        LodSettings settings;
        settings.pixelError = motion % 2 ? 1.0f : 3.0f;
        settings.geomorph = motion % 3 != 0;
        for (int frame = 0; frame < 70; ++frame) {
            step(walker, motion, frame);
            const View view = walker.view();
            const DrawList list = mesh.select(grid, view, settings);
            ASSERT_LE(list.report.errorPixels, settings.pixelError) << "motion " << motion << ", frame " << frame;
            if (frame % every != 0) continue;
            ASSERT_EQ("", meshProblem(grid, list, view, false, false)) << "motion " << motion << ", frame " << frame;
            ASSERT_LE(worstScreenError(grid, list, trianglesOf(grid, list), view), list.report.errorPixels + kRounding)
                << "motion " << motion << ", frame " << frame;
        }
    }
}

TEST_P(RoamFlightOver, KeepsItsBoundUnderLimits)
{
    for (int motion = 0; motion < 6; ++motion) {
        RoamMesh mesh(model, grid);
        Walker walker(box);
        LodSettings settings;
        settings.pixelError = 0.7f;
        settings.geomorph = motion % 2;
        for (int frame = 0; frame < 70; ++frame) {
            step(walker, motion, frame);
            settings.operationLimit = frame / 20 % 2 ? 60 : 0;
            settings.triangleBudget = frame / 35 % 2 ? 800 : 0;
            const View view = walker.view();
            const DrawList list = mesh.select(grid, view, settings);
            if (frame % every != 0 || !std::isfinite(list.report.errorPixels)) continue;
            ASSERT_EQ("", meshProblem(grid, list, view, false, false)) << "motion " << motion << ", frame " << frame;
            ASSERT_LE(worstScreenError(grid, list, trianglesOf(grid, list), view), list.report.errorPixels + kRounding)
                << "motion " << motion << ", frame " << frame;
        }
    }
}

TEST_P(RoamFlightOver, DoesNotPileUpTriangles)
{
    for (int motion = 0; motion < 6; ++motion) {
        RoamMesh mesh(model, grid);
        Walker walker(box);
        LodSettings settings;
        double travelled = 0.0, fresh = 0.0;
        for (int frame = 0; frame < 70; ++frame) {
            step(walker, motion, frame);
            const View view = walker.view();
            const std::uint32_t triangles = mesh.select(grid, view, settings).report.triangles;
            if (frame % 10 != 9) continue;
            travelled += triangles;
            fresh += RoamMesh(model, grid).select(grid, view, settings).report.triangles;
        }
        EXPECT_LE(travelled, fresh * 1.05 + 80.0) << "motion " << motion;
    }
}

TEST_P(RoamFlightOver, KeepsItsPromiseWhenWhatIsAskedForChangesOnTheWay)
{
    RoamMesh mesh(model, grid);
    Walker walker(box);
    for (int frame = 0; frame < 120; ++frame) {
        step(walker, 0, frame);
        LodSettings settings;
        settings.pixelError = frame / 20 % 2 ? 4.0f : 1.0f;
        settings.cull = frame / 35 % 2 == 0;
        settings.geomorph = frame / 15 % 2 == 0;
        settings.clockwise = frame / 50 % 2 == 1;
        View view = walker.view();
        // The window may be resized as well.
        if (frame / 40 % 2) view.viewportPixels *= 1.5;
        const DrawList list = mesh.select(grid, view, settings);
        if (frame % 7 > 0) continue;
        ASSERT_EQ("", meshProblem(grid, list, view, settings.clockwise, !settings.cull)) << "frame " << frame;
        ASSERT_LE(list.report.errorPixels, settings.pixelError) << "frame " << frame;
        ASSERT_LE(worstScreenError(grid, list, trianglesOf(grid, list), view), list.report.errorPixels + kRounding) << "frame " << frame;
    }
}

INSTANTIATE_TEST_SUITE_P(Terrains, RoamFlightOver, testing::ValuesIn(terrains()),
                         [](const testing::TestParamInfo<Terrain>& info) { return info.param.name; });
