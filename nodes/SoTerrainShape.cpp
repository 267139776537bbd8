/*!
  \class SoTerrainShape SoTerrainShape.h SoTerrain/SoTerrainShape.h
  \brief The SoTerrainShape class is the abstract base of all terrain nodes.

  A terrain node draws a grid of samples with an algorithm of its own. All of them take the same data through the same fields, so
  that the algorithm is one word in a file: where a file says QuadMesh, write SoROAMTerrain, and it has level of detail.

  The samples are those of the SoHeightMap before the node, or else the coordinates of an SoCoordinate3, in the order of SoQuadMesh:
  row after row, verticesPerRow points each, from startIndex on. Coordinates on a regular grid, with heights along any axis,
  are found out to be one and cost the least; any other grid, however curved, is drawn as well, its error measured in space.
  A point that is not finite is a hole: the cells around it are not drawn and not picked.

  Normals, materials and texture coordinates are taken as SoQuadMesh takes them, with their bindings. Without normals the node computes
  smooth ones, without texture coordinates the texture spans the terrain. The front of a height field is its upper side, whatever
  SoShapeHints::vertexOrdering says and whichever way rows run, so that it is never black or culled from above. Its underside is drawn unless
  nothing of it can be seen. With a binding per face or row a vertex has the value of the
  face or row that begins at it. SoDrawStyle, SoComplexity, SoShapeHints, lights, fog, clip planes, several texture units and
  shader programs act as on any Coin shape: vertices are the samples themselves, drawn from plain vertex arrays.

  pixelError is a promise: no sample of the terrain that is in view is drawn further from where it belongs than that many pixels. Where a
  limit of a node (SoROAMTerrain::triangleCount, budgets) stops short of it, and in SoGeometryClipmapTerrain, whose grids have the size that
  was chosen (unless SoGeometryClipmapTerrain::clipmapSize is 0), SoTerrainStatistics::errorPixels tells the bound that holds instead.

  Picking is exact: it meets the full-resolution triangles whatever is on screen, and gives an SoTerrainDetail. So do bounding box and
  primitives.

  To look at an algorithm at work there are debugView, wireframeOverlay, and freeze with frozenFrustum; all may be set at any time, in any program:

  \code
  SoChunkedLoDTerrain { debugView LEVELS wireframeOverlay TRUE }
  \endcode
*/

