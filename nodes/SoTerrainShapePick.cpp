// Picking, heights and primitives of SoTerrainShape: all at full resolution, whatever is on screen. Primitives are without detail.
#include <epoxy/gl.h>

#include "SoTerrainShapeP.h"

#include <functional>

#include <Inventor/SbLine.h>
#include <Inventor/SbMatrix.h>
#include <Inventor/SoPickedPoint.h>
#include <Inventor/SoPrimitiveVertex.h>
#include <Inventor/actions/SoCallbackAction.h>
#include <Inventor/actions/SoRayPickAction.h>
#include <Inventor/actions/SoSearchAction.h>
#include <Inventor/details/SoPointDetail.h>
#include <Inventor/elements/SoShapeHintsElement.h>
#include <Inventor/misc/SoState.h>

#include <SoTerrain/SoTerrainDetail.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "FaceNormal.h"
#include "ParentNode.h"
#include "StateAttributes.h"
#include "lod/BruteForceMesh.h"
#include "lod/DetailCast.h"

namespace {

glm::dvec3 toGlm(const SbVec3f & v)
{
    return {v[0], v[1], v[2]};
}

SbVec3f toCoin(const glm::dvec3 & v)
{
    return SbVec3f(float(v.x), float(v.y), float(v.z));
}

/// Geometric normal of the finest triangle over a place in the frame.
SbVec3f finestNormal(const terrain::SampleGrid & grid, const terrain::SynthesisedDetail & detail, const glm::dvec2 & place)
{
    const auto triangle = terrain::finestTriangle(grid, detail, place);
    const glm::dvec3 corner[3] = {triangle[0], triangle[1], triangle[2]};
    return faceNormal(grid, corner);
}

/// Corner i of a triangle of a cell.
StateAttributes::Corner cornerOf(int column, int row, int triangle, int i)
{
    const auto & offset = terrain::kCellTriangles[triangle][i];
    return {column, row, column + offset[0], row + offset[1]};
}

/// Fills in details of triangles of one grid.
class DetailWriter {
public:
    DetailWriter(const terrain::SampleGrid & grid, const StateAttributes & attributes, int startIndex)
        : grid_(grid), attributes_(attributes), start_(std::size_t(startIndex)), pitch_(std::size_t(grid.columns()))
    {
        // A part of a height map has more samples to a row.
        if (grid.isRegular()) pitch_ = std::size_t(grid.heightRow(1) - grid.heightRow(0)) / grid.heightStride();
    }

