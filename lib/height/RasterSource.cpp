#include "height/RasterSource.h"

#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#ifdef HAVE_GDAL

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <mutex>
#include <vector>

#include <gdal_priv.h>

#include "height/HeightFile.h"

namespace terrain {

namespace {

/// Keeps GDAL's messages of this thread as text instead of printing them, for as long as it lives.
class GdalMessages {
public:
    GdalMessages() { CPLPushErrorHandlerEx(&GdalMessages::receive, this); }
    ~GdalMessages() { CPLPopErrorHandler(); }
    GdalMessages(const GdalMessages&) = delete;
    GdalMessages& operator=(const GdalMessages&) = delete;

    std::string reason() const { return text_.empty() ? "unreadable data" : text_; }

private:
    static void CPL_STDCALL receive(CPLErr level, CPLErrorNum, const char* message) {
        auto* self = static_cast<GdalMessages*>(CPLGetErrorHandlerUserData());
        if (level < CE_Failure || !self->text_.empty()) return;
        self->text_ = message;
        std::replace(self->text_.begin(), self->text_.end(), '\n', ' ');
    }

    std::string text_;
};

struct CloseDataset {
    void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, CloseDataset>;

Dataset openDataset(const std::string& path) {
    static std::once_flag registered;
    std::call_once(registered, GDALAllRegister);
    return Dataset(static_cast<GDALDataset*>(
        GDALOpenEx(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, nullptr, nullptr, nullptr)));
}

/// Where the samples stand: x = x0 + column * dx, y = y0 + row * dy, in pixel centres, rows as in the file.
struct Placement {
    bool known = false;
    double x0 = 0.0, dx = 1.0;
    double y0 = 0.0, dy = -1.0;
};

Result<Placement> placementOf(const std::string& path, GDALDataset& dataset) {
    std::array<double, 6> transform{};
    if (dataset.GetGeoTransform(transform.data()) != CE_None) return Placement{};
    if (transform[2] != 0.0 || transform[4] != 0.0) return Error{path, "a raster whose rows run east", "a rotated geotransform"};
    const double dx = transform[1];
    const double dy = transform[5];
    if (!std::isfinite(dx) || !std::isfinite(dy) || dx == 0.0 || dy == 0.0 || !std::isfinite(transform[0]) ||
        !std::isfinite(transform[3]))
        return Error{path, "pixels with a size", std::to_string(dx) + " x " + std::to_string(dy)};
    return Placement{true, transform[0] + 0.5 * dx, dx, transform[3] + 0.5 * dy, dy};
}

double noDataOf(GDALRasterBand& band, int& found) {
    switch (band.GetRasterDataType()) {
    case GDT_Int64:
        return double(band.GetNoDataValueAsInt64(&found));
    case GDT_UInt64:
        return double(band.GetNoDataValueAsUInt64(&found));
    default:
        return band.GetNoDataValue(&found);
    }
}

void describeSamples(GDALRasterBand& band, HeightMapBuilder& builder) {
    const GDALDataType type = band.GetRasterDataType();
    builder.setFloatingPoint(type == GDT_Float32 || type == GDT_Float64);
    int found = 0;
    const double noData = noDataOf(band, found);
    if (found) builder.setFileNoData(noData);
    int hasScale = 0;
    int hasOffset = 0;
    const double scale = band.GetScale(&hasScale);
    const double offset = band.GetOffset(&hasOffset);
    builder.setFileScale(hasScale ? scale : 1.0, hasOffset ? offset : 0.0);
}

/// Rows go to the builder from north to south and from west to east, whichever way the file has them. False when the file does not
/// give one.
bool readBand(GDALDataset& dataset, GDALRasterBand& band, const Placement& place, HeightMapBuilder& builder) {
    const int columns = band.GetXSize();
    const int rows = band.GetYSize();
    constexpr int leastFlushed = 16;
    int blockColumns = 0, blockRows = 1, flushed = 0;
    band.GetBlockSize(&blockColumns, &blockRows);
    std::vector<double> samples(static_cast<std::size_t>(columns));
    for (int i = 0; i < rows; ++i) {
        const int row = place.dy < 0.0 ? i : rows - 1 - i;
        if (band.RasterIO(GF_Read, 0, row, columns, 1, samples.data(), columns, 1, GDT_Float64, 0, 0, nullptr) != CE_None)
            return false;
        if (place.dx < 0.0) std::reverse(samples.begin(), samples.end());
        if (!builder.appendRow(samples.data())) break;
        // GDAL keeps blocks up to a share of the machine's memory; no row of blocks is needed twice.
        const int next = place.dy < 0.0 ? row + 1 : row - 1;
        if (next / blockRows != row / blockRows && i - flushed >= leastFlushed) {
            dataset.FlushCache(false);
            flushed = i;
        }
    }
    return true;
}

void georeference(HeightMap& map, const Placement& place, GDALDataset& dataset) {
    if (place.known) {
        map.spacing = {std::abs(place.dx), std::abs(place.dy)};
        map.origin = {place.dx > 0.0 ? place.x0 : place.x0 + (map.columns - 1) * place.dx,
                      place.dy > 0.0 ? place.y0 : place.y0 + (map.rows - 1) * place.dy};
    }
    const char* projection = dataset.GetProjectionRef();
    if (projection) map.projection = projection;
}

/// An image with a palette has its colours in the table and only indices in the band; a georeferenced raster has values in it.
bool isPaletteImage(const Placement& place, GDALRasterBand& band) {
    return !place.known && band.GetColorTable();
}

}  // namespace

bool hasRasterReader() {
    return true;
}

QuietRasterLibrary::QuietRasterLibrary() {
    CPLPushErrorHandler(CPLQuietErrorHandler);
}
QuietRasterLibrary::~QuietRasterLibrary() {
    CPLPopErrorHandler();
}

bool isGeoreferenced(const std::string& path) {
    const GdalMessages messages;
    const Dataset dataset = openDataset(path);
    std::array<double, 6> transform{};
    return dataset && dataset->GetRasterCount() > 0 && dataset->GetGeoTransform(transform.data()) == CE_None;
}

std::optional<std::string> whyNotARaster(const std::string& path) {
    const GdalMessages messages;
    if (openDataset(path)) return std::nullopt;
    return messages.reason();
}

Result<HeightMap> readRaster(const std::string& path, const HeightFileOptions& options) {
    const GdalMessages messages;
    const Dataset dataset = openDataset(path);
    if (!dataset) return Error{path, "a raster that GDAL reads", messages.reason()};
    if (dataset->GetRasterCount() < 1) return Error{path, "a raster with a band", "none"};
    const auto channel = chooseChannel(path, dataset->GetRasterCount(), options);
    if (!channel) return channel.error();
    const auto place = placementOf(path, *dataset);
    if (!place) return place.error();
    GDALRasterBand& band = *dataset->GetRasterBand(channel.value() + 1);
    if (GDALDataTypeIsComplex(band.GetRasterDataType())) return Error{path, "real numbers as samples", "complex ones"};
    if (isPaletteImage(place.value(), band)) return Error{path, "a grey image", "a palette of colours"};

    auto builder = HeightMapBuilder::create(path, band.GetXSize(), band.GetYSize(), options);
    if (!builder) return builder.error();
    describeSamples(band, builder.value());
    if (!readBand(*dataset, band, place.value(), builder.value())) return Error{path, "a complete raster", messages.reason()};
    auto map = std::move(builder).value().finish();
    if (map) georeference(map.value(), place.value(), *dataset);
    return map;
}

}  // namespace terrain

#else

namespace terrain {

bool hasRasterReader() {
    return false;
}

QuietRasterLibrary::QuietRasterLibrary() = default;
QuietRasterLibrary::~QuietRasterLibrary() = default;

bool isGeoreferenced(const std::string&) {
    return false;
}

std::optional<std::string> whyNotARaster(const std::string&) {
    return "this build lacks GDAL";
}

Result<HeightMap> readRaster(const std::string& path, const HeightFileOptions&) {
    return Error{path, "a build with GDAL", "one that lacks it"};
}

}  // namespace terrain

#endif
