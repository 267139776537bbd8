// What one view of an SoPerfGraph has seen.
#ifndef SOTERRAIN_PERFGRAPHVIEW_H
#define SOTERRAIN_PERFGRAPHVIEW_H

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include <Inventor/SbBasic.h>

#include "PerfCounters.h"
#include "PerfPanel.h"
#include "TerrainViews.h"

/// The graphs of a view: their values, and what is drawn of them. A copy goes on from the same values.
class PerfGraphView {
public:
    using Clock = std::chrono::steady_clock;

    explicit PerfGraphView(const ViewKey & k) : key(k) {}

    ViewKey key;
    bool isNew = true;      ///< not arranged yet for its viewport
    SbUniqueId fields = 0;  ///< the node's id when it was arranged
    bool hasFrame = false;  ///< the values of the frame that is being drawn are in

    /// Follows the counters of these names from now on, those that it has followed without a gap.
    void follow(const std::vector<std::string> & names);
    /// Takes in a frame. What each graph shows goes into as many points as there are pixels.
    void addFrame(std::size_t history, float width, const std::vector<double> & maxima);
    /// What is counted until the next frame is not shown.
    void rest() { isResting_ = true; }
    /// Makes what is to be drawn. Figures stand for a quarter of a second, because nobody reads faster, unless `renewAll`.
    void arrange(const PerfLayout & layout, const std::vector<PerfGraphStyle> & styles, bool renewAll);
    /// False where the context can't.
    bool draw(terrain::OverlayResources & resources, const PerfLayout & layout) const;

    std::size_t size() const { return graphs_.size(); }
    const PerfPlot & plotOf(std::size_t graph) const { return graphs_[graph].plot; }
    /// Names that nothing has counted by for many frames.
    std::vector<std::string> unknownNames() const;

private:
    enum Source { NONE, COUNTER, FRAME, FPS, RESIDENT };
    struct Graph {
        std::string name;
        Source source = NONE;
        const PerfCounter * counter = nullptr;
        double seen = 0.0;  ///< the counter's total in the latest frame
        PerfPlot plot;
        double drawnTop = 0.0, drawnBottom = 0.0;  ///< of the scale that the quads show
    };
    static Graph graphFor(const std::string & name);
    static std::string unitOf(const Graph & graph);
    /// What the graph shows of the frame, or nothing, where it gets no point for it.
    std::optional<double> valueOf(Graph & graph, double frameMilliseconds) const;

    std::vector<Graph> graphs_;
    terrain::OverlayQuads grounds_, texts_;
    std::vector<terrain::OverlayVertex> curves_;
    std::vector<GLsizei> curveLengths_;
    float lineWidth_ = 1.0f;
    bool isResting_ = true;
    std::uint64_t frames_ = 0;
    double residentBytes_ = 0.0;
    std::optional<Clock::time_point> lastFrame_, lastText_, lastResident_;
};

#endif
