#include "NumberedFile.h"

#include <algorithm>
#include <filesystem>
#include <utility>

namespace app {

namespace {

std::string numbered(const std::string& stem, int number) {
    return number == 1 ? stem : stem + "-" + std::to_string(number);
}

bool exists(const std::string& name) {
    std::error_code ignored;
    return std::filesystem::exists(std::filesystem::symlink_status(name, ignored));
}

}  // namespace

std::string freeStem(const std::string& stem, const std::vector<std::string>& endings) {
    for (int number = 1;; ++number) {
        const std::string candidate = numbered(stem, number);
        if (std::none_of(endings.begin(), endings.end(), [&](const std::string& ending) { return exists(candidate + ending); }))
            return candidate;
    }
}

std::optional<std::string> latestFile(const std::string& stem, const std::string& ending) {
    namespace fs = std::filesystem;
    const fs::path parent = fs::path(stem).parent_path(), folder = parent.empty() ? fs::path(".") : parent;
    const std::string name = fs::path(stem).filename().string();
    const auto isOurs = [&](const std::string& file) {
        if (!file.starts_with(name) || !file.ends_with(ending) || file.size() < name.size() + ending.size()) return false;
        const std::string middle = file.substr(name.size(), file.size() - name.size() - ending.size());
        return middle.empty() ||
               (middle.size() > 1 && middle[0] == '-' && middle.find_first_not_of("0123456789", 1) == middle.npos);
    };
    std::optional<std::pair<fs::file_time_type, std::string>> latest;
    std::error_code ignored;
    for (fs::directory_iterator entry(folder, ignored), end; entry != end; entry.increment(ignored)) {
        const std::string file = entry->path().filename().string();
        if (!isOurs(file) || !entry->is_regular_file(ignored)) continue;
        const std::pair found(entry->last_write_time(ignored), (parent / file).string());
        if (!latest || found > *latest) latest = found;
    }
    return latest ? std::optional(latest->second) : std::nullopt;
}

}  // namespace app
