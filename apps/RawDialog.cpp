#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#ifdef HAVE_SOQT

#include "RawDialog.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iterator>

#include <QComboBox>
#include <QDialog>
#include <QDialogButtonBox>
#include <QFormLayout>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>

#include "OpenFiles.h"

namespace app {

using terrain::RawType;

namespace {

constexpr RawType types[] = {RawType::UInt8, RawType::UInt16LittleEndian, RawType::UInt16BigEndian};
constexpr const char* typeTitles[] = {"8 bits", "16 bits, low byte first", "16 bits, high byte first"};

std::int64_t bytesOf(RawType type) {
    return type == RawType::UInt8 ? 1 : 2;
}

std::int64_t lengthOf(const std::string& path) {
    std::error_code failure;
    const auto length = std::filesystem::file_size(path, failure);
    return failure ? 0 : std::int64_t(length);
}

bool isSquare(std::int64_t samples) {
    const auto side = std::int64_t(std::llround(std::sqrt(double(samples))));
    return samples >= 4 && side * side == samples;
}

// The most square of all rectangles with so many samples.
glm::ivec2 likelySize(std::int64_t samples) {
    for (auto rows = std::int64_t(std::sqrt(double(samples))); rows > 1; --rows) {
        if (samples % rows == 0 && samples / rows <= 1000000) return {int(samples / rows), int(rows)};
    }
    return {0, 0};
}

// A square of words is likelier than an odd rectangle of bytes.
RawType likelyType(const Options& options, std::int64_t length) {
    if (options.rawType) return *options.rawType;
    return length % 2 == 0 && isSquare(length / 2) ? RawType::UInt16LittleEndian : RawType::UInt8;
}

QSpinBox* makeSide(int value) {
    auto* box = new QSpinBox;
    box->setRange(2, 1000000);
    box->setValue(value);
    return box;
}

}  // namespace

QComboBox* makeRawTypeBox() {
    auto* box = new QComboBox;
    for (const char* title : typeTitles) box->addItem(title);
    return box;
}

RawType chosenRawType(const QComboBox& box) {
    return types[std::max(0, box.currentIndex())];
}

void chooseRawType(QComboBox& box, RawType type) {
    box.setCurrentIndex(int(std::find(std::begin(types), std::end(types), type) - std::begin(types)));
}

bool needsRawSize(const Options& options) {
    if (!isHeaderless(options.heightMap)) return false;
    const std::int64_t length = lengthOf(options.heightMap), width = bytesOf(options.rawType.value_or(RawType::UInt8));
    if (length == 0) return false;
    if (options.rawSize) return std::int64_t(options.rawSize->x) * options.rawSize->y * width != length;
    return length % width != 0 || !isSquare(length / width);
}

bool askRawSize(QWidget* parent, Options& options) {
    const std::int64_t length = lengthOf(options.heightMap);
    const RawType type = likelyType(options, length);
    const glm::ivec2 size = likelySize(length / bytesOf(type));
    QDialog dialog(parent);
    dialog.setWindowTitle("Size of a headerless file");
    auto* columns = makeSide(size.x);
    auto* rows = makeSide(size.y);
    auto* kind = makeRawTypeBox();
    chooseRawType(*kind, type);
    auto* verdict = new QLabel;
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel);
    const auto judge = [&] {
        const std::int64_t expected = std::int64_t(columns->value()) * rows->value() * bytesOf(chosenRawType(*kind));
        buttons->button(QDialogButtonBox::Ok)->setEnabled(expected == length);
        verdict->setText(expected == length ? QString("That is the file's length: %1 bytes.").arg(length)
                                            : QString("That makes %1 bytes; the file has %2.").arg(expected).arg(length));
    };
    for (QSpinBox* box : {columns, rows}) QObject::connect(box, QOverload<int>::of(&QSpinBox::valueChanged), &dialog, judge);
    QObject::connect(kind, QOverload<int>::of(&QComboBox::currentIndexChanged), &dialog, judge);
    QObject::connect(buttons, &QDialogButtonBox::accepted, &dialog, &QDialog::accept);
    QObject::connect(buttons, &QDialogButtonBox::rejected, &dialog, &QDialog::reject);
    auto* form = new QFormLayout(&dialog);
    form->addRow(new QLabel(QString::fromLocal8Bit(options.heightMap.c_str())));
    form->addRow("&Columns", columns);
    form->addRow("&Rows", rows);
    form->addRow("&Samples", kind);
    form->addRow(verdict);
    form->addRow(buttons);
    judge();
    if (dialog.exec() != QDialog::Accepted) return false;
    options.rawSize = glm::ivec2(columns->value(), rows->value());
    options.rawType = chosenRawType(*kind);
    return true;
}

}  // namespace app

#endif
