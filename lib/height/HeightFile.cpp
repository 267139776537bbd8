#include "height/HeightFile.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <exception>
#include <filesystem>
#include <limits>
#include <new>

#include "height/ImageSource.h"
#include "height/RasterSource.h"
#include "height/RawSource.h"

namespace terrain {

Result<int> chooseChannel(const std::string& path, int channelCount, const HeightFileOptions& options) {
    const std::string count = std::to_string(channelCount) + (channelCount == 1 ? " channel" : " channels");
    if (options.channel < -1 || options.channel >= channelCount)
        return Error{path, "channel to be from 0 to " + std::to_string(channelCount - 1) + ", or -1 for the only one",
                     "channel " + std::to_string(options.channel) + " of " + count};
    if (options.channel >= 0) return options.channel;
    if (channelCount >= 3) return Error{path, "one channel of heights, or the option channel to choose one", count};
    return 0;
}

Result<HeightMapBuilder> HeightMapBuilder::create(const std::string& path, std::int64_t columns, std::int64_t rows,
                                                  const HeightFileOptions& options) {
    const std::string size = std::to_string(columns) + " x " + std::to_string(rows);
    if (columns < 2 || rows < 2) return Error{path, "at least 2 x 2 samples", size};
    constexpr std::int64_t longest = std::numeric_limits<int>::max();
    if (columns > longest || rows > longest || std::uint64_t(columns) * std::uint64_t(rows) > options.maximumSamples)
        return Error{path, "at most " + std::to_string(options.maximumSamples) + " samples, and " + std::to_string(longest) + " a side",
                     size};
    HeightMapBuilder builder;
    builder.map_.columns = int(columns);
    builder.map_.rows = int(rows);
    builder.missingRows_ = int(rows);
    builder.row_.resize(std::size_t(columns));
    const std::uint64_t count = std::uint64_t(columns) * std::uint64_t(rows);
    if (count > options.samplesInMemory) {
        auto scratch = ScratchWriter::create(path, count);
        if (!scratch) return scratch.error();
        builder.scratch_ = std::move(scratch).value();
    } else {
        builder.map_.heights.reserve(std::size_t(count));
    }
    builder.progress_ = options.progress;
    builder.heightScale_ = options.heightScale;
    builder.heightOffset_ = options.heightOffset;
    if (options.noData) builder.noData_.push_back(*options.noData);
    return builder;
}

void HeightMapBuilder::setFileScale(double scale, double offset) {
    fileScale_ = scale;
    fileOffset_ = offset;
}

void HeightMapBuilder::setFileNoData(double value) {
    noData_.push_back(value);
}

bool HeightMapBuilder::isHole(double sample) const {
    return std::any_of(noData_.begin(), noData_.end(),
                       [&](double value) { return sample == value || (floatingPoint_ && float(sample) == float(value)); });
}

bool HeightMapBuilder::appendRow(const double* samples) {
    constexpr float hole = std::numeric_limits<float>::quiet_NaN();
    for (int column = 0; column < map_.columns; ++column) {
        const double sample = samples[column];
        const double height = (sample * fileScale_ + fileOffset_) * heightScale_ + heightOffset_;
        const bool valid = std::abs(height) <= double(std::numeric_limits<float>::max()) && !isHole(sample);
        row_[std::size_t(column)] = valid ? float(height) : hole;
    }
    --missingRows_;
    if (!scratch_)
        for (const float height : row_) map_.heights.push_back(height);
    else if (!problem_)
        problem_ = scratch_->write(std::uint64_t(missingRows_) * row_.size(), row_.data(), row_.size());
    if (progress_) tellProgress();
    return !problem_;
}

void HeightMapBuilder::tellProgress() {
    progress_->part = 1.0f - float(missingRows_) / float(map_.rows);
    if (progress_->isCancelled && !problem_) problem_ = Error{"height map", "to be read to its end", "that it was cancelled"};
}

Result<HeightMap> HeightMapBuilder::finish() && {
    if (problem_) return *problem_;
    if (scratch_) {
        auto heights = std::move(*scratch_).finish();
        if (!heights) return heights.error();
        map_.heights = std::move(heights).value();
        return std::move(map_);
    }
    float* const heights = map_.heights.data();
    const std::size_t columns = row_.size();
    for (std::size_t south = 0, north = std::size_t(map_.rows) - 1; south < north; ++south, --north)
        std::swap_ranges(heights + south * columns, heights + (south + 1) * columns, heights + north * columns);
    return std::move(map_);
}

namespace {

bool isRaw(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return extension == ".raw";
}

std::optional<Error> problemOf(const std::string& path, const HeightFileOptions& options) {
    const auto text = [](glm::dvec2 v) { return std::to_string(v.x) + " " + std::to_string(v.y); };
    if (options.spacing &&
        !(options.spacing->x > 0.0 && options.spacing->y > 0.0 && std::isfinite(options.spacing->x + options.spacing->y)))
        return Error{path, "spacing above 0", text(*options.spacing)};
    if (options.origin && !std::isfinite(options.origin->x + options.origin->y))
        return Error{path, "an origin of two numbers", text(*options.origin)};
    if (!std::isfinite(options.heightScale) || !std::isfinite(options.heightOffset))
        return Error{path, "height scale and offset to be numbers",
                     std::to_string(options.heightScale) + " and " + std::to_string(options.heightOffset)};
    return std::nullopt;
}

Result<HeightMap> readAny(const std::string& path, const HeightFileOptions& options) {
    if (isRaw(path)) return readRaw(path, options);
    const QuietRasterLibrary quiet;
    if (isGeoreferenced(path)) return readRaster(path, options);
    const auto imageReason = whyNotAnImage(path);
    if (!imageReason) return readImage(path, options);
    const auto rasterReason = whyNotARaster(path);
    if (!rasterReason) return readRaster(path, options);
    return Error{path, "a .raw file, or one that OpenImageIO or GDAL reads", *imageReason + "; " + *rasterReason};
}

Result<HeightMap> readChecked(const std::string& path, const HeightFileOptions& options) {
    std::error_code failure;
    const auto status = std::filesystem::status(path, failure);
    if (status.type() == std::filesystem::file_type::not_found) return Error{path, "a height map", "no such file"};
    if (failure) return Error{path, "a height map", failure.message()};
    if (const auto problem = problemOf(path, options)) return *problem;
    auto map = readAny(path, options);
    if (!map) return map.error();
    if (options.spacing) map.value().spacing = *options.spacing;
    if (options.origin) map.value().origin = *options.origin;
    return map;
}

}  // namespace

Result<std::shared_ptr<const HeightSource>> openHeightFile(const std::string& path, const HeightFileOptions& options) {
    auto map = readHeightFile(path, options);
    if (!map) return map.error();
    return makeMapSource(std::move(map).value());
}

Result<HeightMap> readHeightFile(const std::string& path, const HeightFileOptions& options) {
    try {
        return readChecked(path, options);
    } catch (const std::bad_alloc&) {
        return Error{path, "a height map that fits into memory", "too little memory"};
    } catch (const std::exception& exception) {
        return Error{path, "a readable height map", exception.what()};
    }
}

}  // namespace terrain
