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
    std::uint32_t block = 0;
    std::uint8_t level = 0;
    std::array<std::uint8_t, 4> border{};

    bool operator==(const DrawnBlock&) const = default;
};

/// Vertices come in ranges: a corner of blocks, the inside of a border, the inside of a block. A range stays where it is as long as
/// it is drawn at the same level, so that a frame makes those vertices only that are new.
class GeoMipmapVertices {
public:
    explicit GeoMipmapVertices(std::shared_ptr<const GeoMipmapErrors> errors);

    /// Makes the vertices of these blocks and gives up all others, at their true positions.
    void update(const SampleGrid& grid, std::span<const DrawnBlock> blocks);

    /// The vertices of a block by GeoMipmapShape's places; valid until the next call. Only what the block draws is set.
    const std::uint32_t* of(const DrawnBlock& drawn);

    /// Slides the vertices of blocks: `detail` is the level of each block of the grid and, behind the point, how far it has come to
    /// the next one; negative for what is not drawn. True when any vertex has moved.
    bool morph(const SampleGrid& grid, std::span<const DrawnBlock> blocks, const std::vector<float>& detail);

    std::span<const glm::vec3> positions() const { return positions_; }
    std::span<const std::uint32_t> samples() const { return samples_; }
    std::span<const std::uint32_t> newVertices() const { return newVertices_; }
    void forgetNewVertices() { newVertices_.clear(); }
    std::size_t bytes() const;

private:
    static constexpr std::uint8_t kUnused = 0xff;

    struct Range {
        std::uint32_t first = 0;
        std::uint16_t frame = 0;  ///< when last asked for, modulo 2^16
        std::uint8_t level = kUnused;
    };
    /// Where a range's vertices stand: the sample before the first one, and the lines across which they go on, by number.
    struct Extent {
        glm::ivec2 from{0};
        glm::ivec2 cells{0};  ///< 0: along the other axis only
        glm::ivec2 count{1};
    };

    glm::ivec2 blockAt(std::uint32_t block) const;
    std::uint32_t cornerRange(glm::ivec2 at) const { return std::uint32_t(at.y * (layout_.blockColumns + 1) + at.x); }
    std::uint32_t horizontalRange(glm::ivec2 at) const {
        return firstHorizontal_ + std::uint32_t(at.y * layout_.blockColumns + at.x);
    }
    std::uint32_t verticalRange(glm::ivec2 at) const {
        return firstVertical_ + std::uint32_t(at.y * (layout_.blockColumns + 1) + at.x);
    }
    std::uint32_t innerRange(std::uint32_t block) const { return firstInner_ + block; }
    std::uint32_t sideRange(glm::ivec2 block, int side) const;
    Extent extent(std::uint32_t range, int level) const;
    glm::ivec2 sampleOf(const Extent& extent, int level, int number) const;
    int lineAt(int line, int cells, int level) const;

    void use(std::uint32_t range, std::uint8_t level);
    void release(Range& range, std::uint32_t number);
    void allocate(const SampleGrid& grid, std::uint32_t number);
    void place(const SampleGrid& grid, std::uint32_t number, bool isNew);
    float detailBeyond(const std::vector<float>& detail, glm::ivec2 block, int side) const;
    void morphBorder(const SampleGrid& grid, std::uint32_t number, float coarse);
    void morphInner(const SampleGrid& grid, const DrawnBlock& drawn, float coarse);

    std::shared_ptr<const GeoMipmapErrors> errors_;
    const BlockLayout layout_;
    std::uint32_t firstHorizontal_, firstVertical_, firstInner_;
    std::vector<Range> ranges_;
    std::vector<std::uint32_t> used_, added_, moved_;           ///< numbers of ranges
    std::map<std::uint32_t, std::vector<std::uint32_t>> free_;  ///< first vertices, by size
    std::vector<std::uint32_t> ids_;
    std::vector<glm::vec3> positions_;
    std::vector<std::uint32_t> samples_, newVertices_;
    std::uint16_t frame_ = 0;
};

}  // namespace terrain
