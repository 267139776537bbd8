// What a headerless file does not say itself.
#pragma once

#include "Options.h"

class QComboBox;
class QWidget;

namespace app {

/// A choice of sample types.
QComboBox* makeRawTypeBox();
terrain::RawType chosenRawType(const QComboBox& box);
void chooseRawType(QComboBox& box, terrain::RawType type);

/// Whether options.heightMap is a headerless file whose length is not that of what the options say of it, nor of a square.
bool needsRawSize(const Options& options);
/// Asks for columns, rows and type of that file. False when the user does not say.
bool askRawSize(QWidget* parent, Options& options);

}  // namespace app
