// What a file says of a node.
#ifndef SOTERRAIN_FIELDSINUSE_H
#define SOTERRAIN_FIELDSINUSE_H

class SoNode;
class SoWriteAction;

/// Writes a node into a binary file with the fields that the file must have, those that are not default, are connected or ignored, and with
/// their descriptions: Coin writes all fields there of nodes that are not its own, and refuses what it wrote where one is a null node or NaN.
/// False where there is nothing of that to do, in text files and while references are counted: then SoNode::write() does it.
bool writeFieldsInUse(SoWriteAction * action, SoNode * node);

#endif
