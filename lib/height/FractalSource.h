// Procedural terrain: midpoint displacement, smoothed by the filter of "Zobrazovani krajiny a jeho optimalizace pomoci ROAM
// algoritmu", ch. 4.3.
#pragma once

#include <cstdint>
#include <memory>

#include "base/Result.h"
#include "height/HeightSource.h"

namespace terrain {

/// Parameters of the fractal terrain. The same parameters give the same heights, bit for bit, on every machine.
struct FractalParameters {
    int columns = 1025;
    int rows = 1025;                 ///< any size from 2; made in the next 2^n+1 square and cut
    double roughness = 0.5;          ///< factor of the displacement from one level to the next, in (0, 1)
    std::uint32_t seed = 1;
    int filterPasses = 0;            ///< times the filter runs over the map (ch. 4.3.3)
    double filterCoefficient = 0.8;  ///< h = h_neighbour * (1 - k) + h * k, k in (0, 1]; 0.6 is strong, 0.9 weak
    double amplitude = 1.0;          ///< heights lie in [0, amplitude]
};

Result<HeightMap> makeFractalMap(const FractalParameters& parameters);
Result<std::shared_ptr<const HeightSource>> makeFractalSource(const FractalParameters& parameters);

}  // namespace terrain
