// A height map at a multiple of its resolution, made row by row: maps larger than memory.
#pragma once

#include <cstdint>
#include <vector>

#include "height/HeightMap.h"

namespace app {

/// Every cell of a map without holes becomes factor x factor cells: Catmull-Rom splines through the samples, and smaller relief on
/// them, noise whose strength goes on falling by `roughness` from octave to octave. The same arguments give the same heights.
class EnlargedMap {
public:
    /// `relief`: greatest height of the first octave, half a cell of the map wide. The map must outlive this. With a factor of 1
    /// heights are the map's own.
    EnlargedMap(const terrain::HeightMap& map, int factor, double relief, double roughness, std::uint32_t seed);

    int columns() const { return (map_.columns - 1) * factor_ + 1; }
    int rows() const { return (map_.rows - 1) * factor_ + 1; }
    /// All heights lie between these.
    double lowest() const { return lowest_; }
    double highest() const { return highest_; }
    /// Writes columns() heights.
    void makeRow(int row, double* heights) const;

private:
    /// Noise between samples `spacing` apart.
    struct Octave {
        int spacing;
        double relief;
        std::uint32_t seed;
    };
    void addOctave(const Octave& octave, int row, double* heights) const;

    const terrain::HeightMap& map_;
    int factor_;
    double lowest_ = 0.0;
    double highest_ = 0.0;
    std::vector<Octave> octaves_;
};

}  // namespace app
