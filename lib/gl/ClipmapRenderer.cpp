#include "gl/ClipmapRenderer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "base/ProfileScope.h"

namespace terrain {

namespace {

struct Corner {
    GLshort x, y;
};

/// A patch as the vertex shader takes it.
struct Instance {
    GLint low[2], high[2];
    GLint level;
};

class MeshWriter {
public:
    std::vector<Corner> vertices;
    std::vector<GLuint> indices;

    void grid(int columns, int rows) {
        const GLuint first = GLuint(vertices.size()), pitch = GLuint(columns) + 1;
        for (int y = 0; y <= rows; ++y)
            for (int x = 0; x <= columns; ++x) vertices.push_back({GLshort(x), GLshort(y)});
        for (int y = 0; y < rows; ++y)
            for (int x = 0; x < columns; ++x) {
                const GLuint a = first + GLuint(y) * pitch + GLuint(x);
                indices.insert(indices.end(), {a, a + 1, a + pitch, a + 1, a + pitch + 1, a + pitch});
            }
    }
    /// Triangles without area between every second vertex of a side and the two around it, along both axes: on each, what runs
    /// along the other one is cut to a point.
    void seam(int cells) {
        for (const bool alongRow : {true, false}) {
            const GLuint first = GLuint(vertices.size());
            for (int i = 0; i <= cells; ++i) vertices.push_back(alongRow ? Corner{GLshort(i), 0} : Corner{0, GLshort(i)});
            for (GLuint i = 0; i + 2 <= GLuint(cells); i += 2)
                indices.insert(indices.end(), {first + i, first + i + 2, first + i + 1});
        }
    }
};

}  // namespace

ClipmapRenderer::ClipmapRenderer(const ClipmapLayout& layout, bool memoryFree, std::shared_ptr<ProgramPool> programs)
    : layout_(layout), memoryFree_(memoryFree), programs_(std::move(programs)), textures_(layout, memoryFree, programs_) {}

std::optional<Error> ClipmapRenderer::whatIsMissing(const ClipmapLayout& layout) {
    const int version = epoxy_gl_version();
    if (version < 30 || (version < 33 && !epoxy_has_gl_extension("GL_ARB_instanced_arrays")))
        return Error{"geometry clipmap on the GPU", "OpenGL 3.3, or 3.0 with GL_ARB_instanced_arrays",
                     "OpenGL " + std::to_string(version / 10) + "." + std::to_string(version % 10)};
    GLint units = 0;
    glGetIntegerv(GL_MAX_VERTEX_TEXTURE_IMAGE_UNITS, &units);
    if (units < 1) return Error{"geometry clipmap on the GPU", "textures in vertex shaders", "none"};
    if (layout.levels() > kClipmapShaderLevels)
        return Error{"geometry clipmap on the GPU", "at most " + std::to_string(kClipmapShaderLevels) + " levels",
                     std::to_string(layout.levels())};
    return std::nullopt;
}

void ClipmapRenderer::createMeshes() {
    if (vertices_.exists()) return;
    MeshWriter writer;
    const auto add = [&](Footprint footprint, const auto& write) {
        Mesh& mesh = meshes_[std::size_t(footprint)];
        mesh.firstIndex = writer.indices.size();
        write();
        mesh.indices = GLsizei(writer.indices.size() - mesh.firstIndex);
    };
    const int block = footprintCells(layout_), strip = 2 * layout_.blockSize();
    add(Footprint::Block, [&] { writer.grid(block, block); });
    add(Footprint::Column, [&] { writer.grid(2, strip); });
    add(Footprint::Row, [&] { writer.grid(strip, 2); });
    add(Footprint::Seam, [&] { writer.seam(layout_.size() - 1); });
    vertices_.fill(GL_ARRAY_BUFFER, writer.vertices.data(), writer.vertices.size() * sizeof(Corner), GL_STATIC_DRAW);
    indices_.fill(GL_ELEMENT_ARRAY_BUFFER, writer.indices.data(), writer.indices.size() * sizeof(GLuint), GL_STATIC_DRAW);
}

/// What the current vertex array has but for the patches, which drawLevels() sets.
void ClipmapRenderer::setAttributes() const {
    vertices_.bind(GL_ARRAY_BUFFER);
    indices_.bind(GL_ELEMENT_ARRAY_BUFFER);
    glEnableVertexAttribArray(kCornerAttribute);
    glVertexAttribIPointer(kCornerAttribute, 2, GL_SHORT, sizeof(Corner), nullptr);
    for (const GLuint attribute : {GLuint(kPatchAttribute), GLuint(kLevelAttribute)}) {
        glEnableVertexAttribArray(attribute);
        glVertexAttribDivisor(attribute, 1);
    }
}

/// All patches in one buffer, by footprint and within each from the finest level on: what is near hides what is far.
void ClipmapRenderer::sendPatches(const Clipmap::Frame& frame) {
    std::vector<Instance> instances;
    for (std::size_t footprint = 0; footprint < kFootprints; ++footprint) {
        const auto& patches = frame.patches.by[footprint];
        auto& first = firstPatch_[footprint];
        first.assign(std::size_t(layout_.levels()) + 1, GLsizei(instances.size()));
        std::size_t at = 0;
        for (int level = 0; level < layout_.levels(); ++level) {
            first[std::size_t(level)] = GLsizei(instances.size());
            for (; at < patches.size() && patches[at].level == level; ++at) {
                const ClipmapPatch& p = patches[at];
                instances.push_back({{p.low.x, p.low.y}, {p.high.x, p.high.y}, p.level});
            }
        }
        first.back() = GLsizei(instances.size());
    }
    patches_.fill(GL_ARRAY_BUFFER, instances.data(), instances.size() * sizeof(Instance));
}

void ClipmapRenderer::setUniforms(GlProgram& program, const Clipmap::Frame& frame, const ClipmapDrawing& drawing) {
    const int levels = layout_.levels();
    std::array<GLint, 2 * kClipmapShaderLevels> places{};
    std::array<GLint, 4 * kClipmapShaderLevels> borders{};
    std::array<GLfloat, 2 * kClipmapShaderLevels> viewers{};
    constexpr GLint kFar = 1 << 29;
    for (int level = 0; level < levels; ++level) {
        const std::size_t l = std::size_t(level);
        const ClipRect whole = layout_.place(level, frame.viewer), domain = layout_.domain(level);
        const ClipRect& active = frame.active[l];
        const glm::dvec2 viewer = layout_.viewerAt(level, frame.viewer) - glm::dvec2(whole.low);
        places[2 * l] = whole.low.x, places[2 * l + 1] = whole.low.y;
        viewers[2 * l] = float(viewer.x), viewers[2 * l + 1] = float(viewer.y);
        const bool isWhole = active == whole;
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const int a = int(axis);
            borders[4 * l + axis] = isWhole || active.low[a] <= domain.low[a] ? -kFar : active.low[a];
            borders[4 * l + 2 + axis] = isWhole || active.high[a] >= domain.high[a] ? kFar : active.high[a];
        }
    }
    glUniform2iv(program["places"], levels, places.data());
    glUniform4iv(program["borders"], levels, borders.data());
    glUniform2fv(program["viewers"], levels, viewers.data());
    glUniform1i(program["mask"], layout_.size());
    glUniform1i(program["layerMask"], memoryFree_ ? 1 : -1);
    glUniform1i(program["coarsest"], levels - 1);
    glUniform1i(program["blendedLevel"], frame.finest);
    glUniform1f(program["leastBlend"], frame.leastBlend);
    glUniform1f(program["transition"], float(layout_.transitionWidth()));
    glUniform1f(program["inner"], float(layout_.size() - 1) / 2.0f - float(layout_.transitionWidth()) - 1.0f);
    const glm::ivec2 last = layout_.lastUnit();
    glUniform2i(program["lastUnit"], last.x, last.y);
    glUniform1f(program["samplesPerUnit"], 1.0f / float(layout_.unitsPerSample()));
    // Places are floats on the GPU: those near to the viewer must be small.
    const glm::ivec2 base = glm::ivec2(glm::floor(frame.viewer));
    glUniform2i(program["baseUnit"], base.x, base.y);
    const glm::dmat4 fromBase =
        glm::translate(glm::dmat4(1.0), glm::dvec3(glm::dvec2(base) / double(layout_.unitsPerSample()), 0.0));
    const glm::mat4 clip(drawing.clipFromFrame * fromBase), eye(drawing.eyeFromFrame * fromBase);
    const glm::mat3 normal(drawing.eyeFromNormal);
    glUniformMatrix4fv(program["clipFromFrame"], 1, GL_FALSE, glm::value_ptr(clip));
    glUniformMatrix4fv(program["eyeFromFrame"], 1, GL_FALSE, glm::value_ptr(eye));
    glUniformMatrix3fv(program["eyeFromNormal"], 1, GL_FALSE, glm::value_ptr(normal));
    glUniformMatrix3x2fv(program["textureFromSample"], 1, GL_FALSE, glm::value_ptr(drawing.textureFromSample));
    glUniform4fv(program["colourOfAll"], 1, glm::value_ptr(drawing.colour));
    if (drawing.shading.isMatt) {
        const GLsizei lights = GLsizei(drawing.lightDirections.size());
        glUniform3fv(program["ambientOfAll"], 1, glm::value_ptr(drawing.ambient));
        if (lights > 0) {
            glUniform3fv(program["lightDirections"], lights, glm::value_ptr(drawing.lightDirections.front()));
            glUniform3fv(program["lightColours"], lights, glm::value_ptr(drawing.lightColours.front()));
        }
    }
    glUniform1i(program["localViewer"], drawing.localViewer);
    glUniform1f(program["normalBlend"], drawing.blendNormals ? 1.0f : 0.0f);
    glUniform1i(program["colourTexture"], 0);
}

