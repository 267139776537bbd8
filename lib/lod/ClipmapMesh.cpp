#include "lod/ClipmapMesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/ProfileScope.h"
#include "lod/ClipmapSurface.h"

namespace terrain {

namespace {

/// The part `share` of the way from a level's own value to the coarser one's.
template <class Value>
Value blended(const Value& own, const Value& coarser, float share) {
    return share == 1.0f ? coarser : own + (coarser - own) * share;
}

/// The two (or one) runs of texels that vertices first to last have along an axis: run(first vertex, count).
template <class Run>
void forRuns(const ClipmapLayout& layout, int first, int last, const Run& run) {
    while (first <= last) {
        const int count = std::min(last - first + 1, layout.pitch() - layout.texel(first));
        run(first, count);
        first += count;
    }
}

ClipmapShape withSize(ClipmapShape shape, int size) {
    shape.size = size;
    return shape;
}

}  // namespace

ClipmapMesh::ClipmapMesh(const ClipmapLayout& layout, const ClipmapSettings& settings, std::shared_ptr<const BoxPyramid> boxes,
                         Errors errors, std::shared_ptr<const SynthesisedDetail> detail)
    : layout_(layout), options_(settings), boxes_(std::move(boxes)), errors_(std::move(errors)), detail_(std::move(detail)),
      clipmap_(layout) {
    options_.detail = detail_.get();
    start(layout);
}

ClipmapMesh::ClipmapMesh(int columns, int rows, const ClipmapShape& shape, const ClipmapSettings& settings,
                         std::shared_ptr<const BoxPyramid> boxes, Errors errors, std::shared_ptr<const SynthesisedDetail> detail)
    : ClipmapMesh(ClipmapLayout(columns, rows, withSize(shape, shape.size == 0 ? ClipmapShape{}.size : shape.size)), settings,
                  std::move(boxes), std::move(errors), std::move(detail)) {
    if (shape.size == 0) anySize_ = shape;
}

void ClipmapMesh::start(const ClipmapLayout& layout) {
    layout_ = layout;
    clipmap_ = Clipmap(layout);
    const std::size_t pitch = std::size_t(layout.pitch());
    levels_.assign(std::size_t(layout.levels()), {});
    for (Level& level : levels_) {
        level.chunks.resize((pitch / kChunk) * (pitch / kChunk));
        for (const int axis : {0, 1}) {
            level.share[axis].resize(pitch);
            level.place[axis].resize(pitch);
        }
    }
    free_ = {};
    placeCount_ = 0;
    drawn_.clear();
}

void ClipmapMesh::fitSize(const SampleGrid& grid, const View& view) {
    const int size = smallestClipmap(grid, *boxes_, errorsUsed_.get(), view, *anySize_, options_, isFitted_ ? layout_.size() : 0);
    isFitted_ = errorsUsed_ != nullptr;
    if (size != layout_.size()) start(ClipmapLayout(grid.columns(), grid.rows(), withSize(*anySize_, size)));
}

DrawList ClipmapMesh::select(const SampleGrid& grid, const View& view, const LodSettings& settings) {
    const ProfileScope scope("clipmap: select and list");
    newVertices_.clear();
    DrawList list;
    const std::shared_ptr<const ClipmapErrors> errors = errors_ ? errors_(grid) : nullptr;
    if (view_ != view || settings_ != settings || errorsUsed_ != errors || wasEdited_ || !report_.converged) {
        wasEdited_ = false;
        const bool turned = !view_ || settings_.clockwise != settings.clockwise;
        view_ = view;
        settings_ = settings;
        errorsUsed_ = errors;
        findAxes(grid);
        options_.pixelError = settings.pixelError;
        options_.cull = settings.cull;
        if (anySize_) fitSize(grid, view);
        const Clipmap::Frame& frame = clipmap_.select(grid, *boxes_, errors.get(), view, options_);
        for (const ClipmapUpdates::Update& update : frame.updates) store(grid, update);
        useChunks(frame.patches);
        assignPlaces();
        nameVertices(grid, frame.updates);
        list.positionsChanged = placesChanged_;
        for (int level = frame.finest; level < layout_.levels(); ++level) {
            share(grid, level, frame);
            if (writePositions(grid, level)) list.positionsChanged = true;
        }
        if (turned || placesChanged_ || std::exchange(holesChanged_, false) || !std::equal(std::begin(drawn_.by), std::end(drawn_.by), frame.patches.by)) {
            emit(frame.patches);
            drawn_ = frame.patches;
            list.indicesChanged = true;
        }
        report_ = frame.report;
        report_.triangles = std::uint32_t(indexCount_ / 3);
    }
    list.positions = positions_;
    list.samples = samples_;
    list.places = places_;
    list.indices = {indices_.data(), indexCount_};
    list.seamIndices = indexCount_ - firstSeam_;
    list.newVertices = newVertices_;
    list.report = report_;
    return list;
}

bool ClipmapMesh::update(const SampleGrid&, const GridEdits& edits) {
    clipmap_.update(edits);
    wasEdited_ = true;
    holesChanged_ = holesChanged_ || edits.holes;
    return true;
}

void ClipmapMesh::findAxes(const SampleGrid& grid) {
    heightAxis_ = grid.heightAxis();
    for (int axis = 0; axis < 3; ++axis) {
        if (grid.localFromFrame()[0][axis] != 0.0) columnAxis_ = axis;
        if (grid.localFromFrame()[1][axis] != 0.0) rowAxis_ = axis;
    }
}

void ClipmapMesh::store(const SampleGrid& grid, const ClipmapUpdates::Update& update) {
    Level& level = levels_[std::size_t(update.level)];
    const ClipRect& rect = update.rect;
    const std::size_t texels = std::size_t(layout_.pitch()) * std::size_t(layout_.pitch()), columns = std::size_t(rect.columns());
    const bool regular = grid.isRegular();
    if (regular) {
        level.heights.resize(texels);
        scratch_.resize(2 * std::size_t(rect.samples()));
        const int source = layout_.sourceLevel(update.level);
        if (source < 0)
            fillDetail(grid, -source, rect);
        else
            fillLevel(grid, source, rect, scratch_.data());
    } else {
        level.points.resize(2 * texels);
        points_.resize(2 * std::size_t(rect.samples()));
        fillLevel(grid, layout_.sourceLevel(update.level), rect, points_.data());
    }
    for (int row = rect.low.y; row <= rect.high.y; ++row)
        forRuns(layout_, rect.low.x, rect.high.x, [&](int first, int count) {
            const std::size_t from = std::size_t(row - rect.low.y) * columns + std::size_t(first - rect.low.x);
            const std::size_t to = texelIndex({first, row});
            if (regular) {
                for (std::size_t i = 0; i < std::size_t(count); ++i)
                    level.heights[to + i] = {scratch_[2 * (from + i)], scratch_[2 * (from + i) + 1]};
            } else {
                std::copy_n(points_.data() + 2 * from, 2 * count, level.points.data() + 2 * to);
            }
        });
    for (int row = rect.low.y / kChunk; row <= rect.high.y / kChunk; ++row)
        for (int column = rect.low.x / kChunk; column <= rect.high.x / kChunk; ++column)
            level.chunks[chunkIndex(glm::ivec2(column, row) * kChunk)].written = false;
}

/// Synthesised heights of vertices of detail level `level`, and what the triangles of the level before show there, to scratch_.
void ClipmapMesh::fillDetail(const SampleGrid& grid, int level, const ClipRect& rect) {
    const ClipRect all{glm::ivec2(0), SynthesisedDetail::lastVertex(grid, level)};
    const ClipRect around = rect.shrunk(-1).cutTo(all);
    std::vector<float> heights(std::size_t(around.samples()));
    detail_->fill(grid, level, around, heights.data());
    const std::ptrdiff_t pitch = around.columns();
    float* out = scratch_.data();
    for (int y = rect.low.y; y <= rect.high.y; ++y)
        for (int x = rect.low.x; x <= rect.high.x; ++x) {
            const float* at = heights.data() + std::ptrdiff_t(y - around.low.y) * pitch + (x - around.low.x);
            // The last vertices of a level of detail are even: both ends of the coarser edge are there.
            const std::ptrdiff_t step = (x % 2 != 0 ? 1 : 0) - (y % 2 != 0 ? pitch : 0);
            const float coarser = step == 0 ? *at : (at[step] + at[-step]) * 0.5f;
            *out++ = *at;
            *out++ = std::isfinite(coarser) ? coarser : *at;
        }
}

void ClipmapMesh::useChunks(const ClipmapPatches& patches) {
    for (Level& level : levels_)
        for (Chunk& chunk : level.chunks) chunk.used = chunk.isNew = false;
    for (const auto& list : patches.by)
        for (const ClipmapPatch& patch : list) {
            auto& chunks = levels_[std::size_t(patch.level)].chunks;
            for (int row = patch.low.y / kChunk; row <= patch.high.y / kChunk; ++row)
                for (int column = patch.low.x / kChunk; column <= patch.high.x / kChunk; ++column)
                    chunks[chunkIndex(glm::ivec2(column, row) * kChunk)].used = true;
        }
}

void ClipmapMesh::assignPlaces() {
    placesChanged_ = false;
    for (Level& level : levels_)
        for (Chunk& chunk : level.chunks) {
            if (chunk.used || chunk.place == kNoPlace) continue;
            free_.push(chunk.place);
            chunk.place = kNoPlace;
        }
    std::uint32_t end = 0;
    for (Level& level : levels_)
        for (Chunk& chunk : level.chunks) {
            if (chunk.used && chunk.place == kNoPlace) {
                if (free_.empty()) free_.push(placeCount_++);
                chunk.place = free_.top();
                chunk.isNew = true;
                chunk.written = false;
                free_.pop();
                placesChanged_ = true;
            }
            if (chunk.used) end = std::max(end, chunk.place + 1);
        }
    const std::size_t vertices = std::size_t(end) * kChunkVertices;
    placesChanged_ = placesChanged_ || vertices != positions_.size();
    positions_.resize(vertices, glm::vec3(0.0f));
    samples_.resize(vertices, 0);
    if (layout_.detailLevels() > 0) places_.resize(vertices, glm::vec2(0.0f));
}

void ClipmapMesh::nameVertex(const SampleGrid& grid, int level, glm::ivec2 vertex, std::uint32_t id) {
    const glm::ivec2 unit = layout_.unitAt(vertex, level), half(layout_.unitsPerSample() / 2);
    const glm::ivec2 sample = (unit + half) >> layout_.detailLevels();
    samples_[id] = std::uint32_t(grid.index(sample.x, sample.y));
    if (!places_.empty()) places_[id] = glm::vec2(glm::dvec2(unit) / double(layout_.unitsPerSample()));
    newVertices_.push_back(id);
}

/// Those of new chunks, and what is new in the others.
void ClipmapMesh::nameVertices(const SampleGrid& grid, std::span<const ClipmapUpdates::Update> updates) {
    const auto name = [&](int level, const ClipRect& rect, bool inNew) {
        const auto& chunks = levels_[std::size_t(level)].chunks;
        for (int y = rect.low.y; y <= rect.high.y; ++y)
            for (int x = rect.low.x; x <= rect.high.x;) {
                const int end = std::min(rect.high.x, x | (kChunk - 1));
                const Chunk& chunk = chunks[chunkIndex({x, y})];
                if (chunk.place == kNoPlace || chunk.isNew != inNew) {
                    x = end + 1;
                    continue;
                }
                std::uint32_t id = vertexId(level, {x, y});
                while (x <= end) nameVertex(grid, level, {x++, y}, id++);
            }
    };
    for (int level = 0; level < layout_.levels(); ++level) name(level, clipmap_.valid()[std::size_t(level)], true);
    for (const ClipmapUpdates::Update& update : updates) name(update.level, update.rect, false);
}

/// Clipmap::blend() is the larger of two that depend on one axis each.
void ClipmapMesh::share(const SampleGrid& grid, int number, const Clipmap::Frame& frame) {
    Level& level = levels_[std::size_t(number)];
    const ClipRect& valid = clipmap_.valid()[std::size_t(number)];
    const ClipRect drawn = frame.active[std::size_t(number)].cutTo(layout_.domain(number));
    const glm::dmat4& local = grid.localFromFrame();
    const int axes[2] = {columnAxis_, rowAxis_};
    level.sharesChanged = valid != level.valid;
    level.valid = valid;
    for (const int axis : {0, 1}) {
        shares_.assign(std::size_t(layout_.pitch()), 0.0f);
        for (int v = drawn.low[axis]; v <= drawn.high[axis]; ++v)
            shares_[std::size_t(layout_.texel(v))] = clipmap_.blend(number, axis, v);
        if (shares_ != level.share[axis]) level.sharesChanged = true;
        level.share[axis].swap(shares_);
        for (int v = valid.low[axis]; v <= valid.high[axis]; ++v) {
            const int unit = layout_.unitAt(glm::ivec2(v), number)[axis];
            level.place[axis][std::size_t(layout_.texel(v))] =
                float(local[3][axes[axis]] + local[axis][axes[axis]] * (double(unit) / double(layout_.unitsPerSample())));
        }
    }
}

bool ClipmapMesh::writePositions(const SampleGrid& grid, int number) {
    Level& level = levels_[std::size_t(number)];
    const int across = layout_.pitch() / kChunk;
    const auto isPlain = [&](int axis, int chunk) {
        const auto first = level.share[axis].begin() + chunk * kChunk;
        return std::all_of(first, first + kChunk, [](float share) { return share == 0.0f; });
    };
    bool any = false;
    for (int row = 0; row < across; ++row) {
        const bool plainRow = isPlain(1, row);
        for (int column = 0; column < across; ++column) {
            Chunk& chunk = level.chunks[std::size_t(row * across + column)];
            if (!chunk.used) continue;
            const bool plain = plainRow && isPlain(0, column);
            if (chunk.written && (!level.sharesChanged || (plain && chunk.plain))) continue;
            glm::vec3* out = positions_.data() + std::size_t(chunk.place) * kChunkVertices;
            if (grid.isRegular())
                writeRegular(level, glm::ivec2(column, row) * kChunk, out);
            else
                writeCurved(level, glm::ivec2(column, row) * kChunk, out);
            chunk.written = any = true;
            chunk.plain = plain;
        }
    }
    return any;
}

void ClipmapMesh::writeRegular(const Level& level, glm::ivec2 texel, glm::vec3* out) const {
    const float* shares = level.share[0].data() + texel.x;
    const float* columns = level.place[0].data() + texel.x;
    float heights[kChunk];
    for (int y = texel.y; y < texel.y + kChunk; ++y, out += kChunk) {
        const glm::vec2* pairs = level.heights.data() + std::size_t(y) * std::size_t(layout_.pitch()) + std::size_t(texel.x);
        const float rowShare = level.share[1][std::size_t(y)], row = level.place[1][std::size_t(y)];
        for (int i = 0; i < kChunk; ++i) heights[i] = blended(pairs[i].x, pairs[i].y, std::max(rowShare, shares[i]));
        for (int i = 0; i < kChunk; ++i) {
            out[i][columnAxis_] = columns[i];
            out[i][rowAxis_] = row;
            out[i][heightAxis_] = heights[i];
        }
    }
}

void ClipmapMesh::writeCurved(const Level& level, glm::ivec2 texel, glm::vec3* out) const {
    for (int y = texel.y; y < texel.y + kChunk; ++y) {
        const glm::vec3* pairs = level.points.data() + 2 * (std::size_t(y) * std::size_t(layout_.pitch()) + std::size_t(texel.x));
        for (int i = 0; i < kChunk; ++i) {
            const float share = std::max(level.share[1][std::size_t(y)], level.share[0][std::size_t(texel.x + i)]);
            *out++ = blended(pairs[2 * i], pairs[2 * i + 1], share);
        }
    }
}

void ClipmapMesh::emit(const ClipmapPatches& patches) {
    std::size_t most = 0;
    for (int footprint = 0; footprint < kFootprints; ++footprint)
        for (const ClipmapPatch& patch : patches.by[footprint]) {
            const glm::ivec2 cells = glm::max(patch.high - patch.low, glm::ivec2(1));
            most += 6 * std::size_t(cells.x) * std::size_t(cells.y);
        }
    if (most > indices_.size()) indices_.resize(most + most / 8);
    indexCount_ = 0;
    firstSeam_ = 0;
    for (int footprint = 0; footprint < kFootprints; ++footprint)
        for (const ClipmapPatch& patch : patches.by[footprint]) {
            if (Footprint(footprint) == Footprint::Seam)
                emitSeam(patch);
            else
                emitPatch(patch);
            // Seams come last.
            if (Footprint(footprint) != Footprint::Seam) firstSeam_ = indexCount_;
        }
}

bool ClipmapMesh::isHole(int level, glm::ivec2 vertex) const {
    const Level& at = levels_[std::size_t(level)];
    const std::size_t texel = texelIndex(vertex);
    if (!at.heights.empty()) return !std::isfinite(at.heights[texel].x);
    const glm::vec3& p = at.points[2 * texel];
    return !std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z);
}

