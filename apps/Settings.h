// What the program remembers from one start to the next.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <QByteArray>
#include <glm/vec2.hpp>

#include "Options.h"

namespace app {

/// A file that was opened, and how.
struct RecentFile {
    std::string path;     ///< absolute
    std::string texture;  ///< absolute; empty: none
    std::optional<glm::ivec2> rawSize;
    std::optional<terrain::RawType> rawType;
};

/// In the user's configuration files. When inactive, nothing is read or written, and what is asked for has its defaults.
class Settings {
public:
    explicit Settings(bool active) : active_(active) {}

    std::vector<RecentFile> recentFiles() const;  ///< latest first
    void addRecentFile(const RecentFile& file);
    void clearRecentFiles();
    QByteArray windowGeometry() const;
    void setWindowGeometry(const QByteArray& geometry);

    /// Algorithm, error and sizes of a height map.
    void keep(const Options& options);
    /// The same, where the options do not say.
    void recall(Options& options) const;

    static constexpr int mostRecentFiles = 8;

private:
    void writeRecentFiles(const std::vector<RecentFile>& files);

    bool active_;
};

}  // namespace app
