/*!
  \class SoTerrainDrape SoTerrainDrape.h SoTerrain/SoTerrainDrape.h
  \brief The SoTerrainDrape class lays polylines and points on the ground.

  Roads, borders, tracks and markers have two coordinates; the terrain has the third. The node takes the heights of the traversal state as
  terrain nodes do, from the SoHeightMap or the SoCoordinate3 before it, with the same fields for the part of it that is drawn, and belongs
  behind the terrain node in the same separator.

  \code
  #Inventor V2.1 ascii
  Separator {
    SoHeightMap { filename "terrain.png" heightScale 0.0011 }
    SoROAMTerrain { pixelError 2 }
    BaseColor { rgb 1 0.9 0.2 }
    DrawStyle { lineWidth 3 }
    SoTerrainDrape {
      pixelError 2
      point [ 100 120, 400 350, 380 700 ]
    }
    DrawStyle { pointSize 9 }
    SoTerrainDrape { kind POINTS point [ 100 120, 380 700 ] }
  }
  \endcode

  \image html pictures/drape.png

  A line follows the full-resolution surface, whatever is on screen: it has a vertex wherever it crosses a row, a column or the diagonal of a
  cell. Where the two ways to cut a cell differ it takes the higher surface, because terrain nodes cut cells either way. It ends at holes and at
  the border of the terrain, and goes on behind them.

  Ground with level of detail is drawn up to some pixels from where it belongs. So that it does not hide the line, a line is drawn
  as much higher, by no more than pixelError and a third of a pixel on screen, and with a small bias in depth for its width. Parts behind hills
  are hidden. Vertices that make a difference of less than a fifth of a pixel are left out, so that the work of a frame depends on what is
  seen and not on the length of the lines.

  SoDrawStyle (line width, line pattern, point size, POINTS), SoMaterial and SoPackedColor with SoMaterialBinding, fog, clip planes and
  SoPickStyle act as on SoLineSet: PER_FACE is a material per polyline, PER_PART one per segment, PER_VERTEX one per point, with colours in
  between. Lines have no normals, so they are not lit, and the texture of the ground does not apply to them.

  Picking, bounding box and primitives are those of the full-resolution line. A pick gives an SoLineDetail, whose line index counts the polylines
  and whose part index their segments, or an SoPointDetail; coordinate indices count the points.

  A grid that has no heights because it is curved can't be draped: a warning says so.

  <b>FILE FORMAT/DEFAULTS:</b>
  \code
    SoTerrainDrape {
      point [ ]
      numVertices -1
      kind LINES
      closed FALSE
      offset 0
      pixelError 2
      terrain NULL
      verticesPerRow 0
      verticesPerColumn 0
      startIndex 0
      alternateRep NULL
    }
  \endcode

  \sa SoTerrainShape, SoHeightMap, SoTerrainKit
*/

/*!
  \enum SoTerrainDrape::Kind
  LINES: polylines. POINTS: a point at each place.
*/
/*!
  \var SoMFVec2f SoTerrainDrape::point
  (x, y) in the local coordinates of the terrain; where heights run along another axis, the other two in order. None by default.
*/
/*!
  \var SoMFInt32 SoTerrainDrape::numVertices
  Points of each polyline, as in SoLineSet. -1, the default, is all that are left.
*/
/*!
  \var SoSFEnum SoTerrainDrape::kind
  What is drawn. Default LINES.
*/
/*!
  \var SoSFBool SoTerrainDrape::closed
  Whether the last point of each polyline of three or more is joined to its first. Default FALSE.
*/
/*!
  \var SoSFFloat SoTerrainDrape::offset
  Height above the ground. Default 0.
*/
/*!
  \var SoSFFloat SoTerrainDrape::pixelError
  How far, in pixels, the ground may be drawn from where it belongs: SoTerrainShape::pixelError of the terrain node, which is the default 2
  there too. 0 for full detail. SoComplexity changes both alike.
*/
/*!
  \var SoSFNode SoTerrainDrape::terrain
  The terrain node that draws the ground. With it, pixelError is not used but the bound that the node reported for its latest frame
  (SoTerrainStatistics::errorPixels): the right thing for SoGeometryClipmapTerrain, which does not promise an error but reports
  it, and for SoROAMTerrain::triangleCount. NULL, the default: pixelError.
*/
/*!
  \var SoSFInt32 SoTerrainDrape::verticesPerRow
  Samples of a row, as in SoTerrainShape, to be given the same value. Default 0.
*/
/*!
  \var SoSFInt32 SoTerrainDrape::verticesPerColumn
  Samples of a column, likewise. Default 0.
*/
/*!
  \var SoSFInt32 SoTerrainDrape::startIndex
  Index of the first sample, likewise. Default 0.
*/
/*!
  \var SoSFNode SoTerrainDrape::alternateRep
  What a program without this library shows in place of the node. Not used by the node itself. Default NULL.
*/

