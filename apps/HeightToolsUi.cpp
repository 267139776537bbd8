#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#ifdef HAVE_SOQT

#include "HeightToolsUi.h"

#include <cstdio>

#include <QDockWidget>
#include <QFileDialog>
#include <QHBoxLayout>
#include <QImage>
#include <QInputDialog>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>

#include "MainWindow.h"
#include "ProfilePlot.h"

namespace app {

using terrain::Error;

namespace {

const char* const modeHints[] = {"Clicks look around again", "Click on the ground: height and slope",
                                 "Click two or more places: a line over the ground. Start again with M",
                                 "Click where a marker is to stand", "Click beside the marker that is to go"};
const char* const markerFiles = "Markers (*.csv *.iv);;All files (*)";

std::string bytes(const QString& text) {
    return text.toLocal8Bit().toStdString();
}

// With an ending, which says what is written.
QString askForFile(QWidget* parent, const char* title, const QString& name, const QString& filter) {
    return QFileDialog::getSaveFileName(parent, title, name, filter, nullptr, QFileDialog::HideNameFilterDetails);
}

}  // namespace

HeightToolsUi::HeightToolsUi(MainWindow& window, Scene& scene) : window_(window), session_(scene) {
    makeDock();
}

void HeightToolsUi::makeDock() {
    dock_ = new QDockWidget("Height profile", &window_);
    dock_->setObjectName("profile");
    auto* content = new QWidget;
    auto* rows = new QVBoxLayout(content);
    auto* row = new QHBoxLayout;
    figures_ = new QLabel;
    figures_->setWordWrap(true);
    figures_->setTextInteractionFlags(Qt::TextSelectableByMouse);
    row->addWidget(figures_, 1);
    const auto addButton = [&](const char* text, const char* name, auto press) {
        auto* button = new QPushButton(text);
        button->setObjectName(name);
        button->setFocusPolicy(Qt::NoFocus);
        QObject::connect(button, &QPushButton::clicked, [press] { press(); });
        row->addWidget(button);
    };
    addButton("CSV...", "profile-csv", [this] { exportProfile(); });
    addButton("PNG...", "profile-png", [this] { exportPlot(); });
    plot_ = new ProfilePlot;
    plot_->onCursor([this](std::optional<double> distance) {
        const std::string words = session_.showAt(distance);
        if (!words.empty()) window_.say(words);
        window_.area().wake();
    });
    rows->addWidget(plot_, 1);
    rows->addLayout(row);
    dock_->setWidget(content);
    window_.addDockWidget(Qt::BottomDockWidgetArea, dock_);
    dock_->hide();
}

void HeightToolsUi::toggle(Mode mode) {
    mode_ = mode_ == mode ? Mode::Look : mode;
    continues_ = false;
    window_.say(modeHints[int(mode_)]);
}

void HeightToolsUi::click(const SbVec2s& pixel, const SbVec2s& pictureSize, bool picks) {
    const Mode mode = picks ? Mode::Pick : mode_;
    if (mode == Mode::Look) return;
    const auto place = placeUnder(session_.scene(), pixel, pictureSize);
    if (!place) return window_.say("No ground here");
    switch (mode) {
    case Mode::Pick:
        window_.say(session_.pick(*place));
        break;
    case Mode::Measure:
        if (continues_)
            session_.addCorner(*place);
        else
            session_.setLine({*place});
        continues_ = true;
        lineChanged();
        break;
    case Mode::Mark:
        window_.say(session_.addMarker({*place, askForName()}));
        break;
    default:
        removeMarkerAt(*place);
        break;
    }
    window_.area().wake();
}

void HeightToolsUi::lineChanged() {
    const std::string words = session_.lineText();
    plot_->setLine(session_.line(), session_.text().unit());
    figures_->setText(QString::fromStdString(words));
    if (words.empty()) return;
    window_.say(words);
    showProfile(true);
}

void HeightToolsUi::removeMarkerAt(glm::dvec2 place) {
    window_.say(session_.removeMarker(place) ? "Marker removed" : "There is no marker");
}

std::string HeightToolsUi::askForName() const {
    bool given = false;
    const QString name = QInputDialog::getText(&window_, "Place a marker", "Name (none: a number)", QLineEdit::Normal, "", &given);
    window_.area().takeFocus();
    return name.toStdString();
}

void HeightToolsUi::follow() {
    if (!session_.follow()) return;
    mode_ = Mode::Look;
    continues_ = false;
    plot_->setLine(session_.line(), "");
    figures_->clear();
    dock_->hide();
}

void HeightToolsUi::clear() {
    session_.forgetPick();
    session_.setLine({});
    session_.setMarkers({});
    continues_ = false;
    lineChanged();
}

void HeightToolsUi::showProfile(bool on) {
    dock_->setVisible(on);
}

bool HeightToolsUi::showsProfile() const {
    return dock_->isVisible();
}

void HeightToolsUi::tell(const std::optional<Error>& problem, const std::string& done) {
    window_.say(problem ? problem->message() : done);
    window_.area().takeFocus();
}

void HeightToolsUi::exportProfile() {
    const QString path = askForFile(&window_, "Save the profile", "profile.csv", "CSV (*.csv);;All files (*)");
    if (!path.isEmpty()) tell(session_.writeProfile(bytes(path)), "Profile in " + path.toStdString());
}

void HeightToolsUi::exportPlot() {
    const QString path = askForFile(&window_, "Save the plot", "profile.png", "PNG (*.png);;All files (*)");
    if (path.isEmpty()) return;
    const bool written = plot_->picture({1200, 400}).save(path, path.contains('.') ? nullptr : "PNG");
    tell(written ? std::nullopt
                 : std::optional(Error{bytes(path), "a picture that can be written", "no permission, or an unknown format"}),
         "Plot in " + path.toStdString());
}

void HeightToolsUi::openMarkers() {
    const QString path =
        QFileDialog::getOpenFileName(&window_, "Open markers", "", markerFiles, nullptr, QFileDialog::HideNameFilterDetails);
    if (path.isEmpty()) return;
    auto markers = readMarkers(bytes(path));
    if (markers) session_.setMarkers(markers.value());
    tell(markers ? std::nullopt : std::optional(markers.error()), std::to_string(session_.markers().size()) + " markers");
}

void HeightToolsUi::saveMarkers() {
    const QString path = askForFile(&window_, "Save markers", "markers.csv", markerFiles);
    if (path.isEmpty()) return;
    tell(writeMarkers(bytes(path), session_.markers(), session_.scene().localSize()), "Markers in " + path.toStdString());
}

std::optional<Error> HeightToolsUi::apply(const Options& options) {
    const auto said = session_.apply(options);
    if (!said) return said.error();
    std::fputs(said.value().c_str(), options.stats ? stderr : stdout);
    std::fflush(stdout);
    if (!options.profileLine.empty()) lineChanged();
    return std::nullopt;
}

}  // namespace app

#endif
