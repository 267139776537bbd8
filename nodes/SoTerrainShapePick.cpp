// Picking, heights and primitives of SoTerrainShape: all at full resolution, whatever is on screen. Primitives are without detail.
#include <epoxy/gl.h>

#include "SoTerrainShapeP.h"

#include <functional>

#include <Inventor/SbLine.h>
#include <Inventor/SoPickedPoint.h>
#include <Inventor/SoPrimitiveVertex.h>
#include <Inventor/actions/SoCallbackAction.h>
#include <Inventor/actions/SoRayPickAction.h>
#include <Inventor/actions/SoSearchAction.h>
#include <Inventor/details/SoPointDetail.h>
#include <Inventor/misc/SoState.h>

#include <SoTerrain/SoTerrainDetail.h>

#include <glm/matrix.hpp>

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

/// Normal of a triangle in local coordinates, up where up is known.
SbVec3f faceNormal(const terrain::SampleGrid & grid, const SbVec3f (&corner)[3])
{
    SbVec3f normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    normal.normalize();
    if (grid.isRegular() && normal[grid.heightAxis()] < 0.0f) normal.negate();
    return normal;
}

/// Geometric normal of a cell's triangle.
SbVec3f faceNormal(const terrain::SampleGrid & grid, int column, int row, int triangle)
{
    SbVec3f corner[3];
    for (int i = 0; i < 3; ++i) {
        const auto & offset = terrain::kCellTriangles[triangle][i];
        const glm::vec3 p = grid.position(column + offset[0], row + offset[1]);
        corner[i].setValue(p.x, p.y, p.z);
    }
    return faceNormal(grid, corner);
}

/// Geometric normal of the finest triangle over a place in the frame.
SbVec3f faceNormal(const terrain::SampleGrid & grid, const terrain::SynthesisedDetail & detail, const glm::dvec2 & place)
{
    const auto triangle = terrain::finestTriangle(grid, detail, place);
    SbVec3f corner[3];
    for (std::size_t i = 0; i < 3; ++i) corner[i] = toCoin(glm::dvec3(grid.localFromFrame() * glm::dvec4(triangle[i], 1.0)));
    return faceNormal(grid, corner);
}

void fillDetail(SoTerrainDetail & detail, const terrain::SampleGrid & grid, const StateAttributes & attributes, int column, int row,
                int triangle, float height)
{
    detail.setCell(column, row, triangle, height);
    detail.setFaceIndex(row * (grid.columns() - 1) + column);
    detail.setPartIndex(row);
    detail.setNumPoints(3);
    for (int i = 0; i < 3; ++i) {
        const int c = column + terrain::kCellTriangles[triangle][i][0], r = row + terrain::kCellTriangles[triangle][i][1];
        SoPointDetail point;
        point.setCoordinateIndex(int(grid.index(c, r)));
        point.setNormalIndex(int(grid.index(c, r)));
        point.setTextureCoordIndex(int(grid.index(c, r)));
        point.setMaterialIndex(attributes.materialIndex(c, r));
        detail.setPoint(i, &point);
    }
}

/// Normal, texture coordinate and material of a hit, from the corners of its triangle.
void describe(SoPickedPoint * picked, const terrain::SampleGrid & grid, const terrain::SynthesisedDetail * detail,
              const StateAttributes & attributes, const terrain::RayHit & hit)
{
    SbVec3f normal(0.0f, 0.0f, 0.0f);
    SbVec2f texture(0.0f, 0.0f);
    for (int i = 0; i < 3; ++i) {
        const int c = hit.column + terrain::kCellTriangles[hit.triangle][i][0], r = hit.row + terrain::kCellTriangles[hit.triangle][i][1];
        const float weight = float(hit.barycentric[i]);
        if (attributes.hasExplicitNormals()) normal += attributes.normal(c, r) * weight;
        texture += attributes.textureCoordinate(0, c, r) * weight;
    }
    if (!attributes.hasExplicitNormals() || normal.normalize() == 0.0f)
        normal = detail ? faceNormal(grid, *detail, glm::dvec2(hit.point)) : faceNormal(grid, hit.column, hit.row, hit.triangle);
    picked->setObjectNormal(normal);
    picked->setObjectTextureCoords(SbVec4f(texture[0], texture[1], 0.0f, 1.0f));
    picked->setMaterialIndex(attributes.materialIndex(hit.column, hit.row));
}

}  // namespace

