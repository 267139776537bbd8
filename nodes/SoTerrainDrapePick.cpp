// Picking and primitives of SoTerrainDrape: those of the full-resolution lines.
#include <epoxy/gl.h>

#include "SoTerrainDrapeP.h"

#include <Inventor/SoPickedPoint.h>
#include <Inventor/SoPrimitiveVertex.h>
#include <Inventor/actions/SoRayPickAction.h>
#include <Inventor/details/SoLineDetail.h>
#include <Inventor/details/SoPointDetail.h>

#include <glm/mat4x4.hpp>

namespace {

SbVec3f placeOf(const glm::dmat4 & localFromFrame, const terrain::DrapedLines::Vertex & vertex)
{
    const glm::dvec4 local = localFromFrame * glm::dvec4(vertex.position, 1.0);
    return SbVec3f(float(local.x), float(local.y), float(local.z));
}

}  // namespace

void SoTerrainDrape::Private::fill(SoPointDetail & detail, const terrain::DrapedLines::Run & run, Binding binding) const
{
    detail.setCoordinateIndex(run.place);
    detail.setMaterialIndex(materialIndex(binding, run, false));
}

void SoTerrainDrape::Private::fill(SoLineDetail & detail, const terrain::DrapedLines::Run & run, Binding binding) const
{
    detail.setLineIndex(run.polyline);
    detail.setPartIndex(run.segment);
    SoPointDetail point;
    fill(point, run, binding);
    detail.setPoint0(&point);
    point.setCoordinateIndex(run.nextPlace);
    point.setMaterialIndex(materialIndex(binding, run, true));
    detail.setPoint1(&point);
}

void SoTerrainDrape::rayPick(SoRayPickAction * action)
{
    if (!this->shouldRayPick(action)) return;
    const auto found = pimpl->find(action->getState());
    if (!found) return;
    this->computeObjectSpaceRay(action);
    const Private::Binding binding = pimpl->bindingFor(action->getState());
    for (const auto & run : found->lines.runs()) {
        SbVec3f last = placeOf(found->localFromFrame, found->lines.vertices()[run.first]);
        for (std::uint32_t i = run.count == 1 ? 0 : 1; i < run.count; ++i) {
            const SbVec3f next = placeOf(found->localFromFrame, found->lines.vertices()[run.first + i]);
            SbVec3f hit = next;
            const SbBool meets = run.count == 1 ? action->intersect(next) : action->intersect(last, next, hit);
            last = next;
            if (!meets || !action->isBetweenPlanes(hit)) continue;
            SoPickedPoint * picked = action->addIntersection(hit);
            if (!picked) continue;
            picked->setMaterialIndex(pimpl->materialIndex(binding, run, false));
            if (run.count == 1) {
                SoPointDetail * detail = new SoPointDetail;
                pimpl->fill(*detail, run, binding);
                picked->setDetail(detail, this);
            } else {
                SoLineDetail * detail = new SoLineDetail;
                pimpl->fill(*detail, run, binding);
                picked->setDetail(detail, this);
            }
        }
    }
}

void SoTerrainDrape::generatePrimitives(SoAction * action)
{
    const auto found = pimpl->find(action->getState());
    if (!found) return;
    const Private::Binding binding = pimpl->bindingFor(action->getState());
    SoPrimitiveVertex vertex;
    vertex.setNormal(SbVec3f(0.0f, 0.0f, 1.0f));
    for (const auto & run : found->lines.runs()) {
        SoLineDetail line;
        SoPointDetail point;
        if (run.count == 1) pimpl->fill(point, run, binding);
        else pimpl->fill(line, run, binding);
        this->beginShape(action, run.count == 1 ? SoShape::POINTS : SoShape::LINE_STRIP);
        for (std::uint32_t i = 0; i < run.count; ++i) {
            const auto & at = found->lines.vertices()[run.first + i];
            vertex.setDetail(run.count == 1 ? static_cast<SoDetail *>(&point) : static_cast<SoDetail *>(&line));
            vertex.setMaterialIndex(pimpl->materialIndex(binding, run, at.along > 0.5f));
            vertex.setPoint(placeOf(found->localFromFrame, at));
            this->shapeVertex(&vertex);
        }
        this->endShape();
    }
}
