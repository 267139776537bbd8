// Files of heights and textures of every format, through the functions that open them. An input is a byte for the format, a few for
// the options, and the file.
#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <vector>

#ifdef HAVE_OPENIMAGEIO
#include <OpenImageIO/imageio.h>
#endif
#ifdef HAVE_GDAL
#include <gdal_priv.h>
#endif

#include "Input.h"
#include "height/HeightSource.h"
#include "height/TiledImage.h"

using namespace terrain;

namespace {

/// HGT is left out: of it a reader knows name and length alone, and the least length is 2.8 MB.
constexpr const char* kExtensions[] = {"raw", "png", "tif", "exr", "hdr", "jpg", "bmp", "pgm", "tga", "sgi", "dpx", "asc"};
constexpr std::size_t kExtensionCount = std::size(kExtensions);
/// Bytes of an input before the file.
constexpr std::size_t kOptionBytes = 16;
/// As many samples or texels as are decoded in a moment.
constexpr std::uint64_t kMostSamples = 1 << 21;

std::filesystem::path folder;

struct Folder {
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(folder, ignored);
    }
} const removedAtTheEnd;

std::size_t formatOf(std::string_view extension) {
    return std::size_t(std::find(std::begin(kExtensions), std::end(kExtensions), extension) - std::begin(kExtensions));
}

HeightFileOptions optionsOf(fuzz::Input& input) {
    HeightFileOptions options;
    const std::uint8_t which = input.byte();
    options.channel = input.between(0, 5) - 2;
    options.rawSize = {input.between(0, 40), input.between(0, 40)};
    if (which & 1) options.rawSize = {0, 0};
    options.rawType = RawType(input.between(0, 2));
    const double number = input.number(), other = input.number();
    if (which & 2) options.spacing = glm::dvec2(number, other);
    if (which & 4) options.origin = glm::dvec2(other, number);
    if (which & 8) options.noData = number;
    if (which & 16) options.heightScale = other;
    if (which & 32) options.heightOffset = number;
    if (which & 64) options.samplesInMemory = 50;
    options.maximumSamples = kMostSamples;
    return options;
}

void runHeights(const std::string& path, const HeightFileOptions& options) {
    const auto opened = openHeightFile(path, options);
    if (!opened) return fuzz::check(!opened.error().message().empty(), "an error without a word");
    const HeightSource& source = *opened.value();
    const HeightExtent extent = source.extent();
    fuzz::check(extent.columns >= 2 && extent.rows >= 2, "a map of no cells");
    fuzz::check(extent.spacing.x > 0.0 && extent.spacing.y > 0.0 && std::isfinite(extent.origin.x + extent.origin.y),
                "a map nowhere");
    const HeightMap& map = *source.map();
    fuzz::check(map.heights.size() == std::size_t(extent.columns) * std::size_t(extent.rows),
                "fewer samples than the map has places");
    for (std::size_t i = 0; i < map.heights.size(); ++i) fuzz::check(!std::isinf(map.heights[i]), "an infinite height");
    for (int level = -1; level <= source.levelCount(); ++level)
        for (const int place : {-1, 0, 1}) {
            const auto tile = source.load({level, place, place, 8});
            if (!tile) continue;
            const HeightTile& samples = tile.value();
            fuzz::check(samples.heights.size() == std::size_t(samples.columns) * std::size_t(samples.rows),
                        "a tile without samples");
        }
}

void runTexture(const std::string& path, fuzz::Input& input) {
    const auto opened = TiledImage::open(path, 1);
    if (!opened) return fuzz::check(!opened.error().message().empty(), "an error without a word");
    const TiledImage& image = *opened.value();
    const TiledImage::Size all = image.size();
    fuzz::check(all.width > 0 && all.height > 0, "an image without texels");
    // Coarse levels of a file without them are made of all texels.
    const bool isSmall = std::uint64_t(all.width) * std::uint64_t(all.height) <= kMostSamples;
    for (int level = -1; level <= image.levels(); ++level) {
        const bool exists = level >= 0 && level < image.levels();
        if (level > 0 && !isSmall) break;
        const TiledImage::Size size = exists ? image.size(level) : TiledImage::Size{1, 1};
        const int x = exists ? int(input.word() % unsigned(size.width)) : 0,
                  y = exists ? int(input.word() % unsigned(size.height)) : 0;
        const int width = std::min(size.width - x, 70), height = std::min(size.height - y, 70);
        std::vector<std::uint8_t> texels(std::size_t(width) * std::size_t(height) * 4);
        fuzz::check(exists || !image.read(level, x, y, width, height, texels.data()), "a level that does not exist");
        if (exists) image.read(level, x, y, width, height, texels.data());
    }
}