/// One level, or all of them for -1.
void ClipmapRenderer::drawLevels(int level, Drawn& drawn) {
    patches_.current().bind(GL_ARRAY_BUFFER);
    for (std::size_t footprint = 0; footprint < kFootprints; ++footprint) {
        const auto& firstPatch = firstPatch_[footprint];
        const GLsizei first = level < 0 ? firstPatch.front() : firstPatch[std::size_t(level)];
        const GLsizei last = level < 0 ? firstPatch.back() : firstPatch[std::size_t(level) + 1];
        if (first == last) continue;
        const std::size_t at = std::size_t(first) * sizeof(Instance);
        glVertexAttribIPointer(kPatchAttribute, 4, GL_INT, sizeof(Instance), reinterpret_cast<const void*>(at));
        glVertexAttribIPointer(kLevelAttribute, 1, GL_INT, sizeof(Instance),
                               reinterpret_cast<const void*>(at + offsetof(Instance, level)));
        const Mesh& mesh = meshes_[footprint];
        // Which way a seam faces is up to rounding.
        const bool culls = Footprint(footprint) == Footprint::Seam && glIsEnabled(GL_CULL_FACE);
        if (culls) glDisable(GL_CULL_FACE);
        glDrawElementsInstanced(GL_TRIANGLES, mesh.indices, GL_UNSIGNED_INT,
                                reinterpret_cast<const void*>(mesh.firstIndex * sizeof(GLuint)), last - first);
        if (culls) glEnable(GL_CULL_FACE);
        ++drawn.draws;
        drawn.triangles += std::size_t(mesh.indices / 3) * std::size_t(last - first);
    }
}

