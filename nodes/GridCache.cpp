#include "GridCache.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>

#include <Inventor/elements/SoCoordinateElement.h>
#include <Inventor/misc/SoState.h>

#include <SoTerrain/SoHeightMapElement.h>

#include "base/ProfileScope.h"

using terrain::Error;
using terrain::Result;
using terrain::SampleGrid;

namespace {

std::string text(long long number)
{
    return std::to_string(number);
}

/// Sizes of the grid, zeros replaced, or what is wrong with them.
Result<GridRequest> sizesFor(const GridRequest & request, long available, const char * what)
{
    if (request.verticesPerRow < 0 || request.verticesPerColumn < 0 || request.startIndex < 0)
        return Error{"verticesPerRow, verticesPerColumn, startIndex", "numbers that are not negative",
                     text(request.verticesPerRow) + ", " + text(request.verticesPerColumn) + ", " + text(request.startIndex)};
    GridRequest sizes = request;
    const long count = std::max(0L, available - request.startIndex);
    if (sizes.verticesPerRow == 0 && sizes.verticesPerColumn == 0) {
        const long side = std::lround(std::floor(std::sqrt(double(count))));
        if (side * side != count)
            return Error{"verticesPerRow and verticesPerColumn", "sizes, because the samples make no square", text(count) + ' ' + what};
        sizes.verticesPerRow = sizes.verticesPerColumn = int(side);
    } else if (sizes.verticesPerColumn == 0) {
        sizes.verticesPerColumn = int(count / sizes.verticesPerRow);
    } else if (sizes.verticesPerRow == 0) {
        sizes.verticesPerRow = int(count / sizes.verticesPerColumn);
    }
    if (sizes.verticesPerRow < 2 || sizes.verticesPerColumn < 2)
        return Error{"terrain", "at least 2 x 2 samples", text(sizes.verticesPerRow) + " x " + text(sizes.verticesPerColumn) + " of " +
                     text(count) + ' ' + what};
    const long long needed = (long long)sizes.verticesPerRow * sizes.verticesPerColumn;
    if (needed > count)
        return Error{"terrain", text(sizes.verticesPerRow) + " x " + text(sizes.verticesPerColumn) + " = " + text(needed) + ' ' + what +
                     " from startIndex " + text(sizes.startIndex), text(count)};
    return sizes;
}

/// Where in a map a node's samples are.
struct MapPart {
    int column, row, columns, rows;
    SampleGrid of(const terrain::HeightMap & map) const { return SampleGrid(map, column, row, columns, rows); }
};

Result<MapPart> partOf(const terrain::HeightMap & map, const GridRequest & request)
{
    GridRequest part = request;
    if (part.verticesPerRow == 0) part.verticesPerRow = map.columns;
    if (part.verticesPerColumn == 0) part.verticesPerColumn = map.rows;
    const auto sizes = sizesFor(part, long(map.heights.size()), "samples");
    if (!sizes) return sizes.error();
    const int column = part.startIndex % map.columns, row = part.startIndex / map.columns;
    if (column + part.verticesPerRow > map.columns || row + part.verticesPerColumn > map.rows)
        return Error{"terrain", text(part.verticesPerRow) + " x " + text(part.verticesPerColumn) + " samples from column " + text(column) +
                     ", row " + text(row), "a height map of " + text(map.columns) + " x " + text(map.rows)};
    return MapPart{column, row, part.verticesPerRow, part.verticesPerColumn};
}

}  // namespace

bool GridCache::Entry::isFor(const Entry & key) const
{
    return source == key.source && nodeId == key.nodeId && columns == key.columns && rows == key.rows && start == key.start;
}

GridCache::Entry * GridCache::known(const Entry & key)
{
    ++use_;
    // What was not asked for lately is of data that has changed since.
    constexpr std::uint64_t kKept = 16;
    std::erase_if(entries_, [this](const Entry & e) { return use_ - e.lastUse > kKept; });
    for (Entry & e : entries_)
        if (e.isFor(key)) {
            e.lastUse = use_;
            return &e;
        }
    return nullptr;
}

GridCache::Entry & GridCache::entryFor(const Entry & key)
{
    if (Entry * entry = known(key)) return *entry;
    entries_.push_back(key);
    entries_.back().lastUse = use_;
    return entries_.back();
}

Result<TerrainGrid> GridCache::complete(Entry & entry, bool withErrors)
{
    constexpr int kLargestSide = (1 << 15) + 1;
    if (std::max(entry.columns, entry.rows) > kLargestSide)
        return Error{"terrain", "at most " + text(kLargestSide) + " samples a row or column", text(entry.columns) + " x " + text(entry.rows)};
    const terrain::ProfileScope scope("grid: bounds and errors");
    const auto start = std::chrono::steady_clock::now();
    if (!entry.edits) entry.edits = std::make_shared<terrain::EditLog>();
    const bool isNew = !entry.boxes || (withErrors && !entry.errors);
    if (!entry.boxes) entry.boxes = std::make_shared<terrain::BoxPyramid>(entry.grid);
    if (withErrors && !entry.errors) entry.errors = std::make_shared<terrain::ErrorHierarchy>(entry.grid);
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    return TerrainGrid{entry.grid, entry.model(), entry.source != nullptr, isNew ? time.count() : 0.0};
}

void GridCache::update(Entry & entry, const terrain::GridEdits & edits)
{
    if (edits.isEmpty() || !entry.boxes) return;
    const terrain::ProfileScope scope("grid: edit");
    for (const terrain::SampleRect & rect : edits.rects) entry.boxes->update(entry.grid, rect);
    if (entry.errors)
        for (const terrain::SampleRect & rect : edits.rects) entry.errors->update(entry.grid, rect, *entry.boxes);
    entry.edits->add(edits);
}

