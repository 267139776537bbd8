#include "OpenFiles.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "ImageFile.h"

namespace app {

namespace {

std::string extensionOf(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return extension;
}

}  // namespace

FileKind fileKind(const std::string& path) {
    const std::string extension = extensionOf(path);
    if (extension == ".iv" || extension == ".wrl") return FileKind::Scene;
    if (isHeaderless(path)) return FileKind::Heights;
    return channelCount(path) >= 3 ? FileKind::Picture : FileKind::Heights;
}

bool isHeaderless(const std::string& path) {
    return extensionOf(path) == ".raw";
}

FilePatterns picturePatterns() {
    return {"Pictures",
            {"*.png", "*.jpg", "*.jpeg", "*.tif", "*.tiff", "*.exr", "*.bmp", "*.tga", "*.ppm", "*.pgm", "*.webp", "*.jp2"}};
}

std::vector<FilePatterns> openablePatterns() {
    FilePatterns images = picturePatterns();
    images.title = "Height maps in images";
    return {
        images,
        {"Rasters and tiled pyramids",
         {"*.tif", "*.tiff", "*.hgt", "*.asc", "*.dem", "*.ddf", "*.vrt", "*.img", "*.bil", "*.flt", "*.adf", "*.grd", "*.nc",
          "*.dt0", "*.dt1", "*.dt2", "*.gpkg", "*.xyz", "*.ter"}},
        {"Headerless heights", {"*.raw"}},
        {"Scenes", {"*.iv", "*.wrl"}},
    };
}

}  // namespace app