void SoTerrainShape::rayPick(SoRayPickAction * action)
{
    if (!this->shouldRayPick(action)) return;
    const std::optional<TerrainGrid> data = pimpl->findGrid(action->getState(), false);
    if (!data || data->model.boxes->all().isEmpty()) return;
    this->computeObjectSpaceRay(action);
    const terrain::SampleGrid & grid = data->grid;
    const glm::dmat4 frameFromLocal = glm::inverse(grid.localFromFrame());
    const SbLine & line = action->getLine();
    const glm::dvec3 origin(frameFromLocal * glm::dvec4(toGlm(line.getPosition()), 1.0));
    const glm::dvec3 direction(frameFromLocal * glm::dvec4(toGlm(line.getDirection()), 0.0));
    constexpr double kEverywhere = 1e30;
    const terrain::SynthesisedDetail * finer = this->detailOf(*data);
    const terrain::BoxPyramid & boxes = *data->model.boxes;
    const std::vector<terrain::RayHit> hits = finer ? terrain::castRay(grid, boxes, *finer, origin, direction, -kEverywhere, kEverywhere)
                                                    : terrain::castRay(grid, boxes, origin, direction, -kEverywhere, kEverywhere);
    std::optional<StateAttributes> attributes;
    for (const terrain::RayHit & hit : hits) {
        const SbVec3f point = toCoin(glm::dvec3(grid.localFromFrame() * glm::dvec4(hit.point, 1.0)));
        // The action's planes are those of the ray and the clip planes of the state.
        if (!action->isBetweenPlanes(point)) continue;
        if (SoPickedPoint * picked = action->addIntersection(point)) {
            if (!attributes) attributes.emplace(action, grid, false);
            describe(picked, grid, finer, *attributes, hit);
            SoTerrainDetail * detail = new SoTerrainDetail;
            fillDetail(*detail, grid, *attributes, hit.column, hit.row, hit.triangle, point[grid.heightAxis()]);
            picked->setDetail(detail, this);
        }
        if (!action->isPickAll()) return;
    }
}

void SoTerrainShape::generatePrimitives(SoAction * action)
{
    const std::optional<TerrainGrid> data = pimpl->findGrid(action->getState(), false);
    if (!data) return;
    const terrain::SampleGrid & grid = data->grid;
    const StateAttributes attributes(action, grid, false);
    const bool clockwise = pimpl->settingsFor(action->getState(), *data).clockwise;
    SoTerrainDetail detail;
    SoPrimitiveVertex vertex;
    vertex.setDetail(&detail);
    this->beginShape(action, TRIANGLES);
    for (int row = 0; row < grid.rows() - 1; ++row)
        for (int column = 0; column < grid.columns() - 1; ++column) {
            if (terrain::isCellHole(grid, column, row)) continue;
            for (int triangle = 0; triangle < 2; ++triangle) {
                fillDetail(detail, grid, attributes, column, row, triangle, grid.position(column, row)[grid.heightAxis()]);
                for (int i = 0; i < 3; ++i) {
                    const auto & offset = terrain::kCellTriangles[triangle][clockwise ? 2 - i : i];
                    const int c = column + offset[0], r = row + offset[1];
                    const glm::vec3 p = grid.position(c, r);
                    const SbVec2f texture = attributes.textureCoordinate(0, c, r);
                    vertex.setPoint(SbVec3f(p.x, p.y, p.z));
                    vertex.setNormal(attributes.normal(c, r));
                    vertex.setTextureCoords(SbVec4f(texture[0], texture[1], 0.0f, 1.0f));
                    vertex.setMaterialIndex(attributes.materialIndex(c, r));
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
        *normal = finer ? faceNormal(data->grid, *finer, place) : faceNormal(data->grid, surface->column, surface->row, surface->triangle);
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
