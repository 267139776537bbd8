// A GL context without a window system: EGL surfaceless, drawing into a frame buffer object.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/Result.h"

namespace terrain {

/// Pixels of a frame, rows from top to bottom, `channels` bytes a pixel.
struct Image {
    int width = 0;
    int height = 0;
    int channels = 3;
    std::vector<std::uint8_t> pixels;
};

/// Owns an EGL display, a compatibility-profile GL context and a frame buffer with RGBA8 colour and 32-bit float depth. The context
/// is current in the creating thread from create() on; makeCurrent() brings it back after another one was used.
class HeadlessContext {
public:
    /// With `sharedWith` it has that context's buffers, textures and programs, as GL shares them. Error: no EGL, no surfaceless
    /// platform, no desktop GL, or a size that the frame buffer can't have.
    static Result<std::unique_ptr<HeadlessContext>> create(int width, int height, const HeadlessContext* sharedWith = nullptr);
    ~HeadlessContext();

    void makeCurrent();
    /// Binds the frame buffer and sets the viewport to all of it.
    void bindFramebuffer();
    Image readColor() const;               ///< RGB
    std::vector<float> readDepth() const;  ///< width x height, rows from bottom to top, 1 is background
    std::string renderer() const;
    int width() const;
    int height() const;

private:
    HeadlessContext();
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace terrain
