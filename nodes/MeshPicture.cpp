#include <epoxy/gl.h>

#include "MeshPicture.h"

#include <algorithm>
#include <cmath>

#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/elements/SoDrawStyleElement.h>
#include <Inventor/elements/SoMultiTextureMatrixElement.h>
#include <Inventor/misc/SoState.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>

#include "ProgramPools.h"
#include "TerrainFrame.h"
#include "lod/DebugColours.h"
#include "lod/TriangleErrors.h"

namespace {

/// GL as colours need it that mean something; what it was comes back at the end.
class PlainState {
public:
    PlainState()
    {
        if (hasPrograms) glGetIntegerv(GL_CURRENT_PROGRAM, &program);
        glPushAttrib(GL_ALL_ATTRIB_BITS);
        glPushClientAttrib(GL_CLIENT_VERTEX_ARRAY_BIT);
        glBindBuffer(GL_ARRAY_BUFFER, 0);
        if (hasPrograms) glUseProgram(0);
        for (const GLenum feature : {GL_LIGHTING, GL_FOG, GL_BLEND, GL_ALPHA_TEST, GL_POLYGON_STIPPLE, GL_COLOR_SUM, GL_LINE_STIPPLE}) glDisable(feature);
        for (const GLenum feature : {GL_VERTEX_PROGRAM_ARB, GL_FRAGMENT_PROGRAM_ARB})
            if (glIsEnabled(feature)) glDisable(feature);
        GLint units = 1;
        glGetIntegerv(GL_MAX_TEXTURE_UNITS, &units);
        for (int unit = units - 1; unit >= 0; --unit) {
            glActiveTexture(GLenum(GL_TEXTURE0 + unit));
            for (const GLenum target : {GL_TEXTURE_1D, GL_TEXTURE_2D, GL_TEXTURE_3D, GL_TEXTURE_CUBE_MAP}) glDisable(target);
        }
        glShadeModel(GL_SMOOTH);
    }
    ~PlainState()
    {
        glPopClientAttrib();
        glPopAttrib();
        if (hasPrograms) glUseProgram(GLuint(program));
    }
    PlainState(const PlainState &) = delete;
    PlainState & operator=(const PlainState &) = delete;

private:
    const bool hasPrograms = epoxy_gl_version() >= 20;
    GLint program = 0;
};

/// As the fragment shaders count them.
int fogNow()
{
    if (!glIsEnabled(GL_FOG)) return 0;
    GLint mode = 0;
    glGetIntegerv(GL_FOG_MODE, &mode);
    return mode == GL_LINEAR ? 1 : mode == GL_EXP ? 2 : 3;
}

void store(const terrain::Colour & colour, std::uint8_t * out)
{
    for (int i = 0; i < 3; ++i) out[i] = std::uint8_t(std::lround(std::clamp(colour[i], 0.0f, 1.0f) * 255.0f));
}

}  // namespace

/// Triangles on their way to GL.
class MeshPicture::Batch {
public:
    Batch(const TerrainFrame & f, const Wanted & w, const Programs & p)
        : frame(f), wanted(w), programs(p), errors(f.data.grid, f.camera), up(glm::normalize(glm::vec3(f.data.grid.localFromFrame()[2])))
    {
        allowed = f.settings.pixelError > 0.0f ? f.settings.pixelError : 1.0f;
        vertices.reserve(kMost);
        glEnableClientState(GL_VERTEX_ARRAY);
        glEnableClientState(GL_COLOR_ARRAY);
    }

    void add(const terrain::DrawnPatch & patch)
    {
        // Without area, they face any way.
        if (patch.closesGaps) flush();
        isGaps = patch.closesGaps;
        if (isGaps && wanted.picture == SoTerrainShape::NONE) return;
        for (std::size_t i = 0; i + 2 < patch.indices.size(); i += 3) {
            if (vertices.size() + 3 > kMost) flush();
            addTriangle(patch, patch.indices.subspan(i, 3));
        }
        if (isGaps) flush();
    }

