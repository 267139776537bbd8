#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include "Window.h"

#ifndef HAVE_SOQT

namespace app {

std::optional<terrain::Error> openDisplay(const char*)
{
    return terrain::Error{"window", "--offscreen", "a build without SoQt"};
}

std::optional<terrain::Error> runWindow(const Options&, Scene&, double)
{
    return openDisplay("");
}

}  // namespace app

#endif
