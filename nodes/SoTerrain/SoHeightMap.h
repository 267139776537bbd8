// Property node: height data from a file.
#ifndef SOTERRAIN_SOHEIGHTMAP_H
#define SOTERRAIN_SOHEIGHTMAP_H

#include <memory>

#include <Inventor/fields/SoSFEnum.h>
#include <Inventor/fields/SoSFFloat.h>
#include <Inventor/fields/SoSFInt32.h>
#include <Inventor/fields/SoSFString.h>
#include <Inventor/fields/SoSFVec2f.h>
#include <Inventor/fields/SoSFVec2i32.h>
#include <Inventor/nodes/SoNode.h>
#include <Inventor/nodes/SoSubNode.h>

class SoHeightMap : public SoNode {
    typedef SoNode inherited;
    SO_NODE_HEADER(SoHeightMap);

public:
    static void initClass();
    SoHeightMap();

    enum RawType { UINT8, UINT16_LITTLE_ENDIAN, UINT16_BIG_ENDIAN };

    SoSFString filename;
    SoSFVec2f spacing;       ///< (0, 0): the file's own, or (1, 1)
    SoSFFloat heightScale;   ///< 1
    SoSFFloat heightOffset;  ///< 0
    SoSFVec2f origin;        ///< local (x, y) of the first sample (south-west corner); (0, 0)
    SoSFInt32 channel;       ///< -1: the only one
    SoSFVec2i32 rawSize;     ///< columns and rows of a headerless file; (0, 0): square
    SoSFEnum rawType;        ///< UINT8
    SoSFFloat noData;        ///< sample value that marks a hole; NaN (the default) marks none

    /// Whether the file that the fields name has been read; reads it if need be.
    SbBool isLoaded();

    virtual void doAction(SoAction * action);
    virtual void GLRender(SoGLRenderAction * action);
    virtual void callback(SoCallbackAction * action);
    virtual void pick(SoPickAction * action);
    virtual void getBoundingBox(SoGetBoundingBoxAction * action);
    virtual void getPrimitiveCount(SoGetPrimitiveCountAction * action);

protected:
    virtual ~SoHeightMap();
    virtual SbBool readInstance(SoInput * in, unsigned short flags);
    virtual void copyContents(const SoFieldContainer * from, SbBool copyConnections);
    virtual void notify(SoNotList * list);

private:
    void load();

    class Private;
    std::unique_ptr<Private> pimpl;
};

#endif
