// Nodekit: a terrain with all that belongs to it in one node.
#ifndef SOTERRAIN_SOTERRAINKIT_H
#define SOTERRAIN_SOTERRAINKIT_H

#include <Inventor/fields/SoSFEnum.h>
#include <Inventor/fields/SoSFNode.h>
#include <Inventor/nodekits/SoBaseKit.h>
#include <Inventor/nodekits/SoSubKit.h>

class SoTerrainKit : public SoBaseKit {
    typedef SoBaseKit inherited;
    SO_KIT_HEADER(SoTerrainKit);

    SO_KIT_CATALOG_ENTRY_HEADER(topSeparator);
    SO_KIT_CATALOG_ENTRY_HEADER(pickStyle);
    SO_KIT_CATALOG_ENTRY_HEADER(lightModel);
    SO_KIT_CATALOG_ENTRY_HEADER(environment);
    SO_KIT_CATALOG_ENTRY_HEADER(drawStyle);
    SO_KIT_CATALOG_ENTRY_HEADER(shapeHints);
    SO_KIT_CATALOG_ENTRY_HEADER(complexity);
    SO_KIT_CATALOG_ENTRY_HEADER(transform);
    SO_KIT_CATALOG_ENTRY_HEADER(materialBinding);
    SO_KIT_CATALOG_ENTRY_HEADER(material);
    SO_KIT_CATALOG_ENTRY_HEADER(color);
    SO_KIT_CATALOG_ENTRY_HEADER(normalBinding);
    SO_KIT_CATALOG_ENTRY_HEADER(normal);
    SO_KIT_CATALOG_ENTRY_HEADER(texture2Transform);
    SO_KIT_CATALOG_ENTRY_HEADER(textureCoordinate2);
    SO_KIT_CATALOG_ENTRY_HEADER(textureCoordinateFunction);
    SO_KIT_CATALOG_ENTRY_HEADER(texture);
    SO_KIT_CATALOG_ENTRY_HEADER(coordinate3);
    SO_KIT_CATALOG_ENTRY_HEADER(heightMap);
    SO_KIT_CATALOG_ENTRY_HEADER(terrain);
    SO_KIT_CATALOG_ENTRY_HEADER(childList);

public:
    static void initClass();
    SoTerrainKit();

    enum Algorithm { ROAM, CHUNKED_LOD, GEO_MIPMAP, GEOMETRY_CLIPMAP, BRUTE_FORCE, OTHER };

    SoSFEnum algorithm;     ///< ROAM
    SoSFNode alternateRep;  ///< what programs without SoTerrain draw

    using inherited::setPart;
    virtual void addWriteReference(SoOutput * out, SbBool isFromField = FALSE);
    virtual void write(SoWriteAction * action);

protected:
    virtual ~SoTerrainKit();
    virtual SbBool setPart(const int partNumber, SoNode * node);
    virtual SbBool readInstance(SoInput * in, unsigned short flags);
    virtual void copyContents(const SoFieldContainer * from, SbBool copyConnections);
    virtual void setDefaultOnNonWritingFields();
    virtual void notify(SoNotList * list);

private:
    SbBool isPartAllowed(int partNumber, const SoNode * node) const;
    void followAlgorithm();
    void followTerrain();

    SbBool isSettling;        ///< parts and algorithm are being set together
    SbBool isTerrainRefused;  ///< the terrain part that was read is of a wrong type
};

#endif
