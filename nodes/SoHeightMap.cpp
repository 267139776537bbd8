/*!
  \class SoHeightMap SoHeightMap.h SoTerrain/SoHeightMap.h
  \brief The SoHeightMap class reads heights for the terrain nodes that follow it.

  The heights come from an image (any format, channel type and bit depth that OpenImageIO reads; values are taken as they are, 65535
  stays 65535), a raster that GDAL reads (with its spacing, origin and no-data value), or a headerless ".raw" file. Terrain nodes
  prefer a height map to the coordinates of the state, and need no normals and no texture coordinates with it: the texture spans the
  terrain.

  Rows of an image run from north to south: its top row lies at the largest y, as the top of a texture does. Sample (column, row from
  the south) stands at

  \code
  x = origin.x + column * spacing.x
  y = origin.y + row * spacing.y
  z = heightOffset + heightScale * sample
  \endcode

  A relative file name is looked for as textures are: in the directory of the .iv file that names it, and in those of
  SoInput::addDirectoryLast(). Samples that are not finite, or equal to noData or to the file's own no-data value, are holes.

  A map of more than 2^26 samples (8192 x 8192) is decoded into scratch space on disk instead of memory, 4 bytes a sample: an unnamed
  file in the directory that the environment variable TMPDIR names (/tmp without it), which goes when nobody needs the map any more.
  Then memory holds only what is looked at. Too little space there is an error as an unreadable file is.

  \code
  #Inventor V2.1 ascii
  Separator {
    Texture2 { filename "terrain_texture.jpg" }
    SoHeightMap { filename "terrain.png" spacing 10 10 heightScale 0.05 }
    SoROAMTerrain { pixelError 2 }
  }
  \endcode

  <b>FILE FORMAT/DEFAULTS:</b>
  \code
    SoHeightMap {
      filename ""
      spacing 0 0
      heightScale 1
      heightOffset 0
      origin 0 0
      channel -1
      rawSize 0 0
      rawType UINT8
      noData NaN
    }
  \endcode

  \sa SoROAMTerrain, SoBruteForceTerrain
*/

/*!
  \var SoSFString SoHeightMap::filename
  Image, raster or raw file. Empty, the default: no height map.
*/
/*!
  \var SoSFVec2f SoHeightMap::spacing
  Distance between columns and between rows. (0, 0), the default, is what the file says, or (1, 1).
*/
/*!
  \var SoSFFloat SoHeightMap::heightScale
  Factor on the samples: height = heightOffset + heightScale * sample. Default 1.
*/
/*!
  \var SoSFFloat SoHeightMap::heightOffset
  Height of a sample of 0. Default 0.
*/
/*!
  \var SoSFVec2f SoHeightMap::origin
  Position of the south-west sample, (0, 0) by default. The origin of a georeferenced file is not used unless it is given here: local coordinates are
  single precision, and scenes do well to start near zero.
*/
/*!
  \var SoSFInt32 SoHeightMap::channel
  Channel of the file to take. -1, the default, is the only one: an image of three or more channels is an error then.
*/
/*!
  \var SoSFVec2i32 SoHeightMap::rawSize
  Columns and rows of a headerless file. (0, 0), the default, is a square of the size that the file's length gives.
*/
/*!
  \var SoSFEnum SoHeightMap::rawType
  Type of the samples of a headerless file, a RawType. Default UINT8.
*/
/*!
  \enum SoHeightMap::RawType
  Samples of a headerless file: UINT8 of one byte; UINT16_LITTLE_ENDIAN of two bytes, the lower one first; UINT16_BIG_ENDIAN, the higher one first.
*/
/*!
  \var SoSFFloat SoHeightMap::noData
  Sample value, before scaling, that marks a hole. NaN, the default, marks none.
*/

#include <SoTerrain/SoHeightMap.h>

#include <cmath>
#include <limits>

#include <Inventor/SoInput.h>
#include <Inventor/actions/SoCallbackAction.h>
#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/actions/SoGetBoundingBoxAction.h>
#include <Inventor/actions/SoGetPrimitiveCountAction.h>
#include <Inventor/actions/SoPickAction.h>
#include <Inventor/errors/SoDebugError.h>
#include <Inventor/misc/SoState.h>

#include <SoTerrain/SoHeightMapElement.h>
#include <SoTerrain/SoTerrain.h>

#include "FindFile.h"
#include "height/HeightSource.h"

class SoHeightMap::Private {
public:
    std::shared_ptr<const terrain::HeightSource> source;
    bool isStale = true;       ///< a field changed since the file was read
    bool hasFailed = false;    ///< the file could not be read
    SbString path;             ///< filename as it was found when the node was read; empty: look again
};

SO_NODE_SOURCE(SoHeightMap);

void SoHeightMap::initClass()
{
    if (getClassTypeId() != SoType::badType()) return;
    SoHeightMapElement::initClass();
    SO_NODE_INIT_CLASS(SoHeightMap, SoNode, "Node");
    SO_ENABLE(SoGLRenderAction, SoHeightMapElement);
    SO_ENABLE(SoGetBoundingBoxAction, SoHeightMapElement);
    SO_ENABLE(SoPickAction, SoHeightMapElement);
    SO_ENABLE(SoCallbackAction, SoHeightMapElement);
    SO_ENABLE(SoGetPrimitiveCountAction, SoHeightMapElement);
}

