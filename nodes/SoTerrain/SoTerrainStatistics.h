// What a terrain node did for its latest frame.
#ifndef SOTERRAIN_SOTERRAINSTATISTICS_H
#define SOTERRAIN_SOTERRAINSTATISTICS_H

#include <cstddef>
#include <cstdint>

/// Figures of the latest frame that a terrain node drew, in whatever view that was.
struct SoTerrainStatistics {
    uint64_t frame = 0;         ///< frames drawn by this node so far, over all views
    uint32_t triangles = 0;     ///< triangles sent to GL
    uint32_t patches = 0;       ///< parts drawn at one level each: tiles, blocks; else 1
    uint32_t levels = 1;        ///< levels of a clipmap from the coarsest to the finest that is drawn
    uint32_t drawCalls = 0;     ///< of GL
    uint32_t splits = 0;        ///< refinements of the mesh in this frame
    uint32_t merges = 0;        ///< coarsenings of the mesh in this frame
    uint32_t pendingPatches = 0;  ///< tiles that other threads build, or will, while some in view are missing
    bool converged = true;      ///< false: a limit on work per frame stopped refinement, the next frames go on
    double errorPixels = 0.0;   ///< bound on the screen error of every sample in view; at most pixelError when converged without a budget
    std::size_t memoryBytes = 0;    ///< main memory held beyond Coin's own arrays: hierarchy, meshes, tiles of a texture
    std::size_t bufferBytes = 0;    ///< GL buffers, and textures of an SoTerrainTexture, all contexts
    std::size_t uploadedBytes = 0;  ///< sent to GL buffers and textures in this frame, but for a list of patches
    std::size_t newVertexBytes = 0; ///< of those, vertices that were not in GL before: positions, normals and so on; the rest of a mesh is indices and positions that slide
    double buildMilliseconds = 0.0;   ///< preparing the height data; 0 but in the frame that did it
    double tileMilliseconds = 0.0;    ///< what other threads took to build the tiles that were finished since the frame before, added up
    double selectMilliseconds = 0.0;  ///< choosing the mesh
    double uploadMilliseconds = 0.0;  ///< filling buffers
    double drawMilliseconds = 0.0;    ///< GL draw calls, as seen by the calling thread
};

#endif
