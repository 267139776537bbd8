// Errors of one level of a geometry clipmap, found row by row of samples.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <glm/vec3.hpp>

#include "height/SampleGrid.h"

namespace terrain {

/// Largest errors in blocks of kBlockCells x kBlockCells cells of a level, their borders included; see ClipmapErrors for what they
/// are. Takes the samples of the grid once, in order, and of the level's own vertices a row ahead. Blocks with holes get any value.
class ClipmapScan {
public:
    static constexpr int kBlockCells = 8;

    /// `coarsest`: blending errors are not looked for.
    ClipmapScan(const SampleGrid& grid, int level, bool coarsest);

    /// The next row of samples: heights of a regular grid in samples[0]; x, y, z of a curved one.
    void addRow(const SampleGrid& grid, const std::array<const float*, 3>& samples);

    int blockColumns() const { return blockColumns_; }
    int blockRows() const { return blockRows_; }
    /// Row after row, complete after the last row; empty where all are 0 (plain errors of level 0) or not looked for.
    std::vector<float>&& plain() { return std::move(plain_); }
    std::vector<float>&& blending() { return std::move(blending_); }

private:
    /// A quantity known at the vertices, over a row of cells. At sample x and share u of the row's height it is
    /// base + u slope + max(0, u - turn) fold, where 1 - turn is the sample's share of the cell's width.
    struct Channel {
        std::vector<float> low, high;          ///< by vertex
        std::vector<float> base, slope, fold;  ///< by sample
    };
    struct Peaks {
        std::vector<float> plain, blending;  ///< by column of samples
    };
    void beginCells(const SampleGrid& grid);
    void readVertices(const SampleGrid& grid, int vertexRow);
    void expand(Channel& channel) const;
    void measure(const std::array<const float*, 3>& samples);
    void finishBlocks(const Peaks& peaks);
    void finishBlocks(const std::vector<float>& peaks, std::vector<float>& blocks) const;

    int level_;
    bool blend_;
    bool regular_;
    int lastColumn_, lastRow_;
    int cells_;
    int blockColumns_, blockRows_;
    int row_ = 0;
    int cellRow_ = 0, cellHeight_ = 1;  ///< first sample of the row of cells, and samples to the next
    std::vector<Channel> channels_;     ///< regular: height, rising and falling part of the difference; curved: x, y, z, difference
    std::vector<float> turn_;           ///< by sample
    std::vector<float> pairs_;
    std::vector<glm::vec3> positions_;
    Peaks peaks_, before_;
    std::vector<float> plain_, blending_;
};

}  // namespace terrain
