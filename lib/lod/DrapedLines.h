// Polylines and points laid on the full-resolution surface.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "height/SampleGrid.h"

namespace terrain {

/// What to lay on the ground: places (column, row) in the frame of a regular grid, and how many of them make each polyline.
struct DrapeInput {
    std::vector<glm::dvec2> places;
    std::vector<int> counts;  ///< of places by polyline; they add up to at most all places
    bool lines = true;        ///< false: a point at each place
    bool closed = false;      ///< a segment from the last place of each polyline to its first
    float offset = 0.0f;      ///< height over the ground
};

/// Lines and points over a grid, as they lie on its surface: a vertex at every crossing of a segment with a grid line or with the
/// diagonal of a cell. Terrain nodes cut some cells along the one diagonal and some along the other: of the two surfaces the line
/// takes, in each cell, the one that is higher, so that no node's full detail hides it. Outside of the grid and in cells with a
/// hole there is nothing.
class DrapedLines {
public:
    struct Vertex {
        glm::vec3 position;  ///< in the frame of the grid
        glm::vec2 gradient;  ///< of the ground: height by column and by row
        float along;         ///< 0 at the segment's first place, 1 at its second
    };
    /// Part of one segment without a gap; straight when seen from above.
    struct Run {
        std::uint32_t first;  ///< vertex
        std::uint32_t count;  ///< at least 2; 1 for points
        int polyline;
        int segment;     ///< of the polyline; of points: the point
        int place;       ///< index of the segment's first place
        int nextPlace;   ///< and of its second
        bool continues;  ///< begins where the run before ends
    };

    DrapedLines() = default;
    /// The grid must be regular. It is not kept.
    DrapedLines(const SampleGrid& grid, const DrapeInput& input);

    const std::vector<Vertex>& vertices() const { return vertices_; }
    const std::vector<Run>& runs() const { return runs_; }
    /// Largest vertical deviation of the vertices between two of a run from the straight line through the two, by the vertex
    /// halfway between them: halfway(i, j) of the intervals that come from halving the run again and again.
    float deviation(std::uint32_t halfway) const { return deviations_[halfway]; }
    static std::uint32_t halfway(std::uint32_t first, std::uint32_t last) { return first + (last - first) / 2; }
    std::size_t bytes() const;

private:
    void addSegment(const SampleGrid& grid, const glm::dvec2& a, const glm::dvec2& b, Run run);
    void addPoint(const SampleGrid& grid, const glm::dvec2& place, int polyline, int index, int number);
    void measure(std::uint32_t first, std::uint32_t last);

    float offset_ = 0.0f;
    std::vector<Vertex> vertices_;
    std::vector<Run> runs_;
    std::vector<float> deviations_;
};

}  // namespace terrain
