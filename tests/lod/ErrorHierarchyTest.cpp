// The stored error of every diamond against a naive one: all samples, all triangles, in double.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "lod/BruteForceMesh.h"
#include "lod/ErrorHierarchy.h"

#include "Maps.h"
#include "Views.h"

using namespace terrain;
using namespace terrain::test;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// What computing in floats may lose, of heights of up to 60.
constexpr double kRounding = 2e-5;

long cross(glm::ivec2 a, glm::ivec2 b)
{
    return long(a.x) * b.y - long(a.y) * b.x;
}

class ErrorHierarchyOver : public testing::TestWithParam<Terrain> {
protected:
    const SampleGrid grid = GetParam().grid();
    const ErrorHierarchy errors{grid};

    double errorOf(const DiamondShape& d) const { return errors.error(grid, d); }

    /// Barycentric weights of p; none outside of the closed triangle.
    static std::optional<glm::dvec3> weights(const std::array<glm::ivec2, 3>& corner, glm::ivec2 p)
    {
        const double area = double(cross(corner[1] - corner[0], corner[2] - corner[0]));
        glm::dvec3 w(double(cross(corner[1] - p, corner[2] - p)), double(cross(corner[2] - p, corner[0] - p)), double(cross(corner[0] - p, corner[1] - p)));
        w /= area;
        if (std::min({w.x, w.y, w.z}) < 0.0) return std::nullopt;
        return w;
    }

    /// Quarters of cells that a triangle covers: how many are solid, how many are holes or out of the grid.
    std::pair<int, int> countQuarters(const std::array<glm::ivec2, 3>& corner) const
    {
        std::array<glm::ivec2, 3> scaled;
        for (std::size_t i = 0; i < 3; ++i) scaled[i] = corner[i] * 4;
        int solid = 0, missing = 0;
        const auto [left, right] = std::minmax({corner[0].x, corner[1].x, corner[2].x});
        const auto [bottom, top] = std::minmax({corner[0].y, corner[1].y, corner[2].y});
        for (int row = bottom; row < top; ++row)
            for (int column = left; column < right; ++column)
                for (const glm::ivec2 middle : {glm::ivec2(2, 1), glm::ivec2(3, 2), glm::ivec2(2, 3), glm::ivec2(1, 2)})
                    if (weights(scaled, glm::ivec2(column, row) * 4 + middle)) {
                        const bool inGrid = grid.contains(column, row) && grid.contains(column + 1, row + 1);
                        ++(inGrid && !isCellHole(grid, column, row) ? solid : missing);
                    }
        return {solid, missing};
    }

    double deviation(const std::array<glm::ivec2, 3>& corner) const
    {
        glm::dvec3 at[3];
        for (std::size_t i = 0; i < 3; ++i) at[i] = grid.framePosition(corner[i].x, corner[i].y);
        double worst = 0.0;
        const auto [left, right] = std::minmax({corner[0].x, corner[1].x, corner[2].x});
        const auto [bottom, top] = std::minmax({corner[0].y, corner[1].y, corner[2].y});
        for (int row = bottom; row <= top; ++row)
            for (int column = left; column <= right; ++column)
                if (const auto w = weights(corner, {column, row}))
                    worst = std::max(worst, glm::distance(glm::dvec3(grid.framePosition(column, row)), at[0] * w->x + at[1] * w->y + at[2] * w->z));
        return worst;
    }

    struct Expected {
        double low = 0.0;        ///< exact, and at least that of every child
        bool infinite = false;   ///< must be split, or a child must
        bool canBeInfinite = false;  ///< may be split always: some of it is not there
    };

    /// The naive reference, children first.
    const Expected& expected(const DiamondShape& d)
    {
        const auto key = std::pair(d.centre.x, d.centre.y);
        if (const auto found = known_.find(key); found != known_.end()) return found->second;
        Expected e;
        const int side = errors.side();
        for (int half = 0; half < 2; ++half) {
            const std::array<glm::ivec2, 3> corner{d.corner[half ? 2 : 0], d.corner[half ? 3 : 1], d.corner[half ? 0 : 2]};
            const glm::ivec2 apex = corner[1];
            if (apex.x < 0 || apex.y < 0 || apex.x > side || apex.y > side) continue;
            const auto [solid, missing] = countQuarters(corner);
            if (solid > 0 && missing > 0) e.infinite = true;
            if (missing > 0) e.canBeInfinite = true;
            if (solid > 0 && missing == 0) e.low = std::max(e.low, deviation(corner));
        }
        for (int i = 0; i < 4 && !d.isFinest(); ++i)
            if (const glm::ivec2 centre = d.child(i); grid.contains(centre.x, centre.y)) {
                const Expected& child = expected(DiamondShape(centre));
                e.low = std::max(e.low, child.low);
                e.infinite |= child.infinite;
                e.canBeInfinite |= child.canBeInfinite;
            }
        return known_[key] = e;
    }

