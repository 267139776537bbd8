// Work in another thread behind a progress bar.
#pragma once

#include <functional>
#include <string>

#include "height/HeightSource.h"

class QWidget;

namespace app {

/// An Errand that keeps windows alive, but for their input: a dialog with a bar and a button to cancel comes when it takes longer
/// than a moment. False when the user cancelled. `parent` may be null.
bool runBehindProgress(QWidget* parent, const std::string& what, const std::function<void(terrain::ReadProgress&)>& work);

}  // namespace app