Result<TerrainGrid> GridCache::findMap(SoState * state, const GridRequest & request, bool withErrors)
{
    const SoHeightMapElement * element = SoHeightMapElement::getInstance(state);
    const terrain::HeightMap & map = *element->getSource()->map();
    const auto found = partOf(map, request);
    if (!found) return found.error();
    const MapPart & part = found.value();
    Entry key;
    key.source = element->getSource();
    key.columns = part.columns;
    key.rows = part.rows;
    key.start = request.startIndex;
    Entry & entry = entryFor(key);
    entry.grid = part.of(map);
    entry.samples = element->getSource()->weak_from_this().lock();
    if (const terrain::MapSource * source = element->getSource()->editable()) {
        if (entry.samples) entry.gate = std::shared_ptr<terrain::SampleGate>(entry.samples, &source->gate());
        const auto edits = source->edits().since(entry.version);
        const terrain::SampleRect all{{part.column, part.row}, {part.column + part.columns - 1, part.row + part.rows - 1}};
        // Too many to tell: everything, and holes may be elsewhere.
        update(entry, edits ? edits->within(all) : terrain::GridEdits{{{{0, 0}, all.high - all.low}}, true});
        entry.version = source->edits().version();
    }
    // Of a map in scratch space, what the views look at would add up to the whole in the course of a flight.
    constexpr std::size_t kResidentBytes = std::size_t(96) << 20;
    map.heights.limitResident(kResidentBytes);
    return complete(entry, withErrors);
}

/// What coordinates are known by.
Result<GridCache::Entry> GridCache::coordinateKey(SoState * state, const GridRequest & request)
{
    const SoCoordinateElement * element = SoCoordinateElement::getInstance(state);
    const long available = element->getNum();
    // Without any coordinate node the element holds one default point.
    if (available <= 1) return Error{"terrain", "an SoHeightMap or an SoCoordinate3 before it", "neither"};
    if (!element->is3D()) return Error{"terrain", "coordinates of an SoCoordinate3", "coordinates of an SoCoordinate4"};
    const auto sizes = sizesFor(request, available, "coordinates");
    if (!sizes) return sizes.error();
    Entry key;
    key.nodeId = element->getNodeId();
    key.columns = sizes.value().verticesPerRow;
    key.rows = sizes.value().verticesPerColumn;
    key.start = sizes.value().startIndex;
    return key;
}

Result<TerrainGrid> GridCache::findCoordinates(SoState * state, const GridRequest & request, bool withErrors)
{
    const auto found = coordinateKey(state, request);
    if (!found) return found.error();
    const Entry & key = found.value();
    const float * points = SoCoordinateElement::getInstance(state)->getArrayPtr3()[key.start].getValue();
    Entry * entry = known(key);
    if (!entry) entry = changedEntry(key, points);
    if (!entry) entry = &entryFor(key);
    if (entry->boxes) {
        entry->grid = entry->grid.movedTo(points);
    } else {
        auto grid = SampleGrid::overPoints(points, key.columns, key.rows);
        if (!grid) return grid.error();
        entry->grid = grid.value();
        entry->digest = CoordinateDigest(points, key.columns, key.rows);
    }
    return complete(*entry, withErrors);
}

/// The entry of the same coordinates before they changed, brought up to date; null where there is none or nearly all is new.
GridCache::Entry * GridCache::changedEntry(const Entry & key, const float * points)
{
    Entry * before = nullptr;
    for (Entry & e : entries_)
        if (!e.source && e.boxes && e.columns == key.columns && e.rows == key.rows && e.start == key.start && (!before || e.lastUse < before->lastUse))
            before = &e;
    if (!before) return nullptr;
    const auto grid = SampleGrid::overPoints(points, key.columns, key.rows);
    if (!grid || !grid.value().isLike(before->grid)) return nullptr;
    CoordinateDigest now(points, key.columns, key.rows);
    const terrain::GridEdits edits = before->digest.changes(now);
    std::int64_t changed = 0;
    for (const terrain::SampleRect & rect : edits.rects) changed += rect.samples();
    if (2 * changed > std::int64_t(key.columns) * key.rows) return nullptr;
    before->nodeId = key.nodeId;
    before->lastUse = use_;
    before->grid = grid.value();
    before->digest = std::move(now);
    update(*before, edits);
    return before;
}

Result<TerrainGrid> GridCache::find(SoState * state, const GridRequest & request, bool withErrors)
{
    const terrain::HeightSource * source = SoHeightMapElement::getInstance(state)->getSource();
    return source && source->map() ? findMap(state, request, withErrors) : findCoordinates(state, request, withErrors);
}

Result<SampleGrid> GridCache::findSamples(SoState * state, const GridRequest & request)
{
    const terrain::HeightSource * source = SoHeightMapElement::getInstance(state)->getSource();
    if (source && source->map()) {
        const auto part = partOf(*source->map(), request);
        return part ? Result<SampleGrid>(part.value().of(*source->map())) : Result<SampleGrid>(part.error());
    }
    const auto key = coordinateKey(state, request);
    if (!key) return key.error();
    const float * points = SoCoordinateElement::getInstance(state)->getArrayPtr3()[key.value().start].getValue();
    if (Entry * entry = known(key.value())) return entry->grid.movedTo(points);
    auto grid = SampleGrid::overPoints(points, key.value().columns, key.value().rows);
    if (grid) entryFor(key.value()).grid = grid.value();
    return grid;
}

std::size_t GridCache::bytes() const
{
    std::size_t total = 0;
    for (const Entry & e : entries_) total += e.model().bytes() + e.digest.bytes();
    return total;
}
