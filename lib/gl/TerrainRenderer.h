// Draws any DrawList with plain vertex arrays under whatever GL state is current.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

#include "gl/GlObjects.h"
#include "height/SampleGrid.h"
#include "lod/DrawList.h"

namespace terrain {

/// What a vertex carries beside its position. Interleaved in this order: normal (three floats), colour (four
/// bytes), then for each texture unit two floats, or four (s, t, r, q).
struct VertexFormat {
    bool normals = false;
    bool colours = false;
    std::vector<int> textureUnits;  ///< those that get explicit coordinates
    std::vector<int> wideUnits;     ///< those among them that get four

    bool isWide(int unit) const { return std::find(wideUnits.begin(), wideUnits.end(), unit) != wideUnits.end(); }
    std::size_t stride() const {
        return (normals ? 12u : 0u) + (colours ? 4u : 0u) + (textureUnits.size() + wideUnits.size()) * 8u;
    }
    bool operator==(const VertexFormat&) const = default;
};

/// Writes what VertexFormat describes.
class VertexSource {
public:
    virtual ~VertexSource() = default;
    virtual const VertexFormat& format() const = 0;
    /// Changes whenever what write() gives may have changed for samples that were written before.
    virtual std::uint64_t version() const = 0;
    /// `out` has format().stride() bytes.
    virtual void write(std::uint32_t sample, std::uint8_t* out) const = 0;
    /// The same at a place between samples, (column, row) in the grid; `nearest` is the sample nearest to it, which serves where
    /// there is nothing better.
    virtual void writeAt(glm::vec2 /*place*/, std::uint32_t nearest, std::uint8_t* out) const { write(nearest, out); }
    /// The sample will soon be written.
    virtual void prefetch(std::uint32_t) const {}
};

/// The buffers of one view in one GL context. The vertices are the samples themselves, so lights, fog, clip planes, texture units
/// and the user's shader programs act on them as on any shape.
class TerrainRenderer {
public:
    /// Brings the buffers up to date with the list. Returns the bytes sent to GL. Attributes of vertices that are not new may be
    /// sent once more where that is faster, unless `onlyNew`.
    std::size_t upload(const DrawList& list, const SampleGrid& grid, const VertexSource& source, bool onlyNew = false);
    /// Of the bytes of the last upload, those that came with new vertices: their positions, and all attributes that were sent. The
    /// rest is positions of vertices that were there, and indices.
    std::size_t newVertexBytes() const { return newVertexBytes_; }
    /// One draw call, and another one for seams. Client array state is restored; the current colour and normal are undefined after
    /// it where the format has them.
    void draw() const;
    std::uint32_t triangles() const { return indexCount_ / 3; }
    /// Calls that draw() makes.
    std::uint32_t draws() const { return (indexCount_ > seamCount_ ? 1u : 0u) + (seamCount_ > 0 ? 1u : 0u); }
    std::size_t bufferBytes() const { return positions_.bytes() + attributes_.bytes() + indices_.bytes(); }
    std::size_t memoryBytes() const { return mirror_.capacity(); }
    /// Whether the current context has the buffers: not where another one has taken its id without notice.
    bool isThere() const { return positions_.current().isThere(); }
    /// Names of all buffers, which are the caller's to delete; forgets them.
    std::vector<GLuint> release();

private:
    void uploadSamples(const SampleGrid& grid, const VertexSource& source);
    void uploadRect(const SampleGrid& grid, const VertexSource& source, const SampleRect& rect);
    void write(const DrawList& list, const VertexSource& source, std::size_t vertex);
    void writeNew(const DrawList& list, const VertexSource& source);
    void uploadPool(const DrawList& list, const VertexSource& source, bool everything, bool onlyNew);
    std::size_t uploadNew(const DrawList& list, bool onlyNew);

    GlStream positions_, indices_;
    GlBuffer attributes_;
    VertexFormat format_;
    std::uint64_t version_ = 0;
    std::vector<std::uint8_t> mirror_;  ///< attributes of a pool of vertices
    std::uint32_t indexCount_ = 0, seamCount_ = 0;
    std::size_t uploaded_ = 0, newVertexBytes_ = 0;
};

}  // namespace terrain
