// The height source over a map, which can be edited.
#pragma once

#include <cstddef>
#include <memory>

#include "height/EditLog.h"
#include "height/HeightSource.h"
#include "height/SampleGate.h"

namespace terrain {

/// All of a map's samples, in memory or in scratch space. One thread may edit them while others read: those hold the gate, and ask
/// the log afterwards whether what they read has changed. The log, and editing itself, belong to one thread.
class MapSource : public HeightSource {
public:
    /// The map's sizes must be those of its samples: see makeMapSource().
    explicit MapSource(HeightMap map) : map_(std::move(map)) {}

    HeightExtent extent() const override { return {map_.columns, map_.rows, map_.origin, map_.spacing}; }
    int levelCount() const override;
    Result<HeightTile> load(const TileKey& key) const override;
    const HeightMap* map() const override { return &map_; }
    const MapSource* editable() const override { return this; }
    std::size_t bytes() const override { return sizeof *this + map_.heights.memoryBytes() + map_.projection.capacity(); }

    /// Replaces the samples of a rectangle, which must lie in the map, by `heights`: columns() floats a row, row after row without
    /// gaps, the row of the smallest y first. What is not finite becomes a hole.
    void setHeights(const SampleRect& rect, const float* heights);
    /// Samples stay, and stand elsewhere.
    void place(glm::dvec2 origin, glm::dvec2 spacing);
    /// A source of its own with the same samples; in scratch space where these are. Error: no space for them.
    Result<std::shared_ptr<MapSource>> copy() const;

    const EditLog& edits() const { return edits_; }
    SampleGate& gate() const { return gate_; }

private:
    struct Span;
    void measure(HeightTile& tile, const Span& columns, const Span& rows) const;

    HeightMap map_;
    EditLog edits_;
    mutable SampleGate gate_;
};

}  // namespace terrain
