#include "height/RawSource.h"

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <vector>

#include "height/HeightFile.h"

namespace terrain {

namespace {

std::uint64_t bytesPerSample(RawType type) {
    return type == RawType::UInt8 ? 1 : 2;
}

const char* nameOf(RawType type) {
    return type == RawType::UInt8 ? "8 bits" : "16 bits";
}

/// Largest whole number whose square is at most `value`.
std::uint64_t wholeRoot(std::uint64_t value) {
    auto root = std::uint64_t(std::sqrt(double(value)));
    while (root > value / (root ? root : 1)) --root;
    while ((root + 1) <= value / (root + 1)) ++root;
    return root;
}

struct RawSize {
    std::int64_t columns;
    std::int64_t rows;
};

Result<RawSize> sizeOf(const std::string& path, std::uint64_t length, const HeightFileOptions& options) {
    const std::uint64_t width = bytesPerSample(options.rawType);
    const glm::ivec2 size = options.rawSize;
    if (size == glm::ivec2(0, 0)) {
        const std::uint64_t side = wholeRoot(length / width);
        if (side * side * width != length)
            return Error{path, std::string("a square of ") + nameOf(options.rawType) + " a sample, or its size given",
                         std::to_string(length) + " bytes"};
        return RawSize{std::int64_t(side), std::int64_t(side)};
    }
    const std::string given = std::to_string(size.x) + " x " + std::to_string(size.y);
    if (size.x < 2 || size.y < 2) return Error{path, "a raw size of at least 2 x 2, or 0 x 0 for a square", given};
    const std::uint64_t expected = std::uint64_t(size.x) * std::uint64_t(size.y) * width;
    if (expected != length)
        return Error{path, std::to_string(expected) + " bytes for " + given + " samples of " + nameOf(options.rawType),
                     std::to_string(length) + " bytes"};
    return RawSize{size.x, size.y};
}

void decodeRow(const std::vector<unsigned char>& bytes, RawType type, std::vector<double>& samples) {
    if (type == RawType::UInt8) {
        for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = bytes[i];
        return;
    }
    const std::size_t low = type == RawType::UInt16LittleEndian ? 0 : 1;
    for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = bytes[2 * i + low] + 256.0 * bytes[2 * i + 1 - low];
}

}  // namespace

Result<HeightMap> readRaw(const std::string& path, const HeightFileOptions& options) {
    std::error_code failure;
    const std::uint64_t length = std::filesystem::file_size(path, failure);
    if (failure) return Error{path, "a readable file", failure.message()};
    const auto size = sizeOf(path, length, options);
    if (!size) return size.error();
    auto builder = HeightMapBuilder::create(path, size.value().columns, size.value().rows, options);
    if (!builder) return builder.error();

    std::ifstream file(path, std::ios::binary);
    if (!file) return Error{path, "a readable file", "no permission to read it"};
    std::vector<double> samples(std::size_t(size.value().columns));
    std::vector<unsigned char> bytes(samples.size() * bytesPerSample(options.rawType));
    for (std::int64_t row = 0; row < size.value().rows; ++row) {
        if (!file.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size())))
            return Error{path, std::to_string(length) + " bytes", "an end of data in row " + std::to_string(row)};
        decodeRow(bytes, options.rawType, samples);
        if (!builder.value().appendRow(samples.data())) break;
    }
    return std::move(builder).value().finish();
}

}  // namespace terrain
