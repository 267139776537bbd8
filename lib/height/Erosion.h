// Erosion of height maps: rivers, droplets of rain, and crumbling slopes.
#pragma once

#include <cstdint>

#include "base/Result.h"
#include "height/HeightMap.h"

namespace terrain {

/// Rivers by the stream power law dz/dt = U - K * sqrt(A) * S, solved implicitly from the mouths upwards: Braun and Willett, "A
/// very efficient O(n), implicit and parallel method to solve the stream power equation", Geomorphology 180, 2013; over pits water
/// finds its way by the priority flood of Barnes et al., 2014. A is the drained area and S the slope, both in the map's units, so
/// that one set of values fits every spacing. Rivers end at the map's border, which does not rise and sinks with the land behind
/// it.
struct RiverParameters {
    int steps = 50;
    double uplift = 2.0;   ///< U: height that a step adds where the uplift map is 1
    double erosion = 0.3;  ///< K of a step
    double creep = 2.0;    ///< diffusion of soil in a step (an area): rounds ridges, and with K sets how far apart valleys lie
    double talus = 1.0;    ///< steepest slope (rise over run) that a bank keeps
};

/// Droplets that run downhill, pick sediment up where they speed up and drop it where they slow down, after H. T. Beyer,
/// "Implementation of a method for hydraulic erosion", TU Munich, 2015. Slopes are rise over run.
struct DropletParameters {
    int droplets = 100000;
    std::uint32_t seed = 1;
    int lifetime = 64;          ///< steps of one cell
    int radius = 3;             ///< cells around the path over which a change is spread
    double inertia = 0.05;      ///< 0: straight downhill, 1: straight on
    double capacity = 3.0;      ///< sediment per speed, water and slope
    double erosion = 0.3;       ///< part of the free capacity that is taken up in a step
    double deposition = 0.1;    ///< part of the surplus that is dropped in a step
    double evaporation = 0.02;  ///< part of the water that goes in a step
};

/// Slopes above the angle of repose slide onto their lower neighbours (Musgrave, Kolb and Mace, "The synthesis and rendering of
/// eroded fractal terrains", SIGGRAPH 1989, section 3.2).
struct ThermalParameters {
    int iterations = 10;
    double talus = 0.8;  ///< slope (rise over run) that stays
    double rate = 0.5;   ///< part of the surplus that slides in an iteration, up to 1
};

/// Each takes a map and returns it eroded; holes stay holes, and nothing flows through them. The same map and parameters give the
/// same result. Errors: fewer than 2 x 2 samples, negative counts, parameters out of range.
///
/// `upliftMap`: as large as the map, factors of `uplift`; holes count as 0.
Result<HeightMap> erodeByRivers(HeightMap map, const HeightMap& upliftMap, const RiverParameters& parameters);
Result<HeightMap> erodeByDroplets(HeightMap map, const DropletParameters& parameters);
Result<HeightMap> erodeThermally(HeightMap map, const ThermalParameters& parameters);

}  // namespace terrain
