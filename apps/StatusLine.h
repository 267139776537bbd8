// A line of text over the picture.
#pragma once

#include <string>

#include <Inventor/nodes/SoFont.h>

#include "NodePtr.h"

class SoSeparator;
class SoText2;

namespace app {

/// White text with a dark edge in the lower left corner, in a space of its own.
class StatusLine {
public:
    StatusLine();
    /// To be drawn after the scene.
    SoSeparator* root() const { return root_.get(); }
    void setText(const std::string& text);
    /// Makes the text this much larger than Coin's own.
    void setScale(float scale);

private:
    void addText(float shift, float gray);

    NodePtr<SoSeparator> root_;
    NodePtr<SoFont> font_;  ///< takes part while the text is scaled
    SoText2* text_[2] = {nullptr, nullptr};
    int count_ = 0;
};

}  // namespace app