SoHeightMap::SoHeightMap() : pimpl(new Private)
{
    SO_NODE_CONSTRUCTOR(SoHeightMap);
    SO_NODE_ADD_FIELD(filename, (""));
    SO_NODE_ADD_FIELD(spacing, (0.0f, 0.0f));
    SO_NODE_ADD_FIELD(heightScale, (1.0f));
    SO_NODE_ADD_FIELD(heightOffset, (0.0f));
    SO_NODE_ADD_FIELD(origin, (0.0f, 0.0f));
    SO_NODE_ADD_FIELD(channel, (-1));
    SO_NODE_ADD_FIELD(rawSize, (0, 0));
    SO_NODE_ADD_FIELD(rawType, (UINT8));
    SO_NODE_ADD_FIELD(noData, (std::numeric_limits<float>::quiet_NaN()));
    SO_NODE_DEFINE_ENUM_VALUE(RawType, UINT8);
    SO_NODE_DEFINE_ENUM_VALUE(RawType, UINT16_LITTLE_ENDIAN);
    SO_NODE_DEFINE_ENUM_VALUE(RawType, UINT16_BIG_ENDIAN);
    SO_NODE_SET_SF_ENUM_TYPE(rawType, RawType);
}

SoHeightMap::~SoHeightMap() {}

SbBool SoHeightMap::readInstance(SoInput * in, unsigned short flags)
{
    const SbBool ok = inherited::readInstance(in, flags);
    // The directories of the file being read are known only now.
    if (ok && this->filename.getValue().getLength() > 0) pimpl->path = findFile(this->filename.getValue());
    return ok;
}

void SoHeightMap::copyContents(const SoFieldContainer * from, SbBool copyConnections)
{
    inherited::copyContents(from, copyConnections);
    // A copy has the same file and need not read it again.
    const SoHeightMap * other = static_cast<const SoHeightMap *>(from);
    pimpl->path = other->pimpl->path;
    pimpl->source = other->pimpl->source;
    pimpl->isStale = other->pimpl->isStale;
    pimpl->hasFailed = other->pimpl->hasFailed;
}

void SoHeightMap::notify(SoNotList * list)
{
    pimpl->isStale = true;
    if (list->getLastField() == &this->filename) pimpl->path = "";
    // Coin can't read NaN from a file, and need not: it is the default.
    if (list->getLastField() == &this->noData && std::isnan(this->noData.getValue())) this->noData.setDefault(TRUE);
    inherited::notify(list);
}

void SoHeightMap::load()
{
    pimpl->isStale = false;
    pimpl->hasFailed = false;
    if (this->filename.getValue().getLength() == 0) {
        pimpl->source.reset();
        return;
    }
    if (pimpl->path.getLength() == 0) pimpl->path = findFile(this->filename.getValue());
    terrain::HeightFileOptions options;
    options.channel = this->channel.getValue();
    const SbVec2i32 size = this->rawSize.getValue();
    options.rawSize = {size[0], size[1]};
    options.rawType = terrain::RawType(this->rawType.getValue());
    const SbVec2f step = this->spacing.getValue(), start = this->origin.getValue();
    if (step != SbVec2f(0.0f, 0.0f)) options.spacing = glm::dvec2(step[0], step[1]);
    options.origin = glm::dvec2(start[0], start[1]);
    options.heightScale = this->heightScale.getValue();
    options.heightOffset = this->heightOffset.getValue();
    if (!std::isnan(this->noData.getValue())) options.noData = this->noData.getValue();
    auto source = terrain::openHeightFile(pimpl->path.getString(), options);
    pimpl->hasFailed = !source;
    if (source)
        pimpl->source = source.value();
    else
        // The last good heights stay on screen.
        SoDebugError::postWarning("SoHeightMap", "%s", source.error().message().c_str());
}

SbBool SoHeightMap::isLoaded()
{
    if (pimpl->isStale) load();
    return pimpl->source && !pimpl->hasFailed;
}

void SoHeightMap::doAction(SoAction * action)
{
    SoState * state = action->getState();
    if (!state->isElementEnabled(SoHeightMapElement::getClassStackIndex())) return;
    if (pimpl->isStale) load();
    SoHeightMapElement::set(state, this, pimpl->source.get(), pimpl->hasFailed);
}

void SoHeightMap::GLRender(SoGLRenderAction * action)
{
    SoHeightMap::doAction(action);
}

void SoHeightMap::callback(SoCallbackAction * action)
{
    SoHeightMap::doAction(action);
}

void SoHeightMap::pick(SoPickAction * action)
{
    SoHeightMap::doAction(action);
}

void SoHeightMap::getBoundingBox(SoGetBoundingBoxAction * action)
{
    SoHeightMap::doAction(action);
}

void SoHeightMap::getPrimitiveCount(SoGetPrimitiveCountAction * action)
{
    SoHeightMap::doAction(action);
}
