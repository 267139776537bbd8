// Traversal state: the tiled texture that terrain nodes draw.
#ifndef SOTERRAIN_SOTERRAINTEXTUREELEMENT_H
#define SOTERRAIN_SOTERRAINTEXTUREELEMENT_H

#include <cstdint>
#include <memory>

#include <Inventor/elements/SoReplacedElement.h>
#include <Inventor/elements/SoSubElement.h>

namespace terrain {
class TiledImage;
}

/// Set by SoTerrainTexture, in SoGLRenderAction only.
class SoTerrainTextureElement : public SoReplacedElement {
    typedef SoReplacedElement inherited;
    SO_ELEMENT_HEADER(SoTerrainTextureElement);

public:
    static void initClass();

    virtual void init(SoState * state);
    /// Makes \a image the texture of the terrain nodes that follow, in the name of \a node. The rest are the fields of SoTerrainTexture.
    static void set(SoState * state, SoNode * node, const std::shared_ptr<const terrain::TiledImage> & image, int clipSize,
                    uint32_t updateBudget);
    /// The element of this traversal, which must have it enabled.
    static const SoTerrainTextureElement * getInstance(SoState * state);
    /// NULL where no node has set one, or its file could not be read.
    const std::shared_ptr<const terrain::TiledImage> & getImage() const;
    /// Texels along a side of each level's part on the GPU: a power of two.
    int getClipSize() const;
    /// Most texels to load in a frame; 0: no limit.
    uint32_t getUpdateBudget() const;

protected:
    virtual ~SoTerrainTextureElement();

private:
    std::shared_ptr<const terrain::TiledImage> image;
    int clipSize;
    uint32_t updateBudget;
};

#endif
