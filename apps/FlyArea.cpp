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
#include <QWidget>

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
    all->addChild(legend_.root());
    all->addChild(statusLine_.root());
    all->addChild(meters_.root());
    meters_.setOn(options.meters);
    setBackgroundColor(SbColor(skyColor));
    setSceneGraph(all);
    timer_.setTimerType(Qt::PreciseTimer);
    QObject::connect(&timer_, &QTimer::timeout, [this] { tick(); });
    if (options.replays() && ends_)
        startReplay(animation_, options.repeat.value_or(1), options.repeat.has_value());
    else if (options.animates())
        play(animation_);
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
        endReplay(false);
        play_.reset();
        formerError_.reset();
    }
    if (!play_ && !replay_) {
        camera_.setPose(pose);
        scene_.setPose(pose);
    }
    terrainChanged();
}

void FlyArea::terrainChanged() {
    // A replay is of the terrain that it began with.
    if (isReplaying()) takeOver();
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
    legend_.update(scene_, getViewportRegion().getViewportSizePixels());
    meters_.setScale(float(getGLWidget()->devicePixelRatioF()));
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
    if (play_ || replay_) {
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
    if (!play_ && !replay_ && !textDue_ && now > activeUntilMs_) timer_.stop();
}

// The animation's clock starts with its first frame, after the window and the first upload.
void FlyArea::advance(double now) {
    if (due_ || renderer_.empty()) return;
    if (replay_) return advanceReplay(now);
    const FrameSchedule& schedule = play_->animation.schedule;
    if (play_->last < 0) {
        play_->startMs = now;
        took_ = {schedule.durationMs};
    }
    const double elapsed = now - play_->startMs;
    const auto next = schedule.next(play_->last, elapsed);
    // A frame that is not synchronised has its duration too, but a late one delays all that follow.
    double wait = 0.0;
    if (schedule.synchronized)
        wait = next ? next->waitMs : schedule.durationMs - elapsed;
    else if (next && play_->last >= 0)
        wait = lastDueMs_ + schedule.stepMs - now;
    if (wait > 0.5) {
        // The end of a synchronised animation does not wait for the next tick.
        if (wait < tickMs) QTimer::singleShot(int(std::ceil(wait)), Qt::PreciseTimer, &timer_, [this] { tick(); });
        return;
    }
    if (!next) return endOfAnimation();
    play_->last = next->frame;
    scene_.setPose(play_->animation.pose(next->frame));
    freezeInTime(scene_, options_, play_->animation.schedule.time(next->frame));
    due_ = true;
    lastDueMs_ = now;
    scheduleRedraw();
}

void FlyArea::endOfAnimation() {
    if (isReplaying()) {
        camera_.setPose(scene_.pose());
        endReplay(true);
        wake();
    } else if (ends_) {
        if (play_) {
            took_.lastedMs = nowMs() - play_->startMs;
            log_.animation(took_);
        }
        endReplay(true);
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
    if ((play_ || replay_) && !ends_) {
        endReplay(false);
        play_.reset();
        camera_.setPose(scene_.pose());
    }
    wake();
}

void FlyArea::actualRedraw() {
    if (prepare_) prepare_();
    const Stopwatch watch;
    // What refreshes the window between two frames of a replay leaves their meshes alone.
    scene_.holdMeshes(replay_ && !due_ && !renderer_.empty());
    SoQtRenderArea::actualRedraw();
    scene_.holdMeshes(false);
    noteScene();
    if (logging_ || replay_) glFinish();
    const Duration took = watch.elapsed();
    if (renderer_.empty()) {
        const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
        renderer_ = name ? name : "unknown";
        log_.setStart(loadMs_, took.wallMs);
        return;
    }
    frameMs_ = smooth(frameMs_, took.wallMs);
    const double end = nowMs(), interval = end - lastRedrawMs_;
    intervalMs_ = interval < restMs ? smooth(intervalMs_, interval) : 0.0;
    lastRedrawMs_ = end;
    logFrame(took);
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
    // SoQt 1.6.0 gives its widget as many points as the picture has pixels, which are more on a display of high density.
    QWidget* widget = getGLWidget();
    statusLine_.setScale(float(widget->devicePixelRatioF()));
    if (widget->parentWidget() && widget->devicePixelRatioF() != 1.0) widget->setGeometry(widget->parentWidget()->rect());
    drawnScene_ = 0;
    resized_ = true;
    // Frames of another size have other meshes.
    if (isReplaying() && replay_->isMeasured()) takeOver();
    wake();
}

glm::ivec2 FlyArea::sizePixels() const {
    const SbVec2s size = getViewportRegion().getViewportSizePixels();
    return {size[0], size[1]};
}

void FlyArea::logFrame(const Duration& took) {
    if ((play_ || replay_) && !due_) return;  // a redraw of the same frame, for the window's sake
    due_ = false;
    if (replay_) return logReplay(took);
    frame_ = play_ ? play_->last : frame_ + 1;
    const double now = nowMs(), time = play_ ? play_->animation.schedule.time(frame_) : now - startMs_;
    if (play_) took_.longestFrameMs = std::max(took_.longestFrameMs, now - lastDueMs_);
    if (recording_ && now - startMs_ > recording_->back().timeMs) recording_->push_back({now - startMs_, scene_.pose()});
    if (logging_) logScene(frame_, time, took);
}

void FlyArea::logScene(int frame, double timeMs, const Duration& took) {
    log_.frame(frame, timeMs, took, scene_);
    if (!log_.measures(frame)) return;
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

void FlyArea::say(const std::string& message) {
    message_ = message;
    textMs_ = 0.0;
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
    if (isFrozen(scene_)) line += "   frozen";
    if (camera_.constantHeight()) line += "   constant height";
    if (recording_) line += "   recording";
    return message_.empty() ? line : line + "   " + message_;
}

}  // namespace app

#endif
