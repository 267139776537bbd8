#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#ifdef HAVE_SOQT

#include "HelpDialogs.h"

#include <Inventor/Qt/SoQtBasic.h>
#include <Inventor/SoDB.h>
#include <QAction>
#include <QDialog>
#include <QDialogButtonBox>
#include <QHeaderView>
#include <QKeySequence>
#include <QTableWidget>
#include <QVBoxLayout>
#include <SoTerrain/SoTerrain.h>

#include "Commands.h"

namespace app {

namespace {

struct KeyHelp {
    QString keys;
    QString help;
};

const KeyHelp steering[] = {
    {"W, S", "Fly forward, back"},
    {"A, D", "Fly to the left, to the right"},
    {"Q, E", "Fly up, down"},
    {QString::fromUtf8("\u2190 \u2192 \u2191 \u2193"), "Turn"},
    {"PgUp, PgDown", "Roll"},
    {"Mouse: drag", "Look around"},
    {"Mouse: wheel", "Fly faster, slower"},
};

QString shown(const std::string& keys) {
    QStringList names;
    for (const QString& key : QString::fromStdString(keys).split(' ', Qt::SkipEmptyParts))
        names.append(QKeySequence(key).toString(QKeySequence::NativeText));
    return names.join(", ");
}

void addRow(QTableWidget& table, const KeyHelp& line) {
    const int row = table.rowCount();
    table.insertRow(row);
    table.setItem(row, 0, new QTableWidgetItem(line.keys));
    table.setItem(row, 1, new QTableWidgetItem(line.help));
}

}  // namespace

QDialog* makeKeysDialog(QWidget* parent) {
    auto* dialog = new QDialog(parent);
    dialog->setWindowTitle("Keys of SoTerrainTest");
    auto* table = new QTableWidget(0, 2, dialog);
    table->setHorizontalHeaderLabels({"Key", "What it does"});
    table->verticalHeader()->hide();
    table->setEditTriggers(QAbstractItemView::NoEditTriggers);
    table->setSelectionBehavior(QAbstractItemView::SelectRows);
    table->setAlternatingRowColors(true);
    table->setShowGrid(false);
    for (const KeyHelp& line : steering) addRow(*table, line);
    for (const Command& command : commands()) {
        if (!command.keys.empty()) addRow(*table, {shown(command.keys), QString::fromStdString(command.help)});
    }
    table->horizontalHeader()->setDefaultAlignment(Qt::AlignLeft | Qt::AlignVCenter);
    table->horizontalHeader()->setStretchLastSection(true);
    table->setWordWrap(true);
    table->resizeColumnToContents(0);
    table->horizontalHeader()->setSectionResizeMode(1, QHeaderView::Stretch);
    table->verticalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close, dialog);
    QObject::connect(buttons, &QDialogButtonBox::rejected, dialog, &QDialog::hide);
    auto* layout = new QVBoxLayout(dialog);
    layout->addWidget(table);
    layout->addWidget(buttons);
    dialog->resize(680, 640);
    return dialog;
}

QString aboutText(const std::string& renderer) {
    return QString("<h3>SoTerrainTest %1</h3>"
                   "<p>Flies over terrain with level of detail whose error on screen is bounded.</p>"
                   "<p>%2<br>SoQt %3<br>Qt %4<br>OpenGL: %5</p>")
        .arg(SoTerrain::getVersion(), SoDB::getVersion(), SOQT_VERSION, qVersion(),
             QString::fromStdString(renderer).toHtmlEscaped());
}

}  // namespace app

#endif
