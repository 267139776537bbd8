/*!
  \class SoGeometryClipmapTerrain SoGeometryClipmapTerrain.h SoTerrain/SoGeometryClipmapTerrain.h
  \brief The SoGeometryClipmapTerrain class draws a terrain as nested grids around the viewer, each twice as coarse as the one inside.

  The method is geometry clipmaps: Losasso and Hoppe, "Geometry Clipmaps: Terrain Rendering Using Nested Regular Grids", 2004; on the GPU as in
  Asirvatham and Hoppe, "Terrain Rendering Using GPU-Based Geometry Clipmaps", 2005. A level is clipmapSize x clipmapSize vertices, kept as a
  texture. When the viewer moves, only what is newly exposed is sent, and all levels are drawn in at most four calls (in that many for each level with storage MEMORY_FREE). So
  work and memory per frame depend on clipmapSize alone, not on the size of the map nor on how rough it is: that is what to take this node for. For the same error it
  takes more triangles than SoROAMTerrain or SoChunkedLoDTerrain, because it chooses detail by distance.

  The terrain ends exactly at its last samples. The viewer may be anywhere, also outside. Towards its border each level slides
  into the coarser one, heights and normals alike, so that there is no crack and no line.

  pixelError is not a promise here but a wish: levels are not drawn that it does not need, and those that it needs are drawn even where the height over the ground would leave them
  out. What is achieved is reported: SoTerrainStatistics::errorPixels bounds the error of every sample in view. With clipmapSize 0 the node takes the
  smallest size whose bound keeps pixelError.

  Normals are the node's own, from the heights, at twice their resolution; explicit ones are not used. Under an SoShaderProgram, with materials per vertex, several
  textures, curved coordinates or an OpenGL that lacks instances or textures in vertex shaders, the same levels are drawn as vertex arrays.

  \code
  #Inventor V2.1 ascii
  Separator {
    Texture2 { filename "terrain_texture.jpg" }
    SoHeightMap { filename "terrain.png" spacing 10 10 heightScale 0.05 }
    SoGeometryClipmapTerrain { clipmapSize 255 detailLevels 2 }
  }
  \endcode

  <b>FILE FORMAT/DEFAULTS:</b>
  \code
    SoGeometryClipmapTerrain {
      verticesPerRow 0
      verticesPerColumn 0
      startIndex 0
      pixelError 2
      frustumCulling TRUE
      freeze FALSE
      frozenFrustum FALSE
      debugView NONE
      wireframeOverlay FALSE
      alternateRep NULL
      clipmapSize 255
      levels 0
      transitionWidth 0
      updateBudget 0
      activeLevels 0
      detailLevels 0
      detailAmplitude 0
      detailSeed 1
      blendNormals TRUE
      implementation AUTO
      storage STORED
      showLevels FALSE
    }
  \endcode

  \sa SoTerrainShape, SoHeightMap, SoTerrainTexture
*/

