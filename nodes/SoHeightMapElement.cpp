#include <SoTerrain/SoHeightMapElement.h>

#include <SoTerrain/SoTerrain.h>

SO_ELEMENT_SOURCE(SoHeightMapElement);

void SoHeightMapElement::initClass()
{
    if (getClassTypeId() != SoType::badType()) return;
    SO_ELEMENT_INIT_CLASS(SoHeightMapElement, inherited);
}

SoHeightMapElement::~SoHeightMapElement() {}

void SoHeightMapElement::init(SoState * state)
{
    inherited::init(state);
    this->source = NULL;
    this->failed = FALSE;
}

void SoHeightMapElement::set(SoState * state, SoNode * node, const terrain::HeightSource * source, SbBool failed)
{
    SoHeightMapElement * element = static_cast<SoHeightMapElement *>(inherited::getElement(state, classStackIndex, node));
    if (!element) return;
    element->source = source;
    element->failed = failed;
}

const SoHeightMapElement * SoHeightMapElement::getInstance(SoState * state)
{
    return static_cast<const SoHeightMapElement *>(SoElement::getConstElement(state, classStackIndex));
}

const terrain::HeightSource * SoHeightMapElement::getSource() const
{
    return this->source;
}

SbBool SoHeightMapElement::hasFailed() const
{
    return this->failed;
}
