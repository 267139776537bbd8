// The algorithms that programs offer by name.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace app {

/// How a shape gets its heights in a scene that a program builds.
enum class Feed {
    HeightMap,      ///< an SoHeightMap node before it
    QuadMesh,       ///< Coin's own: coordinates, normals and texture coordinates, with rows and columns in fields
    IndexedFaceSet  ///< Coin's own: the same with indexed triangles
};

/// One word of the command line and the node class behind it. A new algorithm is one row of the table.
struct Algorithm {
    std::string_view name;
    const char* className;  ///< found by Coin by this name
    Feed feed;
    std::string_view help;
    const char* title;  ///< in a menu
};

std::span<const Algorithm> algorithms();
/// Null when no algorithm has this name.
const Algorithm* findAlgorithm(std::string_view name);
/// "bruteforce, roam, ..."
std::string algorithmNames();

}  // namespace app
