// A geometry clipmap's choice for one view: which levels, where they are, what of them is new and what is drawn.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/View.h"
#include "height/SampleGrid.h"
#include "lod/BoxPyramid.h"
#include "lod/ClipmapErrors.h"
#include "lod/ClipmapLayout.h"
#include "lod/ClipmapUpdates.h"
#include "lod/DrawList.h"
#include "lod/SynthesisedDetail.h"

namespace terrain {

struct ClipmapSettings {
    float pixelError = 2.0f;        ///< levels are not drawn whose absence shows as no more than that
    int activeLevels = 0;           ///< from the coarsest one; 0: as many as the view needs
    std::int64_t updateBudget = 0;  ///< vertices a frame; 0: n^2. The first selection has no limit
    bool cull = true;
    const SynthesisedDetail* detail = nullptr;  ///< of the levels finer than the samples

    bool operator==(const ClipmapSettings&) const = default;
};

/// One view of a clipmap, without its heights: those are kept by what draws it, in vertex arrays (ClipmapMesh) or in textures, and
/// are brought up to date by `updates`.
class Clipmap {
public:
    struct Frame {
        glm::dvec2 viewer{0.0};                           ///< in units
        int finest = 0;                                   ///< level
        float leastBlend = 0.0f;                          ///< share of the coarser level that the finest one has at least
        std::vector<ClipRect> active;                     ///< by level; empty where nothing of it is drawn
        std::span<const ClipmapUpdates::Update> updates;  ///< what to store before drawing, coarse to fine
        ClipmapPatches patches;
        SelectionReport report;
    };

    explicit Clipmap(const ClipmapLayout& layout) : layout_(layout), updates_(layout) {}

    /// `errors` may be missing: then levels go by height alone and the error is reported as infinite. Valid until the next call.
    const Frame& select(const SampleGrid& grid, const BoxPyramid& boxes, const ClipmapErrors* errors, const View& view,
                        const ClipmapSettings& settings);
    /// Bound on the screen error of all samples in view if all levels from the one that select() would choose were there.
    float errorOf(const SampleGrid& grid, const BoxPyramid& boxes, const ClipmapErrors& errors, const View& view,
                  const ClipmapSettings& settings) const;

    /// Samples have changed: the next selection stores what is in store of them again.
    void update(const GridEdits& edits) { edits_.include(edits); }

    const ClipmapLayout& layout() const { return layout_; }
    /// That of the last selection.
    const Frame& frame() const { return frame_; }
    /// The latest selection once more: nothing of it is new.
    const Frame& again() {
        frame_.updates = {};
        return frame_;
    }
    std::span<const ClipRect> valid() const { return updates_.valid(); }
    /// The share of the coarser level at a vertex, where levels are cropped too: the larger of two that depend on one axis each.
    float blend(int level, glm::ivec2 vertex) const { return std::max(blend(level, 0, vertex.x), blend(level, 1, vertex.y)); }
    float blend(int level, int axis, int vertex) const;
    /// What is stored is lost, or is that of other samples.
    void forget();
    std::size_t bytes() const;

private:
    struct Eye {
        glm::dvec2 sample{0.0};  ///< column and row over which the viewer is, also outside of the grid
        double height =
            0.0;  ///< distance to the ground there, in the smaller distance of samples; infinite for an orthographic camera
    };
    Eye eyeOf(const SampleGrid& grid, const BoxPyramid& boxes, const View& view) const;
    /// Where a level that is all there is drawn at its own heights.
    ClipRect plainPart(int level, glm::dvec2 viewer) const;
    /// The finest level that is drawn, and how far it has gone over to the next one.
    struct Choice {
        int finest = 0;
        float leastBlend = 0.0f;
    };
    Choice choose(const SampleGrid& grid, const BoxPyramid& boxes, const ClipmapErrors* errors, const ScreenSpace& space,
                  const Eye& eye, glm::dvec2 viewer, const ClipmapSettings& settings) const;
    float boundError(const SampleGrid& grid, const BoxPyramid& boxes, const ClipmapErrors& errors, const ScreenSpace& space,
                     glm::dvec2 viewer, std::span<const ClipRect> active, const Choice& choice) const;
    std::span<const ClipmapUpdates::Update> withEdits(std::span<const ClipmapUpdates::Update> updates);
    ClipRect verticesBy(const SampleRect& samples, int level) const;
    void cover(const BoxPyramid& boxes, const ScreenSpace& space, const ClipmapSettings& settings);

    ClipmapLayout layout_;
    ClipmapUpdates updates_;
    Frame frame_;
    GridEdits edits_;  ///< since the last selection
    std::vector<ClipmapUpdates::Update> allUpdates_;
    bool first_ = true;
};

/// The smallest size of a clipmap of this shape whose bound on the error keeps pixelError, or the largest. Sizes smaller than
/// `now`, which is in use, are taken where they keep it with room to spare. Without errors it is `now`, or kLargest / 4.
int smallestClipmap(const SampleGrid& grid, const BoxPyramid& boxes, const ClipmapErrors* errors, const View& view,
                    const ClipmapShape& shape, const ClipmapSettings& settings, int now = 0);

}  // namespace terrain
