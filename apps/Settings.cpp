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

// The whole numbers among them, by the name of the field.
struct Number {
    const char* name;
    std::optional<int> Options::*value;
};
constexpr Number numbers[] = {
    {"triangleCount", &Options::triangleCount}, {"tileSize", &Options::tileSize},         {"clipmapSize", &Options::clipmapSize},
    {"levels", &Options::clipmapLevels},        {"detailLevels", &Options::detailLevels},
};

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

void Settings::keep(const Options& options) {
    if (!active_) return;
    QSettings store(organization, application);
    store.beginGroup("terrain");
    store.remove("");
    if (options.algorithm) store.setValue("algorithm", text(std::string(options.algorithm->name)));
    if (options.pixelError) store.setValue("pixelError", *options.pixelError);
    store.setValue("frustumCulling", options.frustumCulling);
    for (const Number& number : numbers) {
        if (const auto& value = options.*number.value) store.setValue(number.name, *value);
    }
}

void Settings::recall(Options& options) const {
    if (!active_) return;
    QSettings store(organization, application);
    store.beginGroup("terrain");
    if (!options.algorithm) options.algorithm = findAlgorithm(bytes(store.value("algorithm")));
    bool isNumber = false;
    const double error = store.value("pixelError").toDouble(&isNumber);
    if (!options.pixelError && isNumber && error >= 0.0 && error < 1000.0) options.pixelError = error;
    options.frustumCulling = store.value("frustumCulling", true).toBool();
    for (const Number& number : numbers) {
        const int value = store.value(number.name).toInt(&isNumber);
        if (!(options.*number.value) && isNumber && value >= 0) options.*number.value = value;
    }
}

}  // namespace app

#endif
