#include "FindFile.h"

#include <Inventor/SoInput.h>
#include <Inventor/lists/SbStringList.h>

SbString findFile(const SbString & name)
{
    SbStringList subdirectories;
    const SbString found = SoInput::searchForFile(name, SoInput::getDirectories(), subdirectories);
    return found.getLength() > 0 ? found : name;
}
