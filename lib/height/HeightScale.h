// From the samples of a file to heights, and from one such scale to another without the file.
#pragma once

#include <memory>

#include "base/Result.h"
#include "height/MapSource.h"

namespace terrain {

/// The lowest and the highest height of a map; low is above high where all are holes.
struct HeightRange {
    float low = 0.0f;
    float high = 0.0f;

    explicit HeightRange(const HeightMap& map);
    /// Half a bit of the largest height, in parts of the range: what is lost of samples that are told from heights. Infinite where
    /// all heights are the same.
    double rounding() const;
};

/// height = offset + scale * sample.
struct HeightScale {
    float scale = 1.0f;
    float offset = 0.0f;

    bool operator==(const HeightScale&) const = default;
    /// Whether heights of this range give others by another scale: all samples can be told from them, and none becomes too large
    /// for a float.
    bool leadsTo(const HeightScale& other, const HeightRange& range) const;
    /// The height that another scale gives the sample of a height.
    double converted(float height, const HeightScale& other) const {
        return (double(height) - offset) / scale * other.scale + other.offset;
    }
};

/// The heights that the samples have by another scale, which `from` must lead to, in a map of its own where the source stands. A
/// hole stays one. Error: no scratch space for a map that lies there.
Result<std::shared_ptr<MapSource>> rescaled(const MapSource& source, const HeightScale& from, const HeightScale& to);

}  // namespace terrain
