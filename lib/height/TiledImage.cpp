#include "height/TiledImage.h"

#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include <algorithm>

#ifdef HAVE_OPENIMAGEIO
#include <OpenImageIO/imagecache.h>

#include "height/ImageSource.h"
#endif

namespace terrain {

#ifdef HAVE_OPENIMAGEIO

namespace {

/// Side of the tiles that files without any are cut into.
constexpr int kTileSide = 64;

std::string oneLine(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    while (!text.empty() && text.back() == ' ') text.pop_back();
    return text.empty() ? "unreadable data" : text;
}

std::string sizeText(int width, int height) {
    return std::to_string(width) + "x" + std::to_string(height);
}

}  // namespace

struct TiledImage::Cache {
    OIIO::ImageCache* images = OIIO::ImageCache::create(false);
    OIIO::ustring name;
    int channels = 0;  ///< that are read, at most 4
    bool hasAlpha = false;

    ~Cache() { OIIO::ImageCache::destroy(images); }
    std::string reason() const { return oneLine(images->geterror()); }
};

TiledImage::TiledImage() : cache_(std::make_unique<Cache>()) {}

Result<std::shared_ptr<const TiledImage>> TiledImage::open(const std::string& path, int memoryMegabytes) {
    if (const auto problem = whyNotSized(path)) return Error{path, "an image that OpenImageIO reads", *problem};
    std::shared_ptr<TiledImage> image(new TiledImage);
    image->path_ = path;
    Cache& cache = *image->cache_;
    cache.name = OIIO::ustring(path);
    cache.images->attribute("max_memory_MB", float(std::max(1, memoryMegabytes)));
    cache.images->attribute("autotile", kTileSide);
    cache.images->attribute("automip", 1);
    cache.images->attribute("unassociatedalpha", 1);
    OIIO::ImageSpec spec;
    if (!cache.images->get_imagespec(cache.name, spec)) return Error{path, "an image that OpenImageIO reads", cache.reason()};
    const char* format = nullptr;
    if (cache.images->get_image_info(cache.name, 0, 0, OIIO::ustring("fileformat"), OIIO::TypeDesc::STRING, &format) &&
        !imageEnds(path, format))
        return Error{path, "a complete image", "a file that ends too early"};
    if (spec.deep || spec.depth > 1) return Error{path, "a flat image", spec.deep ? "a deep image" : "a volume"};
    if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1)
        return Error{path, "an image with texels", sizeText(spec.width, spec.height)};
    cache.channels = std::min(4, spec.nchannels);
    cache.hasAlpha = cache.channels == 2 || (cache.channels == 4 && spec.alpha_channel == 3);
    for (Size size{spec.width, spec.height};; size = {std::max(1, size.width / 2), std::max(1, size.height / 2)}) {
        const int level = image->levels();
        // A file may have fewer levels, or round their sizes in another way.
        if (image->fileLevels_ == level && cache.images->get_imagespec(cache.name, spec, 0, level) && spec.width == size.width &&
            spec.height == size.height)
            ++image->fileLevels_;
        image->sizes_.push_back(size);
        if (size.width == 1 && size.height == 1) break;
    }
    // Levels that are not there are no errors.
    cache.images->geterror();
    return std::shared_ptr<const TiledImage>(std::move(image));
}

Result<std::size_t> TiledImage::readFile(int level, int x, int y, int width, int height, std::uint8_t* rgba) const {
    const Cache& cache = *cache_;
    OIIO::ImageSpec spec;
    if (!cache.images->get_imagespec(cache.name, spec, 0, level))
        return Error{path_, "level " + std::to_string(level), cache.reason()};
    const int left = spec.x + x, top = spec.y + y;
    if (!cache.images->get_pixels(cache.name, 0, level, left, left + width, top, top + height, spec.z, spec.z + 1, 0,
                                  cache.channels, OIIO::TypeDesc::UINT8, rgba, 4, OIIO::stride_t(width) * 4, OIIO::AutoStride, 0,
                                  cache.channels))
        return Error{path_, "a complete image", cache.reason()};
    const std::size_t texels = std::size_t(width) * std::size_t(height);
    for (std::uint8_t* texel = rgba; texel != rgba + texels * 4; texel += 4) {
        const std::uint8_t alpha = cache.hasAlpha ? texel[cache.channels - 1] : 255;
        if (cache.channels < 3) texel[1] = texel[2] = texel[0];
        texel[3] = alpha;
    }
    return texels;
}

