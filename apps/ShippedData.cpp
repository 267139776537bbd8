#include "ShippedData.h"

#include <filesystem>

namespace app {

std::string findShipped(const std::string& name) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    const fs::path path(name);
    if (name.empty() || path.is_absolute() || fs::exists(path, ignored)) return name;
    const fs::path installed = fs::path(SOTERRAIN_DATADIR) / path;
    return fs::exists(installed, ignored) ? installed.string() : name;
}

}  // namespace app
