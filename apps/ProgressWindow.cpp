#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#ifdef HAVE_SOQT

#include "ProgressWindow.h"

#include <atomic>
#include <chrono>
#include <future>

#include <QCoreApplication>
#include <QEventLoop>
#include <QProgressDialog>
#include <QTimer>

#include "Clock.h"

namespace app {

namespace {

constexpr int pollMs = 30;
constexpr double patienceMs = 400.0;  ///< before the dialog is seen
constexpr int steps = 1000;

void follow(QProgressDialog& dialog, const terrain::ReadProgress& progress) {
    const float part = progress.part;
    dialog.setRange(0, part < 0.0f ? 0 : steps);
    if (part >= 0.0f) dialog.setValue(std::min(int(part * steps), steps - 1));
    if (progress.isCancelled) dialog.setLabelText("Stopping...");
}

}  // namespace

bool runBehindProgress(QWidget* parent, const std::string& what, const std::function<void(terrain::ReadProgress&)>& work) {
    terrain::ReadProgress progress;
    const auto done = std::async(std::launch::async, [&] { work(progress); });
    // What is read at once needs no loop of events.
    if (done.wait_for(std::chrono::milliseconds(60)) == std::future_status::ready) return true;
    QProgressDialog dialog(parent);
    dialog.setWindowTitle("SoTerrainTest");
    dialog.setLabelText(QString::fromLocal8Bit(what.c_str()));
    dialog.setWindowModality(Qt::ApplicationModal);
    dialog.setAutoReset(false);
    dialog.setAutoClose(false);
    dialog.setMinimumDuration(1000000);
    dialog.setMinimumWidth(420);
    // Cancelling hides the dialog, and it must stay until the reader has noticed.
    QObject::disconnect(&dialog, &QProgressDialog::canceled, nullptr, nullptr);
    QObject::connect(&dialog, &QProgressDialog::canceled, &dialog, [&] { progress.isCancelled = true; });
    QEventLoop loop;
    QTimer timer;
    const double start = nowMs();
    QObject::connect(&timer, &QTimer::timeout, &loop, [&] {
        if (done.wait_for(std::chrono::seconds(0)) == std::future_status::ready) return loop.quit();
        if (nowMs() - start > patienceMs && !dialog.isVisible() && !progress.isCancelled) dialog.show();
        follow(dialog, progress);
    });
    timer.start(pollMs);
    loop.exec();
    // The program may have been asked to end.
    if (done.wait_for(std::chrono::seconds(0)) != std::future_status::ready) progress.isCancelled = true;
    done.wait();
    // What follows may keep the window waiting, and should not be taken for this.
    dialog.hide();
    QCoreApplication::processEvents(QEventLoop::ExcludeUserInputEvents);
    return !progress.isCancelled;
}

}  // namespace app

#endif
