#include <SoTerrain/SoTerrainTextureElement.h>

#include "height/TiledImage.h"

SO_ELEMENT_SOURCE(SoTerrainTextureElement);

void SoTerrainTextureElement::initClass()
{
    if (getClassTypeId() != SoType::badType()) return;
    SO_ELEMENT_INIT_CLASS(SoTerrainTextureElement, inherited);
}

SoTerrainTextureElement::~SoTerrainTextureElement() {}

void SoTerrainTextureElement::init(SoState * state)
{
    inherited::init(state);
    this->image.reset();
    this->clipSize = 0;
    this->updateBudget = 0;
}

void SoTerrainTextureElement::set(SoState * state, SoNode * node, const std::shared_ptr<const terrain::TiledImage> & image, int clipSize,
                                  uint32_t updateBudget)
{
    SoTerrainTextureElement * element = static_cast<SoTerrainTextureElement *>(inherited::getElement(state, classStackIndex, node));
    if (!element) return;
    element->image = image;
    element->clipSize = clipSize;
    element->updateBudget = updateBudget;
}

const SoTerrainTextureElement * SoTerrainTextureElement::getInstance(SoState * state)
{
    return static_cast<const SoTerrainTextureElement *>(SoElement::getConstElement(state, classStackIndex));
}

const std::shared_ptr<const terrain::TiledImage> & SoTerrainTextureElement::getImage() const
{
    return this->image;
}

int SoTerrainTextureElement::getClipSize() const
{
    return this->clipSize;
}

uint32_t SoTerrainTextureElement::getUpdateBudget() const
{
    return this->updateBudget;
}
