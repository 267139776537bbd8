// Scrolling graphs of named counters over a scene.
#ifndef SOTERRAIN_SOPERFGRAPH_H
#define SOTERRAIN_SOPERFGRAPH_H

#include <memory>

#include <Inventor/fields/SoMFColor.h>
#include <Inventor/fields/SoMFFloat.h>
#include <Inventor/fields/SoMFString.h>
#include <Inventor/fields/SoSFBool.h>
#include <Inventor/fields/SoSFFloat.h>
#include <Inventor/fields/SoSFInt32.h>
#include <Inventor/fields/SoSFVec2f.h>
#include <Inventor/nodes/SoNode.h>
#include <Inventor/nodes/SoSubNode.h>

class SoPerfGraph : public SoNode {
    typedef SoNode inherited;
    SO_NODE_HEADER(SoPerfGraph);

public:
    static void initClass();
    SoPerfGraph();

    SoMFString counter;      ///< names, one graph each; "": an empty place
    SoMFFloat maximum;       ///< top of each graph, in the counter's unit; 0 or none: follows what is shown
    SoMFColor color;         ///< of each curve; fewer than graphs: from the first again
    SoSFVec2f position;      ///< pixels from the lower left corner of the viewport; negative: from the upper right one
    SoSFVec2f size;          ///< of one graph, in pixels
    SoSFFloat scale;         ///< pixels for one of position, size and text: 2 on displays of high density
    SoSFInt32 columns;       ///< graphs side by side; 0: as many as fit
    SoSFInt32 history;       ///< frames across a graph, from 2 to 65536
    SoSFFloat transparency;  ///< of the ground behind the curves
    SoSFBool on;

    /// Adds to what a counter says of this frame: every graph that names it shows the sum since it was drawn last. The unit is kept from
    /// the latest call that gave one. From any thread; what is not finite is left out.
    static void count(const char * name, double amount, const char * unit = NULL);
    /// What a counter that is no amount stands at, until the next call. From any thread.
    static void set(const char * name, double value, const char * unit = NULL);
    /// The value that graph \a index showed last in whichever view was drawn last, and the top of its scale. The value is NaN where nothing
    /// counts by that name. FALSE where there is no such graph, or it was not drawn yet.
    SbBool getShown(int index, double & value, double & top) const;

    virtual void GLRender(SoGLRenderAction * action);
    virtual SbBool affectsState() const;
    virtual void write(SoWriteAction * action);

protected:
    virtual ~SoPerfGraph();
    virtual void notify(SoNotList * list);

private:
    class Private;
    std::unique_ptr<Private> pimpl;
};

#endif
