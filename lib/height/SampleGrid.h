// The samples that a terrain is drawn from, as a view on memory that somebody else owns.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "base/Result.h"
#include "height/HeightMap.h"
#include "height/ResidentRows.h"

namespace terrain {

/// A grid of columns x rows samples in local coordinates, over a HeightMap or over points (x, y, z per sample).
///
/// The *frame* of the grid is what the algorithms compute in. For a regular grid it is (column, row, height) with
/// `localFromFrame()` taking it to local coordinates; heights may run along any axis of the local coordinates. For a curved grid
/// the frame is the local coordinates themselves.
///
/// The view does not own its samples: it is made for one call and not kept.
class SampleGrid {
public:
    SampleGrid() = default;

    /// Over a map, which must outlive the view.
    explicit SampleGrid(const HeightMap& map);

    /// Over `columns` x `rows` samples of a map from (column, row) on, which must lie in it.
    SampleGrid(const HeightMap& map, int column, int row, int columns, int rows);

    /// Over `columns * rows` points at `xyz` (three floats each, row after row). Finds out whether they lie on a regular grid.
    /// Error: fewer than 2 x 2 samples, or a product that does not fit.
    static Result<SampleGrid> overPoints(const float* xyz, int columns, int rows);

    /// The same samples elsewhere in memory, with the regularity that was found before.
    SampleGrid movedTo(const float* xyz) const;

    /// Columns x rows of the samples from (column, row) on, which must lie in the grid.
    SampleGrid part(int column, int row, int columns, int rows) const;

    /// Whether sizes, kind and frame are the same.
    bool isLike(const SampleGrid& other) const {
        return columns_ == other.columns_ && rows_ == other.rows_ && isRegular() == other.isRegular() &&
               heightAxis_ == other.heightAxis_ && localFromFrame_ == other.localFromFrame_;
    }

    int columns() const { return columns_; }
    int rows() const { return rows_; }
    bool isRegular() const { return heights_ != nullptr; }
    bool contains(int column, int row) const { return column >= 0 && row >= 0 && column < columns_ && row < rows_; }
    std::size_t index(int column, int row) const { return std::size_t(row) * std::size_t(columns_) + std::size_t(column); }

    /// Height of a sample of a regular grid; NaN in a hole.
    float height(int column, int row) const { return heights_[(std::size_t(row) * pitch_ + std::size_t(column)) * stride_]; }
    /// Heights of a row of a regular grid, heightStride() floats from one to the next.
    const float* heightRow(int row) const { return heights_ + std::size_t(row) * pitch_ * stride_; }
    std::size_t heightStride() const { return stride_; }
    /// Position in local coordinates; not finite in a hole.
    glm::vec3 position(int column, int row) const;
    /// Position in the grid's frame.
    glm::vec3 framePosition(int column, int row) const;
    bool isHole(int column, int row) const;
    /// Starts loading a sample that will soon be asked for.
    void prefetch(int column, int row) const {
        const std::size_t sample = std::size_t(row) * pitch_ + std::size_t(column);
        __builtin_prefetch(heights_ ? heights_ + sample * stride_ : points_ + sample * 3);
    }

    /// Who goes over all rows in order calls this with those that are done: over a map in scratch space, their pages need not stay
    /// resident.
    void releaseRows(int firstRow, int count) const {
        if (storage_) storage_->releasePages(std::size_t(heightRow(firstRow) - storage_->data()), std::size_t(count) * pitch_);
    }
    /// For who goes over them in another order.
    ResidentRows residentRows() const { return {storage_, pitch_}; }

    const glm::dmat4& localFromFrame() const { return localFromFrame_; }
    /// Local axis (0, 1, 2) that heights of a regular grid run along.
    int heightAxis() const { return heightAxis_; }

private:
    void findRegularity();

    int columns_ = 0;
    int rows_ = 0;
    const float* heights_ = nullptr;          ///< regular grids only
    std::size_t stride_ = 1;                  ///< floats from one height to the next
    std::size_t pitch_ = 0;                   ///< samples from one row to the next
    const float* points_ = nullptr;           ///< null over a map
    const HeightStorage* storage_ = nullptr;  ///< of a map in scratch space
    int heightAxis_ = 2;
    glm::dmat4 localFromFrame_{1.0};
};

}  // namespace terrain
