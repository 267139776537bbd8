// How a terrain node draws with the SoTerrainTexture of the state.
#ifndef SOTERRAIN_TERRAINTEXTUREUSE_H
#define SOTERRAIN_TERRAINTEXTUREUSE_H

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "TerrainViews.h"
#include "gl/TextureClipmap.h"

class SoGLRenderAction;
class SoState;
class SoTerrainTextureElement;
class StateAttributes;

/// Whether the texture of unit 0 is an SoTerrainTexture: not after an SoTexture2 that follows it, nor where its file could not be opened. For
/// SoGLRenderAction only.
bool hasTerrainTexture(SoState * state);

/// The texture clipmaps of one terrain node, one for each of its views. Textures and programs are deleted in the context that they
/// belong to: at once when it goes, else when it is next current.
///
/// A node with a program of its own puts terrain::TextureClipmap::glsl() into its fragment shader, calls update() in each frame, and where
/// that gives a clipmap draws with a terrain::TextureClipmap::Binding(*clipmap, program, terrain::TextureClipmap::lastUnits()). Without a
/// clipmap it draws untextured, or with the state's SoTexture2. All other nodes draw within a FixedFunction.
class TerrainTextureUse {
public:
    TerrainTextureUse();
    ~TerrainTextureUse();
    TerrainTextureUse(const TerrainTextureUse &) = delete;
    TerrainTextureUse & operator=(const TerrainTextureUse &) = delete;

    struct Frame {
        const terrain::TextureClipmap * clipmap = nullptr;  ///< none: draw as if there was no SoTerrainTexture
        bool converged = true;                              ///< false: more is to be loaded, ask for another frame
        std::size_t uploadedBytes = 0;
        std::string problem;                                ///< to be said once, or empty
        GLuint program = 0;                                 ///< for FixedFunction
    };

    /// Brings the view's clipmap up to date around the viewer, if hasTerrainTexture().
    Frame update(SoGLRenderAction * action, const terrain::View & camera, const terrain::SampleGrid & grid,
                 const StateAttributes & attributes, std::uint64_t frame);

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

    std::size_t memoryBytes() const;
    std::size_t textureBytes() const;

private:
    struct View;
    static void contextGoes(std::uint32_t context, void * closure);
    static void giveUp(View & view);
    View & find(const ViewKey & key, const SoTerrainTextureElement * element, std::uint64_t frame);

    std::vector<std::unique_ptr<View>> views;
};

#endif
