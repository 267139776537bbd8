// What a file says of a node.
#ifndef SOTERRAIN_FIELDSINUSE_H
#define SOTERRAIN_FIELDSINUSE_H

class SoFieldContainer;
class SoFieldData;

/// Adds the fields that a file must have: those that are not default, are connected or ignored. In binary files Coin writes all fields of
/// nodes that are not its own, and refuses what it wrote where one is a null node or NaN.
void addFieldsInUse(SoFieldData & data, SoFieldContainer * container);

#endif
