// Flights that show the same meshes whenever they are flown.
#pragma once

#include "Clock.h"
#include "RunLog.h"
#include "Scene.h"

namespace app {

/// Flies a path, once or several times, and says which frame to draw next:
///
///     while (replay.next()) { draw; replay.drawn(...); }
///
/// Every frame of the schedule is drawn, however long one takes, with all of its tiles. A flight begins with frames at its first
/// pose that belong to none: all nodes begin again and are drawn until nothing is missing, twice before the first flight, because
/// errors that other threads have computed meanwhile may choose another mesh. So whatever was drawn before has no influence on the
/// meshes. What is made once for all flights (shaders, textures, errors) is made there. Where means are to be taken, a flight that
/// is not measured goes before the others, so that all of them find the same tiles and caches.
class Replay {
public:
    /// Lets the scene wait for tiles. The animation's schedule is taken without synchronisation.
    Replay(Scene& scene, Animation animation, int flights, bool warmsUp);

    /// Moves the camera to where the next frame is drawn from. False at the end of the last flight.
    bool next();
    /// The frame has been drawn.
    void drawn();

    /// Whether the frame that next() has chosen is one to be measured.
    bool isMeasured() const { return stage_ == Stage::Fly && flight_ >= 0; }
    /// Whether it is the first of a flight that is measured.
    bool begins() const { return isMeasured() && frame_ == 0; }
    /// Whether it is its last.
    bool ends() const { return isMeasured() && frame_ + 1 == animation_.schedule.frames; }
    int frame() const { return frame_; }
    double timeMs() const { return animation_.schedule.time(frame_); }
    /// Counts flights that are measured from 0; -1 while warming up.
    int flight() const { return flight_; }
    int flights() const { return flights_; }
    const Animation& animation() const { return animation_; }
    /// False when a flight began although something was still missing after a long time.
    bool startsComplete() const { return startsComplete_; }
    static constexpr const char* incompleteStart =
        "expected a complete picture at the start of the flight, found parts of it still coarser";

private:
    /// Settle: waits for what other threads make. Start: the first frame of nodes that have begun again.
    enum class Stage { Settle, Start, Fly, Over };

    void begin(Stage stage);

    Scene& scene_;
    Animation animation_;
    int flights_;
    int flight_;
    int frame_ = -1;
    Stage stage_ = Stage::Settle;
    double stageMs_ = 0.0;  ///< when it began
    bool restarts_ = false;
    bool startsComplete_ = true;
};

}  // namespace app
