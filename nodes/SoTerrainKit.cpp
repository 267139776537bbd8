/*!
  \class SoTerrainKit SoTerrainKit.h SoTerrain/SoTerrainKit.h
  \brief The SoTerrainKit class is a nodekit that holds a terrain with all that belongs to it: one node in a file is a terrain.

  \code
  #Inventor V2.1 ascii
  SoTerrainKit {
    algorithm CHUNKED_LOD
    heightMap SoHeightMap { filename "terrain.png" heightScale 0.0011 }
    texture Texture2 { filename "terrain_texture.jpg" }
  }
  \endcode

  Parts are read, set and asked for as those of Coin's own kits are: set("heightMap { filename terrain.png }"),
  getPart("terrain", TRUE), setPart("material", node). Those that are not given take no part in the scene.

  \verbatim
  CLASS SoTerrainKit
  -->"this"
        "callbackList"
  -->   "topSeparator"
  -->      "pickStyle"
  -->      "lightModel"
  -->      "environment"
  -->      "drawStyle"
  -->      "shapeHints"
  -->      "complexity"
  -->      "transform"
  -->      "materialBinding"
  -->      "material"
  -->      "color"
  -->      "normalBinding"
  -->      "normal"
  -->      "texture2Transform"
  -->      "textureCoordinate2"
  -->      "textureCoordinateFunction"
  -->      "texture"
  -->      "coordinate3"
  -->      "heightMap"
  -->      "terrain"
  -->      "childList"
  \endverbatim

  \verbatim
  CLASS SoTerrainKit
  PVT   "this",  SoTerrainKit  ---
        "callbackList",  SoNodeKitListPart [ SoCallback, SoEventCallback ]
  PVT   "topSeparator",  SoSeparator  ---
        "pickStyle",  SoPickStyle  ---
        "lightModel",  SoLightModel  ---
        "environment",  SoEnvironment  ---
        "drawStyle",  SoDrawStyle  ---
        "shapeHints",  SoShapeHints  ---
        "complexity",  SoComplexity  ---
        "transform",  SoTransform  ---
        "materialBinding",  SoMaterialBinding  ---
        "material",  SoMaterial  ---
        "color",  SoBaseColor or SoPackedColor  ---, (default type = SoBaseColor)
        "normalBinding",  SoNormalBinding  ---
        "normal",  SoNormal  ---
        "texture2Transform",  SoTexture2Transform  ---
        "textureCoordinate2",  SoTextureCoordinate2  ---
        "textureCoordinateFunction",  SoTextureCoordinateFunction  ---, (default type = SoTextureCoordinateDefault)
        "texture",  SoTexture or SoTerrainTexture  ---, (default type = SoTexture2)
        "coordinate3",  SoCoordinate3  ---
        "heightMap",  SoHeightMap  ---
        "terrain",  SoTerrainShape  ---, (default type = the class that algorithm names)
        "childList",  SoNodeKitListPart [ SoNode ]
  \endverbatim

  Heights are those of the part heightMap, or of coordinate3 where there is no heightMap. The nodes of childList come after the terrain, with
  its heights and its transform in the traversal state: what lies on the ground, as SoTerrainDrape does, has its place there.

  The fields that all terrain nodes have in common are those of the part:

  \code
  kit->set("terrain { pixelError 1 freeze TRUE }");
  SO_GET_PART(kit, "terrain", SoTerrainShape)->pixelError.connectFrom(&slider->value);
  \endcode

  In a file the part is written with its class, and algorithm is not needed:

  \code
  SoTerrainKit {
    heightMap SoHeightMap { filename "terrain.png" }
    terrain SoChunkedLoDTerrain { pixelError 1 tileSize 32 }
  }
  \endcode

  Programs without this library can read the kit when its file names the fields, and show alternateRep in its place. Coin writes these names
  itself; of a file written by hand:

  \code
  SoTerrainKit {
    fields [ SFNode heightMap, SFNode alternateRep ]
    heightMap SoHeightMap { fields [ SFString filename ] filename "terrain.png" }
    alternateRep Cube { }
  }
  \endcode

  <b>FILE FORMAT/DEFAULTS:</b>
  \code
    SoTerrainKit {
      callbackList NULL
      algorithm ROAM
      alternateRep NULL
      pickStyle NULL
      lightModel NULL
      environment NULL
      drawStyle NULL
      shapeHints NULL
      complexity NULL
      transform NULL
      materialBinding NULL
      material NULL
      color NULL
      normalBinding NULL
      normal NULL
      texture2Transform NULL
      textureCoordinate2 NULL
      textureCoordinateFunction NULL
      texture NULL
      coordinate3 NULL
      heightMap NULL
      terrain SoROAMTerrain { }
      childList NULL
    }
  \endcode

  \sa SoTerrainShape, SoHeightMap, SoTerrainTexture, SoTerrainDrape
*/

