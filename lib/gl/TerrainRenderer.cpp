#include "gl/TerrainRenderer.h"

#include <algorithm>

#include "base/ProfileScope.h"
#include "gl/VertexRuns.h"

namespace terrain {

namespace {

const void* offset(std::size_t bytes) {
    return reinterpret_cast<const void*>(bytes);
}

}  // namespace

void TerrainRenderer::uploadSamples(const SampleGrid& grid, const VertexSource& source) {
    // In pieces, so that no second copy of the whole grid is ever in memory.
    constexpr std::size_t kPiece = 1u << 16;
    const std::size_t count = std::size_t(grid.columns()) * std::size_t(grid.rows()), stride = format_.stride();
    GlBuffer& positions = positions_.current();
    positions.fill(GL_ARRAY_BUFFER, nullptr, count * sizeof(glm::vec3), GL_STATIC_DRAW);
    if (stride > 0) attributes_.fill(GL_ARRAY_BUFFER, nullptr, count * stride, GL_STATIC_DRAW);
    std::vector<glm::vec3> points;
    std::vector<std::uint8_t> attributes;
    for (std::size_t first = 0; first < count; first += kPiece) {
        const std::size_t size = std::min(kPiece, count - first);
        points.resize(size);
        attributes.resize(size * stride);
        for (std::size_t i = 0; i < size; ++i) {
            const std::size_t sample = first + i;
            points[i] = grid.position(int(sample % std::size_t(grid.columns())), int(sample / std::size_t(grid.columns())));
            if (stride > 0) source.write(std::uint32_t(sample), attributes.data() + i * stride);
        }
        positions.update(GL_ARRAY_BUFFER, first * sizeof(glm::vec3), points.data(), size * sizeof(glm::vec3));
        if (stride > 0) attributes_.update(GL_ARRAY_BUFFER, first * stride, attributes.data(), size * stride);
    }
    uploaded_ += count * (sizeof(glm::vec3) + stride);
    newVertexBytes_ = uploaded_;
}

void TerrainRenderer::uploadRect(const SampleGrid& grid, const VertexSource& source, const SampleRect& rect) {
    const std::size_t count = std::size_t(rect.columns()), stride = format_.stride();
    std::vector<glm::vec3> points(count);
    std::vector<std::uint8_t> attributes(count * stride);
    for (int row = rect.low.y; row <= rect.high.y; ++row) {
        const std::size_t first = grid.index(rect.low.x, row);
        for (std::size_t i = 0; i < count; ++i) {
            points[i] = grid.position(rect.low.x + int(i), row);
            if (stride > 0) source.write(std::uint32_t(first + i), attributes.data() + i * stride);
        }
        positions_.current().update(GL_ARRAY_BUFFER, first * sizeof(glm::vec3), points.data(), count * sizeof(glm::vec3));
        if (stride > 0) attributes_.update(GL_ARRAY_BUFFER, first * stride, attributes.data(), attributes.size());
    }
    uploaded_ += std::size_t(rect.samples()) * (sizeof(glm::vec3) + stride);
}

void TerrainRenderer::write(const DrawList& list, const VertexSource& source, std::size_t vertex) {
    std::uint8_t* out = mirror_.data() + vertex * format_.stride();
    if (list.places.empty())
        source.write(list.samples[vertex], out);
    else
        source.writeAt(list.places[vertex], list.samples[vertex], out);
}

void TerrainRenderer::writeNew(const DrawList& list, const VertexSource& source) {
    // New vertices lie all over arrays that no cache holds.
    constexpr std::size_t kAhead = 8;
    const auto vertices = list.newVertices;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        if (i + kAhead < vertices.size()) source.prefetch(list.samples[vertices[i + kAhead]]);
        write(list, source, vertices[i]);
    }
}

/// A call takes as long as some ten thousand bytes do, so single vertices all over the pool are sent with what lies between them.
std::size_t TerrainRenderer::uploadNew(const DrawList& list, bool onlyNew) {
    constexpr std::size_t kFewRuns = 4;
    const std::size_t most = onlyNew ? list.newVertices.size() : kFewRuns;
    const std::size_t stride = format_.stride();
    std::size_t sent = 0;
    for (const VertexRun& run : vertexRuns(list.newVertices, list.samples.size(), most)) {
        const std::size_t first = run.first * stride, bytes = (run.end - run.first) * stride;
        attributes_.update(GL_ARRAY_BUFFER, first, mirror_.data() + first, bytes);
        sent += bytes;
    }
    return sent;
}

