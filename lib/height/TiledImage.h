// Colours of an image of any size, level by level, from a cache of tiles with a limit on its memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/Result.h"

namespace terrain {

/// A file that OpenImageIO reads, through an ImageCache of its own. Level 0 is the image, each further one half as wide and high,
/// rounded down, the last one 1 x 1. They are the file's MIP levels as far as it has them, best written tiled by `maketx` or
/// `oiiotool -otex`. The levels of a file without any are made on reading, for which all of it is read once.
/// May be read by several threads at once.
class TiledImage {
public:
    struct Size {
        int width = 0;
        int height = 0;
    };

    /// `memoryMegabytes`: most that tiles may take, at least 1. Error: no such file, no image, too large, or a build without
    /// OpenImageIO.
    static Result<std::shared_ptr<const TiledImage>> open(const std::string& path, int memoryMegabytes);
    ~TiledImage();
    TiledImage(const TiledImage&) = delete;
    TiledImage& operator=(const TiledImage&) = delete;

    const std::string& path() const { return path_; }
    int levels() const { return int(sizes_.size()); }
    Size size(int level = 0) const { return sizes_[std::size_t(level)]; }

    /// Writes texels (x, y) to (x + width - 1, y + height - 1) of a level, row after row from the image's top, to `rgba`: 4 * width
    /// * height bytes. Images of one or two channels are grey; alpha is not associated, 255 where the image has none. Values are
    /// taken as they are stored: no colour space is changed. Error: outside of the level, or data that can't be read.
    Result<std::size_t> read(int level, int x, int y, int width, int height, std::uint8_t* rgba) const;

    /// Bytes of tiles that the cache holds.
    std::size_t cacheBytes() const;

private:
    struct Cache;
    TiledImage();
    Result<std::size_t> readFile(int level, int x, int y, int width, int height, std::uint8_t* rgba) const;
    Result<std::size_t> readHalved(int level, int x, int y, int width, int height, std::uint8_t* rgba) const;

    std::string path_;
    std::vector<Size> sizes_;
    int fileLevels_ = 0;  ///< further ones are averages of these
    std::unique_ptr<Cache> cache_;
};

}  // namespace terrain