// epoxy must come before any other GL header, and Coin's headers bring theirs.
#include <epoxy/gl.h>

#include "SoTerrainDrapeP.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/actions/SoGetPrimitiveCountAction.h>
#include <Inventor/bundles/SoMaterialBundle.h>
#include <Inventor/elements/SoComplexityElement.h>
#include <Inventor/elements/SoCoordinateElement.h>
#include <Inventor/elements/SoDrawStyleElement.h>
#include <Inventor/elements/SoGLCacheContextElement.h>
#include <Inventor/elements/SoGLLazyElement.h>
#include <Inventor/elements/SoLineWidthElement.h>
#include <Inventor/elements/SoMaterialBindingElement.h>
#include <Inventor/elements/SoMultiTextureEnabledElement.h>
#include <Inventor/elements/SoPointSizeElement.h>
#include <Inventor/errors/SoDebugError.h>
#include <Inventor/misc/SoState.h>

#include <SoTerrain/SoHeightMap.h>
#include <SoTerrain/SoHeightMapElement.h>
#include <SoTerrain/SoTerrainShape.h>

#include <glm/matrix.hpp>

#include "DrapeDrawing.h"
#include "ElementAccess.h"
#include "FieldsInUse.h"
#include "StateView.h"

SO_NODE_SOURCE(SoTerrainDrape);

namespace {

std::uint32_t colourOf(const SoLazyElement & lazy, int index)
{
    index = std::min(index, lazy.getNumDiffuse() - 1);
    std::uint32_t rgba;
    if (lazy.isPacked()) {
        rgba = lazy.getPackedPointer()[index];
    } else {
        const int transparencies = lazy.getNumTransparencies();
        const float transparency = transparencies > 0 ? lazy.getTransparencyPointer()[std::min(index, transparencies - 1)] : 0.0f;
        rgba = lazy.getDiffusePointer()[index].getPackedValue(transparency);
    }
    return rgba;
}

/// Red first in memory, as GL takes it.
std::uint32_t mixed(std::uint32_t first, std::uint32_t second, float weight)
{
    std::uint8_t bytes[4];
    for (int i = 0; i < 4; ++i) {
        const float a = float((first >> (24 - 8 * i)) & 0xff), b = float((second >> (24 - 8 * i)) & 0xff);
        bytes[i] = std::uint8_t(std::lround(a + weight * (b - a)));
    }
    std::uint32_t result;
    std::memcpy(&result, bytes, sizeof result);
    return result;
}

}  // namespace

void SoTerrainDrape::initClass()
{
    if (getClassTypeId() != SoType::badType()) return;
    SoHeightMap::initClass();
    SO_NODE_INIT_CLASS(SoTerrainDrape, SoShape, "Shape");
}

SoTerrainDrape::SoTerrainDrape() : pimpl(new Private(this))
{
    SO_NODE_CONSTRUCTOR(SoTerrainDrape);
    SO_NODE_ADD_EMPTY_MFIELD(point);
    SO_NODE_ADD_FIELD(numVertices, (-1));
    SO_NODE_ADD_FIELD(kind, (LINES));
    SO_NODE_ADD_FIELD(closed, (FALSE));
    SO_NODE_ADD_FIELD(offset, (0.0f));
    SO_NODE_ADD_FIELD(pixelError, (2.0f));
    SO_NODE_ADD_FIELD(terrain, (NULL));
    SO_NODE_ADD_FIELD(verticesPerRow, (0));
    SO_NODE_ADD_FIELD(verticesPerColumn, (0));
    SO_NODE_ADD_FIELD(startIndex, (0));
    SO_NODE_ADD_FIELD(alternateRep, (NULL));
    SO_NODE_DEFINE_ENUM_VALUE(Kind, LINES);
    SO_NODE_DEFINE_ENUM_VALUE(Kind, POINTS);
    SO_NODE_SET_SF_ENUM_TYPE(kind, Kind);
}

SoTerrainDrape::~SoTerrainDrape() {}

void SoTerrainDrape::notify(SoNotList * list)
{
    const SoField * field = list->getLastField();
    if (field) pimpl->warned.clear();
    for (const SoField * shaping : {(SoField *)&this->point, (SoField *)&this->numVertices, (SoField *)&this->kind,
                                    (SoField *)&this->closed, (SoField *)&this->offset})
        if (field == shaping) ++pimpl->version;
    inherited::notify(list);
}

void SoTerrainDrape::write(SoWriteAction * action)
{
    if (!writeFieldsInUse(action, this)) inherited::write(action);
}

