// Abstract base of the terrain nodes.
#ifndef SOTERRAIN_SOTERRAINSHAPE_H
#define SOTERRAIN_SOTERRAINSHAPE_H

#include <memory>

#include <Inventor/fields/SoSFBool.h>
#include <Inventor/fields/SoSFEnum.h>
#include <Inventor/fields/SoSFFloat.h>
#include <Inventor/fields/SoSFInt32.h>
#include <Inventor/fields/SoSFNode.h>
#include <Inventor/nodes/SoShape.h>
#include <Inventor/nodes/SoSubNode.h>

#include <SoTerrain/SoTerrainStatistics.h>

class SbVec3f;
class SoPath;
struct TerrainFrame;
struct TerrainGrid;

namespace terrain {
class LodAlgorithm;
class SampleGrid;
class SynthesisedDetail;
struct LodSettings;
struct TerrainModel;
}

class SoTerrainShape : public SoShape {
    typedef SoShape inherited;
    SO_NODE_ABSTRACT_HEADER(SoTerrainShape);

public:
    enum DebugView { NONE, TILES, LEVELS, ERRORS, LOADING };

    static void initClass();

    SoSFInt32 verticesPerRow;
    SoSFInt32 verticesPerColumn;
    SoSFInt32 startIndex;
    SoSFFloat pixelError;
    SoSFBool frustumCulling;
    SoSFBool freeze;
    SoSFBool frozenFrustum;
    SoSFEnum debugView;
    SoSFBool wireframeOverlay;
    SoSFNode alternateRep;

    /// Figures of the latest frame drawn by this node.
    SoTerrainStatistics getStatistics() const;

    /// Height of the full-resolution terrain, with the detail that the node adds, over (x, y) of the node's local coordinates; for a
    /// grid whose heights run along another axis, (x, y) are the other two axes in order. The data is that of the node's place in its
    /// (first) scene graph, or of the node at the end of \a path. FALSE outside the terrain, in a hole and without data; then nothing
    /// is written.
    SbBool heightAt(float x, float y, float & height, SbVec3f * normal = NULL, SoPath * path = NULL);

    /// Lets every view begin again with its next frame, as if it had not been drawn before: meshes that are refined from frame to frame
    /// depend on the frames before. After it the same cameras in the same order are drawn with the same triangles, where no tiles are
    /// awaited (SoChunkedLoDTerrain::background FALSE). What takes long to make and is always the same stays: errors, tiles.
    virtual void restart();

    virtual void GLRender(SoGLRenderAction * action);
    virtual void rayPick(SoRayPickAction * action);
    virtual void getPrimitiveCount(SoGetPrimitiveCountAction * action);
    virtual void notify(SoNotList * list);
    virtual void write(SoWriteAction * action);

protected:
    SoTerrainShape();
    virtual ~SoTerrainShape();

    /// A new view's algorithm. Called while rendering.
    virtual std::unique_ptr<terrain::LodAlgorithm> createAlgorithm(const terrain::TerrainModel & model, const terrain::SampleGrid & grid) = 0;
    /// Adds the fields of a subclass to what all terrain nodes ask of an algorithm.
    virtual void getSettings(terrain::LodSettings & settings) const;
    /// Whether the algorithm needs the error hierarchy.
    virtual bool needsErrors() const;
    /// Detail finer than the samples that the node adds to this data, or null: then picking, heights and the bounding box include it.
    virtual const terrain::SynthesisedDetail * detailOf(const TerrainGrid & data);
    /// Draws with GL programs of the node's own, and fills in the statistics that it has. FALSE where the view is to be drawn from
    /// createAlgorithm()'s mesh instead, as all nodes do by default.
    virtual SbBool renderOwn(const TerrainFrame & frame, SoTerrainStatistics & statistics);
    /// To be called when meshes would now be created otherwise: every view gets a new algorithm when it is next drawn.
    void discardMeshes();
    /// The power of two from `least` to `most` nearest to what a field asks for, after a warning where that is another number.
    int validTileSize(int wanted, int least, int most) const;
    /// Posts a warning about this node, once for each text.
    void warnOnce(const char * text) const;

    virtual void computeBBox(SoAction * action, SbBox3f & box, SbVec3f & center);
    virtual void generatePrimitives(SoAction * action);

    class Private;
    std::unique_ptr<Private> pimpl;
    friend class Private;
};

#endif
