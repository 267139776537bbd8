#include "Texture.h"

#include <algorithm>

#include <Inventor/nodes/SoTexture2.h>

#include "ImageFile.h"

namespace app {

terrain::Result<SoTexture2*> loadTexture(const std::string& path, bool topFirst) {
    auto read = readImage(path);
    if (!read) return read.error();
    terrain::Image image = std::move(read).value();
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

}  // namespace app
