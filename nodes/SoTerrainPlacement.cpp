/*!
  \class SoTerrainPlacement SoTerrainPlacement.h SoTerrain/SoTerrainPlacement.h
  \brief The SoTerrainPlacement class places what follows it on the ground.

  Trees, houses and vehicles have two coordinates; the terrain has the third. The node takes the heights of the traversal state as terrain
  nodes do, from the SoHeightMap or the SoCoordinate3 before it, and moves what follows it in the separator, as an SoTransform does: its
  origin comes to stand on the ground. Each object has a separator of its own, behind the terrain node.

  \code
  #Inventor V2.1 ascii
  Separator {
    SoHeightMap { filename "terrain.png" heightScale 0.0011 }
    SoROAMTerrain { pixelError 2 }
    Separator {
      SoTerrainPlacement { point 125 100 heading 0.8 }
      Translation { translation 0 0 2 }
      Cube { width 6 height 4 depth 4 }
    }
    Separator {
      SoTerrainPlacement { point 110 150 align TRUE }
      Cylinder { radius 3 height 0.5 }
    }
  }
  \endcode

  \image html pictures/drape.png

  The height is that of the full-resolution surface, as SoTerrainShape::heightAt() tells it, whatever level of detail is on screen. It
  follows: an object stands on ground that SoHeightMap::setHeights() changes in the same frame, and render caches above know of it.

  Without heights at the point, over a hole or beside the terrain, nothing is moved and a warning says so; likewise over a grid that has no
  heights because it is curved.

  SoGetMatrixAction gives the same matrix, so that picks on what is placed tell points in its coordinates. Detail that
  SoGeometryClipmapTerrain adds to the samples is not known to the node.

  <b>FILE FORMAT/DEFAULTS:</b>
  \code
    SoTerrainPlacement {
      point 0 0
      offset 0
      align FALSE
      heading 0
      verticesPerRow 0
      verticesPerColumn 0
      startIndex 0
    }
  \endcode

  \sa SoTerrainDrape, SoTerrainShape, SoHeightMap
*/

/*!
  \var SoSFVec2f SoTerrainPlacement::point
  (x, y) in the local coordinates of the terrain; where heights run along another axis, the other two in order. Default 0 0.
*/
/*!
  \var SoSFFloat SoTerrainPlacement::offset
  Height above the ground, along the vertical also where align is set. Default 0.
*/
/*!
  \var SoSFBool SoTerrainPlacement::align
  Whether the object is tilted, so that its z axis is the normal of the ground; where heights run along another axis, that one. Default
  FALSE: it stands upright.
*/
/*!
  \var SoSFFloat SoTerrainPlacement::heading
  Turn about the vertical in radians, counterclockwise seen from above, before the tilt. Default 0.
*/
/*!
  \var SoSFInt32 SoTerrainPlacement::verticesPerRow
  Samples of a row, as in SoTerrainShape, to be given the same value. Default 0.
*/
/*!
  \var SoSFInt32 SoTerrainPlacement::verticesPerColumn
  Samples of a column, likewise. Default 0.
*/
/*!
  \var SoSFInt32 SoTerrainPlacement::startIndex
  Index of the first sample, likewise. Default 0.
*/

#include <SoTerrain/SoTerrainPlacement.h>

#include <cmath>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <Inventor/SbMatrix.h>
#include <Inventor/SbRotation.h>
#include <Inventor/actions/SoCallbackAction.h>
#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/actions/SoGetBoundingBoxAction.h>
#include <Inventor/actions/SoGetMatrixAction.h>
#include <Inventor/actions/SoGetPrimitiveCountAction.h>
#include <Inventor/actions/SoPickAction.h>
#include <Inventor/elements/SoModelMatrixElement.h>
#include <Inventor/errors/SoDebugError.h>
#include <Inventor/lists/SoNodeList.h>
#include <Inventor/misc/SoState.h>
#include <Inventor/nodes/SoMatrixTransform.h>

#include <SoTerrain/SoHeightMap.h>
#include <SoTerrain/SoHeightMapElement.h>

#include <glm/matrix.hpp>