/*!
  \var SoSFInt32 SoTerrainShape::verticesPerRow
  Samples of a row. 0, the default, is all columns of the height map; for coordinates it follows from their number and
  verticesPerColumn, or, when both are 0, the grid is square.
*/
/*!
  \var SoSFInt32 SoTerrainShape::verticesPerColumn
  Samples of a column, likewise 0 by default: all rows of the height map.
*/
/*!
  \var SoSFInt32 SoTerrainShape::startIndex
  Index of the first sample, by default 0. As in SoQuadMesh, normals, materials and texture coordinates are counted from 0 all the same.
*/
/*!
  \var SoSFFloat SoTerrainShape::pixelError
  Largest distance on screen, in pixels of the viewport region, between where any sample in view is drawn and where it belongs. 0 is full
  detail. SoGeometryClipmapTerrain reports its bound instead of keeping this one, unless its clipmapSize is 0. Default 2. SoComplexity changes it: a value of 0.5 leaves it, each 0.25 more halves it and each 0.25 less doubles it.
*/
/*!
  \var SoSFBool SoTerrainShape::frustumCulling
  Whether parts outside of the view volume are left out. Default TRUE.
*/
/*!
  \var SoSFBool SoTerrainShape::freeze
  While TRUE the mesh that was chosen last stays, whatever the camera does: a way to look at it from outside. Default FALSE.
*/
/*!
  \var SoSFBool SoTerrainShape::frozenFrustum
  Whether the edges of the view volume that a frozen mesh was chosen for are drawn, as yellow lines. In any program, once the camera stands where you want it:

  \code
  terrain->freeze = TRUE;
  terrain->frozenFrustum = TRUE;
  camera->position = outside;  // and look back
  \endcode

  Default FALSE.
*/
/*!
  \enum SoTerrainShape::DebugView
  What is drawn in place of the terrain: NONE the terrain itself, TILES its parts, LEVELS sizes of triangles, ERRORS distances from the samples on screen, LOADING what is
  still to come.
*/
/*!
  \var SoSFEnum SoTerrainShape::debugView
  Draws the mesh in colours that tell how it was chosen. Lights, materials and textures do not act on them; slopes are shaded a little, unless SoLightModel is
  BASE_COLOR. Bounding box, picks and primitives stay what they are. SoGeometryClipmapTerrain draws from vertex arrays meanwhile. Such a picture
  takes many times as long as the terrain. Transparent terrain under SORTED_OBJECT_SORTED_TRIANGLE_BLEND is drawn by Coin from its primitives, without pictures and edges. Default NONE.

  TILES: each tile or block has one of sixteen colours, its neighbours have others, and it keeps it while it is drawn. SoROAMTerrain has no tiles; triangles have the colour of
  the square of the bisection that they lie in, a sixteenth of the map wide or more. Of SoGeometryClipmapTerrain the squares of 16 x 16 cells are shown in which levels are kept.
  Walls between tiles are dark grey.

  LEVELS: the same colour means the same size of triangles in all nodes. Level 0, full detail, is yellow; each further one, cells twice as wide, goes on over green, blue and
  violet, up to level 9. Levels finer than the samples (SoGeometryClipmapTerrain::detailLevels) are paler than yellow.

  ERRORS: how far what is drawn is from the full-resolution samples, in pixels of the current camera: 0 is dark blue, then blue, green and yellow follow, pixelError is red,
  and what is further off magenta. So a mesh that keeps pixelError has no magenta, and a frozen one has where one comes too near. With a pixelError of 0 red is one pixel. On regular grids each
  pixel is compared with the cell of the full data there (between the two surfaces that its diagonals make there is no error); of curved grids, maps of more than 2^26 samples or more along a side than a texture may have,
  and with detailLevels, each triangle has the colour of the worst sample in view that it covers.

  LOADING: grey is drawn as wanted, orange stands in for finer tiles or levels that are still being built or sent, blue came in this frame, and yellow came and stands in. Nodes that load nothing are all
  grey. Violet is ground for which texels of an SoTerrainTexture are still to come.
*/
/*!
  \var SoSFBool SoTerrainShape::wireframeOverlay
  Whether the edges of the triangles are drawn over the terrain, or over a debugView: lines one pixel wide, fainter where triangles are hardly wider than that. They lie exactly on the surface, so that
  nothing flickers or shines through. SoGeometryClipmapTerrain draws from vertex arrays meanwhile. With SoDrawStyle LINES or POINTS there is nothing to draw them over. Default FALSE.
*/
/*!
  \var SoSFNode SoTerrainShape::alternateRep
  What a program without this library shows in place of the node. Not used by the node itself. Default NULL.
*/

// epoxy must come before any other GL header, and Coin's headers bring theirs.
#include <epoxy/gl.h>

#include "SoTerrainShapeP.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>

#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/actions/SoGetPrimitiveCountAction.h>
#include <Inventor/bundles/SoMaterialBundle.h>
#include <Inventor/elements/SoCacheElement.h>
#include <Inventor/elements/SoClipPlaneElement.h>
#include <Inventor/elements/SoComplexityElement.h>
#include <Inventor/elements/SoDepthBufferElement.h>
#include <Inventor/elements/SoDrawStyleElement.h>
#include <Inventor/elements/SoGLCacheContextElement.h>
#include <Inventor/elements/SoGLLazyElement.h>
#include <Inventor/elements/SoGLShaderProgramElement.h>
#include <Inventor/elements/SoShapeHintsElement.h>
#include <Inventor/elements/SoShapeStyleElement.h>
#include <Inventor/errors/SoDebugError.h>
#include <Inventor/misc/SoState.h>

#include <SoTerrain/SoHeightMap.h>
#include <SoTerrain/SoHeightMapElement.h>
#include <SoTerrain/SoTerrainDetail.h>
#include <SoTerrain/SoTerrainTexture.h>

#include <glm/matrix.hpp>

#include "FieldsInUse.h"
#include "MeshPicture.h"
#include "StateAttributes.h"
#include "StateView.h"
#include "TerrainFrame.h"
#include "lod/BruteForceMesh.h"
#include "lod/DetailCast.h"
#include "lod/UpperSide.h"

