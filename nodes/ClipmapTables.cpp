#include "ClipmapTables.h"

#include <algorithm>

#include "base/TaskRunner.h"

struct ClipmapErrorsLater::Shared {
    std::mutex mutex;
    std::shared_ptr<terrain::ClipmapErrors> errors;
};

namespace {

/// As many levels as the smallest clipmap has over a grid.
int levelsOf(const terrain::SampleGrid & grid)
{
    terrain::ClipmapShape smallest;
    smallest.size = terrain::ClipmapShape::kSmallest;
    return terrain::ClipmapLayout(grid.columns(), grid.rows(), smallest).levels();
}

}  // namespace

ClipmapErrorsLater::ClipmapErrorsLater(const terrain::SampleGrid & grid, const terrain::TerrainModel & model) : shared_(std::make_shared<Shared>()), edits_(model.edits),
      version_(model.edits ? model.edits->version() : 0)
{
    // About 50 ms.
    constexpr std::size_t kAtOnce = std::size_t(1) << 21;
    const int levels = levelsOf(grid);
    const std::size_t samples = std::size_t(grid.columns()) * std::size_t(grid.rows());
    if (samples <= kAtOnce || !model.samples) {
        shared_->errors = std::make_shared<terrain::ClipmapErrors>(grid, levels);
        return;
    }
    terrain::TaskRunner::shared()->submit([shared = std::weak_ptr<Shared>(shared_), grid, levels, owner = model.samples, gate = model.gate] {
        if (shared.expired()) return;
        // Edits need not wait for it: what they change in the meantime is looked at once more by get().
        auto errors = std::make_shared<terrain::ClipmapErrors>(grid, levels, gate.get());
        if (const auto wanted = shared.lock()) {
            const std::lock_guard lock(wanted->mutex);
            wanted->errors = std::move(errors);
        }
    });
}

ClipmapErrorsLater::~ClipmapErrorsLater() {}

std::shared_ptr<const terrain::ClipmapErrors> ClipmapErrorsLater::get(const terrain::SampleGrid & grid) const
{
    std::shared_ptr<terrain::ClipmapErrors> errors;
    {
        const std::lock_guard lock(shared_->mutex);
        errors = shared_->errors;
    }
    if (!errors || !edits_ || edits_->version() == version_) return errors;
    const terrain::GridEdits all{{{glm::ivec2(0), glm::ivec2(grid.columns() - 1, grid.rows() - 1)}}, true};
    errors->update(grid, edits_->since(version_).value_or(all));
    version_ = edits_->version();
    return errors;
}

ClipmapTables::Entry & ClipmapTables::entryOf(const terrain::TerrainModel & model)
{
    std::erase_if(entries_, [](const Entry & entry) { return entry.grid.expired(); });
    const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry & entry) { return entry.grid.lock() == model.boxes; });
    if (found != entries_.end()) return *found;
    entries_.push_back({model.boxes, nullptr, {}, nullptr});
    return entries_.back();
}

std::shared_ptr<const ClipmapErrorsLater> ClipmapTables::errors(const terrain::SampleGrid & grid, const terrain::TerrainModel & model)
{
    Entry & entry = entryOf(model);
    if (!entry.errors) entry.errors = std::make_shared<const ClipmapErrorsLater>(grid, model);
    return entry.errors;
}

std::shared_ptr<const terrain::SynthesisedDetail> ClipmapTables::detail(const terrain::SampleGrid & grid, const terrain::TerrainModel & model,
                                                                        const terrain::DetailShape & shape)
{
    if (shape.levels <= 0) return nullptr;
    Entry & entry = entryOf(model);
    if (!entry.detail || entry.shape != shape) {
        entry.detail = std::make_shared<const terrain::SynthesisedDetail>(grid, shape);
        entry.shape = shape;
    }
    return entry.detail->levels() > 0 ? entry.detail : nullptr;
}
