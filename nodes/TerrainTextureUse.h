// How a terrain node draws with the SoTerrainTexture of the state.
#ifndef SOTERRAIN_TERRAINTEXTUREUSE_H
#define SOTERRAIN_TERRAINTEXTUREUSE_H

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "gl/GlProgram.h"
#include "gl/TextureClipmap.h"

class SoGLRenderAction;
class SoState;
class StateAttributes;

namespace terrain {
class SampleGrid;
struct View;
}

/// Whether the texture of unit 0 is an SoTerrainTexture: not after an SoTexture2 that follows it, nor where its file could not be opened. For
/// SoGLRenderAction only.
bool hasTerrainTexture(SoState * state);

/// The texture clipmap of one view of a terrain node.
///
/// A node with a program of its own puts terrain::TextureClipmap::glsl() into its fragment shader, calls update() in each frame, and where
/// that gives a clipmap draws with a terrain::TextureClipmap::Binding(*clipmap, program, terrain::TextureClipmap::lastUnits()). Without a
/// clipmap it draws untextured, or with the state's SoTexture2. All other nodes draw within a FixedFunction.
class TerrainTextureUse {
public:
    struct Frame {
        const terrain::TextureClipmap * clipmap = nullptr;  ///< none: draw as if there was no SoTerrainTexture
        bool converged = true;                              ///< false: more is to be loaded, ask for another frame
        std::size_t uploadedBytes = 0;
        std::string problem;                                ///< to be said once, or empty
        GLuint program = 0;                                 ///< for FixedFunction
    };

    /// Brings the view's clipmap up to date around the viewer, if hasTerrainTexture().
    Frame update(SoGLRenderAction * action, const terrain::View & camera, const terrain::SampleGrid & grid,
                 const StateAttributes & attributes);

    /// While it lives, vertex arrays under the fixed-function state are drawn with the frame's clipmap: lit colours times the texture at the
    /// texture coordinates of unit 0, then fog. Does nothing where the frame has none.
    class FixedFunction {
    public:
        explicit FixedFunction(const Frame & frame);
        ~FixedFunction();
        FixedFunction(const FixedFunction &) = delete;
        FixedFunction & operator=(const FixedFunction &) = delete;

    private:
        std::unique_ptr<terrain::TextureClipmap::Binding> binding;
        GLint before = 0;
    };

    /// None before the first update().
    const terrain::TiledImage * image() const { return image_.get(); }
    std::size_t textureBytes() const { return clipmap_ ? clipmap_->textureBytes() : 0; }
    /// Whether the current context has them.
    bool isThere() const { return !clipmap_ || clipmap_->isThere(); }
    /// All GL objects but programs, which are the caller's to delete.
    std::vector<terrain::GlName> release();

private:
    std::unique_ptr<terrain::TextureClipmap> clipmap_;
    std::shared_ptr<const terrain::TiledImage> image_;
    int wantedClipSize_ = 0;
    bool isNew_ = true;    ///< nothing has been loaded yet
    std::string problem_;  ///< why it can't be drawn, or empty
};

#endif
