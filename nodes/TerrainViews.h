// One mesh per view of a terrain node, with its buffers.
#ifndef SOTERRAIN_TERRAINVIEWS_H
#define SOTERRAIN_TERRAINVIEWS_H

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Inventor/SbVec2s.h>
#include <Inventor/sensors/SoNodeSensor.h>

#include <glm/mat4x4.hpp>

#include "TerrainTextureUse.h"
#include "base/View.h"
#include "gl/GlProgram.h"
#include "gl/TerrainRenderer.h"
#include "lod/LodAlgorithm.h"
#include "lod/TerrainModel.h"

class MeshPicture;
class SoGLRenderAction;

/// What tells one view of a node from another: context, place in the scene graph, place on the screen.
struct ViewKey {
    std::uint32_t context = 0;
    std::uint64_t path = 0;
    SbVec2s viewportOrigin;
    SbVec2s viewportSize;

    explicit ViewKey(SoGLRenderAction * action);
    bool operator==(const ViewKey & other) const = default;
    bool hasPlaceOf(const ViewKey & other) const { return context == other.context && path == other.path; }
};

/// What a node keeps of a view that it draws with programs of its own.
class ViewDrawing {
public:
    virtual ~ViewDrawing() = default;
    /// What the node draws next is to show these.
    virtual void update(const terrain::SampleGrid & /*grid*/, const terrain::GridEdits & /*edits*/) {}
    /// Whether the current context has its GL objects.
    virtual bool isThere() const = 0;
    /// All GL objects, which are the caller's to delete.
    virtual std::vector<terrain::GlName> release() = 0;
    virtual std::size_t memoryBytes() const = 0;
    virtual std::size_t bufferBytes() const = 0;
};

struct TerrainView {
    ViewKey key;
    std::shared_ptr<const terrain::BoxPyramid> boxes;  ///< names the data that the mesh belongs to
    std::uint64_t edits = 0;                           ///< version of that data
    glm::dmat4 localFromFrame{1.0};                    ///< where it stood
    std::uint64_t meshVersion = 0;                     ///< SoTerrainShape::Private::meshVersion when it was made
    std::uint64_t start = 0;                           ///< SoTerrainShape::Private::start when it was made
    std::unique_ptr<terrain::LodAlgorithm> algorithm;
    terrain::TerrainRenderer renderer;
    std::unique_ptr<ViewDrawing> drawing;  ///< of a node that draws itself
    TerrainTextureUse texture;
    terrain::SelectionReport report;  ///< of the latest selection
    bool hasMesh = false;
    std::optional<terrain::View> chosenFor;  ///< camera of the latest frame that was not frozen
    std::unique_ptr<MeshPicture> debug;        ///< while there is something of it to draw

    TerrainView(const ViewKey & key, SoNode * root);
    ~TerrainView();

private:
    friend class TerrainViews;
    /// Hears of nothing but the root's death: a viewer's own root dies with the viewer.
    class RootSensor : public SoNodeSensor {
    public:
        void notify(SoNotList *) override {}
    };

    RootSensor root_;
    bool isOver_ = false;  ///< given up, to be erased
    std::uint64_t lastRound_ = 0;
};

/// The views of one node. GL objects are deleted in the context that they belong to: at once when it goes, else when it is next current.
/// A view goes with its context, with the root of its path, and when the node was drawn often without it.
class TerrainViews {
public:
    TerrainViews();
    ~TerrainViews();
    TerrainViews(const TerrainViews &) = delete;
    TerrainViews & operator=(const TerrainViews &) = delete;

    /// The view that is being drawn, new if need be.
    TerrainView & find(SoGLRenderAction * action);
    /// Gives up what a node has drawn a view with, whose context must be current.
    static void discardDrawing(TerrainView & view);
    static void discardDebug(TerrainView & view);
    std::size_t memoryBytes() const;
    std::size_t bufferBytes() const;

private:
    static void contextGoes(std::uint32_t context, void * closure);
    static void rootDies(void * view, SoSensor *);
    static void giveUp(TerrainView & view);

    std::vector<std::unique_ptr<TerrainView>> views_;
    std::uint64_t round_ = 0;  ///< counts up whenever a place is drawn again
};

#endif
