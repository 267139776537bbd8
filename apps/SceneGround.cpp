#include "SceneGround.h"

#include <algorithm>
#include <cmath>

#include <Inventor/actions/SoCallbackAction.h>
#include <Inventor/elements/SoCoordinateElement.h>
#include <SoTerrain/SoTerrainShape.h>

#include <glm/geometric.hpp>

namespace app {

namespace {

struct CoordinateQuery {
    const SoTerrainShape* shape;
    Ground::Lattice found;
};

// Rows and columns of coordinates, which a terrain node takes as SoQuadMesh does.
SoCallbackAction::Response readCoordinates(void* closure, SoCallbackAction* action, const SoNode*) {
    auto& query = *static_cast<CoordinateQuery*>(closure);
    const SoCoordinateElement* element = SoCoordinateElement::getInstance(action->getState());
    const int start = query.shape->startIndex.getValue(), count = element ? element->getNum() - start : 0;
    int columns = query.shape->verticesPerRow.getValue(), rows = query.shape->verticesPerColumn.getValue();
    if (columns == 0 && rows == 0) columns = rows = int(std::lround(std::sqrt(double(std::max(0, count)))));
    if (columns == 0) columns = count / std::max(1, rows);
    if (rows == 0) rows = count / std::max(1, columns);
    if (columns < 2 || rows < 2 || start < 0 || columns > count / rows) return SoCallbackAction::PRUNE;
    const SbVec3f first = element->get3(start), last = element->get3(start + columns * rows - 1);
    const glm::dvec2 step((last[0] - first[0]) / (columns - 1), (last[1] - first[1]) / (rows - 1));
    if (step.x != 0.0 && step.y != 0.0 && std::isfinite(step.x + step.y)) query.found = {columns, rows, {first[0], first[1]}, step};
    return SoCallbackAction::PRUNE;
}

}  // namespace

std::optional<Ground::Surface> SceneGround::at(glm::dvec2 place) const {
    SoNode* terrain = scene_.terrain();
    if (!terrain) return std::nullopt;
    if (!terrain->isOfType(SoTerrainShape::getClassTypeId()))
        return scene_.grid() ? scene_.grid()->surfaceAt(place.x, place.y) : std::nullopt;
    float height = 0.0f;
    SbVec3f normal;
    auto* shape = static_cast<SoTerrainShape*>(terrain);
    if (!shape->heightAt(float(place.x), float(place.y), height, &normal, scene_.terrainPath())) return std::nullopt;
    if (normal[2] < 0.0f) normal.negate();
    return Surface{height, glm::normalize(glm::dvec3(normal[0], normal[1], normal[2]))};
}

Ground::Lattice SceneGround::lattice() const {
    if (const auto source = scene_.heightSource()) {
        const terrain::HeightExtent extent = source->extent();
        return {extent.columns, extent.rows, extent.origin, extent.spacing};
    }
    SoNode* terrain = scene_.terrain();
    if (terrain && terrain->isOfType(SoTerrainShape::getClassTypeId())) {
        CoordinateQuery query{static_cast<SoTerrainShape*>(terrain), {}};
        SoCallbackAction action;
        action.addPreCallback(terrain->getTypeId(), readCoordinates, &query);
        action.apply(scene_.terrainPath());
        return query.found;
    }
    if (const auto& grid = scene_.grid()) return {grid->columns, grid->rows, {0.0, 0.0}, grid->spacing};
    return {};
}

}  // namespace app
