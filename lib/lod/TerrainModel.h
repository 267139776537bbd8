// What every algorithm knows of a grid beyond its samples: built once per grid, shared by all nodes and views.
#pragma once

#include <memory>

#include "height/EditLog.h"
#include "height/SampleGate.h"
#include "lod/BoxPyramid.h"
#include "lod/ErrorHierarchy.h"

namespace terrain {

/// Bounds and errors of one grid. Bounds come first and cheap; errors only once something is
/// drawn with level of detail.
struct TerrainModel {
    std::shared_ptr<const BoxPyramid> boxes;
    std::shared_ptr<const ErrorHierarchy> errors;
    std::shared_ptr<const void> samples = nullptr;   ///< keeps the samples' memory, where it can be kept
    std::shared_ptr<SampleGate> gate = nullptr;      ///< other threads hold it to read that memory; null where it never changes
    std::shared_ptr<const EditLog> edits = nullptr;  ///< of the grid; null where it never changes. Bounds and errors are up to date

    std::size_t bytes() const { return (boxes ? boxes->bytes() : 0) + (errors ? errors->bytes() : 0); }
};

}  // namespace terrain
