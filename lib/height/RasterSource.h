// Heights from georeferenced rasters, through GDAL.
#pragma once

#include <optional>
#include <string>

#include "base/Result.h"
#include "height/HeightMap.h"
#include "height/HeightSource.h"

namespace terrain {

/// Whether this build has GDAL. Without it the functions below only report that.
bool hasRasterReader();

/// As long as it lives, GDAL prints nothing from this thread. That goes for libtiff as well, which hands its errors to GDAL as soon
/// as both are in one process, whoever called it.
class QuietRasterLibrary {
public:
    QuietRasterLibrary();
    ~QuietRasterLibrary();
    QuietRasterLibrary(const QuietRasterLibrary&) = delete;
    QuietRasterLibrary& operator=(const QuietRasterLibrary&) = delete;
};

/// Whether GDAL opens the file and finds its place on the earth (a geotransform).
bool isGeoreferenced(const std::string& path);

/// Nothing when GDAL recognises the file, else its reason.
std::optional<std::string> whyNotARaster(const std::string& path);

/// Reads one band of a raster: `options.channel` (from 0), or the first one of one or two.
///
/// Spacing and origin come from the geotransform, in the units of the raster's coordinate system: for a raster in degrees they are
/// degrees, whatever the unit of the heights is. Spacing is positive, the origin is the centre of the south-western pixel. Without
/// a geotransform spacing is (1, 1) and the origin (0, 0). The band's scale, offset and no-data value are applied, its projection
/// kept. Error: unreadable or truncated file with GDAL's reason, rotated raster, complex numbers, three or more bands and none
/// chosen.
Result<HeightMap> readRaster(const std::string& path, const HeightFileOptions& options);

}  // namespace terrain
