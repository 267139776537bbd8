// What the Help menu shows.
#pragma once

#include <string>

#include <QString>

class QDialog;
class QWidget;

namespace app {

/// A table of all keys and mouse buttons, which stays open beside the window. The parent owns it.
QDialog* makeKeysDialog(QWidget* parent);
/// What this program is and which versions it runs with, as rich text. `renderer`: of OpenGL.
QString aboutText(const std::string& renderer);

}  // namespace app