SO_NODE_ABSTRACT_SOURCE(SoTerrainShape);

namespace {

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start)
{
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// Whether columns, rows and heights make a left-handed frame.
bool isMirrored(const terrain::SampleGrid & grid)
{
    return glm::determinant(grid.localFromFrame()) < 0.0;
}
/// Whether what is drawn is what a light sees, to find shadows.
bool isShadowMap(SoState * state)
{
    return (SoShapeStyleElement::get(state)->getFlags() & SoShapeStyleElement::SHADOWMAP) != 0;
}

}  // namespace

SoTerrainShape::Private::Private(SoTerrainShape * masterArg)
    : master(masterArg), again([](void * node, SoSensor *) { static_cast<SoTerrainShape *>(node)->touch(); }, masterArg)
{
}

void SoTerrainShape::initClass()
{
    if (getClassTypeId() != SoType::badType()) return;
    // Elements must be enabled before an action first meets the node.
    SoHeightMap::initClass();
    SoTerrainDetail::initClass();
    SoTerrainTexture::initClass();
    SO_NODE_INIT_ABSTRACT_CLASS(SoTerrainShape, SoShape, "Shape");
}

SoTerrainShape::SoTerrainShape() : pimpl(new Private(this))
{
    SO_NODE_CONSTRUCTOR(SoTerrainShape);
    SO_NODE_ADD_FIELD(verticesPerRow, (0));
    SO_NODE_ADD_FIELD(verticesPerColumn, (0));
    SO_NODE_ADD_FIELD(startIndex, (0));
    SO_NODE_ADD_FIELD(pixelError, (2.0f));
    SO_NODE_ADD_FIELD(frustumCulling, (TRUE));
    SO_NODE_ADD_FIELD(freeze, (FALSE));
    SO_NODE_ADD_FIELD(frozenFrustum, (FALSE));
    SO_NODE_ADD_FIELD(debugView, (NONE));
    SO_NODE_ADD_FIELD(wireframeOverlay, (FALSE));
    SO_NODE_ADD_FIELD(alternateRep, (NULL));
    SO_NODE_DEFINE_ENUM_VALUE(DebugView, NONE);
    SO_NODE_DEFINE_ENUM_VALUE(DebugView, TILES);
    SO_NODE_DEFINE_ENUM_VALUE(DebugView, LEVELS);
    SO_NODE_DEFINE_ENUM_VALUE(DebugView, ERRORS);
    SO_NODE_DEFINE_ENUM_VALUE(DebugView, LOADING);
    SO_NODE_SET_SF_ENUM_TYPE(debugView, DebugView);
}

SoTerrainShape::~SoTerrainShape() {}

SoTerrainStatistics SoTerrainShape::getStatistics() const
{
    return pimpl->statistics;
}

void SoTerrainShape::warnOnce(const char * text) const
{
    if (pimpl->warned.insert(text).second) SoDebugError::postWarning(this->getTypeId().getName().getString(), "%s", text);
}

int SoTerrainShape::validTileSize(int wanted, int least, int most) const
{
    const unsigned int possible = unsigned(std::clamp(wanted, least, most)), below = std::bit_floor(possible), above = std::bit_ceil(possible);
    const int valid = int(possible - below < above - possible ? below : above);
    if (valid != wanted)
        warnOnce(("tileSize: expected a power of two from " + std::to_string(least) + " to " + std::to_string(most) + ", found " +
                  std::to_string(wanted) + "; " + std::to_string(valid) + " is taken").c_str());
    return valid;
}

void SoTerrainShape::getSettings(terrain::LodSettings &) const {}

SbBool SoTerrainShape::renderOwn(const TerrainFrame &, SoTerrainStatistics &)
{
    return FALSE;
}

void SoTerrainShape::discardMeshes()
{
    ++pimpl->meshVersion;
}

void SoTerrainShape::restart()
{
    ++pimpl->start;
    this->touch();
}

bool SoTerrainShape::needsErrors() const
{
    return true;
}

const terrain::SynthesisedDetail * SoTerrainShape::detailOf(const TerrainGrid &)
{
    return NULL;
}

