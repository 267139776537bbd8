#include "Algorithms.h"

namespace app {

namespace {

constexpr Algorithm table[] = {
    {"bruteforce", "SoBruteForceTerrain", Feed::HeightMap, "everything, from static buffers"},
    {"chunkedlod", "SoChunkedLoDTerrain", Feed::HeightMap, "chunked level of detail, tiles of -g cells"},
    {"clipmap", "SoGeometryClipmapTerrain", Feed::HeightMap, "geometry clipmaps, nested grids around the viewer"},
    {"geomipmapping", "SoGeoMipmapTerrain", Feed::HeightMap, "geometrical mip-mapping, blocks of -g cells"},
    {"roam", "SoROAMTerrain", Feed::HeightMap, "real-time optimally adapting meshes"},
    {"indexedfaceset", "SoIndexedFaceSet", Feed::IndexedFaceSet, "Coin's own triangles, for comparison"},
    {"quadmesh", "SoQuadMesh", Feed::QuadMesh, "Coin's own grid, for comparison"},
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