    void flush()
    {
        if (vertices.empty()) return;
        point(vertices.data());
        if (wanted.picture != SoTerrainShape::NONE) drawFaces();
        if (wanted.edges && !isGaps) drawEdges();
        vertices.clear();
        lineColours.clear();
    }

    int fog = 0;  ///< under which the edges lie

private:
    static constexpr std::size_t kMost = 3 << 14;

    terrain::DrawnVertex vertexOf(const terrain::DrawnPatch & patch, std::uint32_t index) const
    {
        const terrain::SampleGrid & grid = frame.data.grid;
        const std::uint32_t sample = patch.wholeGrid ? index : patch.samples[index], columns = std::uint32_t(grid.columns());
        const glm::ivec2 at(int(sample % columns), int(sample / columns));
        return {patch.wholeGrid ? grid.position(at.x, at.y) : patch.positions[index], patch.places.empty() ? glm::vec2(at) : patch.places[index]};
    }

    /// In the frame of a regular grid.
    float heightOf(const glm::vec3 & position) const
    {
        const glm::dmat4 & local = frame.data.grid.localFromFrame();
        const int axis = frame.data.grid.heightAxis();
        return float((double(position[axis]) - local[3][axis]) / local[2][axis]);
    }

    terrain::Colour colourOf(const terrain::DrawnPatch & patch, const std::array<terrain::DrawnVertex, 3> & corner) const
    {
        switch (wanted.picture) {
        case SoTerrainShape::TILES: return terrain::patchColour(patch);
        case SoTerrainShape::LEVELS: return terrain::levelColour(terrain::levelOf(corner[0].place, corner[1].place, corner[2].place));
        case SoTerrainShape::LOADING: {
            terrain::DrawnPatch now = patch;
            now.isNew = patch.isNew && wanted.isSelection;
            return !now.isNew && !now.standsIn && isTextureMissing(corner) ? terrain::kTextureToComeColour : terrain::loadingColour(now);
        }
        default: return programs.errors ? terrain::Colour(0.0f) : terrain::errorColour(errors.pixels(corner) / allowed);
        }
    }

    /// Of an SoTerrainTexture, in the middle of a triangle.
    bool isTextureMissing(const std::array<terrain::DrawnVertex, 3> & corner) const
    {
        if (!frame.texture.clipmap) return false;
        const glm::ivec2 last(frame.data.grid.columns() - 1, frame.data.grid.rows() - 1);
        SbVec3f middle(0.0f, 0.0f, 0.0f);
        for (const terrain::DrawnVertex & vertex : corner) {
            const glm::ivec2 at = glm::clamp(glm::ivec2(vertex.place), glm::ivec2(0), last);
            const SbVec2f place = frame.attributes.textureCoordinate(0, at.x, at.y);
            middle += SbVec3f(place[0], place[1], 0.0f) / 3.0f;
        }
        SoMultiTextureMatrixElement::get(frame.action->getState(), 0).multVecMatrix(middle, middle);
        return frame.texture.clipmap->isMissing({middle[0], middle[1]});
    }

    float shadeOf(const std::array<terrain::DrawnVertex, 3> & corner) const
    {
        if (!wanted.isShaded) return 1.0f;
        const glm::dvec3 a(corner[0].position), b(corner[1].position), c(corner[2].position);
        const glm::dvec3 across = glm::cross(b - a, c - a);
        const double length = glm::length(across);
        if (!(length > 0.0)) return 1.0f;
        glm::vec3 normal(across / length);
        if (frame.data.grid.isRegular() && glm::dot(normal, up) < 0.0f) normal = -normal;
        return terrain::slopeShade(normal, up);
    }