/*!
  \var SoSFInt32 SoGeometryClipmapTerrain::clipmapSize
  Vertices along a side of a level: 15, 31, 63, 127, 255, 511 or 1023; of another number the nearest of these is taken. 0 takes, in each view, the
  smallest whose bound on the error keeps pixelError, or the largest. Default 255.
*/
/*!
  \var SoSFInt32 SoGeometryClipmapTerrain::levels
  Levels of the samples. 0, the default, is as many as cover the terrain wherever the viewer is; with fewer, what lies beyond the coarsest is not drawn.
*/
/*!
  \var SoSFInt32 SoGeometryClipmapTerrain::transitionWidth
  Cells along the border of a level in which it slides into the coarser one. 0, the default, is a tenth of clipmapSize.
*/
/*!
  \var SoSFInt32 SoGeometryClipmapTerrain::updateBudget
  Vertices that are brought up to date in a frame at most, from coarse to fine levels. What a fast flight leaves behind is drawn
  coarser, never wrong, and the node asks for another frame. 0, the default, is clipmapSize squared. The first frame is always complete.
*/
/*!
  \var SoSFInt32 SoGeometryClipmapTerrain::activeLevels
  How many levels are drawn, from the coarsest one. 0, the default, goes by the view: levels that are less than 2.5 times as wide as the viewer is high over the ground are
  left out unless pixelError needs them, and so are those that it does not need.
*/
/*!
  \var SoSFInt32 SoGeometryClipmapTerrain::detailLevels
  Levels finer than the samples, up to 8, with heights made up in place: a smooth surface through the samples, and noise. It is always
  the same ground. Picking and heightAt() include it. Default 0.
*/
/*!
  \var SoSFFloat SoGeometryClipmapTerrain::detailAmplitude
  Standard deviation of the noise on the first of the detailLevels, in units of the heights; half of it on each further one. 0, the default, continues the
  roughness that the samples have when they are first drawn, and edits do not change it; below 0 there is none.
*/
/*!
  \var SoSFUInt32 SoGeometryClipmapTerrain::detailSeed
  Another number makes other detail. Default 1.
*/
/*!
  \var SoSFBool SoGeometryClipmapTerrain::blendNormals
  Whether normals slide into those of the coarser level as heights do. Default TRUE.
*/
/*!
  \var SoSFEnum SoGeometryClipmapTerrain::implementation
  AUTO, the default, draws by vertex textures where it can, and else by vertex arrays. CPU always takes vertex arrays; GPU warns where it has to.
*/
/*!
  \enum SoGeometryClipmapTerrain::Implementation
  How levels are drawn: GPU by textures that the vertex shader reads; CPU by vertex arrays; AUTO by whichever the state allows, the GPU first.
*/
/*!
  \enum SoGeometryClipmapTerrain::Storage
  What the GPU keeps: STORED every level, MEMORY_FREE two of them.
*/
/*!
  \var SoSFEnum SoGeometryClipmapTerrain::storage
  STORED, the default, keeps a texture layer for each level. MEMORY_FREE keeps two, and makes all levels anew in each frame; the picture is the same.
*/
/*!
  \var SoSFBool SoGeometryClipmapTerrain::showLevels
  Tints each level, lighter where it slides into the coarser one. Default FALSE.
*/

#include <epoxy/gl.h>

#include <SoTerrain/SoGeometryClipmapTerrain.h>

#include <algorithm>
#include <cmath>

#include <Inventor/errors/SoDebugError.h>
#include <Inventor/misc/SoNotification.h>

#include "ClipmapTables.h"
#include "ClipmapView.h"
#include "lod/ClipmapMesh.h"

SO_NODE_SOURCE(SoGeometryClipmapTerrain);

class SoGeometryClipmapTerrain::Clipmaps {
public:
    explicit Clipmaps(SoGeometryClipmapTerrain * node) : master(node) {}

    /// A whole number from `least` to `most`, after a warning where the field asks for another.
    int valid(const SoSFInt32 & field, const char * name, int least, int most) const
    {
        const int wanted = field.getValue(), taken = std::clamp(wanted, least, most);
        if (wanted != taken)
            master->warnOnce((std::string(name) + ": expected " + std::to_string(least) + " to " + std::to_string(most) + ", found " +
                              std::to_string(wanted) + "; " + std::to_string(taken) + " is taken").c_str());
        return taken;
    }

    /// All but the size where that is chosen by the view: then it is 0.
    terrain::ClipmapShape shape() const
    {
        terrain::ClipmapShape shape;
        const int wanted = master->clipmapSize.getValue();
        shape.size = wanted == 0 ? 0 : terrain::ClipmapShape::validSize(wanted);
        if (shape.size != wanted)
            master->warnOnce(("clipmapSize: expected 0, 15, 31, 63, 127, 255, 511 or 1023, found " + std::to_string(wanted) + "; " +
                              std::to_string(shape.size) + " is taken").c_str());
        shape.levels = valid(master->levels, "levels", 0, 31);
        shape.transitionWidth = valid(master->transitionWidth, "transitionWidth", 0, terrain::ClipmapShape::kLargest);
        shape.detailLevels = valid(master->detailLevels, "detailLevels", 0, terrain::ClipmapShape::kMostDetail);
        return shape;
    }

