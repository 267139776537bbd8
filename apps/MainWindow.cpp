#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#ifdef HAVE_SOQT

#include "MainWindow.h"

#include <algorithm>

#include <Inventor/Qt/SoQt.h>
#include <QAction>
#include <QActionGroup>
#include <QApplication>
#include <QCloseEvent>
#include <QLabel>
#include <QMenu>
#include <QMenuBar>
#include <QMessageBox>
#include <QProgressBar>
#include <QScreen>
#include <QStatusBar>

#include "HelpDialogs.h"
#include "SettingsDialog.h"

namespace app {

namespace {

constexpr int messageMs = 6000;
const QSize pictureSize(1024, 768);

QList<QKeySequence> keySequences(const std::string& keys) {
    QList<QKeySequence> sequences;
    for (const QString& key : QString::fromStdString(keys).split(' ', Qt::SkipEmptyParts)) sequences.append(QKeySequence(key));
    return sequences;
}

}  // namespace

MainWindow::MainWindow(const Options& options, Scene& scene, RunLog& log, Animation animation, double loadMs)
    : options_(options), settings_(!options.isMeasured() && !options.noSettings), scene_(scene), status_(new QLabel),
      recent_(new QMenu("Open &recent", this)), streaming_(new QProgressBar) {
    setWindowTitle("SoTerrainTest");
    setAcceptDrops(true);
    auto* middle = new QWidget(this);
    middle->setMinimumSize(160, 120);
    setCentralWidget(middle);
    statusBar()->addWidget(status_, 1);
    streaming_->setMaximumSize(220, 14);
    statusBar()->addPermanentWidget(streaming_);
    streaming_->hide();
    status_->setIndent(6);
    area_ = std::make_unique<FlyArea>(middle, options_, scene_, log, std::move(animation), loadMs);
    area_->onStatus([this](const std::string& text) { setStatus(text); });
    tools_ = std::make_unique<HeightToolsUi>(*this, scene_);
    area_->beforeRedraw([this] { tools_->follow(); });
    area_->onClick([this](const SbVec2s& pixel, const SbVec2s& size, bool picks) { tools_->click(pixel, size, picks); });
    addMenus();
    noteFile();
    fillRecentFiles();
    placeWindow();
    area_->show();
    area_->takeFocus();
    announce("Preparing the terrain...");
}

MainWindow::~MainWindow() = default;

// Where it was the last time; else with a picture of the size that --offscreen has too, where the screen has room for it and what
// is around it.
void MainWindow::placeWindow() {
    const QByteArray geometry = settings_.windowGeometry();
    if (!geometry.isEmpty() && restoreGeometry(geometry)) return;
    const QSize around(0, menuBar()->sizeHint().height() + statusBar()->sizeHint().height());
    resize((pictureSize + around).boundedTo(screen()->availableGeometry().size()));
}

void MainWindow::addMenus() {
    std::vector<QMenu*> menus;
    for (const char* title : menuTitles) {
        menus.push_back(menuBar()->addMenu(title));
        connect(menus.back(), &QMenu::aboutToShow, this, [this] { refresh(); });
    }
    std::vector<QActionGroup*> groups(menus.size(), nullptr);
    for (const Command& command : commands()) {
        const auto index = std::size_t(command.menu);
        if (command.id.empty()) {
            menus[index]->addSeparator();
            continue;
        }
        QAction* action = addCommand(command);
        menus[index]->addAction(action);
        if (command.id == "open") menus[index]->addMenu(recent_);
        if (!command.isChoice) continue;
        if (!groups[index]) groups[index] = new QActionGroup(this);
        groups[index]->addAction(action);
    }
    for (QMenu* menu : menus) menu->menuAction()->setVisible(!menu->isEmpty());
    refresh();
}

// The window has the action itself too: its keys work without the menu bar.
QAction* MainWindow::addCommand(const Command& command) {
    auto* action = new QAction(QString::fromStdString(command.text), this);
    action->setObjectName(QString::fromStdString(command.id));
    action->setStatusTip(QString::fromStdString(command.help));
    action->setShortcuts(keySequences(command.keys));
    action->setAutoRepeat(command.repeats);
    action->setCheckable(bool(command.isOn));
    action->setMenuRole(QAction::NoRole);
    connect(action, &QAction::triggered, this, [this, &command] { run(command); });
    addAction(action);
    entries_.push_back({&command, action});
    return action;
}

void MainWindow::run(const Command& command) {
    if (isBusy_ || (command.isPossible && !command.isPossible(*this))) return;
    command.run(*this);
    refresh();
    area_->wake();
}

void MainWindow::refresh() {
    for (const Entry& entry : entries_) {
        if (entry.command->isPossible) entry.action->setEnabled(entry.command->isPossible(*this));
        if (entry.command->isOn) entry.action->setChecked(entry.command->isOn(*this));
    }
    if (settingsDialog_ && settingsDialog_->isVisible()) settingsDialog_->follow();
}

void MainWindow::setStatus(const std::string& text) {
    setWindowTitle(QString::fromLocal8Bit(("SoTerrainTest: " + text + (fileName_.empty() ? "" : "   " + fileName_)).c_str()));
    status_->setText(QString::fromStdString(text));
    if (isAnnounced_ && area_->isDrawn()) endAnnouncement();
    showStreaming();
    refresh();
}

// The frame that follows keeps the window waiting: a terrain is prepared in it.
void MainWindow::announce(const char* what) {
    if (!isAnnounced_) QApplication::setOverrideCursor(Qt::BusyCursor);
    isAnnounced_ = true;
    statusBar()->showMessage(what);
    if (isVisible()) QCoreApplication::processEvents(QEventLoop::ExcludeUserInputEvents);
}

void MainWindow::endAnnouncement() {
    if (!isAnnounced_) return;
    isAnnounced_ = false;
    QApplication::restoreOverrideCursor();
    statusBar()->clearMessage();
}

// While tiles are built or a limit on work per frame holds refinement back.
void MainWindow::showStreaming() {
    const FrameFigures figures = scene_.figures();
    const bool streams = area_->isDrawn() && figures.terrain && !figures.terrain->isComplete;
    if (streaming_->isHidden() == streams) {
        streaming_->setVisible(streams);
        streaming_->setToolTip("Finer parts of the terrain are on their way.");
        mostPending_ = 0;
    }
    if (!streams) return;
    // The share of the tiles that were missing at worst; without tiles, that there is something to come.
    const int pending = int(figures.terrain->pending);
    mostPending_ = std::max(mostPending_, pending);
    streaming_->setRange(0, mostPending_);
    streaming_->setValue(mostPending_ - pending);
    streaming_->setFormat(pending == 1 ? QString("1 tile to come") : QString("%1 tiles to come").arg(pending));
}

void MainWindow::say(const std::string& message) {
    statusBar()->showMessage(QString::fromStdString(message), messageMs);
}

// The geometry is set too, for displays without a window manager that would do it; there Qt forgets the state again.
void MainWindow::toggleFullScreen() {
    fillsScreen_ = !fillsScreen_;
    if (fillsScreen_) windowed_ = geometry();
    menuBar()->setVisible(!fillsScreen_);
    statusBar()->setVisible(!fillsScreen_);
    area_->showStatus(fillsScreen_);
    setWindowState(fillsScreen_ ? windowState() | Qt::WindowFullScreen : windowState() & ~Qt::WindowFullScreen);
    setGeometry(fillsScreen_ ? screen()->geometry() : windowed_);
    area_->takeFocus();
}

void MainWindow::setAlgorithm(const Algorithm& algorithm) {
    if (scene_.shows(algorithm)) return;
    Options now = options_;
    scene_.readFields(now);
    announce("Preparing the terrain...");
    if (auto problem = scene_.setAlgorithm(algorithm, now)) return fail(*problem);
    now.algorithm = &algorithm;
    if (scene_.isHeightMap()) options_ = now;
    area_->terrainChanged();
}

bool MainWindow::canSwitchTo(const Algorithm& algorithm) const {
    return canOpen() && scene_.offers(algorithm);
}

void MainWindow::showSettings() {
    if (!settingsDialog_) settingsDialog_ = new SettingsDialog(*this);
    settingsDialog_->follow();
    settingsDialog_->show();
    settingsDialog_->raise();
    settingsDialog_->activateWindow();
}

void MainWindow::showKeys() {
    if (!keys_) keys_ = makeKeysDialog(this);
    keys_->show();
    keys_->raise();
    keys_->activateWindow();
}

void MainWindow::showAbout() {
    QMessageBox::about(this, "About SoTerrainTest", aboutText(area_->renderer()));
}

void MainWindow::closeEvent(QCloseEvent* event) {
    if (isBusy_) return event->ignore();
    if (scene_.isHeightMap()) {
        scene_.readFields(options_);
        settings_.keep(options_);
    }
    if (!fillsScreen_) settings_.setWindowGeometry(saveGeometry());
    event->accept();
    SoQt::exitMainLoop();
}

}  // namespace app

#endif