void SoTerrainDrape::Private::warnOnce(const std::string & text)
{
    if (warned.insert(text).second) SoDebugError::postWarning("SoTerrainDrape", "%s", text.c_str());
}

terrain::DrapeInput SoTerrainDrape::Private::inputFor(const terrain::SampleGrid & grid)
{
    terrain::DrapeInput input;
    const glm::dmat4 frameFromLocal = glm::inverse(grid.localFromFrame());
    const int up = grid.heightAxis();
    for (int i = 0; i < master->point.getNum(); ++i) {
        glm::dvec4 local(0.0, 0.0, 0.0, 1.0);
        local[up == 0 ? 1 : 0] = master->point[i][0];
        local[up == 2 ? 1 : 2] = master->point[i][1];
        input.places.emplace_back(frameFromLocal * local);
    }
    int left = master->point.getNum();
    for (int i = 0; i < master->numVertices.getNum(); ++i) {
        const int wanted = master->numVertices[i], count = wanted < 0 ? left : std::min(wanted, left);
        if (count < wanted)
            warnOnce("numVertices: expected " + std::to_string(wanted) + " more points, found " + std::to_string(left));
        input.counts.push_back(count);
        left -= count;
    }
    input.lines = master->kind.getValue() == LINES;
    input.closed = master->closed.getValue();
    input.offset = master->offset.getValue();
    return input;
}

std::shared_ptr<const SoTerrainDrape::Private::Draped> SoTerrainDrape::Private::find(SoState * state)
{
    if (master->point.getNum() == 0) return NULL;
    const GridRequest request{master->verticesPerRow.getValue(), master->verticesPerColumn.getValue(), master->startIndex.getValue()};
    const auto found = grids.find(state, request, false);
    if (!found) {
        // An SoHeightMap that failed has said why.
        if (!SoHeightMapElement::getInstance(state)->hasFailed()) warnOnce(found.error().message());
        return NULL;
    }
    const TerrainGrid & data = found.value();
    if (!data.grid.isRegular()) {
        warnOnce("terrain: expected heights over a regular grid, found a curved one");
        return NULL;
    }
    if (data.model.boxes->all().isEmpty()) return NULL;
    const SbUniqueId mapId = SoHeightMapElement::getInstance(state)->getNodeId();
    const SbUniqueId coordinatesId = SoCoordinateElement::getInstance(state)->getNodeId();
    // Not all actions know it.
    const bool asLines = !state->isElementEnabled(SoDrawStyleElement::getClassStackIndex()) ||
                         SoDrawStyleElement::get(state) != SoDrawStyleElement::POINTS;
    for (const auto & one : draped)
        if (one->boxes == data.model.boxes && one->mapId == mapId && one->coordinatesId == coordinatesId && one->version == version &&
            one->asLines == asLines)
            return one;
    auto made = std::make_shared<Draped>();
    made->boxes = data.model.boxes;
    made->mapId = mapId;
    made->coordinatesId = coordinatesId;
    made->version = version;
    made->asLines = asLines;
    made->localFromFrame = data.grid.localFromFrame();
    made->top = data.model.boxes->all().high.z + std::max(0.0f, master->offset.getValue());
    terrain::DrapeInput input = inputFor(data.grid);
    input.lines = input.lines && asLines;
    made->lines = terrain::DrapedLines(data.grid, input);
    // One of each place that the node has in the scene, and what was before them.
    constexpr std::size_t kKept = 4;
    std::erase_if(draped, [this](const auto & one) { return one->version != version; });
    if (draped.size() >= kKept) draped.erase(draped.begin());
    draped.push_back(made);
    return made;
}

float SoTerrainDrape::Private::errorFor(SoState * state)
{
    const SoNode * node = master->terrain.getValue();
    if (node && node->isOfType(SoTerrainShape::getClassTypeId())) {
        const SoTerrainStatistics statistics = static_cast<const SoTerrainShape *>(node)->getStatistics();
        if (statistics.frame > 0 && std::isfinite(statistics.errorPixels)) return float(statistics.errorPixels);
    } else if (node) {
        warnOnce(std::string("terrain: expected an SoTerrainShape, found a node of class ") + node->getTypeId().getName().getString());
    }
    float pixels = master->pixelError.getValue();
    constexpr float kDefault = 2.0f, kMost = 1e4f;
    if (!(pixels >= 0.0f)) {
        warnOnce("pixelError: expected 0 or more pixels, found " + std::to_string(pixels) + "; 2 is taken");
        pixels = kDefault;
    }
    return std::min(kMost, pixels * std::exp2(4.0f * (0.5f - SoComplexityElement::get(state))));
}

