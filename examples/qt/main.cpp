// terrain-window SCENE.iv [PICTURE.png]: a scene file in a window; with a picture, writes the first complete frame and ends.
#include "SceneWidget.h"

#include <QApplication>
#include <QSurfaceFormat>

#include <cstdio>

#include <Inventor/SoDB.h>
#include <Inventor/SoInput.h>
#include <Inventor/SoInteraction.h>
#include <Inventor/nodes/SoSeparator.h>

#include <SoTerrain/SoTerrain.h>

int main(int argc, char ** argv)
{
    // Coin draws with the fixed functions of a compatibility profile. Every context takes this format, so it comes first.
    QSurfaceFormat format;
    format.setProfile(QSurfaceFormat::CompatibilityProfile);
    format.setDepthBufferSize(24);
    QSurfaceFormat::setDefaultFormat(format);
    QApplication application(argc, argv);
    if (argc < 2) {
        std::fprintf(stderr, "Usage: terrain-window SCENE.iv [PICTURE.png]\n");
        return 2;
    }
    SoDB::init();
    SoInteraction::init();
    SoTerrain::init();

    SoInput file;
    SoSeparator * scene = file.openFile(argv[1]) ? SoDB::readAll(&file) : nullptr;
    if (!scene) return 1;
    SceneWidget widget(scene);
    widget.setWindowTitle("SoTerrain");
    widget.resize(800, 600);
    int status = 0;
    if (argc > 2)
        QObject::connect(&widget, &SceneWidget::drawn, &application, [&] {
            status = widget.grabFramebuffer().save(argv[2]) ? 0 : 1;
            QApplication::quit();
        }, Qt::QueuedConnection);
    widget.show();
    return application.exec() || status;
}
