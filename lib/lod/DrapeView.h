// What a view draws of draped lines so that ground with level of detail does not hide them.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "base/View.h"
#include "lod/DrapedLines.h"

namespace terrain {

struct DrapeSettings {
    float pixelError = 2.0f;        ///< how far the drawn ground may be from the true one, on screen
    float width = 1.0f;             ///< of lines, or size of points, in pixels
    float top = 0.0f;               ///< nothing drawn of the ground is higher, in units of the frame
    bool separateSegments = false;  ///< a strip for each segment, because their colours differ

    bool operator==(const DrapeSettings&) const = default;
};

/// Vertices of strips, in order.
struct DrapeSelection {
    struct Vertex {
        std::uint32_t vertex;  ///< of the DrapedLines
        std::uint32_t run;
    };
    std::vector<glm::vec3> positions;  ///< local coordinates
    std::vector<Vertex> vertices;
    std::vector<int> firsts;  ///< by strip, as glMultiDrawArrays has it
    std::vector<int> counts;
};

/// Chooses and places the vertices.
///
/// Ground with level of detail is off by up to `pixelError` pixels along the vertical. Raised by as much height as shows as that
/// many pixels, a line is above the drawn ground wherever it is above the true one: whatever hides it is raised by no more. It
/// needs no more than `top`. Straight down, where height shows as nothing, only `top` and the near plane bound it.
///
/// Vertices whose deviation shows as less than a fifth of a pixel are left out (Douglas and Peucker, 1973, on intervals that
/// are halved); so is all but the ends of what is outside of the view.
///
/// A line's pixels have the depth of its middle, while the ground on one side of it is nearer. So each vertex is brought towards
/// the viewer, along its ray, by as much as the ground comes nearer within half the width.
class DrapeView {
public:
    DrapeView(const DrapedLines& lines, const View& view, const glm::dmat4& localFromFrame, const DrapeSettings& settings);
    DrapeSelection select() const;
    /// Height that shows as the error allowed, over a place in the frame.
    double raise(const glm::dvec3& place) const;

private:
    void addRun(const DrapedLines::Run& run, std::uint32_t number, DrapeSelection& selection) const;
    void refine(std::uint32_t first, std::uint32_t last, std::uint32_t run, DrapeSelection& selection) const;
    void add(std::uint32_t vertex, std::uint32_t run, DrapeSelection& selection) const;
    double towardsViewer(const DrapedLines::Vertex& vertex, const glm::dvec4& clip) const;
    glm::dvec3 position(const glm::dvec3& place) const { return glm::dvec3(localFromFrame_ * glm::dvec4(place, 1.0)); }

    const DrapedLines& lines_;
    DrapeSettings settings_;
    ScreenSpace screen_;
    glm::dmat4 localFromFrame_, clipFromFrame_, frameFromClip_;
    glm::dmat4 rows_;  ///< of clipFromFrame_
    glm::dvec2 halfViewport_;
};

}  // namespace terrain