    template <class Visit>
    void forEachDiamond(Visit visit)
    {
        const int side = errors.side();
        for (int row = 0; row < grid.rows(); ++row)
            for (int column = 0; column < grid.columns(); ++column)
                if (column % side != 0 || row % side != 0) visit(DiamondShape({column, row}));
    }

private:
    std::map<std::pair<int, int>, Expected> known_;
};

}  // namespace

TEST_P(ErrorHierarchyOver, IsTheLargestDeviationOfAnyCoveredSampleOrChild)
{
    forEachDiamond([this](const DiamondShape& d) {
        const Expected& e = expected(d);
        const double error = errorOf(d);
        const auto where = [&d] { return " at " + std::to_string(d.centre.x) + ", " + std::to_string(d.centre.y); };
        if (e.infinite) {
            EXPECT_EQ(error, kInfinity) << "partly there" << where();
        } else if (error == kInfinity) {
            EXPECT_TRUE(e.canBeInfinite) << "all of it is there" << where();
        } else {
            EXPECT_GE(error, e.low - kRounding) << where();
            EXPECT_LE(error, e.low * 1.004 + kRounding) << where();
        }
    });
}

TEST_P(ErrorHierarchyOver, IsAtLeastThatOfEveryChild)
{
    forEachDiamond([this](const DiamondShape& d) {
        for (int i = 0; i < 4 && !d.isFinest(); ++i)
            if (const glm::ivec2 centre = d.child(i); grid.contains(centre.x, centre.y)) {
                EXPECT_GE(errorOf(d), errorOf(DiamondShape(centre)));
            }
    });
}

TEST_P(ErrorHierarchyOver, SplitsWhateverBeyondTheGridReachesIntoIt)
{
    // Diamonds whose centres lie beyond the grid hold no error of their own, but their halves may cover some of it.
    const int side = errors.side();
    for (int row = 0; row <= side; ++row)
        for (int column = 0; column <= side; ++column) {
            if (grid.contains(column, row) || (column % side == 0 && row % side == 0)) continue;
            const DiamondShape d({column, row});
            const double error = errorOf(d);
            EXPECT_TRUE(error == 0.0 || error == kInfinity);
            for (int half = 0; half < 2; ++half) {
                const auto [solid, missing] = countQuarters({d.corner[half ? 2 : 0], d.corner[half ? 3 : 1], d.corner[half ? 0 : 2]});
                EXPECT_TRUE(solid == 0 || error == kInfinity) << column << ", " << row << ": " << solid << " of " << solid + missing;
            }
        }
}

TEST_P(ErrorHierarchyOver, KnowsItsSquareAndItsHoles)
{
    const int cells = std::max(grid.columns(), grid.rows()) - 1;
    EXPECT_GE(errors.side(), cells);
    EXPECT_LT(errors.side() / 2, cells);
    bool hasHoles = false;
    for (int row = 0; row < grid.rows(); ++row)
        for (int column = 0; column < grid.columns(); ++column) hasHoles |= grid.isHole(column, row);
    EXPECT_EQ(errors.hasHoles(), hasHoles);
    EXPECT_EQ(errors.isWhole(), !hasHoles && grid.columns() == errors.side() + 1 && grid.rows() == errors.side() + 1);
}

TEST(ErrorHierarchy, EncodingRoundsUpByLessThanHalfAPercent)
{
    std::mt19937 random(9);
    EXPECT_EQ(ErrorHierarchy::decode(ErrorHierarchy::encode(0.0f)), 0.0f);
    EXPECT_EQ(ErrorHierarchy::decode(ErrorHierarchy::encode(std::numeric_limits<float>::infinity())), std::numeric_limits<float>::infinity());
    for (int i = 0; i < 100000; ++i) {
        const float error = float(std::exp(uniform(random, -60.0, 60.0)));
        const float stored = ErrorHierarchy::decode(ErrorHierarchy::encode(error));
        ASSERT_GE(stored, error);
        ASSERT_LE(stored, error * 1.004f);
    }
}

TEST(ErrorHierarchy, CodesHaveTheOrderOfTheirErrors)
{
    for (unsigned code = 1; code <= ErrorHierarchy::encode(std::numeric_limits<float>::infinity()); ++code) {
        ASSERT_GT(ErrorHierarchy::decode(std::uint16_t(code)), ErrorHierarchy::decode(std::uint16_t(code - 1)));
        ASSERT_EQ(ErrorHierarchy::encode(ErrorHierarchy::decode(std::uint16_t(code))), code);
    }
}

TEST(ErrorHierarchy, TakesOneByteASample)
{
    EXPECT_LE(double(ErrorHierarchy(fractal(257, 257).grid()).bytes()), 1.01 * 257 * 257);
}

INSTANTIATE_TEST_SUITE_P(Terrains, ErrorHierarchyOver, testing::ValuesIn(smallTerrains()),
                         [](const testing::TestParamInfo<Terrain>& info) { return info.param.name; });
