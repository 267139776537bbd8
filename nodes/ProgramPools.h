// The programs that all terrain nodes draw with, by context.
#ifndef SOTERRAIN_PROGRAMPOOLS_H
#define SOTERRAIN_PROGRAMPOOLS_H

#include <memory>

#include "gl/ProgramPool.h"

class SoState;

/// The pool of the context that is being drawn to; contexts of one cache context id share it. Its programs are deleted when Coin is told
/// that the id's last context goes. Each thread has pools of its own, because uniforms are set in a program and not in a context: those who
/// draw at the same time need two.
std::shared_ptr<terrain::ProgramPool> programPoolOf(SoState * state);

#endif
