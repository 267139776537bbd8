// The levels of a geometry clipmap as textures: heights and normals.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <epoxy/gl.h>

#include "base/Result.h"
#include "gl/GlObjects.h"
#include "gl/GlProgram.h"
#include "gl/ProgramPool.h"
#include "height/SampleGrid.h"
#include "lod/ClipmapLayout.h"
#include "lod/ClipmapUpdates.h"
#include "lod/SynthesisedDetail.h"

namespace terrain {

/// Two texture arrays with a layer for each level (Asirvatham and Hoppe 2005, sect. 3.2 and 4). Vertex v of a level lies at texel
/// v mod (n + 1) of its layer, so that a level which moves writes only what is new.
///
/// `heights()`: (n + 1)^2 texels of two floats, the vertex's height and that of the coarser level's surface at the same place.
/// Levels of the samples are sent, 8 bytes a vertex; levels of detail are made on the GPU from the coarser layer. `normals()`: (2 n
/// + 2)^2 texels of four bytes, at the vertices and half-way between them: x and y of the unit normal, own and of the coarser
/// level, as (128 + 127 x) / 255. Made on the GPU. In the frame's axes, all as long as they are in local coordinates.
///
/// With `layers` 2 instead of one for each level, level l is in layer l mod 2: enough for what is drawn level after level, coarse
/// to fine, all made anew each time.
class ClipmapTextures {
public:
    static constexpr GLsizei kBytesPerSample = 8;

    ClipmapTextures(const ClipmapLayout& layout, bool memoryFree, std::shared_ptr<ProgramPool> programs)
        : layout_(layout), memoryFree_(memoryFree), programs_(std::move(programs)) {}

    /// What an update is made from.
    struct Source {
        const SampleGrid& grid;
        const SynthesisedDetail* detail;  ///< may be missing where the layout has no levels of detail
        glm::vec2 slopeScale;             ///< units of height over the distance of samples, in local lengths, by axis
        std::span<const ClipRect> valid;  ///< of each level, after the update
    };

    /// Stores the vertices of these rectangles, which must come from coarse to fine levels. Returns the bytes sent. GL's state is
    /// what it was. Error: GL lacks what it takes.
    Result<std::size_t> update(std::span<const ClipmapUpdates::Update> updates, const Source& source);

    /// Which layer a level is in.
    int layerOf(int level) const { return memoryFree_ ? level % 2 : level; }
    GLuint heights() const { return heights_; }
    GLuint normals() const { return normals_; }
    std::size_t bytes() const { return bytes_; }
    /// What to delete; forgets it. Programs stay in their pool.
    std::vector<GlName> release();

private:
    class PassScope;

    std::optional<Error> create();
    std::optional<Error> findPrograms();
    void makeNoise(const SynthesisedDetail& detail);
    void send(const ClipmapUpdates::Update& update, const SampleGrid& grid);
    void synthesise(const ClipmapUpdates::Update& update, const Source& source);
    void makeNormals(int level, const ClipRect& vertices, const Source& source);
    void draw(GLuint target, int pitch, const ClipRect& texels, GLuint array, int layer) const;

    ClipmapLayout layout_;
    bool memoryFree_;
    GLuint heights_ = 0, normals_ = 0;
    GLuint heightTarget_ = 0, normalTarget_ = 0, noise_ = 0;
    GlBuffer triangle_;
    std::shared_ptr<ProgramPool> programs_;
    GlProgram *detailProgram_ = nullptr, *normalProgram_ = nullptr;  ///< during an update
    float noiseAmplitude_ = 0.0f;
    std::size_t bytes_ = 0;
    std::vector<float> pairs_;
};

/// Keeps GL's bindings of a texture unit as they were.
class TextureUnitScope {
public:
    TextureUnitScope(int unit, GLenum target, GLuint texture);
    ~TextureUnitScope();
    TextureUnitScope(const TextureUnitScope&) = delete;
    TextureUnitScope& operator=(const TextureUnitScope&) = delete;

private:
    int unit_;
    GLenum target_;
    GLint before_ = 0, active_ = 0;
};

}  // namespace terrain
