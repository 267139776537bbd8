#include "height/SampleGrid.h"

#include <algorithm>
#include <limits>
#include <string>

namespace terrain {

namespace {

bool isFinite(const glm::vec3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

}  // namespace

SampleGrid::SampleGrid(const HeightMap& map) : SampleGrid(map, 0, 0, map.columns, map.rows) {}

SampleGrid::SampleGrid(const HeightMap& map, int column, int row, int columns, int rows)
    : columns_(columns), rows_(rows),
      heights_(map.heights.data() + std::size_t(row) * std::size_t(map.columns) + std::size_t(column)),
      pitch_(std::size_t(map.columns)), storage_(map.heights.isMapped() ? &map.heights : nullptr) {
    localFromFrame_[0] = glm::dvec4(map.spacing.x, 0.0, 0.0, 0.0);
    localFromFrame_[1] = glm::dvec4(0.0, map.spacing.y, 0.0, 0.0);
    localFromFrame_[3] = glm::dvec4(map.origin + map.spacing * glm::dvec2(column, row), 0.0, 1.0);
}

Result<SampleGrid> SampleGrid::overPoints(const float* xyz, int columns, int rows) {
    if (columns < 2 || rows < 2)
        return Error{"terrain grid", "at least 2 x 2 samples", std::to_string(columns) + " x " + std::to_string(rows)};
    if (std::size_t(columns) > std::size_t(std::numeric_limits<int>::max()) / std::size_t(rows))
        return Error{"terrain grid", "at most 2^31 samples", std::to_string(columns) + " x " + std::to_string(rows)};
    SampleGrid grid;
    grid.columns_ = columns;
    grid.rows_ = rows;
    grid.points_ = xyz;
    grid.pitch_ = std::size_t(columns);
    grid.findRegularity();
    return grid;
}

SampleGrid SampleGrid::movedTo(const float* xyz) const {
    SampleGrid grid = *this;
    grid.points_ = xyz;
    if (grid.heights_) grid.heights_ = xyz + heightAxis_;
    return grid;
}

SampleGrid SampleGrid::part(int column, int row, int columns, int rows) const {
    const std::size_t first = std::size_t(row) * pitch_ + std::size_t(column);
    SampleGrid grid = *this;
    grid.columns_ = columns;
    grid.rows_ = rows;
    if (heights_) {
        grid.heights_ += first * stride_;
        const glm::dvec4 moved = localFromFrame_ * glm::dvec4(column, row, 0.0, 1.0);
        grid.localFromFrame_[3] = moved;
    }
    if (points_) grid.points_ += first * 3;
    return grid;
}

glm::vec3 SampleGrid::position(int column, int row) const {
    if (points_) {
        const float* p = points_ + (std::size_t(row) * pitch_ + std::size_t(column)) * 3;
        return {p[0], p[1], p[2]};
    }
    return {float(localFromFrame_[3][0] + localFromFrame_[0][0] * column),
            float(localFromFrame_[3][1] + localFromFrame_[1][1] * row), height(column, row)};
}

glm::vec3 SampleGrid::framePosition(int column, int row) const {
    return isRegular() ? glm::vec3(float(column), float(row), height(column, row)) : position(column, row);
}

bool SampleGrid::isHole(int column, int row) const {
    return isRegular() ? !std::isfinite(height(column, row)) : !isFinite(position(column, row));
}

void SampleGrid::findRegularity() {
    // Heights along z first, then y (the habit of VRML), then x; columns run along one of the other axes, rows along the last.
    constexpr int candidates[6][3] = {{0, 1, 2}, {1, 0, 2}, {0, 2, 1}, {2, 0, 1}, {1, 2, 0}, {2, 1, 0}};
    const auto at = [this](int column, int row, int axis) { return points_[index(column, row) * 3 + std::size_t(axis)]; };
    for (const auto& [columnAxis, rowAxis, heightAxis] : candidates) {
        const double originColumn = at(0, 0, columnAxis), originRow = at(0, 0, rowAxis);
        const double stepColumn = (double(at(columns_ - 1, 0, columnAxis)) - originColumn) / (columns_ - 1);
        const double stepRow = (double(at(0, rows_ - 1, rowAxis)) - originRow) / (rows_ - 1);
        if (!std::isfinite(stepColumn) || !std::isfinite(stepRow) || stepColumn == 0.0 || stepRow == 0.0) continue;
        // Coordinates are floats: a thousandth of a cell, or what rounding at this distance from zero gives.
        constexpr double epsilon = std::numeric_limits<float>::epsilon();
        const double farColumn = std::max(std::fabs(originColumn), std::fabs(originColumn + stepColumn * (columns_ - 1)));
        const double farRow = std::max(std::fabs(originRow), std::fabs(originRow + stepRow * (rows_ - 1)));
        const double toleranceColumn = 1e-3 * std::fabs(stepColumn) + epsilon * farColumn;
        const double toleranceRow = 1e-3 * std::fabs(stepRow) + epsilon * farRow;
        bool regular = true;
        for (int row = 0; row < rows_ && regular; ++row)
            for (int column = 0; column < columns_ && regular; ++column)
                regular = !std::isfinite(at(column, row, heightAxis)) ||
                          (std::fabs(at(column, row, columnAxis) - (originColumn + stepColumn * column)) <= toleranceColumn &&
                           std::fabs(at(column, row, rowAxis) - (originRow + stepRow * row)) <= toleranceRow);
        if (!regular) continue;
        heightAxis_ = heightAxis;
        heights_ = points_ + heightAxis;
        stride_ = 3;
        localFromFrame_ = glm::dmat4(0.0);
        localFromFrame_[0][columnAxis] = stepColumn;
        localFromFrame_[1][rowAxis] = stepRow;
        localFromFrame_[2][heightAxis] = 1.0;
        localFromFrame_[3] = glm::dvec4(0.0, 0.0, 0.0, 1.0);
        localFromFrame_[3][columnAxis] = originColumn;
        localFromFrame_[3][rowAxis] = originRow;
        return;
    }
}

}  // namespace terrain
