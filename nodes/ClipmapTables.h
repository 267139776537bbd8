// What geometry clipmaps know of a grid beyond its samples: errors, which may take time, and synthesised detail.
#ifndef SOTERRAIN_CLIPMAPTABLES_H
#define SOTERRAIN_CLIPMAPTABLES_H

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "height/SampleGrid.h"
#include "lod/ClipmapErrors.h"
#include "lod/SynthesisedDetail.h"
#include "lod/TerrainModel.h"

/// Errors of one grid for clipmaps of any size, once they are there. Used by the rendering thread.
class ClipmapErrorsLater {
public:
    /// Of a small grid, or of one whose memory can't be kept, at once; else in the background.
    ClipmapErrorsLater(const terrain::SampleGrid & grid, const terrain::TerrainModel & model);
    ~ClipmapErrorsLater();
    ClipmapErrorsLater(const ClipmapErrorsLater &) = delete;
    ClipmapErrorsLater & operator=(const ClipmapErrorsLater &) = delete;

    /// Null while they are being computed. Those of a grid that has been edited are brought up to date.
    std::shared_ptr<const terrain::ClipmapErrors> get(const terrain::SampleGrid & grid) const;

private:
    struct Shared;
    std::shared_ptr<Shared> shared_;
    std::shared_ptr<const terrain::EditLog> edits_;
    mutable std::uint64_t version_ = 0;  ///< of the edits that they are of
};

/// The tables of one node, found again as long as their grid is in use.
class ClipmapTables {
public:
    std::shared_ptr<const ClipmapErrorsLater> errors(const terrain::SampleGrid & grid, const terrain::TerrainModel & model);
    /// Null for a shape without levels, and where the grid gets none.
    std::shared_ptr<const terrain::SynthesisedDetail> detail(const terrain::SampleGrid & grid, const terrain::TerrainModel & model,
                                                             const terrain::DetailShape & shape);

private:
    struct Entry {
        std::weak_ptr<const terrain::BoxPyramid> grid;
        std::shared_ptr<const ClipmapErrorsLater> errors;
        terrain::DetailShape shape;
        std::shared_ptr<const terrain::SynthesisedDetail> detail;
    };
    Entry & entryOf(const terrain::TerrainModel & model);

    std::vector<Entry> entries_;
};

#endif
