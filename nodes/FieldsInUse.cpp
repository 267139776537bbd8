#include "FieldsInUse.h"

#include <Inventor/SbName.h>
#include <Inventor/fields/SoField.h>
#include <Inventor/fields/SoFieldContainer.h>
#include <Inventor/fields/SoFieldData.h>

void addFieldsInUse(SoFieldData & data, SoFieldContainer * container)
{
    const SoFieldData & all = *container->getFieldData();
    for (int i = 0; i < all.getNumFields(); ++i) {
        const SoField * field = all.getField(container, i);
        if (field->shouldWrite()) data.addField(container, all.getFieldName(i).getString(), field);
    }
}
