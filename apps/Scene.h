// The scene graph that SoTerrainTest shows, built from options.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Inventor/SbBox.h>
#include <Inventor/SoPath.h>
#include <Inventor/nodes/SoCamera.h>
#include <Inventor/nodes/SoDrawStyle.h>
#include <Inventor/nodes/SoMaterial.h>
#include <Inventor/nodes/SoSeparator.h>
#include <Inventor/nodes/SoTexture2.h>

#include "Errand.h"
#include "Flight.h"
#include "MeasureError.h"
#include "NodePtr.h"
#include "Options.h"
#include "Profile.h"
#include "TerrainGrid.h"
#include "base/Result.h"

class SoSearchAction;
class SoTerrainShape;

namespace app {

/// The path to the first node that an SoSearchAction with these settings finds, inside of node kits too; null without one.
NodePtr<SoPath> findNode(SoNode& root, const std::function<void(SoSearchAction&)>& wanted);

/// All nodes of a type, inside of node kits too.
std::vector<SoNode*> findNodes(SoNode& root, SoType type);

/// Sky behind every terrain.
constexpr float skyColor[3] = {0.45f, 0.6f, 0.85f};

/// A root with camera, light and terrain, and what programs ask about them.
class Scene {
public:
    /// Error: a file that can't be read, an algorithm that this build lacks, a map too large for Coin's own shapes.
    /// `tells`: options without effect are told on standard error. `errand` reads the files, which may be cancelled: then the error
    /// is one too.
    static terrain::Result<Scene> build(const Options& options, bool tells = true, const Errand& errand = runHere);
    /// Nothing but an invitation to open a file.
    static Scene empty();

    SoSeparator* root() const { return root_.get(); }
    SoCamera* camera() const { return camera_; }
    SoNode* terrain() const { return terrain_; }  ///< null in a scene file without a shape
    SoPath* terrainPath() const { return terrainPath_.get(); }  ///< from the root
    const std::string& algorithm() const { return algorithm_; }
    const SbBox3f& box() const { return box_; }
    /// The same in the terrain's own coordinates.
    float localSize() const;
    float size() const;  ///< of the ground: the longer side of the box in x and y
    const Pose& home() const { return home_; }
    FlightArea flightArea() const;
    /// The grid that the terrain shows, when it is known.
    const std::optional<TerrainGrid>& grid() const { return grid_; }

    /// Whether it was built over a height map, rather than read from a scene file.
    bool isHeightMap() const { return material_ != nullptr; }

    /// Whether the terrain can be drawn so: a height map always, but for maps too large for Coin's own shapes; of a scene file what
    /// takes the same nodes before it.
    bool offers(const Algorithm& algorithm) const;
    bool shows(const Algorithm& algorithm) const;
    /// Draws the terrain so instead. Fields that both nodes have keep their values; others get what the options say. Error: it is
    /// not offered, and nothing changes.
    std::optional<terrain::Error> setAlgorithm(const Algorithm& algorithm, const Options& options);
    /// Gives the terrain's fields the values that the options have. `tells`: options without effect are told on standard error.
    void setFields(const Options& options, bool tells);
    /// The other way round, for the fields that the terrain has.
    void readFields(Options& options) const;

    /// Of a height map: factor from samples to heights.
    double heightScale() const;
    /// The samples that the terrain node stands on; null where it stands on coordinates.
    std::shared_ptr<const terrain::HeightSource> heightSource() const;

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
    /// Whether frames wait until all of their tiles are built. At first they do as the options and the scene file say.
    void waitForTiles(bool on);
    /// Lets all terrain nodes begin again: what was drawn before has no influence on the meshes that follow.
    void restart();
    /// Keeps all meshes as they are while it is on, without telling anybody: for frames that only refresh the window.
    void holdMeshes(bool on);
    /// The fields of the terrain and their values as in a file, but for those that hold nodes or lists.
    std::vector<std::pair<std::string, std::string>> settings() const;
    /// A meter for the terrain. Error: nothing is known about its full-resolution data.
    terrain::Result<std::unique_ptr<ErrorMeter>> makeErrorMeter();

    /// Lays another picture over a height map, or none where the path is empty. Error: it can't be read, and nothing changes.
    std::optional<terrain::Error> setTexture(const std::string& path, const Errand& errand = runHere);
    void setWireframe(bool on);
    bool wireframe() const;

private:
    friend class SceneBuilder;

    std::optional<terrain::Error> putTerrain(const Algorithm& algorithm, const Options& options);
    void replaceTerrain(SoNode* fresh);
    void addHeightMap(const Options& options);
    std::optional<terrain::Error> addCoinArrays(SoSeparator& group, Feed feed, const std::string& name);
    const TerrainGrid* completeGrid();
    std::vector<SoTerrainShape*> terrainShapes() const;

    NodePtr<SoSeparator> root_;
    SoCamera* camera_ = nullptr;
    SoDrawStyle* drawStyle_ = nullptr;
    SoMaterial* material_ = nullptr;  ///< of a height map
    NodePtr<SoTexture2> texture_;     ///< null without one
    NodePtr<SoNode> heightMap_;       ///< the SoHeightMap before the terrain, once there is one
    SoSeparator* group_ = nullptr;    ///< of a height map: holds the terrain
    SoNode* terrain_ = nullptr;
    NodePtr<SoPath> terrainPath_;  ///< from the root
    std::string algorithm_;
    SbBox3f box_;
    Pose home_;
    std::optional<TerrainGrid> grid_;
    bool ownClipping_ = false;
    std::optional<std::uint64_t> countedTriangles_;
    std::vector<NodePtr<SoNode>> hurried_;  ///< whose `background` is off because frames are to wait
    std::vector<NodePtr<SoNode>> held_;     ///< whose `freeze` is on because meshes are held
};

}  // namespace app
