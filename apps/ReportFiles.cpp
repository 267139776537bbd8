#include "ReportFiles.h"

#include <stdlib.h>

#include <cerrno>
#include <cstring>
#include <fstream>

namespace app {

namespace fs = std::filesystem;
using terrain::Error;
using terrain::Result;

Result<ReportFolder> ReportFolder::make(const std::string& folder) {
    std::error_code problem;
    const bool made = fs::create_directories(folder, problem);
    if (problem) return Error{folder, "a folder that can be written", problem.message()};
    std::string work = fs::absolute(fs::path(folder) / ".soterrain-report-XXXXXX").string();
    if (!mkdtemp(work.data())) return Error{folder, "a folder that can be written", std::strerror(errno)};
    return ReportFolder(folder, work, made);
}

ReportFolder::ReportFolder(ReportFolder&& other) noexcept
    : folder_(std::move(other.folder_)), work_(std::exchange(other.work_, {})), made_(other.made_) {}

ReportFolder::~ReportFolder() {
    if (work_.empty()) return;
    std::error_code ignored;
    fs::remove_all(work_, ignored);
    // Not when a report is in it.
    if (made_) fs::remove(folder_, ignored);
}

std::optional<Error> ReportFolder::write(const std::vector<std::pair<std::string, std::string>>& files) const {
    for (const auto& [name, text] : files) {
        std::ofstream file(work_ + '/' + name, std::ios::trunc | std::ios::binary);
        file << text;
        file.close();
        if (!file) return Error{folder_ + '/' + name, "a file that can be written", "no permission or no space"};
        if (fs::is_directory(fs::path(folder_) / name))
            return Error{folder_ + '/' + name, "a file that can be written", "a folder"};
    }
    for (const auto& [name, text] : files) {
        std::error_code problem;
        fs::rename(work_ + '/' + name, fs::path(folder_) / name, problem);
        if (problem) return Error{folder_ + '/' + name, "a file that can be written", problem.message()};
    }
    return std::nullopt;
}

}  // namespace app