    terrain::DetailShape detailShape() const
    {
        const float amplitude = master->detailAmplitude.getValue();
        if (!std::isfinite(amplitude)) {
            master->warnOnce("detailAmplitude: expected a number, found none; 0 is taken");
            return {valid(master->detailLevels, "detailLevels", 0, terrain::ClipmapShape::kMostDetail), 0.0f, master->detailSeed.getValue()};
        }
        return {valid(master->detailLevels, "detailLevels", 0, terrain::ClipmapShape::kMostDetail), amplitude, master->detailSeed.getValue()};
    }

    terrain::ClipmapSettings settings() const
    {
        terrain::ClipmapSettings settings;
        settings.activeLevels = valid(master->activeLevels, "activeLevels", 0, 64);
        settings.updateBudget = valid(master->updateBudget, "updateBudget", 0, 1 << 30);
        return settings;
    }

    /// Whether texture coordinates are affine, looked at again only when something of the state has changed.
    bool isAffine(const TerrainFrame & frame)
    {
        lookAt(frame);
        return affine;
    }

    /// Whether normals are those of the ground, likewise.
    bool hasNormalsOfSurface(const TerrainFrame & frame)
    {
        lookAt(frame);
        return followsSurface;
    }

    SoGeometryClipmapTerrain * master;
    ClipmapTables tables;

private:
    void lookAt(const TerrainFrame & frame)
    {
        if (affineVersion != frame.attributes.version() || affineGrid.lock() != frame.data.model.boxes) {
            affine = frame.attributes.hasAffineTextureCoordinates(0);
            followsSurface = frame.attributes.hasNormalsOfSurface();
            affineVersion = frame.attributes.version();
            affineGrid = frame.data.model.boxes;
        }
    }

    bool affine = false, followsSurface = false;
    std::uint64_t affineVersion = 0;
    std::weak_ptr<const terrain::BoxPyramid> affineGrid;
};

void SoGeometryClipmapTerrain::initClass()
{
    if (getClassTypeId() != SoType::badType()) return;
    SoTerrainShape::initClass();
    SO_NODE_INIT_CLASS(SoGeometryClipmapTerrain, SoTerrainShape, "SoTerrainShape");
}

SoGeometryClipmapTerrain::SoGeometryClipmapTerrain() : clipmaps(new Clipmaps(this))
{
    SO_NODE_CONSTRUCTOR(SoGeometryClipmapTerrain);
    SO_NODE_ADD_FIELD(clipmapSize, (255));
    SO_NODE_ADD_FIELD(levels, (0));
    SO_NODE_ADD_FIELD(transitionWidth, (0));
    SO_NODE_ADD_FIELD(updateBudget, (0));
    SO_NODE_ADD_FIELD(activeLevels, (0));
    SO_NODE_ADD_FIELD(detailLevels, (0));
    SO_NODE_ADD_FIELD(detailAmplitude, (0.0f));
    SO_NODE_ADD_FIELD(detailSeed, (1));
    SO_NODE_ADD_FIELD(blendNormals, (TRUE));
    SO_NODE_ADD_FIELD(implementation, (AUTO));
    SO_NODE_ADD_FIELD(storage, (STORED));
    SO_NODE_ADD_FIELD(showLevels, (FALSE));
    SO_NODE_DEFINE_ENUM_VALUE(Implementation, AUTO);
    SO_NODE_DEFINE_ENUM_VALUE(Implementation, GPU);
    SO_NODE_DEFINE_ENUM_VALUE(Implementation, CPU);
    SO_NODE_SET_SF_ENUM_TYPE(implementation, Implementation);
    SO_NODE_DEFINE_ENUM_VALUE(Storage, STORED);
    SO_NODE_DEFINE_ENUM_VALUE(Storage, MEMORY_FREE);
    SO_NODE_SET_SF_ENUM_TYPE(storage, Storage);
}

SoGeometryClipmapTerrain::~SoGeometryClipmapTerrain() {}

