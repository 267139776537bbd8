// The render area of SoTerrainTest: keys, mouse, animation and status line.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Inventor/Qt/SoQtRenderArea.h>
#include <QRect>
#include <QTimer>

#include "FlyCamera.h"
#include "Options.h"
#include "Profile.h"
#include "RunLog.h"
#include "Scene.h"
#include "StatusLine.h"

class QKeyEvent;
class QMouseEvent;

namespace app {

class FlyArea : public SoQtRenderArea {
public:
    FlyArea(QWidget* parent, const Options& options, Scene& scene, RunLog& log, Animation animation, double loadMs);

    void toggleFullScreen();
    /// What ended the main loop, if it was not the user or the end of the animation.
    const std::optional<terrain::Error>& problem() const { return problem_; }
    /// Of the GL context; empty before the first frame.
    const std::string& renderer() const { return renderer_; }

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
    void wake();
    void runTimer();
    void noteScene();
    void play(Animation animation);
    void endOfAnimation();
    bool steer(const QKeyEvent& event, bool press);
    bool command(const QKeyEvent& event);
    void scalePixelError(float factor);
    void changeLevels(int by);
    void toggleDetail();
    void toggleRecord();
    void togglePlay();
    void endReplay(const char* how);
    void takeOver();
    bool mouse(const QMouseEvent& event);
    void logFrame(double frameMs);
    std::string status() const;

    const Options& options_;
    Scene& scene_;
    RunLog& log_;
    Animation animation_;
    double loadMs_;
    FlyCamera camera_;
    StatusLine statusLine_;
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
    std::vector<TimedPose> recorded_;
    std::optional<ProfileWriter> replayProfile_;  ///< while P replays
    std::string message_;
    std::optional<std::pair<int, int>> drag_;
    QRect windowed_;  ///< geometry outside full screen
    std::optional<terrain::Error> problem_;
    std::string renderer_;
};

}  // namespace app