/*!
  \enum SoTerrainKit::Algorithm
  The class of the part terrain: ROAM is SoROAMTerrain, CHUNKED_LOD SoChunkedLoDTerrain, GEO_MIPMAP SoGeoMipmapTerrain, GEOMETRY_CLIPMAP
  SoGeometryClipmapTerrain, BRUTE_FORCE SoBruteForceTerrain, and OTHER any other SoTerrainShape.
*/
/*!
  \var SoSFEnum SoTerrainKit::algorithm
  Class of the part terrain. When it changes, a node of the new class takes the place of the part, with the same values and connections, in
  both directions, of the fields that all terrain nodes have in common, and with its name. Fields of one class only have their defaults in the
  new node.

  A part that is set stays: algorithm then takes the value of its class, OTHER where the enum has none (also for classes derived from those that
  it has), and so it does when a file gives both. Setting OTHER changes nothing. A connected algorithm is given what its connection brings.
*/
/*!
  \var SoSFNode SoTerrainKit::alternateRep
  What a program without this library shows in place of the kit. Not used by the kit itself. Default NULL.
*/

#include <SoTerrain/SoTerrainKit.h>

#include <array>
#include <string>

#include <Inventor/SbName.h>
#include <Inventor/SoOutput.h>
#include <Inventor/errors/SoDebugError.h>
#include <Inventor/fields/SoFieldData.h>
#include <Inventor/lists/SoFieldList.h>
#include <Inventor/misc/SoNotification.h>
#include <Inventor/nodekits/SoNodeKit.h>
#include <Inventor/nodekits/SoNodeKitListPart.h>
#include <Inventor/nodes/SoBaseColor.h>
#include <Inventor/nodes/SoPackedColor.h>
#include <Inventor/nodes/SoSeparator.h>
#include <Inventor/nodes/SoTexture2.h>
#include <Inventor/nodes/SoTextureCoordinateDefault.h>

#include <SoTerrain/SoBruteForceTerrain.h>
#include <SoTerrain/SoChunkedLoDTerrain.h>
#include <SoTerrain/SoGeoMipmapTerrain.h>
#include <SoTerrain/SoGeometryClipmapTerrain.h>
#include <SoTerrain/SoHeightMap.h>
#include <SoTerrain/SoROAMTerrain.h>
#include <SoTerrain/SoTerrainTexture.h>

#include "FieldsInUse.h"

SO_KIT_SOURCE(SoTerrainKit)

