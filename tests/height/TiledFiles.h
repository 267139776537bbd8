// Images for tests of tiled textures, and files of them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <OpenImageIO/imageio.h>

namespace terrain::test {

/// Texels row after row from the top, `channels` bytes each.
struct Texels {
    int width = 0, height = 0, channels = 3;
    std::vector<std::uint8_t> bytes;

    const std::uint8_t* at(int x, int y) const {
        return bytes.data() + (std::size_t(y) * std::size_t(width) + std::size_t(x)) * std::size_t(channels);
    }
};

inline Texels texelsOf(int width, int height, int channels, const std::function<std::uint8_t(int x, int y, int channel)>& value) {
    Texels image{width, height, channels, {}};
    image.bytes.reserve(std::size_t(width) * std::size_t(height) * std::size_t(channels));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c) image.bytes.push_back(value(x, y, c));
    return image;
}

/// Any texel tells where it lies.
inline std::uint8_t placeTexel(int x, int y, int channel) {
    const unsigned hash = (unsigned(x) * 2654435761u) ^ (unsigned(y) * 2246822519u) ^ (unsigned(channel) * 3266489917u);
    return std::uint8_t(hash >> 19);
}

/// Waves some hundred texels long.
inline std::uint8_t smoothTexel(int x, int y, int channel) {
    return std::uint8_t(128.0 + 60.0 * std::sin(x * 0.02 + channel) + 60.0 * std::cos(y * 0.023 + 2.0 * channel));
}

/// Half as wide and high, rounded down, by averages of four.
inline Texels halved(const Texels& finer) {
    const auto at = [&](int x, int y, int c) { return int(finer.at(std::min(x, finer.width - 1), std::min(y, finer.height - 1))[c]); };
    return texelsOf(std::max(1, finer.width / 2), std::max(1, finer.height / 2), finer.channels, [&](int x, int y, int c) {
        return std::uint8_t((at(2 * x, 2 * y, c) + at(2 * x + 1, 2 * y, c) + at(2 * x, 2 * y + 1, c) + at(2 * x + 1, 2 * y + 1, c) + 2) / 4);
    });
}

/// The image and all that is coarser.
inline std::vector<Texels> levelsOf(Texels image) {
    std::vector<Texels> levels{std::move(image)};
    while (levels.back().width > 1 || levels.back().height > 1) levels.push_back(halved(levels.back()));
    return levels;
}

/// Writes a file with these MIP levels, tiled where `tile` is not 0.
inline void writeLevels(const std::string& path, const std::vector<Texels>& levels, int tile) {
    auto out = OIIO::ImageOutput::create(path);
    ASSERT_TRUE(out) << path;
    for (std::size_t level = 0; level < levels.size(); ++level) {
        const Texels& image = levels[level];
        OIIO::ImageSpec spec(image.width, image.height, image.channels, OIIO::TypeDesc::UINT8);
        spec.tile_width = spec.tile_height = tile;
        spec.attribute("compression", "none");
        spec.attribute("oiio:UnassociatedAlpha", 1);
        // What maketx writes: without it TIFF's further images are not taken for levels.
        if (levels.size() > 1) spec.attribute("textureformat", "Plain Texture");
        const auto further = out->supports("mipmap") ? OIIO::ImageOutput::AppendMIPLevel : OIIO::ImageOutput::AppendSubimage;
        ASSERT_TRUE(out->open(path, spec, level == 0 ? OIIO::ImageOutput::Create : further)) << out->geterror();
        ASSERT_TRUE(out->write_image(OIIO::TypeDesc::UINT8, image.bytes.data())) << out->geterror();
    }
    ASSERT_TRUE(out->close()) << out->geterror();
}

}  // namespace terrain::test
