// A raster of heights: what every file and procedure is decoded to.
#pragma once

#include <cstddef>
#include <string>

#include <glm/vec2.hpp>

#include "height/HeightStorage.h"

namespace terrain {

/// Regular grid of heights.
///
/// Layout: `heights[row * columns + column]`, row 0 at the smallest y, so that the top row of an image (its north edge) is the last
/// row here. A hole (no data) is NaN; no other value is special. Sample (column, row) stands at
/// `origin + spacing * (column, row)`; heights and coordinates are in the source's own units.
struct HeightMap {
    int columns = 0;
    int rows = 0;
    HeightStorage heights;  ///< in memory, or in scratch space when they are many
    glm::dvec2 origin{0.0, 0.0};
    glm::dvec2 spacing{1.0, 1.0};
    std::string projection;  ///< WKT of the coordinate system, empty when the source has none

    float at(int column, int row) const { return heights[std::size_t(row) * std::size_t(columns) + std::size_t(column)]; }

    /// Who goes over the rows in order calls this with those that are done: their pages need not stay resident.
    void releaseRows(int firstRow, int count) const {
        heights.releasePages(std::size_t(firstRow) * std::size_t(columns), std::size_t(count) * std::size_t(columns));
    }
};

}  // namespace terrain