#include "FaceNormal.h"
#include "FieldsInUse.h"
#include "GridCache.h"
#include "lod/RayCast.h"

SO_NODE_SOURCE(SoTerrainPlacement);

class SoTerrainPlacement::Private {
public:
    explicit Private(SoTerrainPlacement * masterArg) : master(masterArg) {}

    /// None where nothing is to be moved, after a warning.
    std::optional<SbMatrix> find(SoState * state);
    SbMatrix matrixOn(const terrain::SampleGrid & grid, const terrain::SurfacePoint & ground) const;
    /// A node that has the matrix. Caches below depend on the ids of nodes that made the model matrix, and the placement's own stays as it
    /// is when the ground changes.
    SoMatrixTransform * nodeFor(const SbMatrix & matrix);
    void warnOnce(const std::string & text);

    SoTerrainPlacement * master;
    SoNodeList kept;  ///< one for each place that the node has in the scene, the latest last
    std::set<std::string> warned;
};

void SoTerrainPlacement::initClass()
{
    if (getClassTypeId() != SoType::badType()) return;
    // It makes the actions have the element.
    SoHeightMap::initClass();
    SO_NODE_INIT_CLASS(SoTerrainPlacement, SoTransformation, "Transformation");
}

SoTerrainPlacement::SoTerrainPlacement() : pimpl(new Private(this))
{
    SO_NODE_CONSTRUCTOR(SoTerrainPlacement);
    SO_NODE_ADD_FIELD(point, (0.0f, 0.0f));
    SO_NODE_ADD_FIELD(offset, (0.0f));
    SO_NODE_ADD_FIELD(align, (FALSE));
    SO_NODE_ADD_FIELD(heading, (0.0f));
    SO_NODE_ADD_FIELD(verticesPerRow, (0));
    SO_NODE_ADD_FIELD(verticesPerColumn, (0));
    SO_NODE_ADD_FIELD(startIndex, (0));
}

SoTerrainPlacement::~SoTerrainPlacement() {}

void SoTerrainPlacement::notify(SoNotList * list)
{
    if (list->getLastField()) pimpl->warned.clear();
    inherited::notify(list);
}

void SoTerrainPlacement::write(SoWriteAction * action)
{
    if (!writeFieldsInUse(action, this)) inherited::write(action);
}

void SoTerrainPlacement::Private::warnOnce(const std::string & text)
{
    if (warned.insert(text).second) SoDebugError::postWarning("SoTerrainPlacement", "%s", text.c_str());
}

std::optional<SbMatrix> SoTerrainPlacement::Private::find(SoState * state)
{
    // Many objects stand on the same ground, so all nodes know it together. Nothing is kept alive by it.
    static thread_local GridCache grids;
    const GridRequest request{master->verticesPerRow.getValue(), master->verticesPerColumn.getValue(), master->startIndex.getValue()};
    const auto found = grids.findSamples(state, request);
    if (!found) {
        // An SoHeightMap that failed has said why.
        if (!SoHeightMapElement::getInstance(state)->hasFailed()) warnOnce(found.error().message());
        return std::nullopt;
    }
    const terrain::SampleGrid & grid = found.value();
    if (!grid.isRegular()) {
        warnOnce("terrain: expected heights over a regular grid, found a curved one");
        return std::nullopt;
    }
    if (!std::isfinite(master->offset.getValue()) || !std::isfinite(master->heading.getValue())) {
        warnOnce("offset and heading: expected numbers, found " + std::to_string(master->offset.getValue()) + " and " +
                 std::to_string(master->heading.getValue()));
        return std::nullopt;
    }
    const SbVec2f at = master->point.getValue();
    const int up = grid.heightAxis();
    glm::dvec4 local(0.0, 0.0, 0.0, 1.0);
    local[up == 0 ? 1 : 0] = at[0];
    local[up == 2 ? 1 : 2] = at[1];
    const auto ground = terrain::surfaceAt(grid, glm::dvec2(glm::inverse(grid.localFromFrame()) * local));
    if (!ground) {
        warnOnce("point: expected a place on the ground, found " + std::to_string(at[0]) + ' ' + std::to_string(at[1]) +
                 " in a hole or outside of the terrain; nothing is moved");
        return std::nullopt;
    }
    return matrixOn(grid, *ground);
}

