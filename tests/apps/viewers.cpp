// Two SoQt viewers and a context without a window on one scene; viewers that open and close. `viewers FOLDER CLASS` saves pictures
// as FOLDER/*.png, and says what happened to memory and GL objects. CLASS is a terrain node.
#include <epoxy/gl.h>

#include "../gl/GlLedger.h"

#include <QApplication>
#include <QGLWidget>
#include <QImage>
#include <QOpenGLContext>
#include <QPixmap>
#include <QScreen>
#include <QWidget>

#include <malloc.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>

#include <Inventor/Qt/SoQt.h>
#include <Inventor/Qt/viewers/SoQtExaminerViewer.h>
#include <Inventor/SoOffscreenRenderer.h>
#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/elements/SoGLCacheContextElement.h>
#include <Inventor/misc/SoContextHandler.h>
#include <Inventor/nodes/SoCoordinate3.h>
#include <Inventor/nodes/SoDirectionalLight.h>
#include <Inventor/nodes/SoPerspectiveCamera.h>
#include <Inventor/nodes/SoSeparator.h>

#include <SoTerrain/SoTerrain.h>

#include "gl/HeadlessContext.h"

namespace {

constexpr int kSide = 129;
int failures = 0;

void check(bool isTrue, const char* what) {
    if (isTrue) return;
    std::printf("FAIL: %s\n", what);
    ++failures;
}

const void* currentContext() {
    return QOpenGLContext::currentContext();
}

double residentMegabytes() {
    malloc_trim(0);
    double value = 0.0;
    if (std::FILE* file = std::fopen("/proc/self/status", "r")) {
        char line[256];
        while (std::fgets(line, sizeof line, file))
            if (std::strncmp(line, "VmRSS:", 6) == 0) value = std::atof(line + 6) / 1024.0;
        std::fclose(file);
    }
    return value;
}

SoSeparator* makeScene(const char* nodeClass) {
    auto* root = new SoSeparator;
    auto* light = new SoDirectionalLight;
    light->direction.setValue(0.3f, 0.5f, -1.0f);
    root->addChild(light);
    auto* coordinates = new SoCoordinate3;
    coordinates->point.setNum(kSide * kSide);
    SbVec3f* points = coordinates->point.startEditing();
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
            points[y * kSide + x].setValue(float(x), float(y), 8.0f * std::sin(0.11f * float(x)) * std::cos(0.07f * float(y)));
    coordinates->point.finishEditing();
    root->addChild(coordinates);
    auto* shape = static_cast<SoNode*>(SoType::fromName(nodeClass).createInstance());
    for (const char* size : {"verticesPerRow", "verticesPerColumn"}) shape->getField(size)->set(std::to_string(kSide).c_str());
    root->addChild(shape);
    return root;
}

class Viewer {
public:
    Viewer(SoNode* scene, int left, test::GlLedger& ledger, const Viewer* sharedWith = nullptr) : ledger_(ledger) {
        viewer_ = std::make_unique<SoQtExaminerViewer>(static_cast<QWidget*>(nullptr));
        viewer_->setDecoration(FALSE);
        viewer_->setBackgroundColor(SbColor(0.0f, 0.0f, 0.4f));
        viewer_->setTransparencyType(SoGLRenderAction::BLEND);
        viewer_->setSceneGraph(scene);
        viewer_->setSize(SbVec2s(300, 240));
        viewer_->getShellWidget()->move(left, 0);
        viewer_->getCamera()->orientation = SbRotation(SbVec3f(1.0f, 0.0f, 0.0f), 0.9f);
        viewer_->viewAll();
        viewer_->show();
        spin();
        context_ = static_cast<QGLWidget*>(viewer_->getGLWidget())->context()->contextHandle();
        if (sharedWith) {
            check(QOpenGLContext::areSharing(const_cast<QOpenGLContext*>(static_cast<const QOpenGLContext*>(context_)),
                                             const_cast<QOpenGLContext*>(static_cast<const QOpenGLContext*>(sharedWith->context_))),
                  "SoQt's viewers share their GL objects");
            ledger_.share(context_, sharedWith->context_);
        }
    }
    ~Viewer() {
        QWidget* shell = viewer_->getShellWidget();
        viewer_.reset();
        delete shell;
        spin();
        ledger_.forget(context_);
    }
    void spin() {
        for (int i = 0; i < 3; ++i) {
            if (viewer_) viewer_->render();
            QApplication::processEvents();
        }
    }
    void turn(float angle) {
        viewer_->getCamera()->orientation = SbRotation(SbVec3f(1.0f, 0.0f, 0.0f), angle);
        spin();
    }
    /// How many of its pixels show terrain, as soon as it is many: a server that is busy shows a window some time after it was drawn.
    int seen(const std::string& file) {
        constexpr int kTries = 50, kMany = 5000;
        int count = 0;
        for (int i = 0; i < kTries && count <= kMany; ++i) {
            if (i > 0) usleep(100000);
            count = pixelsSeen(file);
        }
        return count;
    }
    int pixelsSeen(const std::string& file) {
        spin();
        QWidget* area = viewer_->getGLWidget();
        const QImage image = QGuiApplication::primaryScreen()->grabWindow(area->winId()).toImage();
        image.save(QString::fromStdString(file));
        int count = 0;
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x) {
                const QColor colour = image.pixelColor(x, y);
                count += std::abs(colour.red() - colour.blue()) < 20 && colour.red() > 30;
            }
        return count;
    }
    const void* context() const { return context_; }

private:
    test::GlLedger& ledger_;
    std::unique_ptr<SoQtExaminerViewer> viewer_;
    const void* context_ = nullptr;
};