namespace {

/// By SoTerrainKit::Algorithm.
std::array<SoType, SoTerrainKit::OTHER> classes()
{
    return {SoROAMTerrain::getClassTypeId(), SoChunkedLoDTerrain::getClassTypeId(), SoGeoMipmapTerrain::getClassTypeId(),
            SoGeometryClipmapTerrain::getClassTypeId(), SoBruteForceTerrain::getClassTypeId()};
}

SoType classOf(int algorithm)
{
    return algorithm >= 0 && algorithm < SoTerrainKit::OTHER ? classes()[std::size_t(algorithm)] : SoType::badType();
}

int algorithmOf(SoType type)
{
    int algorithm = 0;
    while (algorithm < SoTerrainKit::OTHER && classOf(algorithm) != type) ++algorithm;
    return algorithm;
}

/// Value, flags and connections of a field go to another of the same type; fields that follow the one follow the other then.
void handOver(SoField & from, SoField & to)
{
    to.copyFrom(from);
    to.setDefault(from.isDefault());
    to.setIgnored(from.isIgnored());
    SoField * master = NULL;
    SoEngineOutput * output = NULL;
    if (from.getConnectedField(master))
        to.connectFrom(master);
    else if (from.getConnectedEngine(output))
        to.connectFrom(output);
    to.enableConnection(from.isConnectionEnabled());
    from.disconnect();
    SoFieldList followers;
    from.getForwardConnections(followers);
    for (int i = 0; i < followers.getLength(); ++i) {
        SoField * follower = followers[i];
        follower->appendConnection(&to);
        follower->disconnect(&from);
    }
}

void handOver(SoTerrainShape & from, SoTerrainShape & to)
{
    handOver(from.verticesPerRow, to.verticesPerRow);
    handOver(from.verticesPerColumn, to.verticesPerColumn);
    handOver(from.startIndex, to.startIndex);
    handOver(from.pixelError, to.pixelError);
    handOver(from.frustumCulling, to.frustumCulling);
    handOver(from.freeze, to.freeze);
    handOver(from.frozenFrustum, to.frozenFrustum);
    handOver(from.debugView, to.debugView);
    handOver(from.wireframeOverlay, to.wireframeOverlay);
    handOver(from.alternateRep, to.alternateRep);
    const SbName name = from.getName();
    if (name == SbName::empty()) return;
    from.setName(SbName::empty());
    to.setName(name);
}

/// Whether a node is as its class makes it, and a file need not say more than the class.
bool isPlain(const SoNode & node)
{
    if (node.getName() != SbName::empty()) return false;
    SoNode * fresh = static_cast<SoNode *>(node.getTypeId().createInstance());
    fresh->ref();
    const SoFieldData * fields = node.getFieldData();
    bool same = true;
    for (int i = 0; i < fields->getNumFields() && same; ++i) {
        SoField * field = fields->getField(&node, i);
        SoFieldList followers;
        same = !field->isConnected() && field->getForwardConnections(followers) == 0 && !field->isIgnored() &&
               (field->isDefault() || field->isSame(*fields->getField(fresh, i)));
    }
    fresh->unref();
    return same;
}

}  // namespace

void SoTerrainKit::initClass()
{
    if (getClassTypeId() != SoType::badType()) return;
    // Programs that have no nodekits of their own may not have initialised Coin's.
    SoNodeKit::init();
    SoROAMTerrain::initClass();
    SoChunkedLoDTerrain::initClass();
    SoGeoMipmapTerrain::initClass();
    SoGeometryClipmapTerrain::initClass();
    SoBruteForceTerrain::initClass();
    SO_KIT_INIT_CLASS(SoTerrainKit, SoBaseKit, "BaseKit");
}

