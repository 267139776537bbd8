// The scene that measurements fly over: one map, one node.
#pragma once

#include <memory>
#include <optional>

#include <Inventor/actions/SoGLRenderAction.h>

#include "BenchRun.h"
#include "Flight.h"
#include "NodePtr.h"
#include "TerrainGrid.h"
#include "gl/HeadlessContext.h"

class SoBaseColor;
class SoDrawStyle;
class SoNormalBinding;
class SoPerspectiveCamera;
class SoSeparator;

namespace app {

/// Where the standard flight takes place over a grid. Grids of the standard placement have it at 0.07; others keep that gap over
/// their highest point.
FlightArea flightAreaOf(const TerrainGrid& grid);

/// A map that is measured.
struct BenchMap {
    TerrainGrid grid;
    bool topFirst = false;  ///< rows are in the order of the file, not from south to north
};

/// The map as a request wants it. Without a spacing, of its own or of the request, the standard flight is over the unit square with
/// the file's top row at y = 0; any other placement is SoTerrainTest's. Error: an unreadable map, one that does not fit into memory
/// or into Coin's arrays, one that has fewer than 2 x 2 of the samples that are wanted.
terrain::Result<BenchMap> openBenchMap(const BenchRequest& request);

/// A node over a map, with a camera on a flight, in an OpenGL context of its own.
class BenchScene {
public:
    explicit BenchScene(const BenchRequest& request);

    /// Opens all files and makes the scene, without the node in it. Error: what could not be opened or made.
    std::optional<terrain::Error> prepare();
    /// Draws two triangles over the same state, so that the texture's upload and the driver's start are not the node's; then puts
    /// the node into the scene.
    void warmUp();
    /// Draws frame i of the flight; returns milliseconds until GL has finished.
    double frame(int i);
    /// Whether tiles may be built while coarser ones stand in, or each frame is complete.
    void setBackground(bool on);
    /// Draws the edges of frame i's triangles, dark on a light ground that hides those behind. Later frames are drawn in this
    /// style.
    void wireframe(int i);

    const TerrainGrid& grid() const { return grid_; }
    SoSeparator* group() const { return group_; }
    SoNode* node() const { return node_.get(); }
    const terrain::HeadlessContext& context() const { return *context_; }

private:
    std::optional<terrain::Error> openFlight();
    std::optional<terrain::Error> addData();
    void addCamera();
    void addMaterial();
    std::optional<terrain::Error> makeNode();

    const BenchRequest& request_;
    std::unique_ptr<terrain::HeadlessContext> context_;
    SoGLRenderAction action_;
    Flight flight_;
    NodePtr<SoSeparator> root_;
    SoSeparator* group_ = nullptr;
    SoPerspectiveCamera* camera_ = nullptr;
    SoDrawStyle* style_ = nullptr;
    SoBaseColor* ink_ = nullptr;
    SoNormalBinding* binding_ = nullptr;
    NodePtr<SoNode> node_;
    TerrainGrid grid_;
    bool topFirst_ = false;
};

}  // namespace app
