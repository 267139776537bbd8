// The way up from a node.
#ifndef SOTERRAIN_PARENTNODE_H
#define SOTERRAIN_PARENTNODE_H

class SoNode;

/// A group that has the node as a child, NULL when none has. Of several the one that Coin lists first.
SoNode * parentOf(const SoNode * node);

#endif
