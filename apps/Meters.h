// Six graphs over the picture: what a frame takes.
#pragma once

#include <Inventor/nodes/SoSeparator.h>
#include <SoTerrain/SoPerfGraph.h>

#include "NodePtr.h"

namespace app {

/// On top, small: times of selection, of upload and of building new data, and triangles. Below, larger: frames in a second, and memory.
class Meters {
public:
    Meters();

    /// To be drawn after everything else.
    SoSeparator* root() const { return root_.get(); }
    void setOn(bool on);
    bool isOn() const { return small_->on.getValue(); }
    /// Pixels for one of a usual display.
    void setScale(float scale);

private:
    NodePtr<SoSeparator> root_;
    SoPerfGraph* small_;
    SoPerfGraph* large_;
};

}  // namespace app