    /// Corners in the order in which they are passed on.
    void write(SoTerrainDetail & detail, int column, int row, int triangle, float height, bool reversed) const
    {
        detail.setCell(column, row, triangle, height);
        detail.setFaceIndex(row * (grid_.columns() - 1) + column);
        detail.setPartIndex(row);
        detail.setNumPoints(3);
        for (int i = 0; i < 3; ++i) {
            const StateAttributes::Corner corner = cornerOf(column, row, triangle, reversed ? 2 - i : i);
            SoPointDetail point;
            point.setCoordinateIndex(int(start_ + std::size_t(corner.row) * pitch_ + std::size_t(corner.column)));
            point.setNormalIndex(attributes_.normalIndex(corner));
            point.setTextureCoordIndex(int(grid_.index(corner.column, corner.row)));
            point.setMaterialIndex(attributes_.materialIndex(corner));
            detail.setPoint(i, &point);
        }
    }

private:
    const terrain::SampleGrid & grid_;
    const StateAttributes & attributes_;
    std::size_t start_;
    std::size_t pitch_;
};

/// Geometric normal of what was hit.
SbVec3f normalOfHit(const terrain::SampleGrid & grid, const terrain::SynthesisedDetail * detail, const terrain::RayHit & hit)
{
    return detail ? finestNormal(grid, *detail, glm::dvec2(hit.point)) : faceNormal(grid, hit.column, hit.row, hit.triangle);
}

/// Normal, texture coordinate and material of a hit, from the corners of its triangle.
void describe(SoPickedPoint * picked, const StateAttributes & attributes, const terrain::RayHit & hit, const SbVec3f & geometric)
{
    SbVec3f normal(0.0f, 0.0f, 0.0f);
    SbVec4f texture(0.0f, 0.0f, 0.0f, 0.0f);
    int nearest = 0;
    for (int i = 0; i < 3; ++i) {
        const StateAttributes::Corner corner = cornerOf(hit.column, hit.row, hit.triangle, i);
        const float weight = float(hit.barycentric[i]);
        if (attributes.hasExplicitNormals()) normal += attributes.normal(corner) * weight;
        texture += attributes.textureCoordinates(corner) * weight;
        if (hit.barycentric[i] > hit.barycentric[nearest]) nearest = i;
    }
    if (!attributes.hasExplicitNormals() || normal.normalize() == 0.0f) normal = geometric;
    picked->setObjectNormal(normal);
    picked->setObjectTextureCoords(texture);
    // There is no way between materials: Coin's shapes take the nearest corner's, too.
    picked->setMaterialIndex(attributes.materialIndex(cornerOf(hit.column, hit.row, hit.triangle, nearest)));
}

/// A line in the frame of a grid, in double precision: the action's own has single precision, so it is asked for around the grid's middle,
/// however far from zero that is.
struct FrameRay {
    glm::dvec3 origin;
    glm::dvec3 direction;
    glm::dvec3 localDirection;
};

glm::dvec3 middleOf(const terrain::SampleGrid & grid, const terrain::BoxPyramid & boxes)
{
    const auto bounds = boxes.all();
    const glm::dvec3 middle = (glm::dvec3(bounds.low) + glm::dvec3(bounds.high)) * 0.5;
    // As a float, so that the action moves by exactly as much.
    return glm::dvec3(glm::vec3(glm::dvec3(grid.localFromFrame() * glm::dvec4(middle, 1.0))));
}

FrameRay rayAround(const glm::dvec3 & middle, const terrain::SampleGrid & grid, const SbLine & line)
{
    const glm::dmat4 frameFromLocal = glm::inverse(grid.localFromFrame());
    const glm::dvec3 direction = toGlm(line.getDirection());
    return {glm::dvec3(frameFromLocal * glm::dvec4(toGlm(line.getPosition()) + middle, 1.0)),
            glm::dvec3(frameFromLocal * glm::dvec4(direction, 0.0)), direction};
}

/// Whether a ray comes from the front: the upper side of a height field, and of a curved grid the side that SoQuadMesh's order says.
bool comesFromFront(SoState * state, const terrain::SampleGrid & grid, const glm::dvec3 & direction, const SbVec3f & geometric)
{
    const double along = glm::dot(direction, toGlm(geometric));
    if (grid.isRegular()) return along < 0.0;
    return (along > 0.0) != (SoShapeHintsElement::getVertexOrdering(state) == SoShapeHintsElement::CLOCKWISE);
}

}  // namespace

void SoTerrainShape::rayPick(SoRayPickAction * action)
{
    if (!this->shouldRayPick(action)) return;
    SoState * state = action->getState();
    const std::optional<TerrainGrid> data = pimpl->findGrid(state, false);
    if (!data || data->model.boxes->all().isEmpty()) return;
    const terrain::SampleGrid & grid = data->grid;
    const terrain::BoxPyramid & boxes = *data->model.boxes;
    const glm::dvec3 middle = middleOf(grid, boxes);
    SbMatrix toMiddle;
    toMiddle.setTranslate(toCoin(middle));
    this->computeObjectSpaceRay(action, toMiddle);
    const FrameRay ray = rayAround(middle, grid, action->getLine());
    this->computeObjectSpaceRay(action);
    constexpr double kEverywhere = 1e30;
    const terrain::SynthesisedDetail * finer = this->detailOf(*data);
    const std::vector<terrain::RayHit> hits =
        finer ? terrain::castRay(grid, boxes, *finer, ray.origin, ray.direction, -kEverywhere, kEverywhere)
              : terrain::castRay(grid, boxes, ray.origin, ray.direction, -kEverywhere, kEverywhere);
    std::optional<StateAttributes> attributes;
    for (const terrain::RayHit & hit : hits) {
        const SbVec3f point = toCoin(glm::dvec3(grid.localFromFrame() * glm::dvec4(hit.point, 1.0)));
        // The action's planes are those of the ray and the clip planes of the state.
        if (!action->isBetweenPlanes(point)) continue;
        const SbVec3f geometric = normalOfHit(grid, finer, hit);
        SoPickedPoint * picked = action->addIntersection(point, comesFromFront(state, grid, ray.localDirection, geometric));
        // Nothing is added where something else is nearer, or where back faces are not wanted.
        if (!picked) continue;
        if (!attributes) attributes.emplace(action, grid, false);
        describe(picked, *attributes, hit, geometric);
        SoTerrainDetail * detail = new SoTerrainDetail;
        DetailWriter(grid, *attributes, this->startIndex.getValue())
            .write(*detail, hit.column, hit.row, hit.triangle, point[grid.heightAxis()], false);
        picked->setDetail(detail, this);
        if (!action->isPickAll()) return;
    }
}

