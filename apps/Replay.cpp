#include "Replay.h"

#include <utility>

namespace app {

namespace {

constexpr double patienceMs = 30000.0;

}  // namespace

Replay::Replay(Scene& scene, Animation animation, int flights, bool warmsUp)
    : scene_(scene), animation_(std::move(animation)), flights_(flights), flight_(warmsUp ? -1 : 0) {
    scene_.waitForTiles(true);
    begin(Stage::Settle);
}

void Replay::begin(Stage stage) {
    stage_ = stage;
    stageMs_ = nowMs();
    frame_ = -1;
    restarts_ = stage == Stage::Settle || stage == Stage::Start;
}

bool Replay::next() {
    if (stage_ == Stage::Over) return false;
    if (stage_ == Stage::Fly) ++frame_;
    // Not before the camera is there: the first mesh is of the first frame that is drawn, whatever it is drawn for.
    if (std::exchange(restarts_, false)) scene_.restart();
    scene_.setPose(stage_ == Stage::Fly ? animation_.pose(frame_) : animation_.pose(0));
    return true;
}

void Replay::drawn() {
    if (stage_ == Stage::Fly) {
        if (frame_ + 1 < animation_.schedule.frames) return;
        begin(++flight_ < flights_ ? Stage::Start : Stage::Over);
        return;
    }
    const bool isComplete = scene_.isComplete();
    if (!isComplete && nowMs() - stageMs_ < patienceMs) return;
    startsComplete_ = startsComplete_ && isComplete;
    begin(stage_ == Stage::Settle ? Stage::Start : Stage::Fly);
}

}  // namespace app
