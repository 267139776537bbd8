#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#ifdef HAVE_SOQT

#include "Settings.h"

#include <algorithm>
#include <vector>

#include <QSettings>

namespace app {

namespace {

const char* const organization = "SoTerrain";
const char* const application = "SoTerrainTest";

QString text(const std::string& bytes) {
    return QString::fromLocal8Bit(bytes.c_str());
}

std::string bytes(const QVariant& value) {
    return value.toString().toLocal8Bit().toStdString();
}

}  // namespace

std::vector<RecentFile> Settings::recentFiles() const {
    std::vector<RecentFile> files;
    if (!active_) return files;
    QSettings store(organization, application);
    const int count = std::min(store.beginReadArray("recent"), mostRecentFiles);
    for (int i = 0; i < count; ++i) {
        store.setArrayIndex(i);
        RecentFile file{bytes(store.value("path")), bytes(store.value("texture")), {}, {}};
        const int columns = store.value("rawColumns").toInt(), rows = store.value("rawRows").toInt();
        if (columns > 1 && rows > 1) file.rawSize = glm::ivec2(columns, rows);
        file.rawType = findRawType(bytes(store.value("rawType")));
        if (!file.path.empty()) files.push_back(file);
    }
    return files;
}

void Settings::writeRecentFiles(const std::vector<RecentFile>& files) {
    QSettings store(organization, application);
    store.remove("recent");
    store.beginWriteArray("recent", int(files.size()));
    for (std::size_t i = 0; i < files.size(); ++i) {
        store.setArrayIndex(int(i));
        store.setValue("path", text(files[i].path));
        if (!files[i].texture.empty()) store.setValue("texture", text(files[i].texture));
        if (files[i].rawSize) {
            store.setValue("rawColumns", files[i].rawSize->x);
            store.setValue("rawRows", files[i].rawSize->y);
        }
        if (files[i].rawType) store.setValue("rawType", rawTypeName(*files[i].rawType));
    }
    store.endArray();
}

void Settings::addRecentFile(const RecentFile& file) {
    if (!active_) return;
    std::vector<RecentFile> files = recentFiles();
    std::erase_if(files, [&](const RecentFile& other) { return other.path == file.path; });
    files.insert(files.begin(), file);
    if (int(files.size()) > mostRecentFiles) files.resize(mostRecentFiles);
    writeRecentFiles(files);
}

void Settings::clearRecentFiles() {
    if (active_) writeRecentFiles({});
}

QByteArray Settings::windowGeometry() const {
    return active_ ? QSettings(organization, application).value("geometry").toByteArray() : QByteArray();
}

void Settings::setWindowGeometry(const QByteArray& geometry) {
    if (active_) QSettings(organization, application).setValue("geometry", geometry);
}

}  // namespace app

#endif