SbMatrix SoTerrainPlacement::Private::matrixOn(const terrain::SampleGrid & grid, const terrain::SurfacePoint & ground) const
{
    const SbVec2f at = master->point.getValue();
    const int up = grid.heightAxis();
    SbVec3f place, vertical(0.0f, 0.0f, 0.0f);
    place[up == 0 ? 1 : 0] = at[0];
    place[up == 2 ? 1 : 2] = at[1];
    place[up] = ground.height + master->offset.getValue();
    vertical[up] = 1.0f;
    SbRotation rotation(vertical, master->heading.getValue());
    if (master->align.getValue()) rotation *= SbRotation(vertical, faceNormal(grid, ground.column, ground.row, ground.triangle));
    SbMatrix matrix;
    matrix.setTransform(place, rotation, SbVec3f(1.0f, 1.0f, 1.0f));
    return matrix;
}

SoMatrixTransform * SoTerrainPlacement::Private::nodeFor(const SbMatrix & matrix)
{
    for (int i = kept.getLength() - 1; i >= 0; --i) {
        SoMatrixTransform * node = static_cast<SoMatrixTransform *>(kept[i]);
        if (node->matrix.getValue() == matrix) return node;
    }
    constexpr int kKept = 4;
    if (kept.getLength() == kKept) kept.remove(0);
    SoMatrixTransform * node = new SoMatrixTransform;
    node->matrix = matrix;
    kept.append(node);
    return node;
}

void SoTerrainPlacement::doAction(SoAction * action)
{
    SoState * state = action->getState();
    if (!state->isElementEnabled(SoHeightMapElement::getClassStackIndex())) return;
    if (const auto matrix = pimpl->find(state)) SoModelMatrixElement::mult(state, pimpl->nodeFor(*matrix), *matrix);
}

void SoTerrainPlacement::GLRender(SoGLRenderAction * action)
{
    SoTerrainPlacement::doAction(action);
}

void SoTerrainPlacement::callback(SoCallbackAction * action)
{
    SoTerrainPlacement::doAction(action);
}

void SoTerrainPlacement::pick(SoPickAction * action)
{
    SoTerrainPlacement::doAction(action);
}

void SoTerrainPlacement::getBoundingBox(SoGetBoundingBoxAction * action)
{
    SoTerrainPlacement::doAction(action);
}

void SoTerrainPlacement::getPrimitiveCount(SoGetPrimitiveCountAction * action)
{
    SoTerrainPlacement::doAction(action);
}

namespace {

/// What a walk along a path to a placement brings back.
struct StateQuery {
    const SoNode * node;
    std::function<void(SoState *)> ask;
};

SoCallbackAction::Response askAtNode(void * closure, SoCallbackAction * action, const SoNode * node)
{
    StateQuery & query = *static_cast<StateQuery *>(closure);
    // The end of the path, not another place where the same node stands.
    const SoFullPath * at = static_cast<const SoFullPath *>(action->getCurPath());
    const SoFullPath * end = static_cast<const SoFullPath *>(action->getPathAppliedTo());
    if (node == query.node && *at == *end) query.ask(action->getState());
    return SoCallbackAction::CONTINUE;
}

}  // namespace

void SoTerrainPlacement::getMatrix(SoGetMatrixAction * action)
{
    // The action does not have the elements that heights come from; another one along the same path does.
    StateQuery query{this, {}};
    query.ask = [&](SoState * state) {
        const auto matrix = pimpl->find(state);
        if (!matrix) return;
        action->getMatrix().multLeft(*matrix);
        action->getInverse().multRight(matrix->inverse());
    };
    SoPath * path = action->getCurPath()->copy();
    path->ref();
    SoCallbackAction walk(action->getViewportRegion());
    walk.addPreCallback(SoTerrainPlacement::getClassTypeId(), askAtNode, &query);
    walk.apply(path);
    path->unref();
}
