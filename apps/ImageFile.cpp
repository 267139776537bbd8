#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include "ImageFile.h"

#include <algorithm>
#include <fstream>

#ifdef HAVE_OPENIMAGEIO
#include <OpenImageIO/imageio.h>
#endif

namespace app {

using terrain::Error;
using terrain::Image;
using terrain::Result;

namespace {

constexpr int sideLimit = 32767;  // the most that SbVec2s holds

std::optional<Error> writePpm(const std::string& path, const Image& image) {
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file << "P6\n" << image.width << ' ' << image.height << "\n255\n";
    file.write(reinterpret_cast<const char*>(image.pixels.data()), std::streamsize(image.pixels.size()));
    file.close();
    if (file) return std::nullopt;
    return Error{path, "a file that can be written", "no permission, no such folder or no space"};
}

#ifndef HAVE_OPENIMAGEIO
Result<Image> readPnm(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) return Error{path, "a readable picture", "no such file, or no permission"};
    std::string magic;
    int limit = 0;
    Image image;
    file >> magic >> image.width >> image.height >> limit;
    file.get();
    const bool known = file && (magic == "P5" || magic == "P6") && limit == 255;
    if (!known || image.width < 1 || image.height < 1 || image.width > sideLimit || image.height > sideLimit) {
        return Error{path, "a binary PPM or PGM with 8 bits (this build has no OpenImageIO)", "another format"};
    }
    image.channels = magic == "P5" ? 1 : 3;
    image.pixels.resize(std::size_t(image.width) * std::size_t(image.height) * std::size_t(image.channels));
    file.read(reinterpret_cast<char*>(image.pixels.data()), std::streamsize(image.pixels.size()));
    if (!file) return Error{path, std::to_string(image.pixels.size()) + " bytes of pixels", std::to_string(file.gcount())};
    return image;
}
#endif

}  // namespace

#ifdef HAVE_OPENIMAGEIO

Result<Image> readImage(const std::string& path) {
    if (!std::ifstream(path)) return Error{path, "a readable picture", "no such file, or no permission"};
    const auto input = OIIO::ImageInput::open(path);
    if (!input) return Error{path, "a picture", OIIO::geterror()};
    const OIIO::ImageSpec& spec = input->spec();
    if (spec.width < 1 || spec.height < 1 || spec.width > sideLimit || spec.height > sideLimit || spec.nchannels < 1) {
        return Error{path, "at most 32767 pixels a side", std::to_string(spec.width) + "x" + std::to_string(spec.height)};
    }
    Image image{spec.width, spec.height, std::min(spec.nchannels, 4), {}};
    const std::size_t pixel = std::size_t(image.channels);
    image.pixels.resize(std::size_t(image.width) * std::size_t(image.height) * pixel);
    if (!input->read_image(0, 0, 0, image.channels, OIIO::TypeDesc::UINT8, image.pixels.data())) {
        return Error{path, "all of its pixels", input->geterror()};
    }
    return image;
}

bool picturesAreCompressed() {
    return true;
}

int channelCount(const std::string& path) {
    const auto input = OIIO::ImageInput::open(path);
    if (!input) OIIO::geterror();  // or it is complained about at the end
    return input ? input->spec().nchannels : 0;
}

std::optional<Error> writeImage(const std::string& path, const Image& image, int quality) {
    if (path.ends_with(".ppm")) return writePpm(path, image);
    const auto output = OIIO::ImageOutput::create(path);
    if (!output) return Error{path, "the name of a picture, such as .png, .jpg or .ppm", OIIO::geterror()};
    OIIO::ImageSpec spec(image.width, image.height, image.channels, OIIO::TypeDesc::UINT8);
    if (quality > 0) spec.attribute("CompressionQuality", quality);
    const bool written = output->open(path, spec) && output->write_image(OIIO::TypeDesc::UINT8, image.pixels.data());
    if (written && output->close()) return std::nullopt;
    return Error{path, "a file that can be written", output->geterror()};
}

#else

Result<Image> readImage(const std::string& path) {
    return readPnm(path);
}

bool picturesAreCompressed() {
    return false;
}

int channelCount(const std::string& path) {
    const auto read = readPnm(path);
    return read ? read.value().channels : 0;
}

std::optional<Error> writeImage(const std::string& path, const Image& image, int) {
    if (path.ends_with(".ppm")) return writePpm(path, image);
    return Error{path, "a name that ends in .ppm (this build has no OpenImageIO)", "another one"};
}

#endif

}  // namespace app
