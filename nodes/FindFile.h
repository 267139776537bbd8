// Where the file that a node names is.
#ifndef SOTERRAIN_FINDFILE_H
#define SOTERRAIN_FINDFILE_H

#include <Inventor/SbString.h>

/// The file in the directories that Coin searches, which are those of the scene file while one is being read; the name itself where there is none.
SbString findFile(const SbString & name);

#endif
