// The samples that tiles are built from, in other threads and after the traversal that brought them.
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "height/EditLog.h"
#include "height/ResidentRows.h"
#include "height/SampleGate.h"
#include "height/SampleGrid.h"
#include "lod/BoxPyramid.h"

namespace terrain {

/// Samples in the frame of a grid, in memory that lasts: heights of a regular grid, points of a curved one. They change only while
/// the gate is held for that.
class TileSamples {
public:
    /// `owner` keeps the grid's memory; without it, or where heights do not lie one behind the other, they are copied.
    /// `gate`: of who edits that memory; without it nobody does.
    TileSamples(const SampleGrid& grid, const BoxPyramid& boxes, std::shared_ptr<const void> owner,
                std::shared_ptr<SampleGate> gate = nullptr);

    /// Samples of the grid, and its bounds with them, have changed.
    void update(const SampleGrid& grid, const BoxPyramid& boxes, const GridEdits& edits);
    /// To be held while they are read.
    SampleGate& gate() const { return *gate_; }

    int columns() const { return columns_; }
    int rows() const { return rows_; }
    bool isRegular() const { return points_.empty(); }
    const float* heightRow(int row) const { return heights_ + std::size_t(row) * pitch_; }
    const glm::vec3* pointRow(int row) const { return points_.data() + std::size_t(row) * std::size_t(columns_); }
    bool hasHoles() const { return hasHoles_; }
    /// Between the lowest and the highest sample; of points, the size of their box.
    float range() const { return range_; }
    bool isHole(int column, int row) const {
        if (isRegular()) return !std::isfinite(heightRow(row)[column]);
        const glm::vec3& p = pointRow(row)[column];
        return !(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    }
    /// For who reads rows of heights: see there.
    const ResidentRows& residentRows() const { return resident_; }
    /// Bytes of copies.
    std::size_t bytes() const { return copy_.capacity() * sizeof(float) + points_.capacity() * sizeof(glm::vec3); }

private:
    void readBounds(const SampleGrid& grid, const BoxPyramid& boxes);

    int columns_;
    int rows_;
    bool hasHoles_ = false;
    float range_ = 0.0f;
    std::shared_ptr<const void> owner_;
    std::shared_ptr<SampleGate> gate_;
    const float* heights_ = nullptr;
    std::size_t pitch_ = 0;
    ResidentRows resident_;
    std::vector<float> copy_;
    std::vector<glm::vec3> points_;
};

/// What differs between heights and points where a surface is compared with its samples.
struct HeightSamples {
    using Value = float;
    const TileSamples& samples;
    mutable ResidentRows resident = samples.residentRows();
    float at(glm::ivec2 p) const { return samples.heightRow(p.y)[p.x]; }
    static float length(float v) { return std::fabs(v); }
    static glm::vec3 toFrame(float v) { return {0.0f, 0.0f, v}; }
    /// Largest distance of samples [first, last] of a row from start + i * step.
    float rowDeviation(int row, int first, int last, float start, float step) const {
        resident.visit(row);
        const float* sample = samples.heightRow(row) + first;
        float deviation = 0.0f;
#pragma omp simd reduction(max : deviation)
        for (int i = 0; i <= last - first; ++i) {
            const float difference = std::fabs(sample[i] - (start + float(i) * step));
            deviation = deviation > difference ? deviation : difference;
        }
        return deviation;
    }
};

struct PointSamples {
    using Value = glm::vec3;
    const TileSamples& samples;
    glm::vec3 at(glm::ivec2 p) const { return samples.pointRow(p.y)[p.x]; }
    static float length(const glm::vec3& v) { return glm::length(v); }
    static glm::vec3 toFrame(const glm::vec3& v) { return v; }
    float rowDeviation(int row, int first, int last, const glm::vec3& start, const glm::vec3& step) const {
        float deviation = 0.0f;
        for (int i = 0; i <= last - first; ++i)
            deviation = std::max(deviation, glm::length(samples.pointRow(row)[first + i] - (start + float(i) * step)));
        return deviation;
    }
};

}  // namespace terrain