void SoGeometryClipmapTerrain::notify(SoNotList * list)
{
    // Vertex arrays are made for these.
    const SoField * const shaping[] = {&this->clipmapSize, &this->levels, &this->transitionWidth, &this->updateBudget, &this->activeLevels,
                                       &this->detailLevels, &this->detailAmplitude, &this->detailSeed};
    if (std::find(std::begin(shaping), std::end(shaping), list->getLastField()) != std::end(shaping)) discardMeshes();
    inherited::notify(list);
}

bool SoGeometryClipmapTerrain::needsErrors() const
{
    return false;
}

const terrain::SynthesisedDetail * SoGeometryClipmapTerrain::detailOf(const TerrainGrid & data)
{
    return clipmaps->tables.detail(data.grid, data.model, clipmaps->detailShape()).get();
}

std::unique_ptr<terrain::LodAlgorithm> SoGeometryClipmapTerrain::createAlgorithm(const terrain::TerrainModel & model, const terrain::SampleGrid & grid)
{
    terrain::ClipmapShape shape = clipmaps->shape();
    const auto detail = clipmaps->tables.detail(grid, model, clipmaps->detailShape());
    shape.detailLevels = detail ? detail->levels() : 0;
    const auto errors = clipmaps->tables.errors(grid, model);
    return std::make_unique<terrain::ClipmapMesh>(grid.columns(), grid.rows(), shape, clipmaps->settings(), model.boxes,
                                                  [errors](const terrain::SampleGrid & samples) { return errors->get(samples); }, detail);
}

SbBool SoGeometryClipmapTerrain::renderOwn(const TerrainFrame & frame, SoTerrainStatistics & statistics)
{
    if (this->implementation.getValue() == CPU) return FALSE;
    const terrain::SampleGrid & grid = frame.data.grid;
    ClipmapOptions options;
    options.shape = clipmaps->shape();
    options.settings = clipmaps->settings();
    options.settings.pixelError = frame.settings.pixelError;
    options.settings.cull = frame.settings.cull;
    options.memoryFree = this->storage.getValue() == MEMORY_FREE;
    options.blendNormals = this->blendNormals.getValue();
    options.showLevels = this->showLevels.getValue();
    options.freeze = this->freeze.getValue();
    const auto detail = clipmaps->tables.detail(grid, frame.data.model, clipmaps->detailShape());
    options.shape.detailLevels = detail ? detail->levels() : 0;
    const auto errors = clipmaps->tables.errors(grid, frame.data.model)->get(grid);
    options.settings.detail = detail.get();
    ClipmapView * view = static_cast<ClipmapView *>(frame.view.drawing.get());
    if (options.shape.size == 0)
        options.shape.size = options.freeze && view ? view->shape().size
                                                    : terrain::smallestClipmap(grid, *frame.data.model.boxes, errors.get(), frame.camera, options.shape,
                                                                               options.settings, view ? view->shape().size : 0);

    std::string reason = whyNotOnGpu(frame, terrain::ClipmapLayout(grid.columns(), grid.rows(), options.shape),
                                           clipmaps->isAffine(frame));
    if (reason.empty() && !clipmaps->hasNormalsOfSurface(frame)) reason = "normals are not those of the ground";
    if (!reason.empty()) {
        if (this->implementation.getValue() == GPU)
            warnOnce(("implementation GPU: expected what vertex textures can draw, but " + reason + "; vertex arrays are used").c_str());
        TerrainViews::discardDrawing(frame.view);
        return FALSE;
    }
    if (!view || !view->isFor(options.shape, options.memoryFree, detail)) {
        TerrainViews::discardDrawing(frame.view);
        frame.view.drawing = std::make_unique<ClipmapView>(frame, options.shape, options.memoryFree, detail);
        view = static_cast<ClipmapView *>(frame.view.drawing.get());
    }
    if (const auto problem = view->render(frame, options, errors.get(), statistics)) {
        warnOnce((problem->message() + "; vertex arrays are used").c_str());
        return FALSE;
    }
    // Errors that are still to come decide about levels.
    if (!errors) frame.view.report.converged = false;
    return TRUE;
}
