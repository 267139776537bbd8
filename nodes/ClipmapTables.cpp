#include "ClipmapTables.h"

#include <algorithm>

#include "base/TaskRunner.h"

struct ClipmapErrorsLater::Shared {
    std::mutex mutex;
    std::shared_ptr<const terrain::ClipmapErrors> errors;
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

ClipmapErrorsLater::ClipmapErrorsLater(const terrain::SampleGrid & grid, const terrain::TerrainModel & model) : shared_(std::make_shared<Shared>())
{
    // About 50 ms.
    constexpr std::size_t kAtOnce = std::size_t(1) << 21;
    const int levels = levelsOf(grid);
    const std::size_t samples = std::size_t(grid.columns()) * std::size_t(grid.rows());
    if (samples <= kAtOnce || !model.samples) {
        shared_->errors = std::make_shared<const terrain::ClipmapErrors>(grid, levels);
        return;
    }
    terrain::TaskRunner::shared()->submit([shared = std::weak_ptr<Shared>(shared_), grid, levels, owner = model.samples] {
        if (shared.expired()) return;
        auto errors = std::make_shared<const terrain::ClipmapErrors>(grid, levels);
        if (const auto wanted = shared.lock()) {
            const std::lock_guard lock(wanted->mutex);
            wanted->errors = std::move(errors);
        }
    });
}

ClipmapErrorsLater::~ClipmapErrorsLater() {}

std::shared_ptr<const terrain::ClipmapErrors> ClipmapErrorsLater::get() const
{
    const std::lock_guard lock(shared_->mutex);
    return shared_->errors;
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
