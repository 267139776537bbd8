// One mesh per view of a terrain node, with its buffers.
#ifndef SOTERRAIN_TERRAINVIEWS_H
#define SOTERRAIN_TERRAINVIEWS_H

#include <cstdint>
#include <memory>
#include <vector>

#include <Inventor/SbVec2s.h>

#include "gl/GlProgram.h"
#include "gl/TerrainRenderer.h"
#include "lod/LodAlgorithm.h"
#include "lod/TerrainModel.h"

class SoGLRenderAction;

/// What tells one view of a node from another: context, place in the scene graph, place on the screen.
struct ViewKey {
    std::uint32_t context = 0;
    std::uint64_t path = 0;
    SbVec2s viewportOrigin;
    SbVec2s viewportSize;

    explicit ViewKey(SoGLRenderAction * action);
    bool operator==(const ViewKey & other) const = default;
};

/// What a node keeps of a view that it draws with programs of its own.
class ViewDrawing {
public:
    virtual ~ViewDrawing() = default;
    /// All GL objects, which are the caller's to delete.
    virtual std::vector<terrain::GlName> release() = 0;
    virtual std::size_t memoryBytes() const = 0;
    virtual std::size_t bufferBytes() const = 0;
};

struct TerrainView {
    ViewKey key;
    std::shared_ptr<const terrain::BoxPyramid> boxes;  ///< names the data that the mesh belongs to
    std::uint64_t meshVersion = 0;                     ///< SoTerrainShape::Private::meshVersion when it was made
    std::unique_ptr<terrain::LodAlgorithm> algorithm;
    terrain::TerrainRenderer renderer;
    std::unique_ptr<ViewDrawing> drawing;  ///< of a node that draws itself
    terrain::SelectionReport report;  ///< of the latest selection
    bool hasMesh = false;
    std::uint64_t lastFrame = 0;

    explicit TerrainView(const ViewKey & k) : key(k) {}
};

/// The views of one node. Buffers are deleted in the context that they belong to: at once when it goes, else when it is next current.
class TerrainViews {
public:
    TerrainViews();
    ~TerrainViews();
    TerrainViews(const TerrainViews &) = delete;
    TerrainViews & operator=(const TerrainViews &) = delete;

    /// The view with this key, new if need be. Views that were not drawn for long are given up.
    TerrainView & find(const ViewKey & key, std::uint64_t frame);
    /// Gives up what a node has drawn a view with, whose context must be current.
    static void discardDrawing(TerrainView & view);
    std::size_t memoryBytes() const;
    std::size_t bufferBytes() const;

private:
    static void contextGoes(std::uint32_t context, void * closure);
    static void giveUp(TerrainView & view);

    std::vector<std::unique_ptr<TerrainView>> views_;
};

#endif
