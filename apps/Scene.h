// The scene graph that SoTerrainTest shows, built from options.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <Inventor/SbBox.h>
#include <Inventor/SoPath.h>
#include <Inventor/nodes/SoCamera.h>
#include <Inventor/nodes/SoDrawStyle.h>
#include <Inventor/nodes/SoMaterial.h>
#include <Inventor/nodes/SoSeparator.h>
#include <Inventor/nodes/SoTexture2.h>

#include "Flight.h"
#include "NodePtr.h"
#include "Options.h"
#include "Profile.h"
#include "TerrainGrid.h"
#include "base/Result.h"

namespace app {

/// Sky behind every terrain.
constexpr float skyColor[3] = {0.45f, 0.6f, 0.85f};

/// A root with camera, light and terrain, and what programs ask about them.
class Scene {
public:
    /// Error: a file that can't be read, an algorithm that this build lacks, a map too large for Coin's own shapes.
    static terrain::Result<Scene> build(const Options& options);
    /// Nothing but an invitation to open a file.
    static Scene empty();

    SoSeparator* root() const { return root_.get(); }
    SoCamera* camera() const { return camera_; }
    SoNode* terrain() const { return terrain_; }  ///< null in a scene file without a shape
    const std::string& algorithm() const { return algorithm_; }
    const SbBox3f& box() const { return box_; }
    float size() const;  ///< of the ground: the longer side of the box in x and y
    const Pose& home() const { return home_; }
    FlightArea flightArea() const;
    /// The grid that the terrain shows, when it is known.
    const std::optional<TerrainGrid>& grid() const { return grid_; }

    /// Moves the camera, and its clipping planes when they are ours to choose.
    void setPose(const Pose& pose);
    Pose pose() const;
    /// Height of the ground under a point of the scene, if there is ground.
    std::optional<float> groundHeight(const SbVec3f& point) const;
    /// Statistics of the latest frame; the caller fills in frame and times. Triangles of shapes that are not ours are counted,
    /// which is done once.
    FrameFigures figures();
    /// Whether every terrain node has drawn all that it wants to: false while tiles are still being built.
    bool isComplete() const;
    /// A meter for the terrain. Error: nothing is known about its full-resolution data.
    terrain::Result<std::unique_ptr<ErrorMeter>> makeErrorMeter();

    /// Lays another picture over a height map, or none where the path is empty. Error: it can't be read, and nothing changes.
    std::optional<terrain::Error> setTexture(const std::string& path);
    void setWireframe(bool on);
    bool wireframe() const;

private:
    friend class SceneBuilder;

    NodePtr<SoSeparator> root_;
    SoCamera* camera_ = nullptr;
    SoDrawStyle* drawStyle_ = nullptr;
    SoMaterial* material_ = nullptr;  ///< of a height map
    NodePtr<SoTexture2> texture_;     ///< null without one
    SoNode* terrain_ = nullptr;
    NodePtr<SoPath> terrainPath_;  ///< from the root
    std::string algorithm_;
    SbBox3f box_;
    Pose home_;
    std::optional<TerrainGrid> grid_;
    bool ownClipping_ = false;
    std::optional<std::uint64_t> countedTriangles_;
};

}  // namespace app