/// The same scene in a context without a window, current instead of Qt's.
void drawWithoutWindow(SoNode* scene, const char* what) {
    // A thread has one current context, of whatever kind.
    if (QOpenGLContext* current = QOpenGLContext::currentContext()) current->doneCurrent();
    auto made = terrain::HeadlessContext::create(300, 240);
    if (!made) {
        std::printf("no context without a window: %s\n", made.error().message().c_str());
        return;
    }
    auto* root = new SoSeparator;
    root->ref();
    auto* camera = new SoPerspectiveCamera;
    camera->orientation = SbRotation(SbVec3f(1.0f, 0.0f, 0.0f), 0.9f);
    root->addChild(camera);
    root->addChild(scene);
    const SbViewportRegion region(300, 240);
    camera->viewAll(root, region);
    SoGLRenderAction action(region);
    action.setCacheContext(SoGLCacheContextElement::getUniqueCacheContext());
    made.value()->bindFramebuffer();
    glClearColor(0.0f, 0.0f, 0.4f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    action.apply(root);
    check(glGetError() == GL_NO_ERROR, what);
    const terrain::Image image = made.value()->readColor();
    int count = 0;
    for (std::size_t i = 0; i < image.pixels.size(); i += 3) count += image.pixels[i] > 30;
    std::printf("without a window %d pixels\n", count);
    check(count > 5000, what);
    SoContextHandler::destructingContext(action.getCacheContext());
    root->unref();
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    const std::string folder = argv[1];
    QWidget* main = SoQt::init("viewers");
    if (!main) return 77;
    SoTerrain::init();
    test::GlLedger ledger(currentContext);
    SoSeparator* scene = makeScene(argv[2]);
    scene->ref();
    const std::string name = folder + "/viewers_" + argv[2];
    {
        auto first = std::make_unique<Viewer>(scene, 0, ledger);
        auto second = std::make_unique<Viewer>(scene, 320, ledger, first.get());
        const int a = first->seen(name + "_first.png"), b = second->seen(name + "_second.png");
        std::printf("first viewer %d pixels, second %d\n", a, b);
        check(a > 5000 && b > 5000, "both viewers show the terrain");
        drawWithoutWindow(scene, "a context without a window beside them shows the terrain");
        SoOffscreenRenderer renderer(SbViewportRegion(200, 160));
        std::printf("Coin's SoOffscreenRenderer: %s\n", renderer.render(scene) ? "drawn" : "not in this display");
        second.reset();
        first->turn(1.2f);
        const int alone = first->seen(name + "_alone.png");
        std::printf("first alone %d pixels\n", alone);
        check(alone > 5000, "one goes on when the other has closed");

        double before = 0.0;
        std::string objects;
        for (int i = 0; i < 60; ++i) {
            second = std::make_unique<Viewer>(scene, 320, ledger, first.get());
            if (i == 59) check(second->seen(name + "_last.png") > 5000, "the last to open shows the terrain");
            second.reset();
            first->spin();
            if (i == 9) before = residentMegabytes(), objects = test::GlLedger::text(ledger.all());
        }
        check(first->seen(name + "_after.png") > 5000, "the first shows the terrain after all");
        std::printf("GL objects: %s, after 50 more viewers %s\n", objects.c_str(), test::GlLedger::text(ledger.all()).c_str());
        check(objects == test::GlLedger::text(ledger.all()), "GL objects stay as many");
        std::printf("growth beside one: %.2f MB\n", residentMegabytes() - before);
    }
    double before = 0.0;
    for (int i = 0; i < 40; ++i) {
        Viewer viewer(scene, 0, ledger);
        if (i == 9) before = residentMegabytes();
        if (i == 39) check(viewer.seen(name + "_reopened.png") > 5000, "the last to open alone shows the terrain");
    }
    std::printf("growth alone: %.2f MB\n", residentMegabytes() - before);
    for (const std::string& stray : ledger.strays()) std::printf("FAIL: deleted where it was not: %s\n", stray.c_str()), ++failures;
    scene->unref();
    SoQt::done();
    return failures > 0;
}