    void addTriangle(const terrain::DrawnPatch & patch, std::span<const std::uint32_t> indices)
    {
        const std::array<terrain::DrawnVertex, 3> corner{vertexOf(patch, indices[0]), vertexOf(patch, indices[1]), vertexOf(patch, indices[2])};
        const bool hasPicture = wanted.picture != SoTerrainShape::NONE;
        const float shade = hasPicture ? shadeOf(corner) : 1.0f;
        const terrain::Colour colour = hasPicture ? colourOf(patch, corner) * shade : terrain::Colour(0.0f);
        const bool regular = frame.data.grid.isRegular();
        const glm::vec3 base(corner[0].place, regular ? heightOf(corner[0].position) : 0.0f);
        for (std::size_t i = 0; i < 3; ++i) {
            terrain::DebugVertex vertex;
            vertex.position = corner[i].position;
            store(colour, vertex.colour);
            vertex.colour[3] = std::uint8_t(i);
            vertex.base = base;
            vertex.offset = glm::vec3(corner[i].place, regular ? heightOf(corner[i].position) : 0.0f) - base;
            vertex.shade = shade;
            vertices.push_back(vertex);
        }
        if (!wanted.edges) return;
        // Heat shows on dark blue, a surface of its own colours mostly is lighter.
        terrain::Colour line = hasPicture ? terrain::lineColourOn(colour) : terrain::Colour(0.0f);
        if (hasPicture && programs.errors) line = terrain::Colour(1.0f);
        std::array<std::uint8_t, 4> bytes{0, 0, 0, 255};
        store(line, bytes.data());
        lineColours.insert(lineColours.end(), 3, bytes);
    }

    static void pointAt(terrain::DebugAttribute attribute, int size, GLenum type, const void * data)
    {
        glEnableVertexAttribArray(GLuint(attribute));
        glVertexAttribPointer(GLuint(attribute), size, type, GL_FALSE, sizeof(terrain::DebugVertex), data);
    }

    void point(const terrain::DebugVertex * first) const
    {
        glVertexPointer(3, GL_FLOAT, sizeof(terrain::DebugVertex), &first->position);
        if (!programs.errors && !programs.edges) return;
        pointAt(terrain::DebugAttribute::Corner, 1, GL_UNSIGNED_BYTE, &first->colour[3]);
        pointAt(terrain::DebugAttribute::Base, 3, GL_FLOAT, &first->base);
        pointAt(terrain::DebugAttribute::Offset, 3, GL_FLOAT, &first->offset);
        pointAt(terrain::DebugAttribute::Shade, 1, GL_FLOAT, &first->shade);
    }

    void drawTriangles() const
    {
        const GLboolean culls = glIsEnabled(GL_CULL_FACE);
        if (culls && isGaps) glDisable(GL_CULL_FACE);
        glDrawArrays(GL_TRIANGLES, 0, GLsizei(vertices.size()));
        if (culls && isGaps) glEnable(GL_CULL_FACE);
    }

    void drawFaces()
    {
        glColorPointer(3, GL_UNSIGNED_BYTE, sizeof(terrain::DebugVertex), vertices.data()->colour);
        if (programs.errors) {
            programs.errors->use();
            terrain::setErrorUniforms(*programs.errors, frame.data.grid, frame.camera, allowed, 0);
        }
        drawTriangles();
        if (programs.errors) glUseProgram(0);
    }

    void drawEdges()
    {
        glPushAttrib(GL_ENABLE_BIT | GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_POLYGON_BIT);
        glColorPointer(4, GL_UNSIGNED_BYTE, 0, lineColours.data());
        GLint nearer = GL_LESS;
        glGetIntegerv(GL_DEPTH_FUNC, &nearer);
        // The same triangles at the same places have the same depth.
        if (nearer == GL_LESS) glDepthFunc(GL_LEQUAL);
        if (nearer == GL_GREATER) glDepthFunc(GL_GEQUAL);
        glDepthMask(GL_FALSE);
        if (programs.edges) {
            glEnable(GL_BLEND);
            glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
            programs.edges->use();
            glUniform1i((*programs.edges)["fog"], fog);
        } else {
            glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
            glEnable(GL_POLYGON_OFFSET_LINE);
            glPolygonOffset(-1.0f, -1.0f);
            glLineWidth(1.0f);
        }
        drawTriangles();
        if (programs.edges) glUseProgram(0);
        glPopAttrib();
    }

    const TerrainFrame & frame;
    const Wanted & wanted;
    const Programs programs;
    const terrain::TriangleErrors errors;
    const glm::vec3 up;
    float allowed = 1.0f;
    bool isGaps = false;
    std::vector<terrain::DebugVertex> vertices;
    std::vector<std::array<std::uint8_t, 4>> lineColours;
};

