#include "Meters.h"

namespace app {

namespace {

// Above the line of status that stands over a full screen.
constexpr float margin = 8.0f, statusHeight = 34.0f;

}  // namespace

Meters::Meters() : root_(new SoSeparator), small_(new SoPerfGraph), large_(new SoPerfGraph) {
    root_->renderCaching = SoSeparator::OFF;
    const char* inside[] = {"selection", "upload", "building", "triangles"};
    small_->counter.setValues(0, 4, inside);
    small_->counter.setNum(4);
    small_->position.setValue(margin, -margin);
    const char* outside[] = {"fps", "memory"};
    large_->counter.setValues(0, 2, outside);
    large_->counter.setNum(2);
    large_->position.setValue(margin, statusHeight);
    large_->size.setValue(246.0f, 70.0f);
    const SbColor colors[] = {{1.0f, 1.0f, 0.5f}, {0.8f, 0.6f, 1.0f}};
    large_->color.setValues(0, 2, colors);
    large_->color.setNum(2);
    root_->addChild(small_);
    root_->addChild(large_);
    setOn(false);
}

void Meters::setOn(bool on) {
    small_->on = on;
    large_->on = on;
}

void Meters::setScale(float scale) {
    if (small_->scale.getValue() == scale) return;
    small_->scale = scale;
    large_->scale = scale;
}

}  // namespace app