SoTerrainKit::SoTerrainKit() : isSettling(TRUE), isTerrainRefused(FALSE)
{
    SO_KIT_CONSTRUCTOR(SoTerrainKit);
    SO_KIT_ADD_FIELD(algorithm, (ROAM));
    SO_KIT_ADD_FIELD(alternateRep, (NULL));
    SO_KIT_DEFINE_ENUM_VALUE(Algorithm, ROAM);
    SO_KIT_DEFINE_ENUM_VALUE(Algorithm, CHUNKED_LOD);
    SO_KIT_DEFINE_ENUM_VALUE(Algorithm, GEO_MIPMAP);
    SO_KIT_DEFINE_ENUM_VALUE(Algorithm, GEOMETRY_CLIPMAP);
    SO_KIT_DEFINE_ENUM_VALUE(Algorithm, BRUTE_FORCE);
    SO_KIT_DEFINE_ENUM_VALUE(Algorithm, OTHER);
    SO_KIT_SET_SF_ENUM_TYPE(algorithm, Algorithm);

    SO_KIT_ADD_CATALOG_ENTRY(topSeparator, SoSeparator, FALSE, this, "", FALSE);
    SO_KIT_ADD_CATALOG_ENTRY(pickStyle, SoPickStyle, TRUE, topSeparator, lightModel, TRUE);
    SO_KIT_ADD_CATALOG_ENTRY(lightModel, SoLightModel, TRUE, topSeparator, environment, TRUE);
    SO_KIT_ADD_CATALOG_ENTRY(environment, SoEnvironment, TRUE, topSeparator, drawStyle, TRUE);
    SO_KIT_ADD_CATALOG_ENTRY(drawStyle, SoDrawStyle, TRUE, topSeparator, shapeHints, TRUE);
    SO_KIT_ADD_CATALOG_ENTRY(shapeHints, SoShapeHints, TRUE, topSeparator, complexity, TRUE);
    SO_KIT_ADD_CATALOG_ENTRY(complexity, SoComplexity, TRUE, topSeparator, transform, TRUE);
    SO_KIT_ADD_CATALOG_ENTRY(transform, SoTransform, TRUE, topSeparator, materialBinding, TRUE);
    SO_KIT_ADD_CATALOG_ENTRY(materialBinding, SoMaterialBinding, TRUE, topSeparator, material, TRUE);
    SO_KIT_ADD_CATALOG_ENTRY(material, SoMaterial, TRUE, topSeparator, color, TRUE);
    SO_KIT_ADD_CATALOG_ABSTRACT_ENTRY(color, SoNode, SoBaseColor, TRUE, topSeparator, normalBinding, TRUE);
    SO_KIT_ADD_CATALOG_ENTRY(normalBinding, SoNormalBinding, TRUE, topSeparator, normal, TRUE);
    SO_KIT_ADD_CATALOG_ENTRY(normal, SoNormal, TRUE, topSeparator, texture2Transform, TRUE);
    SO_KIT_ADD_CATALOG_ENTRY(texture2Transform, SoTexture2Transform, TRUE, topSeparator, textureCoordinate2, TRUE);
    SO_KIT_ADD_CATALOG_ENTRY(textureCoordinate2, SoTextureCoordinate2, TRUE, topSeparator, textureCoordinateFunction, TRUE);
    SO_KIT_ADD_CATALOG_ABSTRACT_ENTRY(textureCoordinateFunction, SoTextureCoordinateFunction, SoTextureCoordinateDefault, TRUE, topSeparator,
                                      texture, TRUE);
    SO_KIT_ADD_CATALOG_ABSTRACT_ENTRY(texture, SoNode, SoTexture2, TRUE, topSeparator, coordinate3, TRUE);
    SO_KIT_ADD_CATALOG_ENTRY(coordinate3, SoCoordinate3, TRUE, topSeparator, heightMap, TRUE);
    SO_KIT_ADD_CATALOG_ENTRY(heightMap, SoHeightMap, TRUE, topSeparator, terrain, TRUE);
    SO_KIT_ADD_CATALOG_ABSTRACT_ENTRY(terrain, SoTerrainShape, SoROAMTerrain, FALSE, topSeparator, childList, TRUE);
    SO_KIT_ADD_CATALOG_LIST_ENTRY(childList, SoGroup, TRUE, topSeparator, "", SoNode, TRUE);
    SO_KIT_INIT_INSTANCE();
    this->isSettling = FALSE;
}

SoTerrainKit::~SoTerrainKit() {}

/// Coin says nothing of wrong types unless it was built for debugging; and two parts take what has no base class in common.
SbBool SoTerrainKit::isPartAllowed(int partNumber, const SoNode * node) const
{
    const SbName & part = this->getNodekitCatalog()->getName(partNumber);
    const SoType type = this->getNodekitCatalog()->getType(partNumber);
    std::string expected;
    if (part == "texture" && !node->isOfType(SoTexture::getClassTypeId()) && !node->isOfType(SoTerrainTexture::getClassTypeId()))
        expected = "a Texture or an SoTerrainTexture";
    else if (part == "color" && !node->isOfType(SoBaseColor::getClassTypeId()) && !node->isOfType(SoPackedColor::getClassTypeId()))
        expected = "a BaseColor or a PackedColor";
    else if (!node->isOfType(type))
        expected = std::string("a node of class ") + type.getName().getString();
    if (expected.empty()) return TRUE;
    SoDebugError::postWarning("SoTerrainKit", "part %s: expected %s, found one of class %s", part.getString(), expected.c_str(),
                              node->getTypeId().getName().getString());
    return FALSE;
}

