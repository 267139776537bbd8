// Kinds of files that can be opened while the program runs.
#pragma once

#include <string>
#include <vector>

namespace app {

enum class FileKind {
    Heights,  ///< an image, a raster or a headerless file of heights
    Scene,    ///< an Inventor or VRML file
    Picture   ///< a picture in colour: a texture
};

/// What a file is good for, by its name and, of a picture, its channels. A file that can't be read is taken for heights: reading it
/// says what is wrong.
FileKind fileKind(const std::string& path);

/// Whether a file holds nothing but samples, by its name.
bool isHeaderless(const std::string& path);

/// Names of files, for a dialog.
struct FilePatterns {
    const char* title;
    std::vector<std::string> patterns;
};
/// All that this build reads as heights or scenes, kind by kind.
std::vector<FilePatterns> openablePatterns();
FilePatterns picturePatterns();

}  // namespace app