MeshPicture::Programs MeshPicture::findPrograms(const TerrainFrame & frame, const Wanted & wanted, std::string & problem) const
{
    Programs programs;
    const bool byFragment = wanted.picture == SoTerrainShape::ERRORS && !wanted.hasDetail;
    if (epoxy_gl_version() < 30) {
        if (byFragment || wanted.edges)
            problem = "debug views: expected OpenGL 3.0 or newer, found " + std::to_string(epoxy_gl_version() / 10) + "." + std::to_string(epoxy_gl_version() % 10) +
                      "; errors are shown triangle by triangle, edges are GL's own lines";
        return programs;
    }
    const auto find = [&](const char * name, terrain::Result<terrain::GlProgram> (*build)(), const char * instead) -> terrain::GlProgram * {
        const auto program = programPoolOf(frame.action->getState())->find(name, build);
        if (!program) problem = program.error().message() + "; " + instead;
        return program ? program.value() : nullptr;
    };
    if (wanted.edges) programs.edges = find("debug edges", terrain::buildEdgeProgram, "edges are GL's own lines");
    if (!byFragment) return programs;
    // Of curved grids it is expected, and said in the documentation.
    if (const auto why = terrain::HeightTexture::whyNot(frame.data.grid)) {
        if (frame.data.grid.isRegular()) problem = why->message() + "; errors are shown triangle by triangle";
    } else {
        programs.errors = find("debug errors", terrain::buildErrorProgram, "errors are shown triangle by triangle");
    }
    return programs;
}

std::string MeshPicture::draw(const TerrainFrame & frame, const terrain::LodAlgorithm & mesh, const Wanted & wantedArg)
{
    Wanted wanted = wantedArg;
    // Where the style draws edges anyway, there is nothing to draw them over.
    wanted.edges = wanted.edges && SoDrawStyleElement::get(frame.action->getState()) == SoDrawStyleElement::FILLED;
    if (wanted.picture == SoTerrainShape::NONE && !wanted.edges) return std::string();
    std::string problem;
    const Programs programs = findPrograms(frame, wanted, problem);
    const int fog = wanted.picture == SoTerrainShape::NONE ? fogNow() : 0;
    const PlainState plain;
    if (programs.errors) {
        if (heightsOf != frame.data.model.boxes) terrain::deleteNames(release());
        heightsOf = frame.data.model.boxes;
        heights.bind(frame.data.grid, frame.view.edits);
    }
    Batch batch(frame, wanted, programs);
    batch.fog = fog;
    mesh.eachPatch(frame.data.grid, [&batch](const terrain::DrawnPatch & patch) { batch.add(patch); });
    batch.flush();
    return problem;
}

std::vector<terrain::GlName> MeshPicture::release()
{
    const GLuint name = heights.release();
    return name ? std::vector<terrain::GlName>{{terrain::GlName::Texture, name}} : std::vector<terrain::GlName>();
}

void drawViewVolume(const terrain::View & view)
{
    const glm::dmat4 local = glm::inverse(view.clipFromLocal);
    std::array<glm::vec3, 8> corner;
    for (std::size_t i = 0; i < corner.size(); ++i) {
        const glm::dvec4 point = local * glm::dvec4(i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0, 1.0);
        corner[i] = glm::vec3(glm::dvec3(point) / point.w);
    }
    static constexpr std::uint8_t kEdges[24] = {0, 1, 1, 3, 3, 2, 2, 0, 4, 5, 5, 7, 7, 6, 6, 4, 0, 4, 1, 5, 2, 6, 3, 7};
    const PlainState plain;
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glLineWidth(2.0f);
    // Who looks at depth looks for the terrain.
    glDepthMask(GL_FALSE);
    glColor3f(1.0f, 0.9f, 0.1f);
    glEnableClientState(GL_VERTEX_ARRAY);
    glVertexPointer(3, GL_FLOAT, 0, corner.data());
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
    glDrawElements(GL_LINES, 24, GL_UNSIGNED_BYTE, kEdges);
}
