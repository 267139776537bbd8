/*!
  \class SoHeightMap SoHeightMap.h SoTerrain/SoHeightMap.h
  \brief The SoHeightMap class reads heights for the terrain nodes that follow it, and lets a program change them.

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

  <b>Editing.</b> A program may change heights while they are drawn: setHeights() replaces those of a rectangle, also in a map of its own making.
  What depends on these samples alone is brought up to date, in all nodes that draw the map: their meshes keep their refinement and
  pixelError. Nodes that are frozen show edits when they no longer are.

  \code
  SoHeightMap * map = new SoHeightMap;
  std::vector<float> heights(513 * 513, 0.0f);
  map->setHeights(513, 513, heights.data());           // a plain
  std::vector<float> brush(33 * 33, 5.0f);
  map->setHeights(100, 200, 33, 33, brush.data());     // a plateau on it
  \endcode

  Edits are in memory only: SoWriteAction writes the fields, hence the file's name and not what was edited, and of a map of the program's
  making nothing; use getHeights() to keep them. A change of spacing or origin moves the ground as it is, edits included, and one of heightScale or
  heightOffset scales it as it is. A change of filename, channel, rawSize, rawType or noData, and touch(), read the file anew, and edits are
  lost; so does another heightScale after 0, and where heights without edits have been scaled so often, or lie so far from 0, that they are rounded. Without a
  filename all of these do nothing. A filename replaces a map of the program's making.

  A copy of the node has the same map, and shares its memory until one of the two is edited or moved.

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
  Image, raster or raw file. Empty, the default: no height map but what setHeights() makes.
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
#include <optional>
#include <string>

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

#include "FieldsInUse.h"
#include "FindFile.h"
#include "HeightMapReading.h"
#include "height/HeightScale.h"
#include "height/MapSource.h"

namespace {

// Far below what a pixel shows: what rescaling may lose, in parts of the range of heights.
constexpr double kMostLost = 0x1p-17;

/// A map with all the nodes that have it: copies of one another.
struct SharedMap {
    std::shared_ptr<terrain::MapSource> source;
    glm::dvec2 ownSpacing{1.0, 1.0};  ///< of the file
};

std::string text(long long number)
{
    return std::to_string(number);
}

void warn(const char * function, const terrain::Error & error)
{
    SoDebugError::postWarning(function, "%s", error.message().c_str());
}

bool isSame(float a, float b)
{
    return a == b || (std::isnan(a) && std::isnan(b));
}

}  // namespace

class SoHeightMap::Private {
public:
    /// What the samples of a file depend on, beside its contents.
    struct Reading {
        int channel = -1;
        SbVec2i32 rawSize;
        int rawType = 0;
        float noData = 0.0f;
        terrain::HeightScale scale;
        bool hasSameSamples(const Reading & other) const
        {
            return channel == other.channel && rawSize == other.rawSize && rawType == other.rawType && isSame(noData, other.noData);
        }
    };

    struct Rect {
        glm::ivec2 low, size;
    };

    /// The map for this node alone: a copy where others have it too.
    terrain::Result<terrain::MapSource *> ownSource();
    /// Whether the map has the heights of another scale now, without its file.
    bool rescale(const terrain::HeightScale & to);
    std::optional<terrain::Error> whyNot(const Rect & rect, const void * heights) const;
    /// The given map in the scale of the reading; null where there is none, or not without rounding.
    std::shared_ptr<terrain::MapSource> takeGiven();

    std::shared_ptr<const terrain::HeightSource> given;  ///< the file's samples without a scale, for the next reading
    std::shared_ptr<SharedMap> map;
    Reading reading;           ///< of the map's file
    bool isChanged = true;     ///< a field changed since they were last looked at
    bool isStale = true;       ///< the file must be read
    bool isFromFile = false;   ///< the map is
    bool isEdited = false;     ///< and is no longer what the file says
    double lost = 0.0;         ///< by rescaling, at most, in parts of the range of heights
    bool hasFailed = false;    ///< the file could not be read
    bool isEditing = false;
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

void SoHeightMap::write(SoWriteAction * action)
{
    if (!writeFieldsInUse(action, this)) inherited::write(action);
}

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
    const bool isEditing = pimpl->isEditing;
    *pimpl = *other->pimpl;
    pimpl->isEditing = isEditing;
}

void SoHeightMap::notify(SoNotList * list)
{
    const SoField * field = list->getLastField();
    if (!pimpl->isEditing) pimpl->isChanged = true;
    if (field == &this->filename) pimpl->path = "";
    // The file itself may have changed.
    if (!pimpl->isEditing && (field == &this->filename || !field)) pimpl->isStale = true;
    // Coin can't read NaN from a file, and need not: it is the default.
    if (field == &this->noData && std::isnan(this->noData.getValue())) this->noData.setDefault(TRUE);
    inherited::notify(list);
}

/// Reads the file where the samples depend on a field that has changed, and moves them where others have.
void SoHeightMap::bringUpToDate()
{
    if (!pimpl->isChanged) return;
    pimpl->isChanged = false;
    if (this->filename.getValue().getLength() == 0) {
        if (pimpl->isFromFile) pimpl->map.reset();
        pimpl->isStale = pimpl->isFromFile = pimpl->hasFailed = false;
    } else {
        const Private::Reading reading{this->channel.getValue(), this->rawSize.getValue(), this->rawType.getValue(), this->noData.getValue(),
                                       {this->heightScale.getValue(), this->heightOffset.getValue()}};
        const bool isKept = !pimpl->isStale && reading.hasSameSamples(pimpl->reading) && pimpl->rescale(reading.scale);
        pimpl->reading = reading;
        if (!isKept) load();
    }
    if (!pimpl->map) return;
    const SbVec2f step = this->spacing.getValue(), start = this->origin.getValue();
    const glm::dvec2 spacing = step == SbVec2f(0.0f, 0.0f) ? pimpl->map->ownSpacing : glm::dvec2(step[0], step[1]);
    const glm::dvec2 origin(start[0], start[1]);
    const terrain::HeightMap & map = *pimpl->map->source->map();
    if (map.spacing == spacing && map.origin == origin) return;
    const auto source = pimpl->ownSource();
    if (source)
        source.value()->place(origin, spacing);
    else
        warn("SoHeightMap", source.error());
}

void SoHeightMap::load()
{
    pimpl->isStale = false;
    pimpl->hasFailed = false;
    std::shared_ptr<terrain::MapSource> source = pimpl->takeGiven();
    if (!source) {
        const HeightMapReading::File file = HeightMapReading::file(this);
        terrain::HeightFileOptions options = file.options;
        options.heightScale = pimpl->reading.scale.scale;
        options.heightOffset = pimpl->reading.scale.offset;
        auto map = terrain::readHeightFile(file.path, options);
        pimpl->hasFailed = !map;
        if (!map) {
            // The last good heights stay on screen.
            warn("SoHeightMap", map.error());
            return;
        }
        source = std::make_shared<terrain::MapSource>(std::move(map).value());
    }
    const terrain::HeightMap & map = *source->map();
    const glm::dvec2 spacing = map.spacing;
    const SbVec2f step = this->spacing.getValue(), start = this->origin.getValue();
    source->place(glm::dvec2(start[0], start[1]), step == SbVec2f(0.0f, 0.0f) ? spacing : glm::dvec2(step[0], step[1]));
    pimpl->map = std::make_shared<SharedMap>(SharedMap{std::move(source), spacing});
    pimpl->isFromFile = true;
    pimpl->isEdited = false;
    pimpl->lost = 0.0;
}

HeightMapReading::File HeightMapReading::file(SoHeightMap * map)
{
    SoHeightMap::Private & own = *map->pimpl;
    File file;
    if (map->filename.getValue().getLength() == 0) return file;
    if (own.path.getLength() == 0) own.path = findFile(map->filename.getValue());
    file.path = own.path.getString();
    file.options.channel = map->channel.getValue();
    file.options.rawSize = {map->rawSize.getValue()[0], map->rawSize.getValue()[1]};
    file.options.rawType = terrain::RawType(map->rawType.getValue());
    if (!std::isnan(map->noData.getValue())) file.options.noData = map->noData.getValue();
    return file;
}

void HeightMapReading::give(SoHeightMap * map, std::shared_ptr<const terrain::HeightSource> source)
{
    map->pimpl->given = std::move(source);
}

std::shared_ptr<terrain::MapSource> SoHeightMap::Private::takeGiven()
{
    const std::shared_ptr<const terrain::HeightSource> source = std::move(given);
    given.reset();
    const terrain::MapSource * unscaled = source ? source->editable() : nullptr;
    if (!unscaled) return nullptr;
    const terrain::HeightRange range(*unscaled->map());
    const terrain::HeightScale none;
    if (!none.leadsTo(reading.scale, range) || range.rounding() > kMostLost) return nullptr;
    auto scaled = terrain::rescaled(*unscaled, none, reading.scale);
    return scaled ? std::move(scaled).value() : nullptr;
}

bool SoHeightMap::Private::rescale(const terrain::HeightScale & to)
{
    const terrain::HeightScale & from = reading.scale;
    if (isSame(from.scale, to.scale) && isSame(from.offset, to.offset)) return true;
    if (!map || hasFailed) return false;
    const terrain::HeightRange range(*map->source->map());
    if (!from.leadsTo(to, range)) return false;
    // Where the file is not all there is, edits count for more.
    lost += range.rounding();
    if (!isEdited && lost > kMostLost) return false;
    auto scaled = terrain::rescaled(*map->source, from, to);
    if (!scaled) return false;
    map = std::make_shared<SharedMap>(SharedMap{std::move(scaled).value(), map->ownSpacing});
    return true;
}

terrain::Result<terrain::MapSource *> SoHeightMap::Private::ownSource()
{
    if (map.use_count() > 1) {
        auto copy = map->source->copy();
        if (!copy) return copy.error();
        map = std::make_shared<SharedMap>(SharedMap{std::move(copy).value(), map->ownSpacing});
    }
    return map->source.get();
}

std::optional<terrain::Error> SoHeightMap::Private::whyNot(const Rect & rect, const void * heights) const
{
    if (!map) return terrain::Error{"heights", "a map, of a file or of setHeights(columns, rows, heights)", "none"};
    const terrain::HeightMap & whole = *map->source->map();
    const std::int64_t right = std::int64_t(rect.low.x) + rect.size.x, top = std::int64_t(rect.low.y) + rect.size.y;
    if (rect.low.x < 0 || rect.low.y < 0 || rect.size.x < 1 || rect.size.y < 1 || right > whole.columns || top > whole.rows)
        return terrain::Error{"heights", "a rectangle of samples in a map of " + text(whole.columns) + " x " + text(whole.rows),
                              text(rect.size.x) + " x " + text(rect.size.y) + " from column " + text(rect.low.x) + ", row " + text(rect.low.y)};
    if (!heights) return terrain::Error{"heights", text(std::int64_t(rect.size.x) * rect.size.y) + " floats", "NULL"};
    return std::nullopt;
}

SbBool SoHeightMap::getSize(int & columns, int & rows)
{
    bringUpToDate();
    if (!pimpl->map) return FALSE;
    columns = pimpl->map->source->map()->columns;
    rows = pimpl->map->source->map()->rows;
    return TRUE;
}

SbBool SoHeightMap::setHeights(int column, int row, int columns, int rows, const float * heights)
{
    bringUpToDate();
    if (const auto problem = pimpl->whyNot({{column, row}, {columns, rows}}, heights)) {
        warn("SoHeightMap::setHeights", *problem);
        return FALSE;
    }
    const auto source = pimpl->ownSource();
    if (!source) {
        warn("SoHeightMap::setHeights", source.error());
        return FALSE;
    }
    source.value()->setHeights({{column, row}, {column + columns - 1, row + rows - 1}}, heights);
    pimpl->isEdited = true;
    tellOfEdit();
    return TRUE;
}

SbBool SoHeightMap::setHeights(int columns, int rows, const float * heights)
{
    bringUpToDate();
    const auto refuse = [](const std::string & expected, const std::string & found) {
        warn("SoHeightMap::setHeights", {"map", expected, found});
        return FALSE;
    };
    if (this->filename.getValue().getLength() > 0) return refuse("no filename", this->filename.getValue().getString());
    if (columns < 2 || rows < 2) return refuse("at least 2 x 2 samples", text(columns) + " x " + text(rows));
    if (!heights) return refuse(text(std::int64_t(columns) * rows) + " floats", "NULL");
    terrain::HeightMap map;
    map.columns = columns;
    map.rows = rows;
    map.heights.assign(std::size_t(columns) * std::size_t(rows), 0.0f);
    const float * height = heights;
    for (float & sample : map.heights) sample = std::isfinite(*height) ? *height++ : (++height, std::numeric_limits<float>::quiet_NaN());
    const SbVec2f step = this->spacing.getValue(), start = this->origin.getValue();
    if (step != SbVec2f(0.0f, 0.0f)) map.spacing = glm::dvec2(step[0], step[1]);
    map.origin = glm::dvec2(start[0], start[1]);
    pimpl->map = std::make_shared<SharedMap>(SharedMap{std::make_shared<terrain::MapSource>(std::move(map)), glm::dvec2(1.0, 1.0)});
    pimpl->isFromFile = false;
    tellOfEdit();
    return TRUE;
}

SbBool SoHeightMap::getHeights(int column, int row, int columns, int rows, float * heights)
{
    bringUpToDate();
    if (const auto problem = pimpl->whyNot({{column, row}, {columns, rows}}, heights)) {
        warn("SoHeightMap::getHeights", *problem);
        return FALSE;
    }
    const terrain::HeightMap & map = *pimpl->map->source->map();
    for (int y = row; y < row + rows; ++y)
        for (int x = column; x < column + columns; ++x) *heights++ = map.at(x, y);
    return TRUE;
}

/// As a field that changes does.
void SoHeightMap::tellOfEdit()
{
    pimpl->isEditing = true;
    this->touch();
    pimpl->isEditing = false;
}

SbBool SoHeightMap::isLoaded()
{
    bringUpToDate();
    return pimpl->map && !pimpl->hasFailed;
}

void SoHeightMap::doAction(SoAction * action)
{
    SoState * state = action->getState();
    if (!state->isElementEnabled(SoHeightMapElement::getClassStackIndex())) return;
    bringUpToDate();
    SoHeightMapElement::set(state, this, pimpl->map ? pimpl->map->source.get() : NULL, pimpl->hasFailed);
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
