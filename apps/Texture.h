// Textures from picture files.
#pragma once

#include <string>

#include "base/Result.h"
#include "gl/HeadlessContext.h"

class SoTexture2;

namespace app {

/// A texture node that holds the picture itself, so that Coin needs no picture library of its own. The node has no reference yet.
/// `topFirst` keeps the file's top row at the bottom of the texture.
SoTexture2* makeTexture(terrain::Image image, bool topFirst = false);
/// The same from a file.
terrain::Result<SoTexture2*> loadTexture(const std::string& path, bool topFirst = false);

}  // namespace app
