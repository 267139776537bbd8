#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#ifdef HAVE_SOQT

#include <epoxy/gl.h>

#include <cmath>
#include <cstdio>

#include <Inventor/Qt/SoQt.h>
#include <Inventor/fields/SoSFFloat.h>
#include <Inventor/nodes/SoSeparator.h>

#include "Clock.h"
#include "FlyArea.h"

namespace app {

namespace {

// How long the status line follows the last motion or key, whether the picture changes or not.
constexpr double restMs = 600.0;
constexpr double textEveryMs = 250.0;
constexpr int tickMs = 8;

double smooth(double old, double value) {
    return old > 0.0 ? old + 0.15 * (value - old) : value;
}

}  // namespace

FlyArea::FlyArea(QWidget* parent, const Options& options, Scene& scene, RunLog& log, Animation animation, double loadMs)
    : SoQtRenderArea(parent, "SoTerrainTest", TRUE), options_(options), scene_(scene), log_(log), animation_(std::move(animation)),
      loadMs_(loadMs), camera_(makeCamera()), startMs_(nowMs()), lastTickMs_(startMs_) {
    ends_ = options.isMeasured();
    logging_ = ends_;
    camera_.setPose(scene.home());
    auto* all = new SoSeparator;
    all->renderCaching = SoSeparator::OFF;
    all->addChild(scene.root());
    all->addChild(statusLine_.root());
    setBackgroundColor(SbColor(skyColor));
    setSceneGraph(all);
    QObject::connect(&timer_, &QTimer::timeout, [this] { tick(); });
    if (options.animate || options.frames || !options.flight.empty()) play(animation_);
    wake();
}

FlyCamera FlyArea::makeCamera() {
    return FlyCamera([this](const SbVec3f& point) { return scene_.groundHeight(point); }, scene_.size());
}

void FlyArea::sceneChanged(bool keepCamera) {
    static_cast<SoSeparator*>(getSceneGraph())->replaceChild(0, scene_.root());
    const Pose pose = keepCamera ? camera_.pose() : scene_.home();
    camera_ = makeCamera();
    if (!keepCamera) {
        endReplay("stopped");
        play_.reset();
        formerError_.reset();
    }
    if (!play_) {
        camera_.setPose(pose);
        scene_.setPose(pose);
    }
    terrainChanged();
}

void FlyArea::terrainChanged() {
    frameMs_ = intervalMs_ = 0.0;
    drawnScene_ = 0;
    textMs_ = 0.0;
    wake();
}

void FlyArea::play(Animation animation) {
    play_ = Play{std::move(animation), 0.0, -1};
    due_ = false;
    scene_.setPose(play_->animation.flight.at(0.0));
    wake();
}

void FlyArea::wake() {
    activeUntilMs_ = nowMs() + restMs;
    runTimer();
}

void FlyArea::runTimer() {
    if (timer_.isActive()) return;
    lastTickMs_ = nowMs();
    timer_.start(tickMs);
}

void FlyArea::tick() {
    const double now = nowMs();
    if (play_) {
        advance(now);
    } else if (camera_.step(float((now - lastTickMs_) * 1e-3))) {
        scene_.setPose(camera_.pose());
        activeUntilMs_ = now + restMs;
    }
    lastTickMs_ = now;
    if (resized_) scheduleRedraw();
    resized_ = false;
    if (now - textMs_ > textEveryMs) {
        textMs_ = now;
        textDue_ = false;
        const std::string text = status();
        if (showsStatus_) statusLine_.setText(text);
        if (tellStatus_) tellStatus_(text);
    }
    if (!play_ && !textDue_ && now > activeUntilMs_) timer_.stop();
}

// The animation's clock starts with its first frame, after the window and the first upload.
void FlyArea::advance(double now) {
    if (due_ || renderer_.empty()) return;
    if (play_->last < 0) play_->startMs = now;
    const FrameSchedule& schedule = play_->animation.schedule;
    const double elapsed = now - play_->startMs;
    const auto next = schedule.next(play_->last, elapsed);
    // A frame that is not synchronised has its duration too, but a late one delays all that follow.
    const bool early =
        next && (schedule.synchronized ? next->waitMs > 0.5 : play_->last >= 0 && now - lastDueMs_ < schedule.stepMs - 0.5);
    if (early || (!next && schedule.synchronized && elapsed < schedule.durationMs)) return;
    if (!next) return endOfAnimation();
    play_->last = next->frame;
    const double time = schedule.time(next->frame), length = play_->animation.flight.duration();
    scene_.setPose(play_->animation.flight.at(time > length && length > 0.0 ? std::fmod(time, length) : time));
    due_ = true;
    lastDueMs_ = now;
    scheduleRedraw();
}

void FlyArea::endOfAnimation() {
    if (replayProfile_) {
        endReplay("played");
        takeOver();
    } else if (ends_) {
        logging_ = false;  // a redraw that still comes is no frame of the animation
        timer_.stop();
        play_.reset();
        SoQt::exitMainLoop();
    } else {
        play(play_->animation);
    }
}

// The user steers from where the animation is.
void FlyArea::takeOver() {
    if (play_ && !ends_) {
        endReplay("stopped");
        play_.reset();
        camera_.setPose(scene_.pose());
    }
    wake();
}

void FlyArea::actualRedraw() {
    const double start = nowMs();
    SoQtRenderArea::actualRedraw();
    noteScene();
    if (logging_ || replayProfile_) glFinish();
    const double end = nowMs();
    if (renderer_.empty()) {
        const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
        renderer_ = name ? name : "unknown";
        log_.setStart(loadMs_, end - start);
        return;
    }
    frameMs_ = smooth(frameMs_, end - start);
    const double interval = end - lastRedrawMs_;
    intervalMs_ = interval < restMs ? smooth(intervalMs_, interval) : 0.0;
    lastRedrawMs_ = end;
    logFrame(end - start);
}

// A mesh may converge long after the last motion, so every frame of a scene that changed calls for a new text. The frame that
// the text itself causes shows the same scene: the text comes to rest with the picture.
void FlyArea::noteScene() {
    const SbUniqueId scene = scene_.root()->getNodeId();
    if (scene == drawnScene_) return;
    drawnScene_ = scene;
    textDue_ = true;
    runTimer();
}

void FlyArea::sizeChanged(const SbVec2s& size) {
    SoQtRenderArea::sizeChanged(size);
    drawnScene_ = 0;
    resized_ = true;
    wake();
}

void FlyArea::logFrame(double frameMs) {
    if (play_ && !due_) return;  // a redraw of the same frame, for the window's sake
    frame_ = play_ ? play_->last : frame_ + 1;
    const double time = play_ ? play_->animation.schedule.time(frame_) : nowMs() - startMs_;
    due_ = false;
    if (recording_) recording_->push_back({time, scene_.pose()});
    if (replayProfile_) {
        FrameFigures figures = scene_.figures();
        figures.frame = frame_;
        figures.timeMs = time;
        figures.frameMs = frameMs;
        replayProfile_->write(figures);
    }
    if (!logging_) return;
    log_.frame(frame_, time, frameMs, scene_);
    if (!log_.measures(frame_)) return;
    problem_ = log_.measure([this] {
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        getGLRenderAction()->apply(scene_.root());
    });
    if (problem_) SoQt::exitMainLoop();
}

void FlyArea::showStatus(bool on) {
    showsStatus_ = on;
    statusLine_.setText(on ? status() : "");
    wake();
}

std::string FlyArea::status() const {
    if (scene_.algorithm().empty()) return message_.empty() ? "no terrain" : message_;
    const FrameFigures figures = scene_.figures();
    char text[200];
    const double ms = intervalMs_ > 0.0 ? std::max(intervalMs_, frameMs_) : frameMs_;
    std::snprintf(text, sizeof text, "%s   %.0f fps   %llu triangles", scene_.algorithm().c_str(), ms > 0.0 ? 1000.0 / ms : 0.0,
                  static_cast<unsigned long long>(figures.triangles));
    std::string line = text;
    if (figures.terrain) {
        const auto* wanted = dynamic_cast<SoSFFloat*>(scene_.terrain()->getField("pixelError"));
        std::snprintf(text, sizeof text, "   error %.2f of %.2f px", figures.terrain->errorPixels,
                      wanted ? wanted->getValue() : 0.0f);
        line += text;
    }
    if (hasField("frustumCulling") && !culling()) line += "   no culling";
    if (formerError_) line += "   full detail";
    if (camera_.constantHeight()) line += "   constant height";
    if (recording_) line += "   recording";
    return message_.empty() ? line : line + "   " + message_;
}

}  // namespace app

#endif