std::string bytesOf(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// The file as an input: with no options, with scratch space and a hole, and as a texture.
void seed(const std::string& name, const std::string& extension, const std::string& bytes) {
    if (bytes.empty()) return;
    std::string head(1 + kOptionBytes, '\0');
    head[0] = char(formatOf(extension));
    head[1] = 1;
    head[2] = 1;  // channel -1
    fuzz::writeSeed(name, head + bytes);
    head[1] = 64 + 8 + 1;
    head[2] = 2;  // channel 0
    fuzz::writeSeed(name + "-scratch", head + bytes);
    head[0] = char(head[0] + 128);
    fuzz::writeSeed(name + "-texture", head + bytes);
}

#ifdef HAVE_OPENIMAGEIO
void seedImage(const std::string& name, const std::string& extension, int channels, OIIO::TypeDesc type, int tile = 0,
               const std::string& compression = {}) {
    constexpr int kWidth = 19, kHeight = 17;
    const std::string path = folder / ("seed." + extension);
    OIIO::ImageSpec spec(kWidth, kHeight, channels, type);
    spec.tile_width = spec.tile_height = tile;
    if (!compression.empty()) spec.attribute("compression", compression);
    std::vector<float> samples;
    for (int i = 0; i < kWidth * kHeight * channels; ++i) samples.push_back(float(0.5 + 0.5 * std::sin(0.37 * i)));
    const auto output = OIIO::ImageOutput::create(path);
    if (!output || !output->open(path, spec) || !output->write_image(OIIO::TypeDesc::FLOAT, samples.data()) || !output->close())
        return;
    seed(name, extension, bytesOf(path));
}
#endif

#ifdef HAVE_GDAL
void seedRaster(const char* name, GDALDataType type, const char* const* creation) {
    GDALAllRegister();
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    const std::string path = folder / "seed-geo.tif";
    GDALDataset* dataset = driver ? driver->Create(path.c_str(), 12, 9, 1, type, const_cast<char**>(creation)) : nullptr;
    if (!dataset) return;
    double transform[6] = {500.0, 30.0, 0.0, 8000.0, 0.0, -30.0};
    dataset->SetGeoTransform(transform);
    dataset->GetRasterBand(1)->SetNoDataValue(7.0);
    std::vector<double> samples;
    for (int i = 0; i < 12 * 9; ++i) samples.push_back(i % 40);
    const CPLErr written =
        dataset->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, 12, 9, samples.data(), 12, 9, GDT_Float64, 0, 0, nullptr);
    GDALClose(dataset);
    if (written == CE_None) seed(name, "tif", bytesOf(path));
}
#endif

void writeSeeds() {
    seed("bytes", "raw", std::string(81, '\x17'));
    seed("grid", "asc",
         "ncols 4\nnrows 3\nxllcorner 10.5\nyllcorner -20\ncellsize 30\nNODATA_value -9999\n1 2 3 4\n5 -9999 7 8.5\n1e3 2 3 4\n");
    seed("plain", "pgm", "P2\n3 3\n255\n0 1 2\n3 4 5\n6 7 255\n");
#ifdef HAVE_OPENIMAGEIO
    using OIIO::TypeDesc;
    for (const auto& [name, type] :
         {std::pair{"8", TypeDesc(TypeDesc::UINT8)}, {"16", TypeDesc(TypeDesc::UINT16)}, {"f", TypeDesc(TypeDesc::FLOAT)}})
        for (const int channels : {1, 2, 3, 4})
            for (const char* extension : {"png", "tif", "exr", "hdr", "jpg", "bmp", "pgm", "tga", "sgi"})
                seedImage(std::string(extension) + name + std::to_string(channels), extension, channels, type);
    for (const char* compression : {"none", "zip", "lzw", "packbits"}) {
        seedImage(std::string("tiled-") + compression, "tif", 3, TypeDesc::UINT8, 16, compression);
        seedImage(std::string("strips-") + compression, "tif", 1, TypeDesc::UINT16, 0, compression);
    }
    for (const char* compression : {"none", "rle", "zips", "piz", "pxr24", "b44", "dwaa"})
        seedImage(std::string("exr-") + compression, "exr", 1, TypeDesc::HALF, compression[0] == 'p' ? 16 : 0, compression);
#endif
#ifdef HAVE_GDAL
    const char* const none[] = {nullptr};
    const char* const deflated[] = {"COMPRESS=DEFLATE", "PREDICTOR=2", nullptr};
    const char* const tiled[] = {"TILED=YES", "BLOCKXSIZE=16", "BLOCKYSIZE=16", "COMPRESS=LZW", nullptr};
    seedRaster("geo-int16", GDT_Int16, deflated);
    seedRaster("geo-float", GDT_Float32, none);
    seedRaster("geo-double", GDT_Float64, tiled);
    seedRaster("geo-complex", GDT_CFloat32, none);
#endif
}

}  // namespace

int LLVMFuzzerInitialize(int*, char***) {
    std::string name = (std::filesystem::temp_directory_path() / "soterrain-fuzz-XXXXXX").string();
    fuzz::check(mkdtemp(name.data()), "no temporary folder");
    folder = name;
    if (std::getenv("SOTERRAIN_FUZZ_SEEDS")) writeSeeds();
    return 0;
}

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size <= 1 + kOptionBytes) return 0;
    const std::size_t format = (data[0] & 127) % kExtensionCount;
    const bool isTexture = data[0] & 128;
    const std::string path = folder / (std::string("input.") + kExtensions[format]);
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(data) + 1 + kOptionBytes, std::streamsize(size - 1 - kOptionBytes));
    fuzz::Input input(data + 1, kOptionBytes);
    if (isTexture)
        runTexture(path, input);
    else
        runHeights(path, optionsOf(input));
    return 0;
}
