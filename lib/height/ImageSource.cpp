#include "height/ImageSource.h"

#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#ifdef HAVE_OPENIMAGEIO

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <memory>
#include <string_view>
#include <vector>

#include <OpenImageIO/imageio.h>

#include "height/HeightFile.h"

namespace terrain {

namespace {

/// OpenImageIO's reason in one line.
std::string reason(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    while (!text.empty() && text.back() == ' ') text.pop_back();
    return text.empty() ? "unreadable data" : text;
}

std::unique_ptr<OIIO::ImageInput> openInput(const std::string& path) {
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    config.attribute("oiio:RawColor", 1);
    auto input = OIIO::ImageInput::open(path, &config);
    // All work in the calling thread, where the error output of libraries below can be held back.
    if (input) input->threads(1);
    return input;
}

template <class T>
void widen(const void* from, std::vector<double>& to) {
    const T* samples = static_cast<const T*>(from);
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = double(samples[i]);
}

/// Samples of `type` as doubles. False for a type that has no number.
bool toDoubles(OIIO::TypeDesc type, const void* from, std::vector<double>& to) {
    switch (type.basetype) {
    case OIIO::TypeDesc::UINT8:
        widen<std::uint8_t>(from, to);
        return true;
    case OIIO::TypeDesc::INT8:
        widen<std::int8_t>(from, to);
        return true;
    case OIIO::TypeDesc::UINT16:
        widen<std::uint16_t>(from, to);
        return true;
    case OIIO::TypeDesc::INT16:
        widen<std::int16_t>(from, to);
        return true;
    case OIIO::TypeDesc::UINT32:
        widen<std::uint32_t>(from, to);
        return true;
    case OIIO::TypeDesc::INT32:
        widen<std::int32_t>(from, to);
        return true;
    case OIIO::TypeDesc::UINT64:
        widen<std::uint64_t>(from, to);
        return true;
    case OIIO::TypeDesc::INT64:
        widen<std::int64_t>(from, to);
        return true;
    case OIIO::TypeDesc::FLOAT:
        widen<float>(from, to);
        return true;
    case OIIO::TypeDesc::DOUBLE:
        widen<double>(from, to);
        return true;
    default:
        return false;
    }
}

/// Whether the compressed data of a JPEG file end. Its decoder fills the rest of a truncated picture with grey and reports nothing.
/// Compressed data hold no FF byte without a following 0, so the last end marker has to stand behind the last start of a scan.
bool jpegEnds(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::vector<char> bytes(std::size_t(1) << 16);
    bool ended = false, marker = false;
    do {
        file.read(bytes.data(), std::streamsize(bytes.size()));
        for (const char* byte = bytes.data(); byte != bytes.data() + file.gcount(); ++byte) {
            if (marker && *byte == '\xD9') ended = true;
            if (marker && *byte == '\xDA') ended = false;
            marker = *byte == '\xFF';
        }
    } while (file);
    return ended;
}

/// Whether a PNG file goes on to its last chunk. Its decoder would report a missing end too, but on the error output and leaking
/// memory.
bool pngEnds(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    file.seekg(8);
    for (std::array<unsigned char, 8> head; file.read(reinterpret_cast<char*>(head.data()), head.size());) {
        if (std::equal(head.begin() + 4, head.end(), "IEND")) return true;
        const std::int64_t length = std::int64_t(head[0]) << 24 | head[1] << 16 | head[2] << 8 | head[3];
        constexpr std::int64_t checksum = 4;
        file.seekg(length + checksum, std::ios::cur);
    }
    return false;
}

std::string sizeText(int width, int height, int depth) {
    return std::to_string(width) + "x" + std::to_string(height) + "x" + std::to_string(depth);
}

/// Whether an image of such a size has texels, and not more tiles than an int counts, be they its own or of 64 x 64 texels. Its full size, of
/// which the texels are a window, counts as well: coarser levels that a cache makes are of that.
bool isSized(const OIIO::ImageSpec& spec) {
    constexpr std::int64_t least = 64, most = std::int64_t(1) << 30;
    if (spec.width < 1 || spec.height < 1 || spec.depth < 1 || spec.nchannels < 1) return false;
    if (spec.tile_width < 0 || spec.tile_height < 0 || spec.tile_depth < 0) return false;
    const auto tiles = [](std::int64_t length, std::int64_t side) { return side > 0 ? (length + side - 1) / side : 1; };
    const auto count = [&](int width, int height, int depth) {
        const std::int64_t area = tiles(std::max(spec.width, spec.full_width), width) * tiles(std::max(spec.height, spec.full_height), height);
        return area < most ? area * tiles(spec.depth, depth) : most;
    };
    return count(least, least, 1) < most && (spec.tile_width == 0 || count(spec.tile_width, spec.tile_height, spec.tile_depth) < most);
}

/// Reads `count` rows of one channel, counted from the top, as `type`.
bool readRows(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, int channel, OIIO::TypeDesc type, int firstRow, int count,
              void* rows) {
    const int begin = spec.y + firstRow;
    if (spec.tile_width > 0)
        return input.read_tiles(0, 0, spec.x, spec.x + spec.width, begin, begin + count, 0, 1, channel, channel + 1, type, rows);
    return input.read_scanlines(0, 0, begin, begin + count, 0, channel, channel + 1, type, rows);
}

Result<HeightMap> decode(const std::string& path, OIIO::ImageInput& input, const OIIO::ImageSpec& spec, int channel,
                         const HeightFileOptions& options) {
    auto builder = HeightMapBuilder::create(path, spec.width, spec.height, options);
    if (!builder) return builder.error();
    // In the channel's own type nothing is converted, hence nothing is normalised; every half is a float.
    OIIO::TypeDesc type = spec.channelformat(channel);
    if (type == OIIO::TypeDesc::HALF) type = OIIO::TypeDesc::FLOAT;
    builder.value().setFloatingPoint(type.is_floating_point());

    const int chunk = spec.tile_width > 0 ? spec.tile_height : 64;
    const std::size_t rowBytes = std::size_t(spec.width) * type.size();
    std::vector<unsigned char> bytes(rowBytes * std::size_t(std::min(chunk, spec.height)));
    std::vector<double> samples(std::size_t(spec.width));
    for (int row = 0; row < spec.height; row += std::min(chunk, spec.height - row)) {
        const int count = std::min(chunk, spec.height - row);
        if (!readRows(input, spec, channel, type, row, count, bytes.data()) || input.has_error())
            return Error{path, "a complete image", reason(input.geterror())};
        for (int i = 0; i < count; ++i) {
            if (!toDoubles(type, bytes.data() + std::size_t(i) * rowBytes, samples))
                return Error{path, "numbers as samples", std::string("type ") + type.c_str()};
            if (!builder.value().appendRow(samples.data())) return std::move(builder).value().finish();
        }
    }
    return std::move(builder).value().finish();
}

}  // namespace

bool hasImageReader() {
    return true;
}

std::optional<std::string> whyNotAnImage(const std::string& path) {
    if (openInput(path)) return std::nullopt;
    return reason(OIIO::geterror());
}

bool imageEnds(const std::string& path, std::string_view format) {
    return format == "jpeg" ? jpegEnds(path) : format != "png" || pngEnds(path);
}

std::optional<std::string> whyNotSized(const std::string& path) {
    const auto input = openInput(path);
    if (!input) return reason(OIIO::geterror());
    for (int image = 0; input->seek_subimage(image, 0); ++image)
        for (int level = 0; input->seek_subimage(image, level); ++level)
            if (const OIIO::ImageSpec spec = input->spec(); !isSized(spec))
                return sizeText(spec.width, spec.height, spec.depth) + " texels of " + sizeText(spec.full_width, spec.full_height, spec.full_depth) +
                       ", tiles of " + sizeText(spec.tile_width, spec.tile_height, spec.tile_depth);
    return std::nullopt;
}

Result<HeightMap> readImage(const std::string& path, const HeightFileOptions& options) {
    const auto input = openInput(path);
    if (!input) return Error{path, "an image that OpenImageIO reads", reason(OIIO::geterror())};
    const OIIO::ImageSpec spec = input->spec();
    if (spec.deep || spec.depth > 1) return Error{path, "a flat image", spec.deep ? "a deep image" : "a volume"};
    const auto channel = chooseChannel(path, spec.nchannels, options);
    if (!channel) return channel.error();
    if (!imageEnds(path, input->format_name())) return Error{path, "a complete image", "a file that ends too early"};
    return decode(path, *input, spec, channel.value(), options);
}

}  // namespace terrain

#else

namespace terrain {

bool hasImageReader() {
    return false;
}

bool imageEnds(const std::string&, std::string_view) {
    return true;
}

std::optional<std::string> whyNotAnImage(const std::string&) {
    return "this build lacks OpenImageIO";
}

std::optional<std::string> whyNotSized(const std::string&) {
    return "this build lacks OpenImageIO";
}

Result<HeightMap> readImage(const std::string& path, const HeightFileOptions&) {
    return Error{path, "a build with OpenImageIO", "one that lacks it"};
}

}  // namespace terrain

#endif
