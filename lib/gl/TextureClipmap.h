// A colour texture of any size, of which the part around the viewer is on the GPU.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <epoxy/gl.h>

#include <glm/vec2.hpp>

#include "base/Result.h"
#include "height/TiledImage.h"

namespace terrain {

/// A clipmap (Tanner, Migdal, Jones: "The Clipmap: A Virtual Mipmap", 1998). Of each level of the image that is larger than the
/// clip size, a window of clipSize x clipSize texels around a focus is resident, in a layer of a texture array; texel (x, y) of the
/// level lies at (x mod clipSize, y mod clipSize), so that a window that moves writes only the texels that it did not hold. Smaller
/// levels are wholly resident, in a mip-mapped texture: 4 bytes a texel, clipSize^2 for each level and 4/3 clipSize^2 for the small
/// ones.
///
/// Of a level that is not complete yet the part that is there is used: what is resident is always one rectangle.
///
/// For one GL context of version 3.0 or newer, which must be current in update() and Binding. Nothing is deleted in the destructor:
/// the owner takes the names by release().
class TextureClipmap {
public:
    /// Texels from (x0, y0) up to but not including (x1, y1), rows counted from the image's top.
    struct Window {
        int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

        int width() const { return x1 - x0; }
        int height() const { return y1 - y0; }
        bool isEmpty() const { return x1 <= x0 || y1 <= y0; }
        std::size_t texels() const { return isEmpty() ? 0 : std::size_t(width()) * std::size_t(height()); }
        bool operator==(const Window&) const = default;
    };

    /// `clipSize`: a power of two from 16 on; smaller where GL has no textures so large.
    TextureClipmap(std::shared_ptr<const TiledImage> image, int clipSize);
    TextureClipmap(const TextureClipmap&) = delete;
    TextureClipmap& operator=(const TextureClipmap&) = delete;

    /// What update() did.
    struct Progress {
        std::size_t texels = 0;  ///< sent to GL
        bool complete = true;    ///< false: the budget was spent before all that is wanted was there
    };

    /// What is looked at.
    struct Focus {
        /// In texture coordinates: (0, 0) is the image's lower left corner, (1, 1) the upper right one.
        glm::dvec2 place{0.5, 0.5};
        /// Where the middle of a window lies from there, as a part of its width and height; each at most 0.5.
        glm::dvec2 lead{0.0, 0.0};
        /// Finer levels are not needed.
        int finestLevel = 0;
    };

    /// Moves the windows and loads what they newly cover, from coarse to fine, each texel once. Levels that are not needed stay as
    /// they are. `texelBudget`: most texels to load, but at least one line of a window; 0: no limit. The small levels are loaded at
    /// once in the first call, without counting. Error: the image can't be read, or GL is too old; the clipmap must not be used
    /// then. GL's state is what it was.
    Result<Progress> update(const Focus& focus, std::size_t texelBudget);

    /// GLSL 1.30, to be put into a fragment shader behind "#version 130" or later: declares the uniforms and
    /// `vec4 terrainTexture(vec2 st)`, the colour at texture coordinates st, clamped to [0, 1], opaque. The level is that which the
    /// derivatives of st ask for, or the finest there; levels are blended (trilinear), and at the border of what is there of a
    /// level into the next coarser one. To be called in uniform control flow. Names begin with "terrainTexture".
    static const char* glsl();
    /// How many texture units terrainTexture() uses.
    static constexpr int kUnits = 2;

    /// While it lives, the textures are bound to units firstUnit and firstUnit + 1 and the uniforms of `program`, which must be in
    /// use, are set. Then those units and the active unit are what they were.
    class Binding {
    public:
        Binding(const TextureClipmap& clipmap, GLuint program, int firstUnit);
        ~Binding();
        Binding(const Binding&) = delete;
        Binding& operator=(const Binding&) = delete;

    private:
        GLint active_ = 0, small_ = 0, array_ = 0;  ///< before
        int firstUnit_;
    };
    /// The highest texture units that there are, which no Coin node uses: a first unit for Binding.
    static int lastUnits();

    const TiledImage& image() const { return *image_; }
    int clipSize() const { return clipSize_; }
    /// Levels with a window: 0 to levels() - 1 of the image. Those from levels() on are wholly resident.
    int levels() const { return int(windows_.size()); }
    /// What is there of a level.
    const Window& resident(int level) const { return windows_[std::size_t(level)]; }
    /// Whether texels there, in texture coordinates, were wanted in the latest update() and did not come in it.
    bool isMissing(glm::dvec2 place) const;
    std::size_t textureBytes() const { return textureBytes_; }
    /// Whether the current context has the textures.
    bool isThere() const { return small_ == 0 || glIsTexture(small_); }
    /// Names of all textures, which are the caller's to delete; forgets them and what was resident.
    std::vector<GLuint> release();

private:
    class UploadScope;
    std::optional<Error> create();
    std::optional<Error> createArray();
    std::optional<Error> loadSmall();
    std::optional<Error> load(int level, const Window& part);
    std::optional<Error> moveWindow(int level, const Window& wanted, int focusRow, std::size_t budget, Progress& progress);
    void fitClipSize();
    Window wantedAround(int level, const Focus& focus) const;

    std::shared_ptr<const TiledImage> image_;
    int clipSize_;
    glm::ivec2 layer_{0, 0};  ///< texels of a layer of the array: clipSize_, or all of an image that is not as wide or as high
    std::vector<Window> windows_, wanted_;  ///< by level; what the latest update wanted, empty where it wanted none
    GLuint small_ = 0, array_ = 0;
    std::size_t textureBytes_ = 0;
    std::vector<std::uint8_t> texels_;
};

}  // namespace terrain
