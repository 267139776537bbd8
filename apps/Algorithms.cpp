#include "Algorithms.h"

namespace app {

namespace {

constexpr Algorithm table[] = {
    {"bruteforce", "SoBruteForceTerrain", Feed::HeightMap, "everything, from static buffers", "Brute force"},
    {"chunkedlod", "SoChunkedLoDTerrain", Feed::HeightMap, "chunked level of detail, tiles of -g cells", "Chunked level of detail"},
    {"clipmap", "SoGeometryClipmapTerrain", Feed::HeightMap, "geometry clipmaps, nested grids around the viewer",
     "Geometry clipmaps"},
    {"geomipmapping", "SoGeoMipmapTerrain", Feed::HeightMap, "geometrical mip-mapping, blocks of -g cells",
     "Geometrical mip-mapping"},
    {"roam", "SoROAMTerrain", Feed::HeightMap, "real-time optimally adapting meshes", "ROAM"},
    {"indexedfaceset", "SoIndexedFaceSet", Feed::IndexedFaceSet, "Coin's own triangles, for comparison", "Coin's IndexedFaceSet"},
    {"quadmesh", "SoQuadMesh", Feed::QuadMesh, "Coin's own grid, for comparison", "Coin's QuadMesh"},
};

}  // namespace

std::span<const Algorithm> algorithms() {
    return table;
}

const Algorithm* findAlgorithm(std::string_view name) {
    // The first SoTerrain spelled it so, and its users' scripts may still.
    if (name == "brutalforce") name = "bruteforce";
    for (const Algorithm& algorithm : table) {
        if (algorithm.name == name) return &algorithm;
    }
    return nullptr;
}

std::string algorithmNames() {
    std::string names;
    for (const Algorithm& algorithm : table) names += (names.empty() ? "" : ", ") + std::string(algorithm.name);
    return names;
}

}  // namespace app
