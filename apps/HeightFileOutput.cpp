#include "HeightFileOutput.h"

#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <vector>

#ifdef HAVE_OPENIMAGEIO
#include <OpenImageIO/imageio.h>
#endif

namespace app {

namespace {

/// Heights stretched to 16 bits: `count` rows, from north to south, the first one being `first` rows below the top.
std::vector<std::uint16_t> toWords(const EnlargedMap& map, int first, int count) {
    const double range = std::max(map.highest() - map.lowest(), 1e-30);
    std::vector<std::uint16_t> words;
    words.reserve(std::size_t(count) * std::size_t(map.columns()));
    std::vector<double> heights(std::size_t(map.columns()));
    for (int row = first; row < first + count; ++row) {
        map.makeRow(map.rows() - 1 - row, heights.data());
        for (const double height : heights)
            words.push_back(std::uint16_t((float(height) - float(map.lowest())) / range * 65535.0 + 0.5));
    }
    return words;
}

}  // namespace

#ifdef HAVE_OPENIMAGEIO

std::string writeHeights(const EnlargedMap& map, const std::string& path, int tile) {
    const auto output = OIIO::ImageOutput::create(path);
    if (!output) return path + ": " + OIIO::geterror();
    if (tile > 0 && !output->supports("tiles")) return path + ": expected a format that has tiles, found " + output->format_name();
    OIIO::ImageSpec spec(map.columns(), map.rows(), 1, OIIO::TypeDesc::UINT16);
    spec.attribute("compression", "zip");
    spec.attribute("png:compressionLevel", 9);
    spec.tile_width = spec.tile_height = tile;
    spec.tile_depth = 1;
    bool good = output->open(path, spec);
    const int band = tile > 0 ? tile : 64;
    for (int row = 0; good && row < map.rows(); row += band) {
        const int end = std::min(row + band, map.rows());
        const auto words = toWords(map, row, end - row);
        good = tile > 0 ? output->write_tiles(0, map.columns(), row, end, 0, 1, OIIO::TypeDesc::UINT16, words.data())
                        : output->write_scanlines(row, end, 0, OIIO::TypeDesc::UINT16, words.data());
    }
    return good && output->close() ? std::string() : path + ": " + output->geterror();
}

#else

std::string writeHeights(const EnlargedMap& map, const std::string& path, int) {
    std::ofstream file(path, std::ios::binary);
    for (int row = 0; row < map.rows() && file; ++row)
        for (const std::uint16_t word : toWords(map, row, 1)) file << char(word & 255) << char(word >> 8);
    file.flush();
    return file ? std::string() : path + ": can't be written";
}

#endif

}  // namespace app
