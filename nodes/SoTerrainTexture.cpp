/*!
  \class SoTerrainTexture SoTerrainTexture.h SoTerrain/SoTerrainTexture.h
  \brief The SoTerrainTexture class gives the terrain nodes that follow it a colour texture of any size.

  The file is any image that OpenImageIO reads. Best it is tiled and has MIP levels, as maketx or oiiotool write it:

  \code
  oiiotool colours.jpg -otex colours.tx
  \endcode

  Then no more of it is read than is looked at. The levels of other files are made on reading, for which all of it is read once.

  Of each level the part around the viewer is on the GPU, in a clipmap (Tanner, Migdal, Jones: "The Clipmap: A Virtual Mipmap", 1998):
  clipSize^2 texels of 4 bytes for each level that is larger than that, whatever the size of the image. When the viewer moves, only what
  comes into those parts is loaded, from coarse to fine and at most updateBudget texels in a frame. So after a jump the picture is less
  sharp for some frames, but never wrong: SoTerrainStatistics::converged is FALSE then, and the terrain asks for another frame.
  The first frame of a view is complete.

  The texture modulates the lit colour of the terrain. It takes the place of the SoTexture2 before it on texture unit 0, as an SoTexture2 after
  it takes its place; without texture coordinates of the state it spans the terrain, its top row at the largest t. Coordinates outside of [0, 1]
  have the colour of the border; transparency of the image is not used. Where a shader program of the scene is active the terrain has its
  own colour alone, and textures of further units are not drawn. It takes OpenGL 3.0. All terrain nodes draw it, other shapes do not.

  A relative file name is looked for as textures are: in the directory of the .iv file that names it, and in those of
  SoInput::addDirectoryLast(). Without the file, or when it turns out to be damaged, a warning says so and the terrain is drawn without texture.

  \code
  #Inventor V2.1 ascii
  Separator {
    SoTerrainTexture { filename "colours.tx" }
    SoHeightMap { filename "terrain.png" spacing 10 10 heightScale 0.05 }
    SoROAMTerrain { pixelError 2 }
  }
  \endcode

  <b>FILE FORMAT/DEFAULTS:</b>
  \code
    SoTerrainTexture {
      filename ""
      clipSize 1024
      updateBudget 262144
      memoryBudget 256
    }
  \endcode

  \sa SoTerrainShape, SoHeightMap
*/

/*!
  \var SoSFString SoTerrainTexture::filename
  Image file. Empty, the default: no texture.
*/
/*!
  \var SoSFInt32 SoTerrainTexture::clipSize
  Texels along a side of the part of each level that is on the GPU, a power of two from 64 to 8192. The picture is as sharp as the screen all
  over when it is about as large as the longer side of the window. Default 1024.
*/
/*!
  \var SoSFInt32 SoTerrainTexture::updateBudget
  Most texels to load in one frame after the first, but at least a line of clipSize texels. 0 is no limit. Default 262144.
*/
/*!
  \var SoSFInt32 SoTerrainTexture::memoryBudget
  Megabytes of main memory for tiles of the file, at least 1. Default 256.
*/

#include <SoTerrain/SoTerrainTexture.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include <Inventor/SoInput.h>
#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/elements/SoGLMultiTextureEnabledElement.h>
#include <Inventor/elements/SoGLMultiTextureImageElement.h>
#include <Inventor/elements/SoTextureOverrideElement.h>
#include <Inventor/elements/SoTextureUnitElement.h>
#include <Inventor/errors/SoDebugError.h>
#include <Inventor/misc/SoState.h>

#include <SoTerrain/SoTerrainTextureElement.h>

#include "FindFile.h"
#include "height/TiledImage.h"

class SoTerrainTexture::Private {
public:
    explicit Private(SoTerrainTexture * masterArg) : master(masterArg) {}

    void load();
    void warnOnce(const std::string & text);
    int validClipSize();
    int atLeast(const SoSFInt32 & field, const char * name, int least, int fallback);

    SoTerrainTexture * master;
    std::shared_ptr<const terrain::TiledImage> image;
    bool isStale = true;  ///< the file to open, or how, has changed
    SbString path;        ///< filename as it was found when the node was read; empty: look again
    std::set<std::string> warned;
};

SO_NODE_SOURCE(SoTerrainTexture);

void SoTerrainTexture::initClass()
{
    if (getClassTypeId() != SoType::badType()) return;
    SoTerrainTextureElement::initClass();
    SO_NODE_INIT_CLASS(SoTerrainTexture, SoNode, "Node");
    SO_ENABLE(SoGLRenderAction, SoTerrainTextureElement);
}

