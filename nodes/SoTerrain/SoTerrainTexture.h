// Property node: a colour texture of any size.
#ifndef SOTERRAIN_SOTERRAINTEXTURE_H
#define SOTERRAIN_SOTERRAINTEXTURE_H

#include <memory>

#include <Inventor/fields/SoSFInt32.h>
#include <Inventor/fields/SoSFString.h>
#include <Inventor/nodes/SoNode.h>
#include <Inventor/nodes/SoSubNode.h>

class SoTerrainTexture : public SoNode {
    typedef SoNode inherited;
    SO_NODE_HEADER(SoTerrainTexture);

public:
    static void initClass();
    SoTerrainTexture();

    SoSFString filename;
    SoSFInt32 clipSize;      ///< texels along a side of what is on the GPU of each level, a power of two from 64 to 8192
    SoSFInt32 updateBudget;  ///< most texels to load in a frame after the first; 0: no limit
    SoSFInt32 memoryBudget;  ///< megabytes that tiles of the file may take in main memory

    /// Whether the file that the fields name has been opened; opens it if need be.
    SbBool isLoaded();

    virtual void GLRender(SoGLRenderAction * action);

protected:
    virtual ~SoTerrainTexture();
    virtual SbBool readInstance(SoInput * in, unsigned short flags);
    virtual void copyContents(const SoFieldContainer * from, SbBool copyConnections);
    virtual void notify(SoNotList * list);

private:
    class Private;
    std::unique_ptr<Private> pimpl;
};

#endif
