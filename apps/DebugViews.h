// Pictures of the mesh itself, as the terrain nodes draw them, and what their colours mean.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Inventor/SbVec2s.h>

#include "NodePtr.h"
#include "Options.h"

class SoGroup;
class SoNode;
class SoSeparator;

namespace app {

class Scene;

/// One of SoTerrainShape::debugView's values.
struct DebugPicture {
    const char* name;   ///< as --debug-view has it
    const char* title;  ///< in menus, & before the letter that Alt chooses
    const char* help;
    int value;
};
const std::vector<DebugPicture>& debugPictures();
/// Nothing when no picture has this name.
const DebugPicture* findDebugPicture(std::string_view name);

/// What the scene's terrain shows of its mesh. Without a terrain node of ours all is off and stays off.
bool canDebug(const Scene& scene);
int debugPicture(const Scene& scene);
void setDebugPicture(Scene& scene, int value);
bool hasEdges(const Scene& scene);
void setEdges(Scene& scene, bool on);
/// Frozen, the mesh stays as it is and the camera's view volume is drawn, to be looked at from elsewhere.
bool isFrozen(const Scene& scene);
void setFrozen(Scene& scene, bool on);
/// As the options want it from the start; they are told on standard error where they have no effect.
void applyDebugOptions(Scene& scene, const Options& options);
/// Freezes the mesh where the animation is beyond --freeze-at. To be called before the frame is drawn.
void freezeInTime(Scene& scene, const Options& options, double timeMs);

/// Explains the colours of a picture, in its upper right corner.
class DebugLegend {
public:
    DebugLegend();
    /// To be drawn after the scene, in a space of its own.
    SoSeparator* root() const { return root_.get(); }
    /// What the terrain shows now, for a picture of so many pixels. Changes nothing when that is as before.
    void update(const Scene& scene, const SbVec2s& size);

private:
    struct Row {
        float colour[3];
        std::string text;
        bool blends = false;  ///< into the next one's colour
    };
    static std::vector<Row> rowsFor(int picture, float pixelError);
    void build(const std::vector<Row>& rows, const SbVec2s& size);
    void addPanel(float x, float y, float width, float height, const float low[3], const float high[3]);
    void addText(float x, float y, const std::string& text);

    NodePtr<SoSeparator> root_;
    std::string shown_;  ///< what is built
};

}  // namespace app