void TerrainRenderer::uploadPool(const DrawList& list, const VertexSource& source, bool everything, bool onlyNew) {
    if (list.positionsChanged || everything) {
        positions_.fill(GL_ARRAY_BUFFER, list.positions.data(), list.positions.size_bytes());
        uploaded_ += list.positions.size_bytes();
    }
    const std::size_t stride = format_.stride();
    newVertexBytes_ = (everything ? list.samples.size() : list.newVertices.size()) * sizeof(glm::vec3);
    if (stride == 0 || (list.newVertices.empty() && !everything)) return;
    const std::size_t size = list.samples.size() * stride;
    if (size > mirror_.capacity()) mirror_.reserve(size + size / 8);
    mirror_.resize(size);
    if (everything)
        for (std::size_t vertex = 0; vertex < list.samples.size(); ++vertex) write(list, source, vertex);
    else
        writeNew(list, source);
    std::size_t sent = mirror_.size();
    if (!everything && attributes_.grow(GL_STREAM_DRAW, mirror_.size()))
        sent = uploadNew(list, onlyNew);
    else
        attributes_.refill(GL_ARRAY_BUFFER, mirror_.data(), mirror_.size());
    uploaded_ += sent;
    newVertexBytes_ += sent;
}

std::size_t TerrainRenderer::upload(const DrawList& list, const SampleGrid& grid, const VertexSource& source, bool onlyNew) {
    const ProfileScope scope("renderer: upload");
    uploaded_ = newVertexBytes_ = 0;
    const bool everything = !positions_.current().exists() || format_ != source.format() || version_ != source.version();
    format_ = source.format();
    version_ = source.version();
    if (!list.wholeGrid)
        uploadPool(list, source, everything, onlyNew);
    else if (everything || list.positionsChanged)
        uploadSamples(grid, source);
    else
        for (const SampleRect& rect : list.changedSamples) uploadRect(grid, source, rect);
    if (list.indicesChanged) {
        if (list.wholeGrid)
            indices_.current().fill(GL_ELEMENT_ARRAY_BUFFER, list.indices.data(), list.indices.size_bytes(), GL_STATIC_DRAW);
        else
            indices_.fill(GL_ELEMENT_ARRAY_BUFFER, list.indices.data(), list.indices.size_bytes());
        indexCount_ = std::uint32_t(list.indices.size());
        seamCount_ = std::uint32_t(list.seamIndices);
        uploaded_ += list.indices.size_bytes();
    }
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
    return uploaded_;
}

void TerrainRenderer::draw() const {
    if (indexCount_ == 0) return;
    const ProfileScope scope("renderer: draw");
    glPushClientAttrib(GL_CLIENT_VERTEX_ARRAY_BIT);
    positions_.current().bind(GL_ARRAY_BUFFER);
    glEnableClientState(GL_VERTEX_ARRAY);
    glVertexPointer(3, GL_FLOAT, sizeof(glm::vec3), nullptr);
    const GLsizei stride = GLsizei(format_.stride());
    std::size_t at = 0;
    if (stride > 0) attributes_.bind(GL_ARRAY_BUFFER);
    if (format_.normals) {
        glEnableClientState(GL_NORMAL_ARRAY);
        glNormalPointer(GL_FLOAT, stride, offset(at));
        at += 12;
    }
    if (format_.colours) {
        glEnableClientState(GL_COLOR_ARRAY);
        glColorPointer(4, GL_UNSIGNED_BYTE, stride, offset(at));
        at += 4;
    }
    for (const int unit : format_.textureUnits) {
        glClientActiveTexture(GLenum(GL_TEXTURE0 + unit));
        glEnableClientState(GL_TEXTURE_COORD_ARRAY);
        const bool isWide = format_.isWide(unit);
        glTexCoordPointer(isWide ? 4 : 2, GL_FLOAT, stride, offset(at));
        at += isWide ? 16 : 8;
    }
    indices_.current().bind(GL_ELEMENT_ARRAY_BUFFER);
    const std::uint32_t faces = indexCount_ - seamCount_;
    if (faces > 0) glDrawElements(GL_TRIANGLES, GLsizei(faces), GL_UNSIGNED_INT, nullptr);
    if (seamCount_ > 0) {
        const GLboolean culls = glIsEnabled(GL_CULL_FACE);
        if (culls) glDisable(GL_CULL_FACE);
        glDrawElements(GL_TRIANGLES, GLsizei(seamCount_), GL_UNSIGNED_INT, offset(std::size_t(faces) * sizeof(std::uint32_t)));
        if (culls) glEnable(GL_CULL_FACE);
    }
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
    glPopClientAttrib();
}

std::vector<GLuint> TerrainRenderer::release() {
    std::vector<GLuint> names;
    const auto take = [&names](GlBuffer& buffer) {
        if (const GLuint name = buffer.release()) names.push_back(name);
    };
    for (GlBuffer& buffer : positions_.all()) take(buffer);
    for (GlBuffer& buffer : indices_.all()) take(buffer);
    take(attributes_);
    indexCount_ = seamCount_ = 0;
    return names;
}

}  // namespace terrain