/// The pool's vertices of a row.
void ClipmapMesh::fillRow(int level, int row, int first, int last, std::vector<std::uint32_t>& out) const {
    out.resize(std::size_t(last - first + 1));
    std::uint32_t* to = out.data();
    while (first <= last) {
        const int end = std::min(last, first | (kChunk - 1));
        std::uint32_t id = vertexId(level, {first, row});
        for (; first <= end; ++first) *to++ = id++;
    }
}

void ClipmapMesh::emitPatch(const ClipmapPatch& patch) {
    const bool holes = boxes_->hasHoles();
    const std::size_t second = settings_.clockwise ? 2 : 1, third = 3 - second;
    std::uint32_t* out = indices_.data() + indexCount_;
    fillRow(patch.level, patch.low.y, patch.low.x, patch.high.x, rows_[1]);
    for (int y = patch.low.y; y < patch.high.y; ++y) {
        rows_[0].swap(rows_[1]);
        fillRow(patch.level, y + 1, patch.low.x, patch.high.x, rows_[1]);
        const std::uint32_t *low = rows_[0].data(), *high = rows_[1].data();
        for (int x = patch.low.x; x < patch.high.x; ++x, ++low, ++high) {
            if (holes && (isHole(patch.level, {x, y}) || isHole(patch.level, {x + 1, y}) || isHole(patch.level, {x, y + 1}) ||
                          isHole(patch.level, {x + 1, y + 1})))
                continue;
            out[0] = low[0];
            out[second] = low[1];
            out[third] = high[0];
            out[3] = low[1];
            out[3 + second] = high[1];
            out[3 + third] = high[0];
            out += 6;
        }
    }
    indexCount_ = std::size_t(out - indices_.data());
}

