#include "FieldsInUse.h"

#include <Inventor/SbName.h>
#include <Inventor/SoOutput.h>
#include <Inventor/actions/SoWriteAction.h>
#include <Inventor/fields/SoField.h>
#include <Inventor/fields/SoFieldData.h>
#include <Inventor/nodes/SoNode.h>

namespace {

/// A pointer to a protected member, taken through a derived class, applies to the base class too.
class NodeAccess : public SoNode {
public:
    /// False where the rest of the node is in the file already.
    static bool begin(SoNode * node, SoOutput * out) { return !(node->*(&NodeAccess::writeHeader))(out, FALSE, FALSE); }
    static void end(SoNode * node, SoOutput * out) { (node->*(&NodeAccess::writeFooter))(out); }
};

}  // namespace

bool writeFieldsInUse(SoWriteAction * action, SoNode * node)
{
    SoOutput * out = action->getOutput();
    if (!out->isBinary() || out->getStage() != SoOutput::WRITE) return false;
    if (!NodeAccess::begin(node, out)) return true;
    const SoFieldData & all = *node->getFieldData();
    SoFieldData inUse;
    for (int i = 0; i < all.getNumFields(); ++i) {
        const SoField * field = all.getField(node, i);
        if (field->shouldWrite()) inUse.addField(node, all.getFieldName(i).getString(), field);
    }
    inUse.write(out, node);
    NodeAccess::end(node, out);
    return true;
}
