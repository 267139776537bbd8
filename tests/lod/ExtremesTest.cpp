// Maps and cameras whose numbers are at the ends of what floats hold. The fuzzer of tests/fuzz found what is held here.
#include <limits>

#include <gtest/gtest.h>

#include "lod/RoamMesh.h"

#include "Maps.h"
#include "MeshCheck.h"
#include "Views.h"

using namespace terrain;
using namespace terrain::test;

namespace {

/// A plain with two samples so far up and down that a float can't hold their distance.
Terrain farApart(int side) {
    constexpr float far = std::numeric_limits<float>::max();
    return {"FarApart",
            mapOf(side, side,
                  [=](int column, int row) {
                      if (row != side - 2) return 0.0f;
                      return column == 1 ? far : column == side - 2 ? -far : 0.0f;
                  }),
            {}};
}

/// Of the plain's near corner, without the two.
View cornerView() {
    const glm::dvec3 eye(-12.0, 4.0, 6.0), target(-7.0, 10.0, 0.0);
    const glm::dmat4 camera = glm::lookAt(eye, target, glm::dvec3(0.0, 0.0, 1.0));
    return {glm::perspective(0.8, 4.0 / 3.0, 0.1, 100.0) * camera, {640.0, 480.0}};
}

}  // namespace

TEST(RoamOfExtremes, DrawsWhatIsInViewOfHeightsThatSpanMoreThanAFloat) {
    const Terrain terrain = farApart(33);
    const SampleGrid grid = terrain.grid();
    RoamMesh mesh(terrain.model(), grid);
    LodSettings settings;
    settings.cull = true;
    const DrawList list = mesh.select(grid, cornerView(), settings);
    EXPECT_GT(list.report.triangles, 0u);
    EXPECT_EQ("", meshProblem(grid, list, cornerView(), false, false));
}

TEST(RoamOfExtremes, KeepsItsPromiseAfterACameraThatIsNoNumber) {
    const Terrain terrain = fractal(40, 23);
    const SampleGrid grid = terrain.grid();
    RoamMesh mesh(terrain.model(), grid);
    LodSettings settings;
    View broken = flightView(terrain.box(), 0, 40);
    broken.clipFromLocal[2][1] = std::numeric_limits<double>::quiet_NaN();
    broken.clipFromLocal[0][3] = std::numeric_limits<double>::infinity();
    for (int frame = 0; frame < 20; ++frame) {
        mesh.select(grid, broken, settings);
        const View view = flightView(terrain.box(), frame, 40);
        const DrawList list = mesh.select(grid, view, settings);
        ASSERT_EQ("", meshProblem(grid, list, view, false, false));
        ASSERT_LE(worstScreenError(grid, list, trianglesOf(grid, list), view), settings.pixelError + 0.03) << frame;
    }
}
