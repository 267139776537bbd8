// Where heights come from: one interface over memory, images, rasters, raw files and procedures.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "base/Result.h"
#include "height/HeightMap.h"

namespace terrain {

/// Size and place of a source's full-resolution grid (level 0).
struct HeightExtent {
    int columns = 0;
    int rows = 0;
    glm::dvec2 origin{0.0, 0.0};   ///< position of sample (0, 0)
    glm::dvec2 spacing{1.0, 1.0};  ///< distance between neighbouring columns and rows
};

/// Names a square tile of a source's level pyramid: `cells` x `cells` cells at a stride of 2^level samples, whose first sample is
/// (column, row) * cells * 2^level of level 0.
struct TileKey {
    int level = 0;
    int column = 0;
    int row = 0;
    int cells = 64;

    bool operator==(const TileKey&) const = default;
};

/// Immutable samples of one tile: (columns x rows), at most (cells + 1) x (cells + 1); fewer where the map ends.
/// Neighbouring tiles of a level share their border samples.
struct HeightTile {
    TileKey key;
    int columns = 0;
    int rows = 0;
    std::vector<float> heights;  ///< layout as HeightMap
    float minimum = 0.0f;        ///< over the valid samples of the *full-resolution* area; NaN when there is none
    float maximum = 0.0f;
};

class MapSource;

/// A source of heights. Immutable after opening, but for what editable() says; every member may be called from any thread.
class HeightSource : public std::enable_shared_from_this<HeightSource> {
public:
    virtual ~HeightSource() = default;

    virtual HeightExtent extent() const = 0;
    /// Levels of the pyramid: 1 for a single cell, one more for every doubling of the longer side.
    virtual int levelCount() const = 0;
    /// Samples of one tile; an Error for a key outside the pyramid or an unreadable file.
    virtual Result<HeightTile> load(const TileKey& key) const = 0;
    /// The whole of level 0 when it can be read like memory, else null. Lives as long as the source.
    virtual const HeightMap* map() const { return nullptr; }
    /// Where samples may change: their log and gate (MapSource.h). Else null.
    virtual const MapSource* editable() const { return nullptr; }
    /// Bytes of memory that the source holds, without what it has in scratch space.
    virtual std::size_t bytes() const = 0;
};

/// Pixel type of a headerless file.
enum class RawType { UInt8, UInt16LittleEndian, UInt16BigEndian };

/// How far the reading of a file is, and whether it is to stop. For the reader and for who waits for it, in any threads.
struct ReadProgress {
    std::atomic<float> part{-1.0f};        ///< of the rows, 0 to 1; below 0 while that is unknown
    std::atomic<bool> isCancelled{false};  ///< an Error follows soon
};

/// How a file is to be read. Fields that do not apply to a kind of file are ignored by it.
struct HeightFileOptions {
    int channel = -1;          ///< -1: the only channel (a file with three or more channels is an error); else its index
    glm::ivec2 rawSize{0, 0};  ///< columns and rows of a headerless file; (0, 0): a square, from the file's length
    RawType rawType = RawType::UInt8;
    std::optional<glm::dvec2> spacing;  ///< overrides the file's own
    std::optional<glm::dvec2> origin;   ///< overrides the file's own
    double heightScale = 1.0;           ///< height = sample * heightScale + heightOffset
    double heightOffset = 0.0;
    std::optional<double> noData;  ///< sample value (before scaling) that marks a hole, beside the file's own and NaN
    /// A map of more samples than these (256 MiB) is decoded into scratch space on disk, 4 bytes each: an unnamed file in the
    /// directory for temporary files (TMPDIR), of which only what is looked at takes memory.
    std::uint64_t samplesInMemory = std::uint64_t(1) << 26;
    /// A file that holds, or only promises, more samples than these is an error: 64 GiB of heights, or less for who is in a hurry.
    std::uint64_t maximumSamples = std::uint64_t(1) << 34;
    ReadProgress* progress = nullptr;  ///< told of every row; outlives the call
};

/// Opens any file this build can read: ".raw" by rawSize and rawType, GDAL's georeferenced rasters, images by OpenImageIO.
/// Errors: missing or unreadable file, truncated data, channel out of range, three channels and none chosen, fewer than 2 x 2
/// samples, no scratch space for a large map.
Result<std::shared_ptr<const HeightSource>> openHeightFile(const std::string& path, const HeightFileOptions& options);
/// The same as a map.
Result<HeightMap> readHeightFile(const std::string& path, const HeightFileOptions& options);

/// The source over a map (takes the map). Error: fewer than 2 x 2 samples, or sizes that do not match the samples.
Result<std::shared_ptr<const HeightSource>> makeMapSource(HeightMap map);

}  // namespace terrain