/// A triangle over each edge of the coarser level, with the vertex that stands on it.
void ClipmapMesh::emitSeam(const ClipmapPatch& patch) {
    const glm::ivec2 step = patch.high.x > patch.low.x ? glm::ivec2(1, 0) : glm::ivec2(0, 1);
    for (glm::ivec2 at = patch.low; at.x + 2 * step.x <= patch.high.x && at.y + 2 * step.y <= patch.high.y; at += 2 * step) {
        const glm::ivec2 ends[3] = {at, at + step, at + 2 * step};
        if (boxes_->hasHoles() && std::any_of(ends, ends + 3, [&](glm::ivec2 v) { return isHole(patch.level, v); })) continue;
        for (const glm::ivec2 v : ends) indices_[indexCount_++] = vertexId(patch.level, v);
    }
}

std::size_t ClipmapMesh::bytes() const {
    const auto held = [](const auto& items) { return items.capacity() * sizeof(items[0]); };
    std::size_t total = clipmap_.bytes() + held(positions_) + held(samples_) + held(places_) + held(newVertices_) + held(indices_) +
                        held(scratch_) + held(shares_) + held(points_) + free_.size() * sizeof(std::uint32_t);
    for (const Level& level : levels_)
        total += held(level.heights) + held(level.points) + held(level.chunks) + 2 * (held(level.share[0]) + held(level.place[0]));
    return total;
}

}  // namespace terrain
