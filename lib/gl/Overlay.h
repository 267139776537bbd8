// Flat shapes and text in pixels, over whatever has been drawn.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <epoxy/gl.h>
#include <glm/vec2.hpp>

#include "gl/BitmapFont.h"

namespace terrain {

/// Red, green, blue and opacity, 0 to 255.
using OverlayColor = std::array<std::uint8_t, 4>;

/// Places are in pixels from the lower left corner of the viewport; s and t are texels of the font, for text.
struct OverlayVertex {
    float x, y;
    std::int16_t s, t;
    OverlayColor color;
};

/// Rectangles and characters, four vertices each, in the order in which they are to be drawn.
class OverlayQuads {
public:
    void addRectangle(glm::vec2 low, glm::vec2 high, const OverlayColor& color);
    /// `place`: lower left corner of the first of the glyphs, which come side by side, `scale` times as large as they are.
    void addText(glm::vec2 place, std::basic_string_view<std::uint8_t> glyphs, const OverlayColor& color, int scale);
    void clear() { vertices_.clear(); }
    std::span<const OverlayVertex> vertices() const { return vertices_; }

private:
    std::vector<OverlayVertex> vertices_;
};

/// What overlays need of one context, or of contexts that share their objects: the BitmapFont as a texture. Nothing is deleted in
/// the destructor: the owner takes the name by release() and deletes it where it belongs.
class OverlayResources {
public:
    GLuint release();

private:
    friend class OverlayScope;
    /// What the context is able to do.
    struct Abilities {
        int version = 0;                ///< of GL, 10 times
        bool fixedFunctions = false;    ///< no core profile, no GLES
        bool assemblyPrograms = false;  ///< ARB_vertex_program and ARB_fragment_program
        bool rectangles = false;        ///< GL_TEXTURE_RECTANGLE
        int textureUnits = 1;           ///< of fixed functions
        int attributes = 0;             ///< of vertices, for programs
    };
    /// Asks once, and anew where the current context is not the one that was asked.
    void find();
    void makeFont();

    GLuint font_ = 0;
    bool isKnown_ = false;
    Abilities abilities_;
};

/// While it lives, GL draws overlays: unlit, blended, without a depth test, a clip plane, a texture or a program of others. After
/// it GL is what it was, so nobody has to be told. Fixed functions and client arrays of GL 1.1 suffice.
class OverlayScope {
public:
    /// `resources` are those of the current context. Sizes of the viewport are in pixels.
    OverlayScope(OverlayResources& resources, int width, int height);
    ~OverlayScope();
    OverlayScope(const OverlayScope&) = delete;
    OverlayScope& operator=(const OverlayScope&) = delete;

    /// False where the context has no fixed functions (a core profile, GLES) or no room to keep its state; nothing is drawn then.
    bool canDraw() const { return canDraw_; }
    void drawRectangles(std::span<const OverlayVertex> vertices) const { drawQuads(vertices, false); }
    void drawText(std::span<const OverlayVertex> vertices) const { drawQuads(vertices, true); }
    /// Lines, each along as many vertices as `lengths` has for it, one line's behind the other's, `width` pixels wide. They are not
    /// blended.
    void drawLines(std::span<const OverlayVertex> vertices, std::span<const GLsizei> lengths, float width) const;

private:
    void saveBlending();
    void switchOff() const;
    void switchOffArrays() const;
    void takeProgramAndTexture();
    void drawQuads(std::span<const OverlayVertex> vertices, bool isText) const;
    static void setArrays(std::span<const OverlayVertex> vertices, bool isText);

    OverlayResources& resources_;
    bool canDraw_ = false;
    GLint vertexArray_ = 0, matrixMode_ = 0, program_ = 0, activeTexture_ = 0, texture_ = 0, sampler_ = 0, environment_ = 0;
    GLint blending_[6] = {};
    float matrices_[3][16];
};

}  // namespace terrain
