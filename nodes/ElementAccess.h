// Node ids that Coin's elements keep to themselves: they tell whether what an element holds has changed since the last frame.
#ifndef SOTERRAIN_ELEMENTACCESS_H
#define SOTERRAIN_ELEMENTACCESS_H

#include <cstdint>

#include <Inventor/elements/SoLazyElement.h>
#include <Inventor/elements/SoMultiTextureCoordinateElement.h>
#include <Inventor/elements/SoMultiTextureImageElement.h>
#include <Inventor/misc/SoState.h>

/// A pointer to a protected member, taken through a derived class, applies to the base class too.
class LazyElementAccess : public SoLazyElement {
public:
    static std::uint64_t colourId(const SoLazyElement * element)
    {
        const CoinState & state = element->*(&LazyElementAccess::coinstate);
        return std::uint64_t(state.diffusenodeid) * 31 + std::uint64_t(state.transpnodeid);
    }
};

class TextureCoordinateElementAccess : public SoMultiTextureCoordinateElement {
public:
    static std::uint64_t unitId(const SoMultiTextureCoordinateElement * element, int unit)
    {
        const UnitData & (SoMultiTextureCoordinateElement::*unitData)(int) const = &TextureCoordinateElementAccess::getUnitData;
        return (element->*unitData)(unit).nodeid;
    }
};

class TextureImageElementAccess : public SoMultiTextureImageElement {
public:
    static std::uint64_t unitId(SoState * state, int unit)
    {
        const auto * element = static_cast<const SoMultiTextureImageElement *>(state->getConstElement(getClassStackIndex()));
        const UnitData & (SoMultiTextureImageElement::*unitData)(int) const = &TextureImageElementAccess::getUnitData;
        return (element->*unitData)(unit).nodeid;
    }
};

#endif