void SoTerrainShape::generatePrimitives(SoAction * action)
{
    const std::optional<TerrainGrid> data = pimpl->findGrid(action->getState(), false);
    if (!data) return;
    const terrain::SampleGrid & grid = data->grid;
    const StateAttributes attributes(action, grid, false);
    const DetailWriter details(grid, attributes, this->startIndex.getValue());
    const bool clockwise = pimpl->settingsFor(action->getState(), *data).clockwise;
    SoTerrainDetail detail;
    SoPrimitiveVertex vertex;
    vertex.setDetail(&detail);
    this->beginShape(action, TRIANGLES);
    for (int row = 0; row < grid.rows() - 1; ++row)
        for (int column = 0; column < grid.columns() - 1; ++column) {
            if (terrain::isCellHole(grid, column, row)) continue;
            for (int triangle = 0; triangle < 2; ++triangle) {
                details.write(detail, column, row, triangle, grid.position(column, row)[grid.heightAxis()], clockwise);
                for (int i = 0; i < 3; ++i) {
                    const StateAttributes::Corner corner = cornerOf(column, row, triangle, clockwise ? 2 - i : i);
                    const glm::vec3 p = grid.position(corner.column, corner.row);
                    vertex.setPoint(SbVec3f(p.x, p.y, p.z));
                    vertex.setNormal(attributes.normal(corner));
                    vertex.setTextureCoords(attributes.textureCoordinates(corner));
                    vertex.setMaterialIndex(attributes.materialIndex(corner));
                    this->shapeVertex(&vertex);
                }
            }
        }
    this->endShape();
}

namespace {

/// What a walk along a path to a terrain node brings back.
struct HeightQuery {
    SoTerrainShape * node;
    bool reached = false;
    std::function<void(SoState *)> ask;
};

SoCallbackAction::Response askAtNode(void * closure, SoCallbackAction * action, const SoNode * node)
{
    HeightQuery & query = *static_cast<HeightQuery *>(closure);
    if (node == query.node && !query.reached) {
        query.reached = true;
        query.ask(action->getState());
    }
    // Its triangles are not wanted.
    return SoCallbackAction::PRUNE;
}

/// The path from the topmost ancestor, along first parents.
SoPath * pathFromTop(SoNode * node)
{
    SoNodeList chain;
    for (SoNode * at = node; at; at = parentOf(at)) chain.insert(at, 0);
    SoPath * path = new SoPath(chain[0]);
    for (int i = 1; i < chain.getLength(); ++i) path->append(chain[i]);
    return path;
}

}  // namespace

SbBool SoTerrainShape::heightAt(float x, float y, float & height, SbVec3f * normal, SoPath * path)
{
    SbBool found = FALSE;
    HeightQuery query{this, false, {}};
    query.ask = [&](SoState * state) {
        const std::optional<TerrainGrid> data = pimpl->findGrid(state, false);
        if (!data || !data->grid.isRegular()) return;
        const int up = data->grid.heightAxis();
        glm::dvec3 local(0.0);
        local[up == 0 ? 1 : 0] = x;
        local[up == 2 ? 1 : 2] = y;
        const glm::dvec4 frame = glm::inverse(data->grid.localFromFrame()) * glm::dvec4(local, 1.0);
        const glm::dvec2 place(frame);
        const terrain::SynthesisedDetail * finer = this->detailOf(*data);
        const auto surface = finer ? terrain::surfaceAt(data->grid, *finer, place) : terrain::surfaceAt(data->grid, place);
        if (!surface) return;
        height = surface->height;
        found = TRUE;
        if (!normal) return;
        *normal = finer ? finestNormal(data->grid, *finer, place) : faceNormal(data->grid, surface->column, surface->row, surface->triangle);
    };
    this->ref();
    SoPath * walked = path ? path : pathFromTop(this);
    walked->ref();
    SoNode * head = walked->getHead();
    head->ref();
    SoCallbackAction action;
    action.addPreCallback(SoTerrainShape::getClassTypeId(), askAtNode, &query);
    action.apply(walked);
    walked->unref();
    // A head that nobody owns must survive the question.
    head->unrefNoDelete();
    this->unrefNoDelete();
    return found;
}