void SoTerrainShape::notify(SoNotList * list)
{
    // What was wrong may be right now, and is worth saying again if it is not.
    if (list->getLastField()) pimpl->warned.clear();
    inherited::notify(list);
}

void SoTerrainShape::write(SoWriteAction * action)
{
    if (!writeFieldsInUse(action, this)) inherited::write(action);
}

std::optional<TerrainGrid> SoTerrainShape::Private::findGrid(SoState * state, bool withErrors)
{
    const GridRequest request{master->verticesPerRow.getValue(), master->verticesPerColumn.getValue(), master->startIndex.getValue()};
    auto found = grids.find(state, request, withErrors);
    if (found) return std::move(found).value();
    // An SoHeightMap that failed has said why.
    if (!SoHeightMapElement::getInstance(state)->hasFailed()) master->warnOnce(found.error().message().c_str());
    return std::nullopt;
}

terrain::LodSettings SoTerrainShape::Private::settingsFor(SoState * state, const TerrainGrid & data) const
{
    terrain::LodSettings settings;
    const float pixels = master->pixelError.getValue();
    // However much is allowed, what can't be drawn coarsely is not.
    constexpr float kLargest = 1e30f;
    if (pixels >= 0.0f)
        settings.pixelError = std::min(pixels, kLargest);
    else
        master->warnOnce(("pixelError: expected 0 or more pixels, found " + std::to_string(pixels) + "; 2 is taken").c_str());
    settings.pixelError *= std::exp2(4.0f * (0.5f - SoComplexityElement::get(state)));
    settings.cull = master->frustumCulling.getValue();
    // A height field's front is its upper side, whichever way rows run and whatever SoShapeHints call the front; only a curved grid has
    // SoQuadMesh's order, because it has no upper side.
    const bool hintsClockwise = SoShapeHintsElement::getVertexOrdering(state) == SoShapeHintsElement::CLOCKWISE;
    settings.clockwise = !data.grid.isRegular() || hintsClockwise != isMirrored(data.grid);
    master->getSettings(settings);
    return settings;
}

void SoTerrainShape::Private::select(TerrainView & view, const terrain::View & camera, const terrain::LodSettings & settings,
                                     const TerrainGrid & data, const StateAttributes & attributes)
{
    const Clock::time_point start = Clock::now();
    const terrain::DrawList list = view.algorithm->select(data.grid, camera, settings);
    statistics.selectMilliseconds = millisecondsSince(start);
    view.report = list.report;
    const Clock::time_point selected = Clock::now();
    statistics.uploadedBytes = view.renderer.upload(list, data.grid, attributes, settings.uploadBudget > 0 && !settings.complete);
    statistics.newVertexBytes = view.renderer.newVertexBytes();
    statistics.uploadMilliseconds = millisecondsSince(selected);
    view.hasMesh = true;
    statistics.splits = list.report.splits;
    statistics.merges = list.report.merges;
    statistics.tileMilliseconds = list.report.buildMilliseconds;
    statistics.pendingPatches = list.report.pending;
}

bool SoTerrainShape::Private::hidesUndersides(const TerrainView & view, const terrain::View & camera, SoState * state,
                                              const TerrainGrid & data) const
{
    // A frozen mesh, or one still on its way, keeps no error to this camera.
    if (master->freeze.getValue() || !std::isfinite(view.report.errorPixels)) return false;
    // What is cut open or seen through shows its underside, and a shader may move vertices anywhere.
    constexpr unsigned int kTransparent = SoShapeStyleElement::TRANSP_MATERIAL | SoShapeStyleElement::TRANSP_TEXTURE;
    if (SoDrawStyleElement::get(state) != SoDrawStyleElement::FILLED || SoClipPlaneElement::getInstance(state)->getNum() > 0 ||
        (SoShapeStyleElement::get(state)->getFlags() & kTransparent) != 0 || SoGLShaderProgramElement::get(state))
        return false;
    const SoDepthBufferElement::DepthWriteFunction nearer = SoDepthBufferElement::getFunction(state);
    if (!SoDepthBufferElement::getTestEnable(state) || (nearer != SoDepthBufferElement::LESS && nearer != SoDepthBufferElement::LEQUAL))
        return false;
    return terrain::showsUpperSideOnly(data.grid, *data.model.boxes, camera);
}

