// The render area of SoTerrainTest: steering, animation and status.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Inventor/Qt/SoQtRenderArea.h>
#include <QTimer>

#include "DebugViews.h"
#include "FlyCamera.h"
#include "Options.h"
#include "FrameStatistics.h"
#include "Meters.h"
#include "Replay.h"
#include "RunLog.h"
#include "Scene.h"
#include "StatusLine.h"
#include "gl/HeadlessContext.h"

class QKeyEvent;
class QMouseEvent;

namespace app {

class FlyArea : public SoQtRenderArea {
public:
    FlyArea(QWidget* parent, const Options& options, Scene& scene, RunLog& log, Animation animation, double loadMs);

    // What commands do; the caller wakes the area afterwards.
    /// Raises (1) or lowers (-1) the pixel error by a step.
    void scalePixelError(int direction);
    void toggleCulling();
    /// No error at all, or the former one again.
    void toggleDetail();
    /// More or fewer levels of a clipmap than there are now; as many as the view needs for 0.
    void changeLevels(int by);
    void toggleConstantHeight();
    void toggleMeters() { meters_.setOn(!meters_.isOn()); }
    void goHome();
    /// Records the camera, or writes down what was recorded.
    void toggleRecord();
    /// Replays the latest record so many times, with means of more than one, or stops it.
    void replay(int flights);

    bool hasField(const char* name) const;  ///< of the terrain node
    bool culling() const;
    bool fullDetail() const { return formerError_.has_value(); }
    bool constantHeight() const { return camera_.constantHeight(); }
    bool showsMeters() const { return meters_.isOn(); }
    bool isRecording() const { return recording_.has_value(); }
    bool isReplaying() const { return replay_ && !ends_; }
    bool isBenchmarking() const { return isReplaying() && replay_->flights() > 1; }
    /// Whether the program ends with its animation: then nothing may disturb it.
    bool endsByItself() const { return ends_; }

    /// Another node draws the terrain.
    void terrainChanged();
    /// The scene has been replaced. Unless the camera is kept, it goes to the new scene's home.
    void sceneChanged(bool keepCamera);
    /// Draws and follows the scene again, after something has changed.
    void wake();
    /// Whether the scene has been drawn since it changed its terrain.
    bool isDrawn() const { return drawnScene_ != 0; }
    /// Gives the keyboard to this area.
    void takeFocus();
    /// Who is told of every new status text.
    void onStatus(std::function<void(const std::string&)> tell) { tellStatus_ = std::move(tell); }
    /// Who is asked to bring the scene up to date before each frame.
    void beforeRedraw(std::function<void()> prepare) { prepare_ = std::move(prepare); }
    /// Who is told of a click that did not look around: where in the picture, from its lower left corner, and whether with Ctrl.
    void onClick(std::function<void(const SbVec2s& pixel, const SbVec2s& pictureSize, bool withControl)> tell) {
        tellClick_ = std::move(tell);
    }
    /// Writes the status over the picture too, or does not.
    void showStatus(bool on);
    /// What ended the main loop, if it was not the user or the end of the animation.
    const std::optional<terrain::Error>& problem() const { return problem_; }
    /// Of the GL context; empty before the first frame.
    const std::string& renderer() const { return renderer_; }
    /// Of the picture.
    glm::ivec2 sizePixels() const;
    /// The picture as it is, without the status. Error: there is none yet, or no frame buffer for it.
    terrain::Result<terrain::Image> picture();
    /// A message at the end of the status, until the next one.
    void say(const std::string& message);

protected:
    void processEvent(QEvent* event) override;
    void actualRedraw() override;
    void sizeChanged(const SbVec2s& size) override;

private:
    struct Play {
        Animation animation;
        double startMs = 0.0;
        int last = -1;
    };

    void tick();
    void advance(double now);
    void runTimer();
    void noteScene();
    void play(Animation animation);
    void endOfAnimation();
    FlyCamera makeCamera();
    bool steer(const QKeyEvent& event, bool press);
    std::optional<std::string> flightToReplay() const;
    void startReplay(Animation animation, int flights, bool warmsUp);
    void advanceReplay(double now);
    void logReplay(const Duration& took);
    void endReplay(bool isWhole);
    void writeReplay(bool isBenchmark, bool isWhole);
    void takeOver();
    bool mouse(const QMouseEvent& event);
    void click(const QMouseEvent& event);
    void logFrame(const Duration& took);
    void logScene(int frame, double timeMs, const Duration& took);
    std::string status() const;

    const Options& options_;
    Scene& scene_;
    RunLog& log_;
    Animation animation_;
    double loadMs_;
    FlyCamera camera_;
    StatusLine statusLine_;
    DebugLegend legend_;
    Meters meters_;
    QTimer timer_;
    std::optional<Play> play_;
    bool ends_;             ///< the program ends with the animation
    bool due_ = false;      ///< a frame of the animation waits to be drawn
    bool resized_ = false;  ///< SoQt drops a redraw that is asked for while its widgets are resized
    bool logging_;          ///< times are those of finished frames
    int frame_ = -1;
    double startMs_;
    double lastTickMs_;
    double activeUntilMs_ = 0.0;
    double textMs_ = 0.0;
    bool textDue_ = false;       ///< the scene changed after the text was set
    SbUniqueId drawnScene_ = 0;  ///< node id of the scene in the latest frame, 0 if it must be drawn anew
    double frameMs_ = 0.0;       ///< smoothed
    double intervalMs_ = 0.0;    ///< smoothed, between frames that follow each other closely
    double lastRedrawMs_ = 0.0;
    double lastDueMs_ = 0.0;            ///< when the latest frame of the animation was asked for
    std::optional<float> formerError_;  ///< pixel error before full detail
    std::optional<std::vector<TimedPose>> recording_;
    std::string recorded_;            ///< file of the latest record
    std::unique_ptr<Replay> replay_;  ///< drives the camera in place of play_
    FrameStatistics replayed_;        ///< of a replay that the user asked for
    AnimationTime took_;              ///< play_, so far
    std::string message_;
    std::optional<std::pair<int, int>> drag_;
    std::optional<std::pair<int, int>> pressed_;  ///< where a click began that may still be one
    std::function<void(const std::string&)> tellStatus_;
    std::function<void()> prepare_;
    std::function<void(const SbVec2s&, const SbVec2s&, bool)> tellClick_;
    bool showsStatus_ = false;  ///< over the picture
    std::optional<terrain::Error> problem_;
    std::string renderer_;
};

}  // namespace app
