// Draws a geometry clipmap by vertex textures, all levels in at most four draws.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include <glm/mat3x2.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include "gl/ClipmapShader.h"
#include "gl/ClipmapTextures.h"
#include "gl/GlObjects.h"
#include "gl/ProgramPool.h"
#include "gl/TextureClipmap.h"
#include "lod/Clipmap.h"

namespace terrain {

/// What one drawing of a clipmap needs beside its frame.
struct ClipmapDrawing {
    ClipmapShading shading;
    glm::dmat4 clipFromFrame{1.0};
    glm::dmat4 eyeFromFrame{1.0};
    glm::dmat3 eyeFromNormal{1.0};        ///< of unit normals in the frame's axes
    glm::mat3x2 textureFromSample{0.0f};  ///< texture coordinates of (column, row, 1), before the texture matrix
    bool clockwise = false;               ///< front faces are those drawn clockwise in the grid's (column, row) plane
    glm::vec4 colour{1.0f};               ///< of all: diffuse where there is light
    bool localViewer = false;
    /// Where shading.isMatt: what every pixel has, and for each light its direction in the frame's axes and its colour on the
    /// ground.
    glm::vec3 ambient{0.0f};
    std::vector<glm::vec3> lightDirections, lightColours;
    bool blendNormals = true;                 ///< into those of the coarser level, as heights
    const TextureClipmap* texture = nullptr;  ///< for TextureClipmapModulate
};

/// The GL side of one view of a clipmap, in one context. It takes OpenGL 3.3, or 3.0 with GL_ARB_instanced_arrays, in a
/// compatibility context: lights, material, texture, fog and clip planes are GL's own.
class ClipmapRenderer {
public:
    /// `programs`: those of the context.
    ClipmapRenderer(const ClipmapLayout& layout, bool memoryFree, std::shared_ptr<ProgramPool> programs);

    /// What is missing of GL in the current context for any of these; nothing where all is there.
    static std::optional<Error> whatIsMissing(const ClipmapLayout& layout);

    struct Drawn {
        std::size_t uploadedBytes = 0;
        std::size_t draws = 0;
        std::size_t triangles = 0;  ///< with those that the border of a patch or of the grid leaves without area
    };
    /// Brings the textures up to date with the frame and draws it. The state of GL is what it was. Error: what GL lacks.
    Result<Drawn> draw(const Clipmap::Frame& frame, const ClipmapTextures::Source& source, const ClipmapDrawing& drawing);
    const ClipmapTextures& textures() const { return textures_; }
    std::size_t bufferBytes() const { return textures_.bytes() + vertices_.bytes() + indices_.bytes() + patches_.bytes(); }
    /// Whether the current context has all this, as TerrainRenderer::isThere().
    bool isThere() const { return vertices_.isThere() && (textures_.heights() == 0 || glIsTexture(textures_.heights())); }
    /// All but programs, which stay in their pool.
    std::vector<GlName> release();

private:
    struct Mesh {
        std::size_t firstIndex = 0;
        GLsizei indices = 0;
    };

    void createMeshes();
    void setAttributes() const;
    void sendPatches(const Clipmap::Frame& frame);
    void setUniforms(GlProgram& program, const Clipmap::Frame& frame, const ClipmapDrawing& drawing);
    void drawLevels(int level, Drawn& drawn);

    ClipmapLayout layout_;
    bool memoryFree_;
    std::shared_ptr<ProgramPool> programs_;
    ClipmapTextures textures_;
    GlBuffer vertices_, indices_;
    GlStream patches_;
    std::array<Mesh, kFootprints> meshes_{};
    /// First instance of each footprint and level: those of level l are [l], up to [l + 1].
    std::array<std::vector<GLsizei>, kFootprints> firstPatch_;
};

}  // namespace terrain
