// Opening files in the running program.
#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#ifdef HAVE_SOQT

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <utility>

#include <QDragEnterEvent>
#include <QDropEvent>
#include <QFileDialog>
#include <QFileInfo>
#include <QMenu>
#include <QMessageBox>
#include <QMimeData>
#include <QUrl>

#include "ImageFile.h"
#include "MainWindow.h"
#include "OpenFiles.h"
#include "ProgressWindow.h"
#include "RawDialog.h"

namespace app {

using terrain::Error;

namespace {

QString text(const std::string& bytes) {
    return QString::fromLocal8Bit(bytes.c_str());
}

std::string bytes(const QString& text) {
    return text.toLocal8Bit().toStdString();
}

std::string absolute(const std::string& path) {
    std::error_code ignored;
    return path.empty() ? path : std::filesystem::absolute(path, ignored).string();
}

std::string nameOf(const std::string& path) {
    return std::filesystem::path(path).filename().string();
}

QString filter(const FilePatterns& kind) {
    QStringList patterns;
    for (const std::string& pattern : kind.patterns) patterns.append(text(pattern));
    return QString("%1 (%2)").arg(kind.title, patterns.join(' '));
}

QString openFilters() {
    FilePatterns all{"All that can be opened", {}};
    QStringList filters;
    for (const FilePatterns& kind : openablePatterns()) {
        all.patterns.insert(all.patterns.end(), kind.patterns.begin(), kind.patterns.end());
        filters.append(filter(kind));
    }
    filters.prepend(filter(all));
    filters.append("All files (*)");
    return filters.join(";;");
}

std::vector<std::string> localFiles(const QMimeData& data) {
    std::vector<std::string> paths;
    for (const QUrl& url : data.urls()) {
        if (url.isLocalFile()) paths.push_back(bytes(url.toLocalFile()));
    }
    return paths;
}

// What was given for one map does not fit another.
Options withoutFile(Options options) {
    options.heightMap.clear();
    options.scene.clear();
    options.texture.clear();
    options.spacing.reset();
    options.heightScale.reset();
    options.channel.reset();
    options.rawSize.reset();
    options.rawType.reset();
    return options;
}

// A scene file says itself how it is drawn.
Options forScene(Options options) {
    options.algorithm = nullptr;
    options.frustumCulling = false;
    options.pixelError.reset();
    for (auto* value :
         {&options.triangleCount, &options.tileSize, &options.clipmapSize, &options.clipmapLevels, &options.detailLevels})
        value->reset();
    return options;
}

}  // namespace

Errand MainWindow::errand() {
    return [this](const std::string& what, const std::function<void(terrain::ReadProgress&)>& work) {
        isBusy_ = true;
        isCancelled_ = !runBehindProgress(this, what, work);
        isBusy_ = false;
    };
}

void MainWindow::fail(const Error& problem) {
    endAnnouncement();
    if (std::exchange(isCancelled_, false)) return say("Cancelled: " + problem.subject);
    std::fprintf(stderr, "SoTerrainTest: %s\n", problem.message().c_str());
    QMessageBox::warning(this, "SoTerrainTest", text(problem.message()));
}

bool MainWindow::showScene(const Options& next, bool keepCamera) {
    auto built = Scene::build(next.scene.empty() ? next : forScene(next), false, errand());
    if (!built) {
        fail(built.error());
        return false;
    }
    const bool wireframe = scene_.wireframe();
    isCancelled_ = false;
    announce("Preparing the terrain...");
    options_ = next;
    scene_ = std::move(built).value();
    scene_.setWireframe(wireframe);
    area_->sceneChanged(keepCamera);
    noteFile();
    refresh();
    return true;
}

// The window's title and the list of recent files follow what is shown.
void MainWindow::noteFile() {
    const std::string& path = options_.scene.empty() ? options_.heightMap : options_.scene;
    fileName_ = nameOf(path);
    if (path.empty()) return;
    settings_.addRecentFile({absolute(path), absolute(options_.texture), options_.rawSize, options_.rawType});
    fillRecentFiles();
}

void MainWindow::openFiles(const std::vector<std::string>& paths) {
    if (isBusy_ || !canOpen()) return;
    std::string scene, map, picture;
    for (const std::string& path : paths) {
        const FileKind kind = fileKind(path);
        (kind == FileKind::Picture ? picture : kind == FileKind::Scene ? scene : map) = path;
    }
    if (!scene.empty()) return openFile({scene, "", {}, {}});
    if (map.empty() && !picture.empty() && scene_.isHeightMap()) return setTexture(picture);
    if (map.empty()) std::swap(map, picture);
    if (!map.empty()) openFile({map, picture, {}, {}});
}

void MainWindow::openFile(const RecentFile& file) {
    if (scene_.isHeightMap()) scene_.readFields(options_);
    Options next = withoutFile(options_);
    (fileKind(file.path) == FileKind::Scene ? next.scene : next.heightMap) = file.path;
    if (!next.heightMap.empty() && !scene_.isHeightMap()) next.frustumCulling = true;
    next.texture = file.texture;
    next.rawSize = file.rawSize;
    next.rawType = file.rawType;
    if (needsRawSize(next) && !askRawSize(this, next)) return;
    showScene(next, false);
}

// The camera stays where the ground does.
void MainWindow::showAgain(const Options& next) {
    Options now = next;
    scene_.readFields(now);
    const SbBox3f former = scene_.box();
    if (!showScene(now, true)) return;
    const SbVec3f low = former.getMin() - scene_.box().getMin(), high = former.getMax() - scene_.box().getMax();
    if (std::max({std::abs(low[0]), std::abs(low[1]), std::abs(high[0]), std::abs(high[1])}) > 1e-3f * scene_.size())
        area_->goHome();
}

void MainWindow::setTexture(const std::string& path) {
    if (auto problem = scene_.setTexture(path, errand())) return fail(*problem);
    options_.texture = path;
    noteFile();
    area_->wake();
}

QString MainWindow::folder() const {
    const std::string& path = options_.scene.empty() ? options_.heightMap : options_.scene;
    return text(std::filesystem::path(absolute(path)).parent_path().string());
}

void MainWindow::chooseFiles() {
    const QStringList chosen =
        QFileDialog::getOpenFileNames(this, "Open a terrain", folder(), openFilters(), nullptr, QFileDialog::HideNameFilterDetails);
    std::vector<std::string> paths;
    for (const QString& path : chosen) paths.push_back(bytes(path));
    if (!paths.empty()) openFiles(paths);
    area_->takeFocus();
}

void MainWindow::chooseTexture() {
    const QString chosen =
        QFileDialog::getOpenFileName(this, "Open a texture", folder(), filter(picturePatterns()) + ";;All files (*)", nullptr,
                                     QFileDialog::HideNameFilterDetails);
    if (!chosen.isEmpty()) setTexture(bytes(chosen));
    area_->takeFocus();
}

bool MainWindow::canOpen() const {
    return !area_->endsByItself();
}

bool MainWindow::canTexture() const {
    return canOpen() && scene_.isHeightMap();
}

// soterrain-0001.png, or the first number after it that is free.
void MainWindow::savePicture() {
    char name[40];
    int number = 0;
    std::error_code ignored;
    do {
        std::snprintf(name, sizeof name, "soterrain-%04d.%s", ++number, picturesAreCompressed() ? "png" : "ppm");
    } while (std::filesystem::exists(std::filesystem::symlink_status(name, ignored)));
    writePicture(name);
}

void MainWindow::choosePicture() {
    // What is seen now, not what the dialog leaves of it.
    auto picture = area_->picture();
    if (!picture) return fail(picture.error());
    const QString chosen = QFileDialog::getSaveFileName(this, "Save the picture", QString("soterrain.png"),
                                                        "Pictures (*.png *.jpg *.tif *.ppm);;All files (*)");
    area_->takeFocus();
    if (chosen.isEmpty()) return;
    const std::string path = bytes(QFileInfo(chosen).suffix().isEmpty() ? chosen + ".png" : chosen);
    if (auto problem = writeImage(path, picture.value())) return fail(*problem);
    area_->say("saved " + nameOf(path));
}

void MainWindow::writePicture(const std::string& path) {
    auto picture = area_->picture();
    if (!picture) return fail(picture.error());
    if (auto problem = writeImage(path, picture.value())) return fail(*problem);
    area_->say("saved " + path);
}

void MainWindow::fillRecentFiles() {
    recent_->clear();
    for (const RecentFile& file : settings_.recentFiles()) {
        std::string title = nameOf(file.path);
        if (!file.texture.empty()) title += " with " + nameOf(file.texture);
        QAction* action = recent_->addAction(text(title).replace('&', "&&"), this, [this, file] { openFile(file); });
        action->setStatusTip(text(file.path));
    }
    recent_->setEnabled(!recent_->isEmpty() && canOpen());
    if (recent_->isEmpty()) return;
    recent_->addSeparator();
    recent_->addAction("&Forget these", this, [this] {
        settings_.clearRecentFiles();
        fillRecentFiles();
    });
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
    if (canOpen() && !isBusy_ && !localFiles(*event->mimeData()).empty()) event->acceptProposedAction();
}

// The dialogs that may follow must not keep the other program waiting.
void MainWindow::dropEvent(QDropEvent* event) {
    const std::vector<std::string> paths = localFiles(*event->mimeData());
    event->acceptProposedAction();
    QMetaObject::invokeMethod(
        this, [this, paths] { openFiles(paths); }, Qt::QueuedConnection);
}

}  // namespace app

#endif