SbBool SoTerrainKit::setPart(const int partNumber, SoNode * node)
{
    const bool isTerrain = this->getNodekitCatalog()->getName(partNumber) == "terrain";
    if (node && !isPartAllowed(partNumber, node)) {
        this->isTerrainRefused = this->isTerrainRefused || isTerrain;
        return FALSE;
    }
    if (!isTerrain) return inherited::setPart(partNumber, node);
    const SoType named = classOf(this->algorithm.getValue());
    if (!this->terrain.getValue() && node && !this->isSettling && named != SoType::badType() && named != node->getTypeId()) {
        // Coin makes the part before it sets another, so it is a part that is asked for, of the default type.
        node->ref();
        node->unref();
        node = static_cast<SoNode *>(named.createInstance());
    }
    if (!inherited::setPart(partNumber, node)) return FALSE;
    if (!this->isSettling) followTerrain();
    return TRUE;
}

void SoTerrainKit::followAlgorithm()
{
    const int wanted = this->algorithm.getValue();
    const SoType type = classOf(wanted);
    if (type == SoType::badType()) {
        if (wanted != OTHER)
            SoDebugError::postWarning("SoTerrainKit", "algorithm: expected a value of SoTerrainKit::Algorithm, found %d; the terrain stays", wanted);
        return;
    }
    SoTerrainShape * old = static_cast<SoTerrainShape *>(this->terrain.getValue());
    if (old && old->getTypeId() == type) return;
    SoTerrainShape * fresh = static_cast<SoTerrainShape *>(type.createInstance());
    fresh->ref();
    if (old) {
        old->ref();
        handOver(*old, *fresh);
    }
    const SbBool wasDefault = this->terrain.isDefault();
    const SbBool wasSettling = this->isSettling;
    this->isSettling = TRUE;
    this->setPart(SbName("terrain"), fresh);
    this->isSettling = wasSettling;
    this->terrain.setDefault(wasDefault);
    if (old) old->unref();
    fresh->unref();
}

void SoTerrainKit::followTerrain()
{
    const SoNode * node = this->terrain.getValue();
    if (!node) return;
    const int found = algorithmOf(node->getTypeId());
    if (this->algorithm.getValue() == found) return;
    const SbBool wasSettling = this->isSettling;
    this->isSettling = TRUE;
    this->algorithm = found;
    this->isSettling = wasSettling;
}

void SoTerrainKit::notify(SoNotList * list)
{
    if (list->getLastField() == &this->algorithm && !this->isSettling) followAlgorithm();
    inherited::notify(list);
}

SbBool SoTerrainKit::readInstance(SoInput * in, unsigned short flags)
{
    this->isSettling = TRUE;
    this->isTerrainRefused = FALSE;
    const SbBool ok = inherited::readInstance(in, flags);
    if (this->isTerrainRefused) this->terrain.setDefault(TRUE);
    if (ok && this->terrain.isDefault())
        followAlgorithm();
    else if (ok)
        followTerrain();
    this->isSettling = FALSE;
    return ok;
}

void SoTerrainKit::copyContents(const SoFieldContainer * from, SbBool copyConnections)
{
    this->isSettling = TRUE;
    inherited::copyContents(from, copyConnections);
    this->isSettling = FALSE;
}

void SoTerrainKit::addWriteReference(SoOutput * out, SbBool isFromField)
{
    if (!out->isBinary()) {
        inherited::addWriteReference(out, isFromField);
        return;
    }
    // Kits collect what they write while they count references. Here it is known without, and as if the class were Coin's own only
    // what write() writes is counted.
    setDefaultOnNonWritingFields();
    this->isBuiltIn = TRUE;
    SoNode::addWriteReference(out, isFromField);
    this->isBuiltIn = FALSE;
}

void SoTerrainKit::write(SoWriteAction * action)
{
    if (!writeFieldsInUse(action, this)) inherited::write(action);
}

void SoTerrainKit::setDefaultOnNonWritingFields()
{
    // What algorithm says need not be said again; but a default part whose fields have changed must be.
    const SoNode * node = this->terrain.getValue();
    constexpr int kOwnReferences = 2;
    if (node) {
        const bool isShared = node->getRefCount() > kOwnReferences;
        const bool isNamed = algorithmOf(node->getTypeId()) != OTHER && algorithmOf(node->getTypeId()) == this->algorithm.getValue();
        if (!isPlain(*node) || !isNamed)
            this->terrain.setDefault(FALSE);
        else if (!isShared)
            this->terrain.setDefault(TRUE);
    }
    this->topSeparator.setDefault(TRUE);
    inherited::setDefaultOnNonWritingFields();
}
