// A Coin scene in a Qt widget, without SoQt and without Quarter (which Debian 12 does not have).
#ifndef SOTERRAIN_EXAMPLE_SCENEWIDGET_H
#define SOTERRAIN_EXAMPLE_SCENEWIDGET_H

#include <QOpenGLWidget>
#include <QTimer>

#include <memory>

class SoEvent;
class SoPerspectiveCamera;
class SoRenderManager;
class SoSeparator;

/// Draws a scene, passes mouse events to it, and turns the camera around what is in view: drag with the left button, zoom with the wheel.
class SceneWidget : public QOpenGLWidget {
    Q_OBJECT

public:
    /// The widget keeps \a scene. It uses the scene's own perspective camera and light, and brings what the scene lacks.
    explicit SceneWidget(SoSeparator * scene, QWidget * parent = nullptr);
    ~SceneWidget() override;

signals:
    /// After each frame of which nothing is left for a later one.
    void drawn();

protected:
    void initializeGL() override;
    void resizeGL(int width, int height) override;
    void paintGL() override;
    void mousePressEvent(QMouseEvent * event) override;
    void mouseReleaseEvent(QMouseEvent * event) override;
    void mouseMoveEvent(QMouseEvent * event) override;
    void wheelEvent(QWheelEvent * event) override;

private:
    bool pass(SoEvent & event, const QPoint & place);
    void passButton(QMouseEvent * event, bool isDown);
    void turn(float aroundUp, float aroundSide);

    SoPerspectiveCamera * camera;
    std::unique_ptr<SoRenderManager> manager;
    QTimer sensors;
    QPoint last;
};

#endif