SoTerrainDrape::Private::Binding SoTerrainDrape::Private::bindingFor(SoState * state) const
{
    if (SoLazyElement::getInstance(state)->getNumDiffuse() <= 1) return OVERALL;
    switch (SoMaterialBindingElement::get(state)) {
    case SoMaterialBindingElement::OVERALL: return OVERALL;
    case SoMaterialBindingElement::PER_FACE:
    case SoMaterialBindingElement::PER_FACE_INDEXED: return PER_POLYLINE;
    case SoMaterialBindingElement::PER_PART:
    case SoMaterialBindingElement::PER_PART_INDEXED: return PER_SEGMENT;
    default: return PER_POINT;
    }
}

int SoTerrainDrape::Private::materialIndex(Binding binding, const terrain::DrapedLines::Run & run, bool atEnd) const
{
    switch (binding) {
    case PER_POLYLINE: return run.polyline;
    // Segments are counted over all polylines: each has one fewer than points unless it is closed.
    case PER_SEGMENT: return run.place - (master->kind.getValue() == LINES && !master->closed.getValue() ? run.polyline : 0);
    case PER_POINT: return atEnd ? run.nextPlace : run.place;
    default: return 0;
    }
}

void SoTerrainDrape::Private::render(SoGLRenderAction * action)
{
    SoState * state = action->getState();
    const auto found = find(state);
    if (!found || found->lines.runs().empty()) return;
    TerrainView & view = views.find(action);
    if (!view.drawing) view.drawing = std::make_unique<DrapeDrawing>();
    DrapeDrawing & drawing = static_cast<DrapeDrawing &>(*view.drawing);

    const Binding binding = bindingFor(state);
    const bool points = found->lines.runs().front().count == 1;
    const float size = points ? SoPointSizeElement::get(state) : SoLineWidthElement::get(state);
    const SoLazyElement * lazy = SoLazyElement::getInstance(state);
    DrapeDrawing::Key key{found, viewOf(state), {}, 0};
    key.settings.pixelError = errorFor(state);
    key.settings.width = std::max(1.0f, size);
    key.settings.top = found->top;
    key.settings.separateSegments = binding == PER_SEGMENT;
    if (binding != OVERALL) key.colours = LazyElementAccess::colourId(lazy) * 4 + std::uint64_t(binding);
    if (!drawing.isCurrent(key)) {
        const terrain::DrapeSelection selection =
            terrain::DrapeView(found->lines, key.camera, found->localFromFrame, key.settings).select();
        std::vector<std::uint32_t> colours;
        if (binding != OVERALL)
            for (const auto & chosen : selection.vertices) {
                const terrain::DrapedLines::Run & run = found->lines.runs()[chosen.run];
                colours.push_back(mixed(colourOf(*lazy, materialIndex(binding, run, false)), colourOf(*lazy, materialIndex(binding, run, true)),
                                        found->lines.vertices()[chosen.vertex].along));
            }
        drawing.fill(key, selection, colours);
    }
    drawing.draw(points ? GL_POINTS : GL_LINE_STRIP);
    if (binding != OVERALL) SoGLLazyElement::getInstance(state)->reset(state, SoLazyElement::DIFFUSE_MASK);
}

void SoTerrainDrape::GLRender(SoGLRenderAction * action)
{
    if (!this->shouldGLRender(action)) return;
    SoState * state = action->getState();
    // The vertices depend on the camera.
    SoGLCacheContextElement::shouldAutoCache(state, SoGLCacheContextElement::DONT_AUTO_CACHE);
    state->push();
    SoLazyElement::setLightModel(state, SoLazyElement::BASE_COLOR);
    SoMultiTextureEnabledElement::disableAll(state);
    {
        SoMaterialBundle materials(action);
        materials.sendFirst();
        pimpl->render(action);
    }
    state->pop();
}

void SoTerrainDrape::computeBBox(SoAction * action, SbBox3f & box, SbVec3f & center)
{
    const auto found = pimpl->find(action->getState());
    if (!found) return;
    for (const auto & vertex : found->lines.vertices()) {
        const glm::dvec4 local = found->localFromFrame * glm::dvec4(vertex.position, 1.0);
        box.extendBy(SbVec3f(float(local.x), float(local.y), float(local.z)));
    }
    if (!box.isEmpty()) center = box.getCenter();
}

void SoTerrainDrape::getPrimitiveCount(SoGetPrimitiveCountAction * action)
{
    if (!this->shouldPrimitiveCount(action)) return;
    const auto found = pimpl->find(action->getState());
    if (!found) return;
    for (const auto & run : found->lines.runs()) {
        if (run.count == 1) action->addNumPoints(1);
        else action->addNumLines(int(run.count) - 1);
    }
}
