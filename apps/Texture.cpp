#include "Texture.h"

#include <algorithm>

#include <Inventor/nodes/SoTexture2.h>

#include "ImageFile.h"

namespace app {

SoTexture2* makeTexture(terrain::Image image, bool topFirst) {
    const std::size_t stride = std::size_t(image.width) * std::size_t(image.channels);
    // Inventor counts rows from the bottom.
    for (int row = 0; !topFirst && row < image.height / 2; ++row) {
        auto* top = image.pixels.data() + stride * std::size_t(row);
        std::swap_ranges(top, top + stride, image.pixels.data() + stride * std::size_t(image.height - 1 - row));
    }
    auto* texture = new SoTexture2;
    texture->image.setValue(SbVec2s(short(image.width), short(image.height)), image.channels, image.pixels.data());
    return texture;
}

terrain::Result<SoTexture2*> loadTexture(const std::string& path, bool topFirst) {
    auto read = readImage(path);
    if (!read) return read.error();
    return makeTexture(std::move(read).value(), topFirst);
}

}  // namespace app
