// Rays from the near rectangle of views that claim to see a terrain from above only.
#include "lod/UpperSide.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "lod/BruteForceMesh.h"
#include "lod/RayCast.h"

#include "Maps.h"
#include "Views.h"

using namespace terrain;
using namespace terrain::test;

namespace {

bool showsUpperSideOnly(const Terrain& terrain, const View& view)
{
    return terrain::showsUpperSideOnly(terrain.grid(), BoxPyramid(terrain.grid()), view);
}

/// Which side of the first triangle that a pixel's ray meets faces the eye: 1 the upper one, -1 the lower one, 0 none.
int sideSeenAt(const SampleGrid& grid, const BoxPyramid& boxes, const View& view, const glm::dvec2& ndc)
{
    const glm::dmat4 frameFromClip = glm::inverse(view.clipFromLocal * grid.localFromFrame());
    const glm::dvec4 a = frameFromClip * glm::dvec4(ndc, -1.0, 1.0), b = frameFromClip * glm::dvec4(ndc, 1.0, 1.0);
    const glm::dvec3 first = glm::dvec3(a) / a.w, last = glm::dvec3(b) / b.w;
    const std::vector<RayHit> hits = castRay(grid, boxes, first, last - first, 0.0, 1.0);
    if (hits.empty()) return 0;
    glm::dvec3 corner[3];
    for (int i = 0; i < 3; ++i)
        corner[i] = grid.framePosition(hits[0].column + kCellTriangles[hits[0].triangle][i][0],
                                       hits[0].row + kCellTriangles[hits[0].triangle][i][1]);
    glm::dvec3 up = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
    if (up.z < 0.0) up = -up;
    return glm::dot(up, last - first) < 0.0 ? 1 : -1;
}

/// A camera at `eye` that looks at `target`, both local.
View lookingFrom(const glm::dvec3& eye, const glm::dvec3& target)
{
    return {glm::perspective(0.8, 4.0 / 3.0, 0.05, 500.0) * glm::lookAt(eye, target, glm::dvec3(0.1, 0.0, 1.0)), {800.0, 600.0}};
}

}  // namespace

TEST(UpperSide, IsAllThatAnyRaySeesWhereItIsClaimed)
{
    std::mt19937 random(5);
    int claimed = 0, lower = 0;
    for (const Terrain& terrain : smallTerrains()) {
        const SampleGrid grid = terrain.grid();
        const BoxPyramid boxes(grid);
        for (int i = 0; i < 300; ++i) {
            const View view = randomView(random, terrain.box());
            const bool claim = terrain::showsUpperSideOnly(grid, boxes, view);
            claimed += claim;
            if (!grid.isRegular() || boxes.all().isEmpty()) {
                ASSERT_FALSE(claim) << terrain;
                continue;
            }
            for (int ray = 0; ray < 12; ++ray) {
                const int side = sideSeenAt(grid, boxes, view, {uniform(random, -1.0, 1.0), uniform(random, -1.0, 1.0)});
                lower += side < 0;
                ASSERT_TRUE(side >= 0 || !claim) << terrain << ", view " << i;
            }
        }
    }
    EXPECT_GT(claimed, 100);
    EXPECT_GT(lower, 100) << "the rays do not tell the sides apart";
}

TEST(UpperSide, IsClaimedFromAboveAndFromNowhereElse)
{
    const Terrain terrain = fractal(33, 33);
    const Box box = terrain.box();
    const glm::dvec3 above = glm::dvec3(box.centre) + glm::dvec3(0.0, 0.0, box.half.z + 2.0f);
    const glm::dvec3 ahead = above + glm::dvec3(10.0, 3.0, -4.0);
    EXPECT_TRUE(showsUpperSideOnly(terrain, lookingFrom(above, ahead)));
    const glm::dvec3 down(0.0, 0.0, -2.0 * box.half.z - 4.0);
    EXPECT_FALSE(showsUpperSideOnly(terrain, lookingFrom(above + down, ahead + down))) << "from below";
    const glm::dvec3 aside(2.0 * box.half.x, 0.0, 0.0);
    EXPECT_FALSE(showsUpperSideOnly(terrain, lookingFrom(above + aside, above))) << "from beside";
    View mirrored = lookingFrom(above, ahead);
    mirrored.clipFromLocal = glm::scale(glm::dmat4(1.0), glm::dvec3(-1.0, 1.0, 1.0)) * mirrored.clipFromLocal;
    EXPECT_FALSE(showsUpperSideOnly(terrain, mirrored)) << "in a mirror";
}

TEST(UpperSide, IsNotClaimedWhereOneSampleIsMissing)
{
    const Terrain terrain = withSingleHole(33), whole = {"Whole", fractalMap(33, 33, 2), {}};
    const Box box = whole.box();
    const glm::dvec3 eye = glm::dvec3(box.centre) + glm::dvec3(0.0, 0.0, box.half.z + 3.0f);
    const View view = lookingFrom(eye, eye + glm::dvec3(10.0, 0.0, -5.0));
    EXPECT_TRUE(showsUpperSideOnly(whole, view));
    EXPECT_FALSE(showsUpperSideOnly(terrain, view));
}
