// The settings of the terrain, in a window beside the picture.
#pragma once

#include <functional>
#include <vector>

#include <QDialog>

#include "Options.h"

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QFormLayout;
class QSpinBox;

namespace app {

class MainWindow;

/// What is changed here is seen at once, and what is changed elsewhere is seen here.
class SettingsDialog : public QDialog {
public:
    explicit SettingsDialog(MainWindow& window);
    /// Shows what holds now.
    void follow();

private:
    QWidget* makeDetail();
    QWidget* makeHeights();
    QComboBox* addChoice(QFormLayout& form, const char* label, const char* field, const std::vector<int>& values, const char* zero);
    QSpinBox* addNumber(QFormLayout& form, const char* label, const char* field, int most, int step, const char* zero);
    void setField(const char* name, int value);
    void chooseAlgorithm(int index);
    void placeHeights();
    void readRaw();
    void reset();

    MainWindow& window_;
    bool follows_ = false;  ///< values are set by follow(), not by the user
    QComboBox* algorithm_;
    QDoubleSpinBox* pixelError_;
    QCheckBox* culling_;
    QDoubleSpinBox* spacing_[2];
    QDoubleSpinBox* heightScale_;
    QSpinBox* rawSize_[2];
    QComboBox* rawType_;
    QWidget* heights_;
    QWidget* raw_;
    std::vector<std::function<void()>> followers_;  ///< of the fields
};

}  // namespace app