void SoTerrainShape::Private::renderMesh(const TerrainFrame & frame)
{
    TerrainView & view = frame.view;
    if (!view.algorithm) {
        const Clock::time_point start = Clock::now();
        view.algorithm = master->createAlgorithm(frame.data.model, frame.data.grid);
        view.hasMesh = false;
        statistics.buildMilliseconds += millisecondsSince(start);
    }
    const bool isSelection = !master->freeze.getValue() || !view.hasMesh;
    if (isSelection) select(view, *view.chosenFor, frame.settings, frame.data, frame.attributes);
    const Clock::time_point start = Clock::now();
    if (frame.attributes.hasOverallNormal()) glNormal3fv(frame.attributes.normal(0, 0).getValue());
    SoState * state = frame.action->getState();
    const bool cull = !glIsEnabled(GL_CULL_FACE) && hidesUndersides(view, frame.camera, state, frame.data);
    if (cull) glEnable(GL_CULL_FACE);
    const bool debugs = wantsDebug(state);
    if (!debugs || master->debugView.getValue() == NONE) {
        const TerrainTextureUse::FixedFunction tiled(frame.texture);
        view.renderer.draw();
    }
    if (debugs) renderDebug(frame, isSelection);
    if (cull) glDisable(GL_CULL_FACE);
    if (frame.attributes.format().colours) SoGLLazyElement::getInstance(state)->reset(state, SoLazyElement::DIFFUSE_MASK);
    statistics.drawMilliseconds = millisecondsSince(start);
    statistics.triangles = view.renderer.triangles();
    statistics.drawCalls = view.renderer.draws();
    statistics.patches = view.renderer.triangles() > 0 ? view.report.patches : 0;
}

bool SoTerrainShape::Private::wantsDebug(SoState * state) const
{
    return (master->debugView.getValue() != NONE || master->wireframeOverlay.getValue()) && !isShadowMap(state);
}

void SoTerrainShape::Private::renderDebug(const TerrainFrame & frame, bool isSelection)
{
    SoState * state = frame.action->getState();
    if (!frame.view.debug) frame.view.debug = std::make_unique<MeshPicture>();
    MeshPicture::Wanted wanted;
    wanted.picture = master->debugView.getValue();
    wanted.edges = master->wireframeOverlay.getValue();
    wanted.isSelection = isSelection;
    wanted.hasDetail = master->detailOf(frame.data) != NULL;
    wanted.isShaded = SoLazyElement::getLightModel(state) != SoLazyElement::BASE_COLOR;
    const std::string problem = frame.view.debug->draw(frame, *frame.view.algorithm, wanted);
    if (!problem.empty()) master->warnOnce(problem.c_str());
}

void SoTerrainShape::Private::bringUpToDate(TerrainView & view, const TerrainGrid & data) const
{
    const std::uint64_t version = data.model.edits ? data.model.edits->version() : 0;
    const bool sameGrid = view.boxes == data.model.boxes && view.localFromFrame == data.grid.localFromFrame();
    const auto edits = sameGrid && data.model.edits ? data.model.edits->since(view.edits) : std::optional<terrain::GridEdits>(terrain::GridEdits{});
    if (!sameGrid || !edits || view.start != start) TerrainViews::discardDrawing(view);
    if (view.start != start) view.algorithm.reset();
    if (!sameGrid || !edits || view.meshVersion != meshVersion) {
        // What it shares with others of its kind, and does not depend on places, is found again while it is there.
        const std::unique_ptr<terrain::LodAlgorithm> before = std::move(view.algorithm);
        view.hasMesh = false;
        if (before && view.boxes == data.model.boxes && edits && view.meshVersion == meshVersion) view.algorithm = master->createAlgorithm(data.model, data.grid);
    }
    if (edits && !edits->isEmpty()) {
        if (view.drawing) view.drawing->update(data.grid, *edits);
        if (view.algorithm && !view.algorithm->update(data.grid, *edits)) view.algorithm.reset();
    }
    view.boxes = data.model.boxes;
    view.edits = version;
    view.localFromFrame = data.grid.localFromFrame();
    view.meshVersion = meshVersion;
    view.start = start;
}

