// Programs of the debug views, and the heights that they compare with.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "base/View.h"
#include "gl/GlProgram.h"
#include "height/SampleGrid.h"

namespace terrain {

/// A corner of a triangle of its own. Positions go to GL as those of any mesh do, so that depth comes out the same.
struct DebugVertex {
    glm::vec3 position{0.0f};     ///< local coordinates
    std::uint8_t colour[4] = {};  ///< red, green, blue; behind it the corner, 0 to 2
    glm::vec3 base{0.0f};         ///< (column, row, height) of the triangle's first corner
    glm::vec3 offset{0.0f};       ///< from there: so that what is interpolated is small
    float shade = 1.0f;
};

/// Generic attributes of the programs.
enum class DebugAttribute : GLuint { Corner = 8, Base = 9, Offset = 10, Shade = 11 };

/// Errors in pixels, fragment by fragment: the vertical distance between the drawn surface and the full-resolution cell there, as
/// the screen shows it. A cell may be cut along either diagonal; what lies between the two surfaces is no error.
Result<GlProgram> buildErrorProgram();
/// Lines one pixel wide along the sides of triangles, in the colour of the vertices, drawn over them.
Result<GlProgram> buildEdgeProgram();

/// Sets what buildErrorProgram() takes. The program must be in use, the heights bound to `unit`.
void setErrorUniforms(GlProgram& program, const SampleGrid& grid, const View& view, float allowedPixels, int unit);

/// Heights of a regular grid as a texture of single floats. The owner deletes it by the name of release().
class HeightTexture {
public:
    /// Most samples that are sent: 256 MB.
    static constexpr std::size_t kMostSamples = std::size_t(1) << 26;

    /// Why this context can't hold the grid's heights, or nothing.
    static std::optional<Error> whyNot(const SampleGrid& grid);
    /// Binds it to GL_TEXTURE_2D of the active unit, after sending the heights if `version` is another than before.
    void bind(const SampleGrid& grid, std::uint64_t version);

    bool isThere() const { return name_ == 0 || glIsTexture(name_); }
    std::size_t bytes() const { return bytes_; }
    GLuint release() {
        bytes_ = 0;
        return std::exchange(name_, 0u);
    }

private:
    void send(const SampleGrid& grid);

    GLuint name_ = 0;
    std::uint64_t version_ = 0;
    std::size_t bytes_ = 0;
};

}  // namespace terrain
