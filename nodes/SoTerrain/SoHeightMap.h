// Property node: height data from a file, or from the program.
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

    /// Whether the file that the fields name has been read, or heights were given by setHeights(); reads it if need be.
    SbBool isLoaded();

    /// Columns and rows of the map. FALSE where there is none; then nothing is written.
    SbBool getSize(int & columns, int & rows);

    /// Replaces the heights of \a columns x \a rows samples from (\a column, \a row) on, counted from the south-west: \a heights are as
    /// many floats, row after row from south to north without gaps (a rowstride of \a columns), as they are drawn: heightScale,
    /// heightOffset and noData do not act on them. What is not finite becomes a hole. All nodes that draw the map follow in their next
    /// frame, and picks, heights and boxes at once. FALSE, after a warning, for a rectangle that does not lie in the map, without a
    /// map and for NULL; then nothing changes.
    SbBool setHeights(int column, int row, int columns, int rows, const float * heights);
    /// Makes a map of \a columns x \a rows samples of these heights, of a node without a filename: spacing (or 1) and origin say where
    /// they stand. FALSE, after a warning, for fewer than 2 x 2 samples, for NULL and where there is a filename.
    SbBool setHeights(int columns, int rows, const float * heights);
    /// Writes the heights of a rectangle, as setHeights() takes them; holes are NaN. FALSE, after a warning, as there.
    SbBool getHeights(int column, int row, int columns, int rows, float * heights);

    virtual void doAction(SoAction * action);
    virtual void GLRender(SoGLRenderAction * action);
    virtual void callback(SoCallbackAction * action);
    virtual void pick(SoPickAction * action);
    virtual void getBoundingBox(SoGetBoundingBoxAction * action);
    virtual void getPrimitiveCount(SoGetPrimitiveCountAction * action);
    virtual void write(SoWriteAction * action);

protected:
    virtual ~SoHeightMap();
    virtual SbBool readInstance(SoInput * in, unsigned short flags);
    virtual void copyContents(const SoFieldContainer * from, SbBool copyConnections);
    virtual void notify(SoNotList * list);

private:
    friend class HeightMapReading;
    void bringUpToDate();
    void load();
    void tellOfEdit();

    class Private;
    std::unique_ptr<Private> pimpl;
};

#endif
