#include "lod/GeoMipmapMesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/common.hpp>

#include "base/ProfileScope.h"
#include "lod/BruteForceMesh.h"

namespace terrain {

GeoMipmapMesh::GeoMipmapMesh(std::shared_ptr<GeoMipmapErrors> errors)
    : errors_(std::move(errors)), layout_(errors_->layout()), vertices_(errors_), detail_(layout_), factor_(layout_.blockCount()),
      queued_(layout_.blockCount()), emitted_(layout_.blockCount()) {}

DrawList GeoMipmapMesh::select(const SampleGrid& grid, const View& view, const LodSettings& settings) {
    const ProfileScope scope("geo mip-mapping: select");
    vertices_.forgetNewVertices();
    DrawList drawList;
    if (view_ != view || settings_ != settings || !edits_.isEmpty()) {
        // Of blocks that have changed, diagonals and holes may be others.
        const GridEdits edits = std::exchange(edits_, {});
        const bool otherTriangles = !view_ || !edits.isEmpty() || settings_.clockwise != settings.clockwise ||
                                    settings_.geomorph != settings.geomorph ||
                                    (settings_.pixelError > 0.0f) != (settings.pixelError > 0.0f);
        view_ = view;
        settings_ = settings;
        morphing_ = settings.geomorph && settings.pixelError > 0.0f;
        limit_ = morphing_ ? morphStart(settings.pixelError) : settings.pixelError;
        choose(grid);
        settle();
        list();
        if (otherTriangles || drawn_ != drawnBefore_) {
            vertices_.update(grid, drawn_, drawnBefore_);
            vertices_.placeAgain(grid, drawn_, edits);
            emit(grid, otherTriangles);
            drawList.indicesChanged = true;
            drawList.positionsChanged = !vertices_.newVertices().empty();
        }
        if (vertices_.morph(grid, sliding_, detail_)) drawList.positionsChanged = true;
        report_ = {};
        report_.triangles = std::uint32_t(indexCount_ / 3);
        report_.patches = std::uint32_t(drawn_.size());
        report_.errorPixels = boundError();
    }
    drawList.positions = vertices_.positions();
    drawList.samples = vertices_.samples();
    drawList.indices = {indices_.data(), indexCount_};
    drawList.newVertices = vertices_.newVertices();
    drawList.report = report_;
    return drawList;
}

bool GeoMipmapMesh::update(const SampleGrid& grid, const GridEdits& edits) {
    errors_->follow(grid);
    edits_.include(edits);
    return true;
}

void GeoMipmapMesh::list() {
    drawnBefore_.swap(drawn_);
    drawn_.clear();
    sliding_.clear();
    for (const BlockAt& at : chosen_) {
        const float detail = detail_[at];
        DrawnBlock drawn{at, std::uint8_t(detail), {}};
        for (int side = 0; side < 4; ++side)
            drawn.border[std::size_t(side)] = std::uint8_t(std::max(detail, detail_.beyond(at, side)));
        if (detail > float(drawn.level)) sliding_.push_back(drawn);
        if (!settings_.cull || !std::signbit(factor_[at.number])) drawn_.push_back(drawn);
    }
}

/// What is drawn of most blocks is what was drawn before, and many in a row: their indices are copied.
void GeoMipmapMesh::emit(const SampleGrid& grid, bool everything) {
    indices_.swap(indicesBefore_);
    indexCount_ = 0;
    IndexRange run;
    const auto copyRun = [&] {
        makeRoom(run.count);
        std::copy_n(indicesBefore_.data() + run.first, run.count, indices_.data() + indexCount_);
        indexCount_ += run.count;
    };
    for (const DrawnBlock& drawn : drawn_) {
        IndexRange& range = emitted_[drawn.at.number];
        if (!everything && vertices_.isAsBefore(drawn)) {
            if (run.first + run.count != range.first) {
                copyRun();
                run = {range.first, 0};
            }
            range.first = std::uint32_t(indexCount_) + run.count;
            run.count += range.count;
            continue;
        }
        copyRun();
        run = {};
        range.first = std::uint32_t(indexCount_);
        emitBlock(grid, drawn);
        range.count = std::uint32_t(indexCount_) - range.first;
    }
    copyRun();
}

void GeoMipmapMesh::makeRoom(std::size_t count) {
    if (indexCount_ + count > indices_.size()) indices_.resize(std::max(indexCount_ + count, 2 * indices_.size()));
}

void GeoMipmapMesh::emitBlock(const SampleGrid& grid, const DrawnBlock& drawn) {
    const std::uint32_t* vertices = vertices_.of(drawn);
    const GeoMipmapShape& shape = errors_->shape(drawn.at.column, drawn.at.row);
    const bool holes = errors_->hasHoles(drawn.at.number);
    if (drawn.level == layout_.exponent) return emitTriangles(shape.flat(errors_->hasOtherDiagonal(drawn.at.number)), vertices);
    if (drawn.level == 0 && !morphing_ && drawn.border == std::array<std::uint8_t, 4>{}) {
        if (holes) return emitSolid(grid, drawn, shape.cells(), vertices);
        return emitTriangles(shape.cells(), vertices);
    }
    if (holes)
        emitSolid(grid, drawn, shape.inner(drawn.level), vertices);
    else
        emitTriangles(shape.inner(drawn.level), vertices);
    for (int side = 0; side < 4; ++side) {
        const int border = drawn.border[std::size_t(side)];
        // A border that is coarser has no hole along it.
        if (holes && border == 0)
            emitSolid(grid, drawn, shape.side(side, 0, 0), vertices);
        else
            emitTriangles(shape.side(side, drawn.level, border), vertices);
    }
}

void GeoMipmapMesh::emitTriangles(std::span<const GeoMipmapShape::Triangle> triangles, const std::uint32_t* vertices) {
    makeRoom(3 * triangles.size());
    std::uint32_t* out = indices_.data() + indexCount_;
    indexCount_ += 3 * triangles.size();
    const std::size_t second = settings_.clockwise ? 2 : 1, third = 3 - second;
    for (const GeoMipmapShape::Triangle& triangle : triangles) {
        *out++ = vertices[triangle[0]];
        *out++ = vertices[triangle[second]];
        *out++ = vertices[triangle[third]];
    }
}

/// Triangles of the finest level, without those in cells that are holes.
void GeoMipmapMesh::emitSolid(const SampleGrid& grid, const DrawnBlock& drawn, std::span<const GeoMipmapShape::Triangle> triangles,
                              const std::uint32_t* vertices) {
    const GeoMipmapShape& shape = errors_->shape(drawn.at.column, drawn.at.row);
    const glm::ivec2 from = glm::ivec2(drawn.at.column, drawn.at.row) * layout_.tileSize;
    for (const GeoMipmapShape::Triangle& triangle : triangles) {
        const glm::ivec2 cell = from + glm::min(shape.at(triangle[0]), glm::min(shape.at(triangle[1]), shape.at(triangle[2])));
        if (!isCellHole(grid, cell.x, cell.y)) emitTriangles({&triangle, 1}, vertices);
    }
}

std::size_t GeoMipmapMesh::bytes() const {
    const auto held = [](const auto& items) { return items.capacity() * sizeof(items[0]); };
    // Its share of the table, which meshes and their vertices refer to.
    const std::size_t table = 2 * errors_->bytes() / std::size_t(std::max(2L, errors_.use_count()));
    return table + vertices_.bytes() + detail_.bytes() + held(factor_) + queued_.capacity() / 8 + held(chosen_) + held(queue_) +
           held(drawn_) + held(drawnBefore_) + held(sliding_) + held(indices_) + held(indicesBefore_) + held(emitted_);
}

int GeoMipmapMesh::level(int blockColumn, int blockRow) const {
    const float detail =
        detail_[{std::uint32_t(layout_.block(blockColumn, blockRow)), std::uint16_t(blockColumn), std::uint16_t(blockRow)}];
    return detail == kHidden ? -1 : int(detail);
}

}  // namespace terrain
