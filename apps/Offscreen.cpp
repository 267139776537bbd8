#include "Offscreen.h"

#include <epoxy/gl.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

#include <Inventor/SbViewportRegion.h>
#include <Inventor/SoDB.h>
#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/elements/SoGLCacheContextElement.h>
#include <Inventor/sensors/SoSensorManager.h>

#include "Clock.h"
#include "FrameName.h"
#include "ImageFile.h"
#include "RunLog.h"

namespace app {

using terrain::Error;
using terrain::HeadlessContext;

namespace {

constexpr double patienceMs = 10000.0;

class OffscreenRun {
public:
    OffscreenRun(const Options& options, Scene& scene, HeadlessContext& context)
        : options_(options), scene_(scene), context_(context),
          action_(SbViewportRegion(short(context.width()), short(context.height()))) {
        action_.setCacheContext(SoGLCacheContextElement::getUniqueCacheContext());
        context_.bindFramebuffer();
        glEnable(GL_DEPTH_TEST);
        glClearColor(skyColor[0], skyColor[1], skyColor[2], 1.0f);
    }

    void draw() {
        SoSensorManager* sensors = SoDB::getSensorManager();
        sensors->processTimerQueue();
        sensors->processDelayQueue(TRUE);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        action_.apply(scene_.root());
    }

    /// Milliseconds that a whole frame takes.
    double drawTimed() {
        const double start = nowMs();
        draw();
        glFinish();
        return nowMs() - start;
    }

    /// Draws until nothing is missing. False when that takes too long.
    bool complete() {
        const double end = nowMs() + patienceMs;
        while (!scene_.isComplete()) {
            if (nowMs() > end) return false;
            drawTimed();
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return true;
    }

    std::optional<Error> frame(RunLog& log, int frame, double timeMs) {
        log.frame(frame, timeMs, drawTimed(), scene_);
        if (!options_.output.empty()) {
            if (auto problem = writeImage(frameName(options_.output, frame), context_.readColor())) return problem;
        }
        return log.measures(frame) ? log.measure([this] { draw(); }) : std::nullopt;
    }

    std::optional<Error> animate(RunLog& log, const Animation& animation);

private:
    const Options& options_;
    Scene& scene_;
    HeadlessContext& context_;
    SoGLRenderAction action_;
};

std::optional<Error> OffscreenRun::animate(RunLog& log, const Animation& animation) {
    const FrameSchedule& schedule = animation.schedule;
    const double start = nowMs();
    const auto wait = [](double ms) { std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(ms)); };
    int last = -1;
    while (const auto next = schedule.next(last, nowMs() - start)) {
        last = next->frame;
        if (next->waitMs > 0.0) wait(next->waitMs);
        // More frames than the animation has fly round again.
        const double time = schedule.time(next->frame), length = animation.flight.duration();
        scene_.setPose(animation.flight.at(time > length && length > 0.0 ? std::fmod(time, length) : time));
        if (auto problem = frame(log, next->frame, time)) return problem;
    }
    const double rest = schedule.durationMs - (nowMs() - start);
    if (schedule.synchronized && rest > 0.0) wait(rest);
    return std::nullopt;
}

}  // namespace

std::optional<Error> runOffscreen(const Options& options, Scene& scene, double startedMs) {
    const bool animated = options.animate || options.frames || !options.flight.empty();
    auto animation = Animation::make(options, scene);
    if (!animation) return animation.error();
    if (animated) scene.setPose(animation.value().flight.at(0.0));
    auto log = RunLog::open(options, scene);
    if (!log) return log.error();
    auto context = HeadlessContext::create(options.offscreen->x, options.offscreen->y);
    if (!context) return context.error();

    OffscreenRun run(options, scene, *context.value());
    const double loaded = nowMs() - startedMs;
    log.value().setStart(loaded, run.drawTimed());
    if (!animated && !run.complete()) {
        std::fprintf(stderr, "SoTerrainTest: expected a complete picture within %.0f s, found parts of it still coarser\n",
                     patienceMs * 1e-3);
    }
    auto problem = animated ? run.animate(log.value(), animation.value()) : run.frame(log.value(), 0, 0.0);
    if (problem) return problem;
    return log.value().finish(options, scene, context.value()->renderer());
}

}  // namespace app
