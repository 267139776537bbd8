#include "ParentNode.h"

#include <cstdint>

#include <Inventor/C/base/rbptree.h>
#include <Inventor/misc/SoNotRec.h>
#include <Inventor/nodes/SoNode.h>

namespace {

/// SoBase::getAuditors() of Coin 4.0.0 writes to a list that is not there when it is first called for an object, so the tree that it reads
/// is read here. Access is not checked in explicit instantiations.
template <cc_rbptree SoBase::*Member>
struct AuditorTree {
    friend const cc_rbptree & auditorsOf(const SoBase & base) { return base.*Member; }
};
const cc_rbptree & auditorsOf(const SoBase & base);
template struct AuditorTree<&SoBase::auditortree>;

void takeParent(void * auditor, void * type, void * closure)
{
    SoNode *& parent = *static_cast<SoNode **>(closure);
    if (!parent && reinterpret_cast<std::uintptr_t>(type) == SoNotRec::PARENT) parent = static_cast<SoNode *>(auditor);
}

}  // namespace

SoNode * parentOf(const SoNode * node)
{
    SoNode * parent = nullptr;
    cc_rbptree_traverse(&auditorsOf(*node), takeParent, &parent);
    return parent;
}
