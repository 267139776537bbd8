// Transformation node: places what follows it on the ground.
#ifndef SOTERRAIN_SOTERRAINPLACEMENT_H
#define SOTERRAIN_SOTERRAINPLACEMENT_H

#include <memory>

#include <Inventor/fields/SoSFBool.h>
#include <Inventor/fields/SoSFFloat.h>
#include <Inventor/fields/SoSFInt32.h>
#include <Inventor/fields/SoSFVec2f.h>
#include <Inventor/nodes/SoSubNode.h>
#include <Inventor/nodes/SoTransformation.h>

class SoTerrainPlacement : public SoTransformation {
    typedef SoTransformation inherited;
    SO_NODE_HEADER(SoTerrainPlacement);

public:
    static void initClass();
    SoTerrainPlacement();

    SoSFVec2f point;              ///< 0 0
    SoSFFloat offset;             ///< 0
    SoSFBool align;               ///< FALSE
    SoSFFloat heading;            ///< radians; 0
    SoSFInt32 verticesPerRow;     ///< 0
    SoSFInt32 verticesPerColumn;  ///< 0
    SoSFInt32 startIndex;         ///< 0

    virtual void doAction(SoAction * action);
    virtual void GLRender(SoGLRenderAction * action);
    virtual void callback(SoCallbackAction * action);
    virtual void pick(SoPickAction * action);
    virtual void getBoundingBox(SoGetBoundingBoxAction * action);
    virtual void getMatrix(SoGetMatrixAction * action);
    virtual void getPrimitiveCount(SoGetPrimitiveCountAction * action);
    virtual void notify(SoNotList * list);
    virtual void write(SoWriteAction * action);

protected:
    virtual ~SoTerrainPlacement();

private:
    class Private;
    std::unique_ptr<Private> pimpl;
};

#endif
