#include <SoTerrain/SoTerrainDetail.h>

SO_DETAIL_SOURCE(SoTerrainDetail);

void SoTerrainDetail::initClass()
{
    if (getClassTypeId() != SoType::badType()) return;
    SO_DETAIL_INIT_CLASS(SoTerrainDetail, SoFaceDetail);
}

SoTerrainDetail::SoTerrainDetail() : column(0), row(0), triangle(0), height(0.0f) {}

SoTerrainDetail::~SoTerrainDetail() {}

SoDetail * SoTerrainDetail::copy() const
{
    SoTerrainDetail * other = new SoTerrainDetail;
    other->setNumPoints(this->getNumPoints());
    for (int i = 0; i < this->getNumPoints(); ++i) other->setPoint(i, this->getPoint(i));
    other->setFaceIndex(this->getFaceIndex());
    other->setPartIndex(this->getPartIndex());
    other->setCell(this->column, this->row, this->triangle, this->height);
    return other;
}

void SoTerrainDetail::setCell(int columnArg, int rowArg, int triangleArg, float heightArg)
{
    this->column = columnArg;
    this->row = rowArg;
    this->triangle = triangleArg;
    this->height = heightArg;
}
