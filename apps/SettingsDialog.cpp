#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#ifdef HAVE_SOQT

#include "SettingsDialog.h"

#include <cmath>

#include <Inventor/fields/SoSFBool.h>
#include <Inventor/fields/SoSFFloat.h>
#include <Inventor/fields/SoSFInt32.h>
#include <QCheckBox>
#include <QComboBox>
#include <QDialogButtonBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QGroupBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>
#include <QStandardItemModel>
#include <QVBoxLayout>

#include "MainWindow.h"
#include "OpenFiles.h"
#include "RawDialog.h"

namespace app {

namespace {

template <class Field>
Field* fieldOf(MainWindow& window, const char* name) {
    SoNode* terrain = window.scene().terrain();
    return terrain ? dynamic_cast<Field*>(terrain->getField(name)) : nullptr;
}

QWidget* sideBySide(QWidget* first, const char* between, QWidget* second) {
    auto* both = new QWidget;
    auto* layout = new QHBoxLayout(both);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->addWidget(first, 1);
    layout->addWidget(new QLabel(between));
    layout->addWidget(second, 1);
    return both;
}

void resetField(SoNode& node, const char* name) {
    const NodePtr<SoNode> fresh(static_cast<SoNode*>(node.getTypeId().createInstance()));
    if (SoField* field = node.getField(name)) field->copyFrom(*fresh->getField(name));
}

// What the box shows, unless it is the present value, rounded.
double entered(const QDoubleSpinBox& box, double present) {
    return std::abs(box.value() - present) < std::pow(10.0, -box.decimals()) ? present : box.value();
}

QDoubleSpinBox* makeReal(double least, double most, int decimals) {
    auto* box = new QDoubleSpinBox;
    box->setDecimals(decimals);
    box->setRange(least, most);
    box->setStepType(QAbstractSpinBox::AdaptiveDecimalStepType);
    box->setKeyboardTracking(false);
    return box;
}

}  // namespace

SettingsDialog::SettingsDialog(MainWindow& window) : QDialog(&window), window_(window) {
    setWindowTitle("Settings of SoTerrainTest");
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close | QDialogButtonBox::RestoreDefaults);
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::hide);
    connect(buttons->button(QDialogButtonBox::RestoreDefaults), &QPushButton::clicked, this, [this] { reset(); });
    // Enter in a field is no wish to close the dialog or to reset it.
    for (QAbstractButton* button : buttons->buttons()) static_cast<QPushButton*>(button)->setAutoDefault(false);
    auto* layout = new QVBoxLayout(this);
    layout->addWidget(makeDetail());
    heights_ = makeHeights();
    layout->addWidget(heights_);
    layout->addStretch();
    layout->addWidget(buttons);
    follow();
}

QComboBox* SettingsDialog::addChoice(QFormLayout& form, const char* label, const char* field, const std::vector<int>& values,
                                     const char* zero) {
    auto* box = new QComboBox;
    for (const int value : values) box->addItem(value == 0 ? QString(zero) : QString::number(value), value);
    form.addRow(label, box);
    connect(box, QOverload<int>::of(&QComboBox::activated), this,
            [this, box, field] { setField(field, box->currentData().toInt()); });
    followers_.push_back([this, box, field] {
        const auto* here = fieldOf<SoSFInt32>(window_, field);
        box->setEnabled(here);
        if (!here) return box->setCurrentIndex(-1);
        if (box->findData(here->getValue()) < 0) box->addItem(QString::number(here->getValue()), here->getValue());
        box->setCurrentIndex(box->findData(here->getValue()));
    });
    return box;
}

QSpinBox* SettingsDialog::addNumber(QFormLayout& form, const char* label, const char* field, int most, int step, const char* zero) {
    auto* box = new QSpinBox;
    box->setRange(0, most);
    box->setSingleStep(step);
    box->setSpecialValueText(zero);
    box->setKeyboardTracking(false);
    form.addRow(label, box);
    connect(box, QOverload<int>::of(&QSpinBox::valueChanged), this, [this, field](int value) { setField(field, value); });
    followers_.push_back([this, box, field] {
        const auto* here = fieldOf<SoSFInt32>(window_, field);
        box->setEnabled(here);
        if (here && !box->hasFocus()) box->setValue(here->getValue());
    });
    return box;
}

QWidget* SettingsDialog::makeDetail() {
    auto* group = new QGroupBox("Level of detail");
    auto* form = new QFormLayout(group);
    algorithm_ = new QComboBox;
    for (const Algorithm& algorithm : algorithms()) algorithm_->addItem(algorithm.title);
    connect(algorithm_, QOverload<int>::of(&QComboBox::activated), this, [this](int index) { chooseAlgorithm(index); });
    form->addRow("&Algorithm", algorithm_);
    pixelError_ = makeReal(0.0, 1000.0, 2);
    pixelError_->setSuffix(" px");
    connect(pixelError_, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this, [this](double value) {
        auto* field = fieldOf<SoSFFloat>(window_, "pixelError");
        if (follows_ || !field) return;
        field->setValue(float(value));
        window_.area().wake();
    });
    form->addRow("&Pixel error", pixelError_);
    culling_ = new QCheckBox("leave out what is not in view");
    connect(culling_, &QCheckBox::clicked, this, [this](bool on) {
        if (auto* field = fieldOf<SoSFBool>(window_, "frustumCulling")) field->setValue(on);
        window_.area().wake();
    });
    form->addRow("&Culling", culling_);
    addNumber(*form, "&Triangles at most", "triangleCount", 100000000, 1000, "no limit");
    addChoice(*form, "Tile si&ze", "tileSize", {2, 4, 8, 16, 32, 64, 128}, "");
    addChoice(*form, "Clip&map size", "clipmapSize", {0, 15, 31, 63, 127, 255, 511, 1023}, "as the pixel error needs");
    addNumber(*form, "&Levels", "levels", 31, 1, "as many as cover the map");
    addNumber(*form, "&Detail levels", "detailLevels", 16, 1, "none");
    return group;
}

