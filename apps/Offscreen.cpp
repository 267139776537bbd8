#include "Offscreen.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>

#include <Inventor/SbViewportRegion.h>
#include <Inventor/SoDB.h>
#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/elements/SoGLCacheContextElement.h>
#include <Inventor/nodes/SoSeparator.h>
#include <Inventor/sensors/SoSensorManager.h>

#include "Clock.h"
#include "DebugViews.h"
#include "FrameName.h"
#include "HeightSession.h"
#include "ImageFile.h"
#include "Meters.h"
#include "Replay.h"
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
        meters_.setOn(options.meters);
        glClearColor(skyColor[0], skyColor[1], skyColor[2], 1.0f);
    }

    void draw() {
        SoSensorManager* sensors = SoDB::getSensorManager();
        sensors->processTimerQueue();
        sensors->processDelayQueue(TRUE);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        action_.apply(scene_.root());
        legend_.update(scene_, SbVec2s(short(context_.width()), short(context_.height())));
        if (legend_.root()->getNumChildren() > 0) action_.apply(legend_.root());
        if (meters_.isOn()) action_.apply(meters_.root());
    }

    /// What a whole frame takes.
    Duration drawTimed() {
        const Stopwatch watch;
        draw();
        glFinish();
        return watch.elapsed();
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
    std::optional<Error> replay(RunLog& log, const Animation& animation);

private:
    const Options& options_;
    Scene& scene_;
    HeadlessContext& context_;
    SoGLRenderAction action_;
    DebugLegend legend_;
    Meters meters_;
};

std::optional<Error> OffscreenRun::animate(RunLog& log, const Animation& animation) {
    const FrameSchedule& schedule = animation.schedule;
    AnimationTime took{schedule.durationMs};
    const double start = nowMs();
    const auto wait = [](double ms) { std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(ms)); };
    int last = -1;
    while (const auto next = schedule.next(last, nowMs() - start)) {
        last = next->frame;
        if (next->waitMs > 0.0) wait(next->waitMs);
        const double begin = nowMs();
        scene_.setPose(animation.pose(next->frame));
        freezeInTime(scene_, options_, schedule.time(next->frame));
        if (auto problem = frame(log, next->frame, schedule.time(next->frame))) return problem;
        took.longestFrameMs = std::max(took.longestFrameMs, nowMs() - begin);
    }
    const double rest = schedule.durationMs - (nowMs() - start);
    if (schedule.synchronized && rest > 0.0) wait(rest);
    took.lastedMs = nowMs() - start;
    log.animation(took);
    return std::nullopt;
}

std::optional<Error> OffscreenRun::replay(RunLog& log, const Animation& animation) {
    Replay replay(scene_, animation, options_.repeat.value_or(1), options_.repeat.has_value());
    while (replay.next()) {
        if (replay.begins()) log.beginRepetition();
        freezeInTime(scene_, options_, replay.timeMs());
        if (!replay.isMeasured()) {
            drawTimed();
        } else if (auto problem = frame(log, replay.frame(), replay.timeMs())) {
            return problem;
        }
        replay.drawn();
    }
    if (!replay.startsComplete()) std::fprintf(stderr, "SoTerrainTest: %s\n", Replay::incompleteStart);
    return std::nullopt;
}

}  // namespace

std::optional<Error> runOffscreen(const Options& options, Scene& scene, double startedMs) {
    const bool animated = options.animates();
    auto animation = Animation::make(options, scene);
    if (!animation) return animation.error();
    if (animated) scene.setPose(animation.value().flight.at(0.0));
    HeightSession tools(scene);
    const auto said = tools.apply(options);
    if (!said) return said.error();
    std::fputs(said.value().c_str(), options.stats ? stderr : stdout);
    // For what was asked no picture is needed.
    if (options.asksGround() && options.output.empty() && !options.isMeasured() && !animated) return std::nullopt;
    auto log = RunLog::open(options, scene);
    if (!log) return log.error();
    auto context = HeadlessContext::create(options.offscreen->x, options.offscreen->y);
    if (!context) return context.error();

    OffscreenRun run(options, scene, *context.value());
    const double loaded = nowMs() - startedMs;
    log.value().setStart(loaded, run.drawTimed().wallMs);
    if (!animated && !run.complete()) {
        std::fprintf(stderr, "SoTerrainTest: expected a complete picture within %.0f s, found parts of it still coarser\n",
                     patienceMs * 1e-3);
    }
    auto problem = options.replays() ? run.replay(log.value(), animation.value())
                   : animated        ? run.animate(log.value(), animation.value())
                                     : run.frame(log.value(), 0, 0.0);
    if (problem) return problem;
    return log.value().finish(options, scene, context.value()->renderer(), *options.offscreen);
}

}  // namespace app
