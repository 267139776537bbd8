// What every algorithm of level of detail is to the nodes.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/View.h"
#include "height/EditLog.h"
#include "height/SampleGrid.h"
#include "lod/DrawList.h"
#include "lod/DrawnPatch.h"

namespace terrain {

/// What a selection is to meet. An algorithm ignores what it has no use for.
struct LodSettings {
    float pixelError = 2.0f;                            ///< largest screen error of any sample in view, in pixels; 0: full detail
    std::uint32_t triangleBudget = 0;                   ///< hard limit on the triangles of the mesh; 0: none
    std::uint32_t operationLimit = 0;                   ///< most splits and merges of a selection but the first; 0: no limit
    bool cull = true;                                   ///< leave out what is outside of the view volume, and do not refine it
    bool geomorph = false;                              ///< let vertices slide between the coarse and the fine surface
    std::size_t memoryBudget = std::size_t(256) << 20;  ///< bytes that tiles may take
    std::size_t uploadBudget = 0;  ///< bytes of vertices that tiles new on screen may send to GL in a frame; 0: no limit
    std::size_t vertexBytes = 32;  ///< that a vertex takes in GL: position, normal and so on
    bool complete = false;         ///< wait for tiles that are built in the background, and send them whatever the upload budget
    bool clockwise = false;        ///< orientation of the triangles in the grid's (column, row) plane

    bool operator==(const LodSettings&) const = default;
};

/// One view's choice of triangles. It keeps no pointer to samples: select() is given them.
class LodAlgorithm {
public:
    virtual ~LodAlgorithm() = default;
    /// The same calls in the same order give the same results. The list is valid until the next call.
    virtual DrawList select(const SampleGrid& grid, const View& view, const LodSettings& settings) = 0;
    /// Samples of the grid have changed, and bounds and errors of the model have been brought up to date with them. The next
    /// selections are to show it, and to list as new all vertices whose sample has changed or has a neighbour that has: their
    /// normals are others. False where that takes a new mesh.
    virtual bool update(const SampleGrid& /*grid*/, const GridEdits& /*edits*/) { return false; }
    /// All triangles of the latest selection, part after part, seams last. It costs nothing unless it is called.
    virtual void eachPatch(const SampleGrid& grid, const PatchVisitor& visit) const = 0;
    /// Memory held.
    virtual std::size_t bytes() const = 0;
};

}  // namespace terrain