QWidget* SettingsDialog::makeHeights() {
    auto* group = new QGroupBox("Height map");
    auto* form = new QFormLayout(group);
    for (QDoubleSpinBox*& box : spacing_) box = makeReal(1e-7, 1e6, 7);
    form->addRow("&Spacing", sideBySide(spacing_[0], "by", spacing_[1]));
    heightScale_ = makeReal(1e-9, 1e6, 9);
    form->addRow("&Height scale", heightScale_);
    for (QDoubleSpinBox* box : {spacing_[0], spacing_[1], heightScale_})
        connect(box, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this, [this] { placeHeights(); });
    for (QSpinBox*& box : rawSize_) {
        box = new QSpinBox;
        box->setRange(0, 1000000);
        box->setSpecialValueText("square");
        box->setKeyboardTracking(false);
    }
    rawType_ = makeRawTypeBox();
    auto* read = new QPushButton("&Read again");
    read->setAutoDefault(false);
    connect(read, &QPushButton::clicked, this, [this] { readRaw(); });
    raw_ = new QWidget;
    auto* raw = new QHBoxLayout(raw_);
    raw->setContentsMargins(0, 0, 0, 0);
    raw->addWidget(sideBySide(rawSize_[0], "by", rawSize_[1]), 1);
    raw->addWidget(rawType_);
    raw->addWidget(read);
    form->addRow("Ra&w file", raw_);
    return group;
}

void SettingsDialog::setField(const char* name, int value) {
    auto* field = fieldOf<SoSFInt32>(window_, name);
    if (follows_ || !field) return;
    field->setValue(value);
    window_.area().wake();
}

void SettingsDialog::chooseAlgorithm(int index) {
    window_.setAlgorithm(algorithms()[std::size_t(index)]);
    follow();
}

// All that holds is given, not what was typed alone: without any spacing and scale the map would be placed anew.
void SettingsDialog::placeHeights() {
    if (follows_) return;
    Options next = window_.options();
    const glm::dvec2 spacing = window_.scene().grid()->spacing;
    next.spacing = glm::dvec2(entered(*spacing_[0], spacing.x), entered(*spacing_[1], spacing.y));
    next.heightScale = entered(*heightScale_, window_.scene().heightScale());
    window_.showAgain(next);
}

void SettingsDialog::readRaw() {
    Options next = window_.options();
    next.rawSize.reset();
    if (rawSize_[0]->value() > 0 && rawSize_[1]->value() > 0) next.rawSize = glm::ivec2(rawSize_[0]->value(), rawSize_[1]->value());
    next.rawType = chosenRawType(*rawType_);
    next.spacing.reset();
    next.heightScale.reset();
    window_.showAgain(next);
}

void SettingsDialog::reset() {
    if (SoNode* terrain = window_.scene().terrain()) {
        for (const char* name :
             {"pixelError", "frustumCulling", "triangleCount", "tileSize", "clipmapSize", "levels", "detailLevels"})
            resetField(*terrain, name);
    }
    Options next = window_.options();
    const bool isPlaced = next.spacing || next.heightScale;
    next.spacing.reset();
    next.heightScale.reset();
    if (isPlaced) window_.showAgain(next);
    window_.area().wake();
    follow();
}

void SettingsDialog::follow() {
    follows_ = true;
    const Scene& scene = window_.scene();
    auto& items = *static_cast<QStandardItemModel*>(algorithm_->model());
    for (std::size_t i = 0; i < algorithms().size(); ++i) {
        const Algorithm& algorithm = algorithms()[i];
        items.item(int(i))->setEnabled(window_.canSwitchTo(algorithm));
        if (scene.shows(algorithm)) algorithm_->setCurrentIndex(int(i));
    }
    const auto* error = fieldOf<SoSFFloat>(window_, "pixelError");
    pixelError_->setEnabled(error);
    if (error && !pixelError_->hasFocus()) pixelError_->setValue(error->getValue());
    const auto* culling = fieldOf<SoSFBool>(window_, "frustumCulling");
    culling_->setEnabled(culling);
    culling_->setChecked(culling && culling->getValue());
    for (const auto& tell : followers_) tell();
    heights_->setVisible(scene.isHeightMap());
    if (scene.isHeightMap()) {
        const TerrainGrid& grid = *scene.grid();
        if (!spacing_[0]->hasFocus()) spacing_[0]->setValue(grid.spacing.x);
        if (!spacing_[1]->hasFocus()) spacing_[1]->setValue(grid.spacing.y);
        if (!heightScale_->hasFocus()) heightScale_->setValue(scene.heightScale());
        raw_->setEnabled(isHeaderless(window_.options().heightMap));
        if (!rawSize_[0]->hasFocus() && !rawSize_[1]->hasFocus() && raw_->isEnabled()) {
            rawSize_[0]->setValue(grid.columns);
            rawSize_[1]->setValue(grid.rows);
            chooseRawType(*rawType_, window_.options().rawType.value_or(terrain::RawType::UInt8));
        }
    }
    follows_ = false;
}

}  // namespace app

#endif
