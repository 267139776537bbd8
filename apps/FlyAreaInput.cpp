// Keys that are held, mouse and commands of the render area.
#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#ifdef HAVE_SOQT

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstdio>

#include <Inventor/fields/SoSFBool.h>
#include <Inventor/fields/SoSFFloat.h>
#include <Inventor/fields/SoSFInt32.h>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QWheelEvent>
#include <QWidget>

#include <SoTerrain/SoTerrainShape.h>

#include "FlyArea.h"

namespace app {

namespace {

struct SteeringKey {
    int key;
    FlyAxis axis;
    float amount;
};

constexpr SteeringKey steeringKeys[] = {
    {Qt::Key_W, FlyAxis::Forward, 1.0f},   {Qt::Key_S, FlyAxis::Forward, -1.0f},  {Qt::Key_D, FlyAxis::Right, 1.0f},
    {Qt::Key_A, FlyAxis::Right, -1.0f},    {Qt::Key_Q, FlyAxis::Up, 1.0f},        {Qt::Key_E, FlyAxis::Up, -1.0f},
    {Qt::Key_Left, FlyAxis::Turn, 1.0f},   {Qt::Key_Right, FlyAxis::Turn, -1.0f}, {Qt::Key_Up, FlyAxis::Pitch, 1.0f},
    {Qt::Key_Down, FlyAxis::Pitch, -1.0f}, {Qt::Key_PageUp, FlyAxis::Roll, 1.0f}, {Qt::Key_PageDown, FlyAxis::Roll, -1.0f},
};

constexpr float errorStep = 1.25f;
constexpr float radiansPerPixel = 0.004f;

}  // namespace

void FlyArea::processEvent(QEvent* event) {
    switch (event->type()) {
    case QEvent::KeyPress:
    case QEvent::KeyRelease: {
        const auto& key = static_cast<const QKeyEvent&>(*event);
        if (key.isAutoRepeat() || steer(key, event->type() == QEvent::KeyPress)) return;
        break;
    }
    case QEvent::FocusOut:
        camera_.releaseAll();
        break;
    case QEvent::MouseButtonPress:
    case QEvent::MouseButtonRelease:
    case QEvent::MouseMove:
        if (mouse(static_cast<const QMouseEvent&>(*event))) return;
        break;
    case QEvent::Wheel: {
        const int steps = static_cast<const QWheelEvent&>(*event).angleDelta().y();
        camera_.changeSpeed(std::pow(1.2f, float(steps) / 120.0f));
        return;
    }
    default:
        break;
    }
    SoQtRenderArea::processEvent(event);
}

bool FlyArea::steer(const QKeyEvent& event, bool press) {
    const auto known = std::find_if(std::begin(steeringKeys), std::end(steeringKeys),
                                    [&](const SteeringKey& steering) { return steering.key == event.key(); });
    if (known == std::end(steeringKeys)) return false;
    camera_.push(known->axis, press ? known->amount : -known->amount);
    takeOver();
    return true;
}

void FlyArea::takeFocus() {
    getGLWidget()->setFocusPolicy(Qt::StrongFocus);
    getGLWidget()->setFocus();
}

bool FlyArea::hasField(const char* name) const {
    return scene_.terrain() && scene_.terrain()->getField(name);
}

bool FlyArea::culling() const {
    const auto* field = scene_.terrain() ? dynamic_cast<SoSFBool*>(scene_.terrain()->getField("frustumCulling")) : nullptr;
    return field && field->getValue();
}

void FlyArea::toggleCulling() {
    auto* field = scene_.terrain() ? dynamic_cast<SoSFBool*>(scene_.terrain()->getField("frustumCulling")) : nullptr;
    if (field) field->setValue(!field->getValue());
}

void FlyArea::toggleConstantHeight() {
    camera_.setConstantHeight(!camera_.constantHeight());
}

void FlyArea::goHome() {
    takeOver();
    camera_.setPose(scene_.home());
    scene_.setPose(scene_.home());
}

void FlyArea::scalePixelError(int direction) {
    auto* field = scene_.terrain() ? dynamic_cast<SoSFFloat*>(scene_.terrain()->getField("pixelError")) : nullptr;
    if (!field) return;
    const float before = formerError_.value_or(field->getValue());
    formerError_.reset();
    field->setValue(std::clamp(std::max(before, 0.1f) * (direction > 0 ? errorStep : 1.0f / errorStep), 0.1f, 100.0f));
}

void FlyArea::changeLevels(int by) {
    auto* shape = dynamic_cast<SoTerrainShape*>(scene_.terrain());
    auto* field = shape ? dynamic_cast<SoSFInt32*>(shape->getField("activeLevels")) : nullptr;
    if (!field) return;
    const int now = int(shape->getStatistics().levels);
    field->setValue(by == 0 ? 0 : std::max(1, now + by));
}

void FlyArea::toggleDetail() {
    auto* field = scene_.terrain() ? dynamic_cast<SoSFFloat*>(scene_.terrain()->getField("pixelError")) : nullptr;
    if (!field) return;
    if (formerError_) {
        field->setValue(*formerError_);
        formerError_.reset();
    } else {
        formerError_ = field->getValue();
        field->setValue(0.0f);
    }
}

// A button that goes down and up at nearly the same place has not looked around.
bool FlyArea::mouse(const QMouseEvent& event) {
    constexpr int still = 3;
    const std::pair<int, int> here(event.x(), event.y());
    if (event.type() == QEvent::MouseButtonPress && event.button() == Qt::LeftButton) pressed_ = here;
    if (pressed_ && std::max(std::abs(here.first - pressed_->first), std::abs(here.second - pressed_->second)) > still)
        pressed_.reset();
    if (!(event.buttons() & Qt::LeftButton)) {
        if (pressed_ && event.type() == QEvent::MouseButtonRelease) click(event);
        pressed_.reset();
        drag_.reset();
        return false;
    }
    if (drag_ && here != *drag_ && !pressed_) {
        takeOver();
        if (!play_ && !replay_) {
            camera_.look(float(drag_->first - here.first) * radiansPerPixel, float(drag_->second - here.second) * radiansPerPixel);
            scene_.setPose(camera_.pose());
        }
    }
    if (!drag_ || !pressed_) drag_ = here;
    return true;
}

void FlyArea::click(const QMouseEvent& event) {
    if (!tellClick_ || ends_) return;
    const QSize widget = getGLWidget()->size();
    const glm::ivec2 picture = sizePixels();
    const double x = (event.x() + 0.5) / widget.width(), y = 1.0 - (event.y() + 0.5) / widget.height();
    tellClick_(SbVec2s(short(x * picture.x), short(y * picture.y)), SbVec2s(short(picture.x), short(picture.y)),
               event.modifiers() & Qt::ControlModifier);
}

}  // namespace app

#endif
