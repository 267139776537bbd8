// Shape node: polylines and points on the ground.
#ifndef SOTERRAIN_SOTERRAINDRAPE_H
#define SOTERRAIN_SOTERRAINDRAPE_H

#include <memory>

#include <Inventor/fields/SoMFInt32.h>
#include <Inventor/fields/SoMFVec2f.h>
#include <Inventor/fields/SoSFBool.h>
#include <Inventor/fields/SoSFEnum.h>
#include <Inventor/fields/SoSFFloat.h>
#include <Inventor/fields/SoSFInt32.h>
#include <Inventor/fields/SoSFNode.h>
#include <Inventor/nodes/SoShape.h>
#include <Inventor/nodes/SoSubNode.h>

class SoTerrainDrape : public SoShape {
    typedef SoShape inherited;
    SO_NODE_HEADER(SoTerrainDrape);

public:
    static void initClass();
    SoTerrainDrape();

    enum Kind { LINES, POINTS };

    SoMFVec2f point;
    SoMFInt32 numVertices;        ///< -1: all, or all that are left
    SoSFEnum kind;                ///< LINES
    SoSFBool closed;              ///< FALSE
    SoSFFloat offset;             ///< 0
    SoSFFloat pixelError;         ///< 2
    SoSFNode terrain;             ///< the node that draws the ground; NULL
    SoSFInt32 verticesPerRow;     ///< 0
    SoSFInt32 verticesPerColumn;  ///< 0
    SoSFInt32 startIndex;         ///< 0
    SoSFNode alternateRep;

    virtual void GLRender(SoGLRenderAction * action);
    virtual void rayPick(SoRayPickAction * action);
    virtual void getPrimitiveCount(SoGetPrimitiveCountAction * action);
    virtual void notify(SoNotList * list);
    virtual void write(SoWriteAction * action);

protected:
    virtual ~SoTerrainDrape();
    virtual void computeBBox(SoAction * action, SbBox3f & box, SbVec3f & center);
    virtual void generatePrimitives(SoAction * action);

private:
    class Private;
    std::unique_ptr<Private> pimpl;
};

#endif
