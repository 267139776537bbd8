#include "ShippedData.h"

#include <filesystem>

namespace app {

std::string findShipped(const std::string& name) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    const fs::path path(name);
    if (name.empty() || path.is_absolute() || fs::exists(path, ignored)) return name;
    return installedFile(name).value_or(name);
}

std::optional<std::string> installedFile(const std::string& name) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    const fs::path installed = fs::path(SOTERRAIN_DATADIR) / name;
    return fs::exists(installed, ignored) ? std::optional(installed.string()) : std::nullopt;
}

}  // namespace app
