#include "SceneWidget.h"

#include <QMouseEvent>
#include <QOpenGLContext>
#include <QOpenGLFunctions>
#include <QWheelEvent>

#include <cmath>

#include <Inventor/SbViewportRegion.h>
#include <Inventor/SoDB.h>
#include <Inventor/SoRenderManager.h>
#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/actions/SoHandleEventAction.h>
#include <Inventor/actions/SoSearchAction.h>
#include <Inventor/events/SoLocation2Event.h>
#include <Inventor/events/SoMouseButtonEvent.h>
#include <Inventor/nodes/SoDirectionalLight.h>
#include <Inventor/nodes/SoPerspectiveCamera.h>
#include <Inventor/nodes/SoSeparator.h>
#include <Inventor/sensors/SoSensorManager.h>

// The first node of a class in a scene, or null.
static SoNode * firstOf(SoNode * scene, SoType type)
{
    SoSearchAction search;
    search.setType(type);
    search.apply(scene);
    return search.getPath() ? search.getPath()->getTail() : nullptr;
}

SceneWidget::SceneWidget(SoSeparator * scene, QWidget * parent) : QOpenGLWidget(parent), camera(nullptr), manager(new SoRenderManager)
{
    SoSeparator * root = new SoSeparator;
    root->ref();
    root->addChild(scene);
    if (!firstOf(scene, SoLight::getClassTypeId())) {
        SoDirectionalLight * light = new SoDirectionalLight;
        light->direction.setValue(0.5f, 0.5f, -1.0f);
        root->insertChild(light, 0);
    }
    camera = static_cast<SoPerspectiveCamera *>(firstOf(scene, SoPerspectiveCamera::getClassTypeId()));
    if (!camera) {
        camera = new SoPerspectiveCamera;
        root->insertChild(camera, 0);
        camera->orientation.setValue(SbVec3f(1.0f, 0.0f, 0.0f), 1.1f);
        camera->viewAll(root, SbViewportRegion(4, 3));
        camera->heightAngle = 0.5f;
    }
    manager->setSceneGraph(root);
    manager->setCamera(camera);
    manager->setAutoClipping(SoRenderManager::VARIABLE_NEAR_PLANE);
    manager->setBackgroundColor(SbColor4f(0.7f, 0.8f, 0.95f, 1.0f));
    root->unref();
    // A changed scene asks for a frame. So do nodes that have more to show than one frame could load.
    manager->setRenderCallback([](void * widget, SoRenderManager *) { static_cast<SceneWidget *>(widget)->update(); }, this);
    manager->activate();
    // Coin's sensors run from Qt's event loop.
    connect(&sensors, &QTimer::timeout, [this] {
        SoDB::getSensorManager()->processTimerQueue();
        SoDB::getSensorManager()->processDelayQueue(TRUE);
    });
    sensors.start(10);
}

SceneWidget::~SceneWidget()
{
    // What Coin holds in GL goes while its context is current.
    makeCurrent();
    manager->setSceneGraph(nullptr);
    manager.reset();
    doneCurrent();
}

void SceneWidget::initializeGL()
{
    // Widgets whose contexts share objects would share this number too.
    static uint32_t contexts = 0;
    manager->getGLRenderAction()->setCacheContext(++contexts);
}

void SceneWidget::resizeGL(int, int)
{
    // Pixels, which on dense screens are more than Qt's units: pixelError counts pixels.
    const QSize pixels = size() * devicePixelRatioF();
    manager->setViewportRegion(SbViewportRegion(short(pixels.width()), short(pixels.height())));
}

void SceneWidget::paintGL()
{
    // Coin leaves this to the window.
    context()->functions()->glEnable(GL_DEPTH_TEST);
    manager->render(TRUE, TRUE);
    if (!SoDB::getSensorManager()->isDelaySensorPending()) emit drawn();
}

bool SceneWidget::pass(SoEvent & event, const QPoint & place)
{
    const QPoint pixel = place * devicePixelRatioF();
    const short height = manager->getViewportRegion().getViewportSizePixels()[1];
    event.setPosition(SbVec2s(short(pixel.x()), short(height - 1 - pixel.y())));
    event.setTime(SbTime::getTimeOfDay());
    SoHandleEventAction action(manager->getViewportRegion());
    action.setEvent(&event);
    action.apply(manager->getSceneGraph());
    return action.isHandled();
}

void SceneWidget::passButton(QMouseEvent * event, bool isDown)
{
    SoMouseButtonEvent button;
    button.setState(isDown ? SoButtonEvent::DOWN : SoButtonEvent::UP);
    button.setButton(event->button() == Qt::LeftButton    ? SoMouseButtonEvent::BUTTON1
                     : event->button() == Qt::RightButton ? SoMouseButtonEvent::BUTTON2
                                                          : SoMouseButtonEvent::BUTTON3);
    last = event->pos();
    pass(button, event->pos());
}

void SceneWidget::mousePressEvent(QMouseEvent * event)
{
    passButton(event, true);
}

void SceneWidget::mouseReleaseEvent(QMouseEvent * event)
{
    passButton(event, false);
}

void SceneWidget::mouseMoveEvent(QMouseEvent * event)
{
    SoLocation2Event moved;
    const bool isTaken = pass(moved, event->pos());
    const QPoint way = event->pos() - last;
    last = event->pos();
    if (!isTaken && (event->buttons() & Qt::LeftButton)) turn(-0.005f * way.x(), -0.005f * way.y());
}

void SceneWidget::wheelEvent(QWheelEvent * event)
{
    SbVec3f ahead;
    camera->orientation.getValue().multVec(SbVec3f(0.0f, 0.0f, -1.0f), ahead);
    const float distance = camera->focalDistance.getValue();
    const float nearer = distance * std::pow(0.999f, float(event->angleDelta().y()));
    camera->position.setValue(camera->position.getValue() + (distance - nearer) * ahead);
    camera->focalDistance = nearer;
}

// Around the point that the camera looks at; z is up.
void SceneWidget::turn(float aroundUp, float aroundSide)
{
    const SbRotation before = camera->orientation.getValue();
    SbVec3f ahead;
    before.multVec(SbVec3f(0.0f, 0.0f, -1.0f), ahead);
    const SbVec3f center = camera->position.getValue() + camera->focalDistance.getValue() * ahead;
    const SbRotation after = SbRotation(SbVec3f(1.0f, 0.0f, 0.0f), aroundSide) * before * SbRotation(SbVec3f(0.0f, 0.0f, 1.0f), aroundUp);
    after.multVec(SbVec3f(0.0f, 0.0f, -1.0f), ahead);
    camera->orientation = after;
    camera->position = center - camera->focalDistance.getValue() * ahead;
}
