// Traversal state: the height map that terrain nodes draw.
#ifndef SOTERRAIN_SOHEIGHTMAPELEMENT_H
#define SOTERRAIN_SOHEIGHTMAPELEMENT_H

#include <Inventor/elements/SoReplacedElement.h>
#include <Inventor/elements/SoSubElement.h>

namespace terrain {
class HeightSource;
}

/// Set by SoHeightMap. The source is valid during the traversal; getNodeId() changes whenever its heights may have.
class SoHeightMapElement : public SoReplacedElement {
    typedef SoReplacedElement inherited;
    SO_ELEMENT_HEADER(SoHeightMapElement);

public:
    static void initClass();

    virtual void init(SoState * state);
    /// Makes \a source the height map of what follows, in the name of \a node. NULL: none; \a failed tells why.
    static void set(SoState * state, SoNode * node, const terrain::HeightSource * source, SbBool failed);
    /// The element of this traversal, which must have it enabled.
    static const SoHeightMapElement * getInstance(SoState * state);
    /// NULL where no node has set one, or its file could not be read.
    const terrain::HeightSource * getSource() const;
    /// A node names a file that could not be read, and has said so.
    SbBool hasFailed() const;

protected:
    virtual ~SoHeightMapElement();

private:
    const terrain::HeightSource * source;
    SbBool failed;
};

#endif