std::size_t TiledImage::cacheBytes() const {
    long long bytes = 0;
    cache_->images->getattribute("stat:cache_memory_used", OIIO::TypeDesc::INT64, &bytes);
    return std::size_t(std::max(0ll, bytes));
}

#else

struct TiledImage::Cache {};

TiledImage::TiledImage() = default;

Result<std::shared_ptr<const TiledImage>> TiledImage::open(const std::string& path, int) {
    return Error{path, "a build with OpenImageIO", "one that lacks it"};
}

Result<std::size_t> TiledImage::readFile(int, int, int, int, int, std::uint8_t*) const {
    return Error{path_, "a build with OpenImageIO", "one that lacks it"};
}

std::size_t TiledImage::cacheBytes() const {
    return 0;
}

#endif

TiledImage::~TiledImage() = default;

Result<std::size_t> TiledImage::readHalved(int level, int x, int y, int width, int height, std::uint8_t* rgba) const {
    // In bands, because each level down takes four times the memory.
    constexpr int kBandTexels = 1 << 18;
    const Size finer = size(level - 1);
    const int left = 2 * x, right = std::min(finer.width, 2 * (x + width)), wide = right - left;
    const int rows = std::max(1, kBandTexels / wide);
    std::vector<std::uint8_t> band;
    for (int row = 0; row < height; row += rows) {
        const int top = 2 * (y + row), bottom = std::min(finer.height, top + 2 * std::min(rows, height - row)), tall = bottom - top;
        band.resize(std::size_t(wide) * std::size_t(tall) * 4);
        const auto done = read(level - 1, left, top, wide, tall, band.data());
        if (!done) return done.error();
        const auto at = [&](int column, int line) {
            return band.data() +
                   (std::size_t(std::min(line, tall - 1)) * std::size_t(wide) + std::size_t(std::min(column, wide - 1))) * 4;
        };
        for (int v = 0; v < std::min(rows, height - row); ++v)
            for (int u = 0; u < width; ++u) {
                const std::uint8_t *a = at(2 * u, 2 * v), *b = at(2 * u + 1, 2 * v), *c = at(2 * u, 2 * v + 1),
                                   *d = at(2 * u + 1, 2 * v + 1);
                std::uint8_t* out = rgba + (std::size_t(row + v) * std::size_t(width) + std::size_t(u)) * 4;
                for (int i = 0; i < 4; ++i) out[i] = std::uint8_t((a[i] + b[i] + c[i] + d[i] + 2) / 4);
            }
    }
    return std::size_t(width) * std::size_t(height);
}

Result<std::size_t> TiledImage::read(int level, int x, int y, int width, int height, std::uint8_t* rgba) const {
    if (level < 0 || level >= levels()) return Error{path_, std::to_string(levels()) + " levels", "level " + std::to_string(level)};
    const Size all = size(level);
    if (x < 0 || y < 0 || width < 1 || height < 1 || width > all.width - x || height > all.height - y)
        return Error{path_, "texels of " + std::to_string(all.width) + "x" + std::to_string(all.height),
                     std::to_string(width) + "x" + std::to_string(height) + " from (" + std::to_string(x) + ", " +
                         std::to_string(y) + ")"};
    return level < fileLevels_ ? readFile(level, x, y, width, height, rgba) : readHalved(level, x, y, width, height, rgba);
}

}  // namespace terrain
