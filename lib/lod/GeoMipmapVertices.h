// The vertices of a Geo Mip-Mapping mesh: one for each sample that is drawn, shared by the blocks that meet there.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "height/SampleGrid.h"
#include "lod/GeoMipmapErrors.h"

namespace terrain {

/// A block to be drawn, with its level and those of its borders, by side.
struct DrawnBlock {
    BlockAt at;
    std::uint8_t level = 0;
    std::array<std::uint8_t, 4> border{};

    bool operator==(const DrawnBlock&) const = default;
};

/// How far each block is from full detail: its level and, behind the point, how far it has come to the next one. Around the blocks
/// lies a rim that is never drawn.
class BlockDetails {
public:
    static constexpr float kHidden = -1.0f;

    explicit BlockDetails(const BlockLayout& layout)
        : pitch_(std::size_t(layout.blockColumns) + 2), detail_(pitch_ * (std::size_t(layout.blockRows) + 2), kHidden) {}

    float& operator[](const BlockAt& at) { return detail_[place(at)]; }
    float operator[](const BlockAt& at) const { return detail_[place(at)]; }
    float beyond(const BlockAt& at, int side) const { return detail_[std::size_t(std::ptrdiff_t(place(at)) + step(side))]; }
    std::size_t bytes() const { return detail_.capacity() * sizeof(float); }

private:
    std::size_t place(const BlockAt& at) const { return (std::size_t(at.row) + 1) * pitch_ + at.column + 1; }
    std::ptrdiff_t step(int side) const {
        return side % 2 == 0 ? (side == GeoMipmapShape::Bottom ? -std::ptrdiff_t(pitch_) : std::ptrdiff_t(pitch_))
                             : (side == GeoMipmapShape::Right ? 1 : -1);
    }

    std::size_t pitch_;
    std::vector<float> detail_;
};

/// Vertices come in ranges: a corner of blocks, the inside of a border, the inside of a block. A range stays where it is as long as
/// it is drawn at the same level, so that a frame makes those vertices only that are new.
class GeoMipmapVertices {
public:
    explicit GeoMipmapVertices(std::shared_ptr<const GeoMipmapErrors> errors);

    /// Makes the vertices of these blocks, at their true positions, and gives up all others. `before` is what was given last.
    void update(const SampleGrid& grid, std::span<const DrawnBlock> blocks, std::span<const DrawnBlock> before);

    /// Puts those of these blocks, which are drawn, to their true positions whose samples have changed or are next to one that has, and
    /// lists them as new.
    void placeAgain(const SampleGrid& grid, std::span<const DrawnBlock> blocks, const GridEdits& edits);

    /// The vertices of a block by GeoMipmapShape's places; valid until the next call. Only what the block draws is set.
    const std::uint32_t* of(const DrawnBlock& drawn);

    /// Slides the vertices of these blocks: all those whose detail is between two levels, and among them such as are not drawn
    /// themselves, for the borders of others. True when any vertex has moved.
    bool morph(const SampleGrid& grid, std::span<const DrawnBlock> sliding, const BlockDetails& detail);

    /// Whether the vertices of a block were the same before the last update.
    bool isAsBefore(const DrawnBlock& drawn) const { return states_[drawn.at.number].since != update_; }

    std::span<const glm::vec3> positions() const { return positions_; }
    std::span<const std::uint32_t> samples() const { return samples_; }
    std::span<const std::uint32_t> newVertices() const { return newVertices_; }
    void forgetNewVertices() { newVertices_.clear(); }
    std::size_t bytes() const;

private:
    static constexpr std::uint8_t kUnused = 0xff;

    struct Range {
        std::uint32_t first = 0;
        std::uint8_t level = kUnused;
        std::uint8_t users = 0;  ///< blocks that draw it
    };
    /// What is drawn of a block, and the first and the last update that found it so.
    struct State {
        std::uint8_t level = 0;
        std::array<std::uint8_t, 4> border{};
        bool drawn = false;
        std::uint16_t update = 0;
        std::uint16_t since = 0;
    };
    /// Where a range's vertices stand: the sample before the first one, and the lines across which they go on, by number.
    struct Extent {
        glm::ivec2 from{0};
        glm::ivec2 cells{0};  ///< 0: along the other axis only
        glm::ivec2 count{1};
    };

    std::uint32_t cornerRange(int column, int row) const { return std::uint32_t(row * (layout_.blockColumns + 1) + column); }
    std::uint32_t sideRange(const BlockAt& at, int side) const {
        const std::uint32_t columns = std::uint32_t(layout_.blockColumns);
        if (side % 2 == 0) return firstHorizontal_ + at.number + (side == GeoMipmapShape::Top ? columns : 0);
        return firstVertical_ + at.number + at.row + (side == GeoMipmapShape::Right ? 1 : 0);
    }
    std::uint32_t innerRange(const BlockAt& at) const { return firstInner_ + at.number; }
    /// The ranges of a block: corners, sides, inside.
    std::array<std::uint32_t, 9> rangesOf(const BlockAt& at) const;
    Extent extent(std::uint32_t range, int level) const;
    glm::ivec2 sampleOf(const Extent& extent, int level, int number) const;
    template <class Visit>
    void forSamples(const Extent& extent, int level, const Visit& visit) const;
    int lineAt(int line, int cells, int level) const;

    void use(const SampleGrid& grid, std::uint32_t number, std::uint8_t level);
    void unuse(std::uint32_t number);
    void release(std::uint32_t number);
    void forget(std::span<const DrawnBlock> blocks);
    void allocate(const SampleGrid& grid, std::uint32_t number);
    void place(const SampleGrid& grid, std::uint32_t number, bool isNew);
    void morphBorder(const SampleGrid& grid, std::uint32_t number, float coarse);
    void morphInner(const SampleGrid& grid, const DrawnBlock& drawn, float coarse);

    std::shared_ptr<const GeoMipmapErrors> errors_;
    const BlockLayout layout_;
    std::uint32_t firstHorizontal_, firstVertical_, firstInner_;
    std::vector<Range> ranges_;
    std::vector<State> states_;                                 ///< by block
    std::vector<std::uint32_t> emptied_, moved_;                ///< numbers of ranges
    std::map<std::uint32_t, std::vector<std::uint32_t>> free_;  ///< first vertices, by size
    std::vector<std::uint32_t> ids_;
    std::vector<glm::vec3> positions_;
    std::vector<std::uint32_t> samples_, newVertices_;
    std::size_t drawnVertices_ = 0;
    std::uint16_t update_ = 0;
};

}  // namespace terrain
