// The files of a report, all or none.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/Result.h"

namespace app {

/// A folder for the time of a report within the folder that the report is for; goes with everything in it.
class ReportFolder {
public:
    /// Makes both. Error: a folder that can't be made or written.
    static terrain::Result<ReportFolder> make(const std::string& folder);
    ReportFolder(ReportFolder&& other) noexcept;
    ReportFolder& operator=(ReportFolder&&) = delete;
    ~ReportFolder();

    const std::string& work() const { return work_; }
    /// Writes files, given as name and contents, beside each other and gives them their names when all are there, in this order.
    /// Those of a former report are replaced. Returns what went wrong, if anything did; then nothing has changed.
    std::optional<terrain::Error> write(const std::vector<std::pair<std::string, std::string>>& files) const;

private:
    ReportFolder(std::string folder, std::string work, bool made)
        : folder_(std::move(folder)), work_(std::move(work)), made_(made) {}

    std::string folder_;
    std::string work_;
    bool made_ = false;  ///< the folder was not there before: it goes, too, while it is empty
};

}  // namespace app
