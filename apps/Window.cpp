#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include "Window.h"

#ifdef HAVE_SOQT

#include <cstdio>
#include <cstdlib>

#include <Inventor/Qt/SoQt.h>
#include <QCoreApplication>
#include <QSurfaceFormat>

#include "Clock.h"
#include "MainWindow.h"
#include "ProgressWindow.h"
#include "RunLog.h"
#include "Settings.h"

namespace app {

using terrain::Error;

namespace {

const char* const noDisplay = "no display: use --offscreen";

// Qt aborts when it can't use the display; a message and an exit status serve better.
void showMessage(QtMsgType type, const QMessageLogContext&, const QString& text) {
    if (type == QtDebugMsg || type == QtInfoMsg) return;
    std::fprintf(stderr, "SoTerrainTest: %s\n", text.toLocal8Bit().constData());
    if (type != QtFatalMsg) return;
    std::fprintf(stderr, "SoTerrainTest: %s\n", noDisplay);
    std::_Exit(EXIT_FAILURE);
}

bool isSet(const char* variable) {
    const char* value = std::getenv(variable);
    return value && *value;
}

}  // namespace

std::optional<Error> openDisplay(const char* program) {
    if (!isSet("DISPLAY") && !isSet("WAYLAND_DISPLAY") && !isSet("QT_QPA_PLATFORM")) return Error{noDisplay, "", ""};
    qInstallMessageHandler(showMessage);
    // Coin needs the fixed functions of a compatibility profile.
    QSurfaceFormat format;
    format.setProfile(QSurfaceFormat::CompatibilityProfile);
    format.setDepthBufferSize(24);
    QSurfaceFormat::setDefaultFormat(format);
    // Sizes of windows are in points, that of the picture in pixels of the device: pixel errors are too.
    QCoreApplication::setAttribute(Qt::AA_EnableHighDpiScaling);
    QCoreApplication::setAttribute(Qt::AA_UseHighDpiPixmaps);
    return SoQt::init(program) ? std::nullopt : std::optional(Error{noDisplay, "", ""});
}

Errand windowErrand(const Options& options) {
    if (options.isMeasured()) return runHere;
    return [](const std::string& what, const std::function<void(terrain::ReadProgress&)>& work) {
        runBehindProgress(nullptr, what, work);
    };
}

void recallSettings(Options& options) {
    Settings(!options.isMeasured() && !options.noSettings).recall(options);
}

std::optional<Error> runWindow(const Options& options, Scene& scene, double startedMs) {
    auto animation = Animation::make(options, scene);
    if (!animation) return animation.error();
    auto log = RunLog::open(options, scene);
    if (!log) return log.error();
    MainWindow window(options, scene, log.value(), animation.value(), nowMs() - startedMs);
    if (auto problem = window.tools().apply(options)) return problem;
    SoQt::show(&window);
    if (options.fullScreen) window.toggleFullScreen();
    SoQt::mainLoop();
    const FlyArea& area = window.area();
    if (area.problem()) return area.problem();
    return log.value().finish(options, scene, area.renderer(), area.sizePixels());
}

}  // namespace app

#else

namespace app {

std::optional<terrain::Error> openDisplay(const char*) {
    return terrain::Error{"window", "--offscreen", "a build without SoQt"};
}

Errand windowErrand(const Options&) {
    return runHere;
}

void recallSettings(Options&) {}

std::optional<terrain::Error> runWindow(const Options&, Scene&, double) {
    return openDisplay("");
}

}  // namespace app

#endif