void SoTerrainShape::Private::render(SoGLRenderAction * action)
{
    SoState * state = action->getState();
    const std::optional<TerrainGrid> data = findGrid(state, master->needsErrors());
    if (!data || data->model.boxes->all().isEmpty()) return;
    const std::uint64_t number = statistics.frame + 1;
    statistics = SoTerrainStatistics{};
    statistics.frame = number;
    statistics.buildMilliseconds = data->buildMilliseconds;

    TerrainView & view = views.find(action);
    bringUpToDate(view, *data);
    SoMaterialBundle materials(action);
    materials.sendFirst();
    const StateAttributes attributes(action, data->grid, true);
    for (const std::string & problem : attributes.problems()) master->warnOnce(problem.c_str());
    const terrain::View camera = viewOf(state);
    const TerrainTextureUse::Frame texture = view.texture.update(action, camera, data->grid, attributes);
    if (!texture.problem.empty()) master->warnOnce(texture.problem.c_str());
    terrain::LodSettings settings = settingsFor(state, *data);
    settings.vertexBytes = sizeof(glm::vec3) + attributes.format().stride();
    const TerrainFrame frame{action, *data, camera, settings, attributes, texture, view};
    if (!master->freeze.getValue() || !view.chosenFor) view.chosenFor = camera;
    const bool debugs = wantsDebug(state);
    if (!debugs && view.debug) TerrainViews::discardDebug(view);
    // Of what is drawn by programs of the node's own the triangles are known as a mesh only.
    if (debugs || !master->renderOwn(frame, statistics)) renderMesh(frame);
    if (master->freeze.getValue() && master->frozenFrustum.getValue() && !isShadowMap(state)) drawViewVolume(*view.chosenFor);

    statistics.converged = view.report.converged && texture.converged;
    statistics.uploadedBytes += texture.uploadedBytes;
    statistics.levels = view.report.levels;
    statistics.errorPixels = view.report.errorPixels;
    statistics.memoryBytes = grids.bytes() + views.memoryBytes();
    statistics.bufferBytes = views.bufferBytes();
    counters.publish(statistics);
    if (!statistics.converged && !again.isScheduled()) again.schedule();
}

void SoTerrainShape::GLRender(SoGLRenderAction * action)
{
    if (!this->shouldGLRender(action)) return;
    // The mesh depends on the camera and lives in buffers: a display list around it would only be thrown away.
    SoGLCacheContextElement::shouldAutoCache(action->getState(), SoGLCacheContextElement::DONT_AUTO_CACHE);
    // Nor is one to be recorded where renderCaching is ON: programs and textures of its own can't be.
    SoCacheElement::invalidate(action->getState());
    pimpl->render(action);
}

void SoTerrainShape::computeBBox(SoAction * action, SbBox3f & box, SbVec3f & center)
{
    const std::optional<TerrainGrid> data = pimpl->findGrid(action->getState(), false);
    if (!data) return;
    const terrain::SynthesisedDetail * detail = this->detailOf(*data);
    const terrain::BoxPyramid & boxes = *data->model.boxes;
    const terrain::BoxPyramid::Bounds bounds = detail ? terrain::detailBounds(boxes, *detail) : boxes.all();
    if (bounds.isEmpty()) return;
    for (const glm::vec3 & corner : {bounds.low, bounds.high}) {
        const glm::dvec4 local = data->grid.localFromFrame() * glm::dvec4(corner, 1.0);
        box.extendBy(SbVec3f(float(local.x), float(local.y), float(local.z)));
    }
    center = box.getCenter();
}

void SoTerrainShape::getPrimitiveCount(SoGetPrimitiveCountAction * action)
{
    if (!this->shouldPrimitiveCount(action)) return;
    const std::optional<TerrainGrid> data = pimpl->findGrid(action->getState(), false);
    if (!data) return;
    int triangles = 0;
    for (int row = 0; row < data->grid.rows() - 1; ++row)
        for (int column = 0; column < data->grid.columns() - 1; ++column) triangles += terrain::isCellHole(data->grid, column, row) ? 0 : 2;
    action->addNumTriangles(triangles);
}