SoTerrainTexture::SoTerrainTexture() : pimpl(new Private(this))
{
    SO_NODE_CONSTRUCTOR(SoTerrainTexture);
    SO_NODE_ADD_FIELD(filename, (""));
    SO_NODE_ADD_FIELD(clipSize, (1024));
    SO_NODE_ADD_FIELD(updateBudget, (262144));
    SO_NODE_ADD_FIELD(memoryBudget, (256));
}

SoTerrainTexture::~SoTerrainTexture() {}

SbBool SoTerrainTexture::readInstance(SoInput * in, unsigned short flags)
{
    const SbBool ok = inherited::readInstance(in, flags);
    // The directories of the file being read are known only now.
    if (ok && this->filename.getValue().getLength() > 0) pimpl->path = findFile(this->filename.getValue());
    return ok;
}

void SoTerrainTexture::copyContents(const SoFieldContainer * from, SbBool copyConnections)
{
    inherited::copyContents(from, copyConnections);
    // A copy has the same file and shares its tiles.
    const SoTerrainTexture * other = static_cast<const SoTerrainTexture *>(from);
    pimpl->path = other->pimpl->path;
    pimpl->image = other->pimpl->image;
    pimpl->isStale = other->pimpl->isStale;
}

void SoTerrainTexture::notify(SoNotList * list)
{
    const SoField * field = list->getLastField();
    if (field == &this->filename) pimpl->path = "";
    if (field == &this->filename || field == &this->memoryBudget) pimpl->isStale = true;
    if (field) pimpl->warned.clear();
    inherited::notify(list);
}

void SoTerrainTexture::Private::warnOnce(const std::string & text)
{
    if (warned.insert(text).second) SoDebugError::postWarning("SoTerrainTexture", "%s", text.c_str());
}

int SoTerrainTexture::Private::validClipSize()
{
    constexpr int kLeast = 64, kMost = 8192;
    const int wanted = master->clipSize.getValue();
    const int valid = 1 << std::lround(std::log2(double(std::clamp(wanted, kLeast, kMost))));
    if (valid != wanted)
        warnOnce("clipSize: expected a power of two from " + std::to_string(kLeast) + " to " + std::to_string(kMost) + ", found " +
                 std::to_string(wanted) + "; " + std::to_string(valid) + " is taken");
    return valid;
}

int SoTerrainTexture::Private::atLeast(const SoSFInt32 & field, const char * name, int least, int fallback)
{
    const int wanted = field.getValue();
    if (wanted >= least) return wanted;
    warnOnce(std::string(name) + ": expected " + std::to_string(least) + " or more, found " + std::to_string(wanted) + "; " +
             std::to_string(fallback) + " is taken");
    return fallback;
}

void SoTerrainTexture::Private::load()
{
    isStale = false;
    image.reset();
    if (master->filename.getValue().getLength() == 0) return;
    if (path.getLength() == 0) path = findFile(master->filename.getValue());
    auto opened = terrain::TiledImage::open(path.getString(), atLeast(master->memoryBudget, "memoryBudget", 1, 256));
    if (opened)
        image = std::move(opened).value();
    else
        warnOnce(opened.error().message());
}

SbBool SoTerrainTexture::isLoaded()
{
    if (pimpl->isStale) pimpl->load();
    return pimpl->image != NULL;
}

void SoTerrainTexture::GLRender(SoGLRenderAction * action)
{
    SoState * state = action->getState();
    if (SoTextureUnitElement::get(state) != 0) {
        pimpl->warnOnce("expected texture unit 0, found unit " + std::to_string(SoTextureUnitElement::get(state)) + "; it is not drawn");
        return;
    }
    if (SoTextureOverrideElement::getImageOverride(state)) return;
    if (pimpl->isStale) pimpl->load();
    const int budget = pimpl->atLeast(this->updateBudget, "updateBudget", 0, 262144);
    SoTerrainTextureElement::set(state, this, pimpl->image, pimpl->validClipSize(), uint32_t(budget));
    // The texture before it goes, and the image element bears this node's id until another texture comes.
    SoGLMultiTextureImageElement::set(state, this, 0, NULL, SoMultiTextureImageElement::MODULATE, SbColor(1.0f, 1.0f, 1.0f));
    SoMultiTextureImageElement::set(state, this, 0, SbVec2s(0, 0), 0, NULL, SoMultiTextureImageElement::CLAMP,
                                    SoMultiTextureImageElement::CLAMP, SoMultiTextureImageElement::MODULATE, SbColor(1.0f, 1.0f, 1.0f));
    SoGLMultiTextureEnabledElement::set(state, this, 0, FALSE);
    if (this->isOverride()) SoTextureOverrideElement::setImageOverride(state, TRUE);
}