Result<ClipmapRenderer::Drawn> ClipmapRenderer::draw(const Clipmap::Frame& frame, const ClipmapTextures::Source& source,
                                                     const ClipmapDrawing& drawing) {
    const ProfileScope scope("clipmap: draw");
    const auto found = programs_->find(nameOf(drawing.shading), [&] { return buildClipmapProgram(drawing.shading); });
    if (!found) return found.error();
    GlProgram& program = *found.value();
    Drawn result;
    const auto update = [&](std::span<const ClipmapUpdates::Update> updates) -> std::optional<Error> {
        const auto sent = textures_.update(updates, source);
        if (!sent) return sent.error();
        result.uploadedBytes += sent.value();
        return std::nullopt;
    };
    if (!memoryFree_)
        if (auto problem = update(frame.updates)) return *problem;

    GLint programBefore = 0, bufferBefore = 0, faceBefore = 0;
    glGetIntegerv(GL_CURRENT_PROGRAM, &programBefore);
    glGetIntegerv(GL_ARRAY_BUFFER_BINDING, &bufferBefore);
    glGetIntegerv(GL_FRONT_FACE, &faceBefore);
    // A binding of indices is part of the vertex array: none but this one's is touched.
    std::optional<VertexArrayScope> vertexArray(std::in_place);
    createMeshes();
    setAttributes();
    sendPatches(frame);
    if (drawing.clockwise) glFrontFace(faceBefore == GL_CCW ? GL_CW : GL_CCW);
    const int heightUnit = TextureClipmap::lastUnits() - 1, normalUnit = heightUnit - 1;
    const auto drawWith = [&](int level) {
        const TextureUnitScope heights(heightUnit, GL_TEXTURE_2D_ARRAY, textures_.heights());
        const TextureUnitScope normals(normalUnit, GL_TEXTURE_2D_ARRAY, textures_.normals());
        program.use();
        glUniform1i(program["heights"], heightUnit);
        glUniform1i(program["normals"], normalUnit);
        std::optional<TextureClipmap::Binding> colours;
        if (drawing.texture) colours.emplace(*drawing.texture, program.name(), TextureClipmap::lastUnits());
        setUniforms(program, frame, drawing);
        drawLevels(level, result);
        glUseProgram(GLuint(programBefore));
    };
    std::optional<Error> problem;
    if (!memoryFree_) {
        drawWith(-1);
    } else {
        for (int level = layout_.levels() - 1; level >= frame.finest && !problem; --level) {
            const ClipRect& valid = source.valid[std::size_t(level)];
            if (valid.isEmpty()) break;
            const ClipmapUpdates::Update whole{level, valid};
            problem = update({&whole, 1});
            if (!problem) drawWith(level);
        }
    }
    if (drawing.clockwise) glFrontFace(GLenum(faceBefore));
    vertexArray.reset();
    glBindBuffer(GL_ARRAY_BUFFER, GLuint(bufferBefore));
    if (problem) return *problem;
    return result;
}

std::vector<GlName> ClipmapRenderer::release() {
    std::vector<GlName> names = textures_.release();
    const auto take = [&names](GlBuffer& buffer) {
        if (const GLuint name = buffer.release()) names.push_back({GlName::Buffer, name});
    };
    take(vertices_);
    take(indices_);
    for (GlBuffer& buffer : patches_.all()) take(buffer);
    return names;
}

}  // namespace terrain
