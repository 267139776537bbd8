// What the readers of height files share: the choice of a channel, and the way from raw samples to a HeightMap.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/Result.h"
#include "height/HeightSource.h"

namespace terrain {

/// Index of the channel to read. Error: `options.channel` out of range, or none chosen among three or more.
Result<int> chooseChannel(const std::string& path, int channelCount, const HeightFileOptions& options);

/// Collects the rows of a file, from north to south, into a HeightMap.
///
/// Samples come as doubles, which hold every 32-bit integer exactly; a height is rounded once, to float, after the scaling. No-data
/// values are compared with the raw sample. What is not finite after that is a hole. Memory, or scratch space for maps of more than
/// `options.samplesInMemory`, fills as rows arrive, so that a header that promises more than the file holds costs nothing.
class HeightMapBuilder {
public:
    /// Error: fewer than 2 x 2 samples, more than fit (`options.maximumSamples`, or an int per side), or no scratch space for them.
    static Result<HeightMapBuilder> create(const std::string& path, std::int64_t columns, std::int64_t rows,
                                           const HeightFileOptions& options);

    /// Scaling and no-data that the file states itself; the options' scaling comes after the file's.
    void setFileScale(double scale, double offset);
    void setFileNoData(double value);
    /// Samples of a floating-point file equal a no-data value when they do so as floats: -9999.9 has no exact double.
    void setFloatingPoint(bool floatingPoint) { floatingPoint_ = floatingPoint; }

    /// `samples`: as many as there are columns. False when there is no space for them, or reading was cancelled: finish() says why.
    bool appendRow(const double* samples);
    /// The map, rows turned so that the first one is the southernmost, once every row has been appended.
    Result<HeightMap> finish() &&;

private:
    HeightMapBuilder() = default;
    bool isHole(double sample) const;
    void tellProgress();

    HeightMap map_;
    ReadProgress* progress_ = nullptr;
    std::optional<ScratchWriter> scratch_;
    std::optional<Error> problem_;
    int missingRows_ = 0;
    std::vector<float> row_;
    double fileScale_ = 1.0;
    double fileOffset_ = 0.0;
    double heightScale_ = 1.0;
    double heightOffset_ = 0.0;
    bool floatingPoint_ = false;
    std::vector<double> noData_;
};

}  // namespace terrain
