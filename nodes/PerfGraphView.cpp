#include "PerfGraphView.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <utility>

namespace {

constexpr auto kReadable = std::chrono::milliseconds(250);
constexpr double kRestMilliseconds = 2000.0;
constexpr std::uint64_t kPatienceFrames = 60;

double residentBytes()
{
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("VmRSS:")) return 1024.0 * std::strtod(line.c_str() + 6, nullptr);
    return std::nan("");
}

}  // namespace

PerfGraphView::Graph PerfGraphView::graphFor(const std::string & name)
{
    Graph graph;
    graph.name = name;
    graph.source = name.empty() ? NONE : name == "frame" ? FRAME : name == "fps" ? FPS : name == "resident" ? RESIDENT : COUNTER;
    if (graph.source != COUNTER) return graph;
    graph.counter = &PerfCounters::instance().find(name);
    graph.seen = graph.counter->total;
    return graph;
}

std::string PerfGraphView::unitOf(const Graph & graph)
{
    switch (graph.source) {
    case COUNTER: return PerfCounters::instance().unitOf(*graph.counter);
    case FRAME: return "ms";
    case FPS: return "/s";
    case RESIDENT: return "B";
    default: return {};
    }
}

void PerfGraphView::follow(const std::vector<std::string> & names)
{
    std::vector<Graph> graphs;
    for (const std::string & name : names) {
        const auto known = std::find_if(graphs_.begin(), graphs_.end(), [&](const Graph & graph) { return graph.name == name && !name.empty(); });
        // One name may stand several times.
        graphs.push_back(known != graphs_.end() ? *known : graphFor(name));
    }
    graphs_ = std::move(graphs);
    frames_ = 0;
}

std::optional<double> PerfGraphView::valueOf(Graph & graph, double frameMilliseconds) const
{
    const bool isFrame = frameMilliseconds > 0.0 && frameMilliseconds < kRestMilliseconds;
    switch (graph.source) {
    case FRAME: return isFrame ? std::optional(frameMilliseconds) : std::nullopt;
    case FPS: return isFrame ? std::optional(1000.0 / frameMilliseconds) : std::nullopt;
    case RESIDENT: return residentBytes_;
    case COUNTER: {
        const PerfCounter::Kind kind = graph.counter->kind;
        if (kind == PerfCounter::NOTHING_YET) return std::nan("");
        if (kind == PerfCounter::VALUE) return graph.counter->value;
        const double total = graph.counter->total, before = std::exchange(graph.seen, total);
        return isResting_ ? 0.0 : total - before;
    }
    default: return std::nullopt;
    }
}

void PerfGraphView::addFrame(std::size_t history, float width, const std::vector<double> & maxima)
{
    const Clock::time_point now = Clock::now();
    const double milliseconds = lastFrame_ && !isResting_ ? std::chrono::duration<double, std::milli>(now - *lastFrame_).count() : 0.0;
    lastFrame_ = now;
    const bool showsResident = std::any_of(graphs_.begin(), graphs_.end(), [](const Graph & graph) { return graph.source == RESIDENT; });
    if (showsResident && (!lastResident_ || now - *lastResident_ >= kReadable)) {
        lastResident_ = now;
        residentBytes_ = residentBytes();
    }
    for (std::size_t i = 0; i < graphs_.size(); ++i) {
        Graph & graph = graphs_[i];
        if (const std::optional<double> value = valueOf(graph, milliseconds)) graph.plot.add(*value, history, std::size_t(std::max(2.0f, width)));
        graph.plot.scale(i < maxima.size() ? maxima[i] : 0.0);
    }
    isResting_ = false;
    ++frames_;
}

void PerfGraphView::arrange(const PerfLayout & layout, const std::vector<PerfGraphStyle> & styles, bool renewAll)
{
    const Clock::time_point now = Clock::now();
    bool renew = renewAll || !lastText_ || now - *lastText_ >= kReadable;
    for (const Graph & graph : graphs_) renew = renew || graph.plot.top() != graph.drawnTop || graph.plot.bottom() != graph.drawnBottom;
    if (renew) {
        lastText_ = now;
        grounds_.clear();
        texts_.clear();
        lineWidth_ = float(layout.textScale);
    }
    curves_.clear();
    curveLengths_.clear();
    for (std::size_t i = 0; i < graphs_.size(); ++i) {
        Graph & graph = graphs_[i];
        if (graph.source == NONE) continue;
        const PerfGraphPicture picture(layout, int(i));
        curveLengths_.push_back(picture.addCurve(curves_, graph.plot, styles[i].color));
        if (!renew) continue;
        graph.drawnTop = graph.plot.top();
        graph.drawnBottom = graph.plot.bottom();
        picture.addGround(grounds_, graph.plot, styles[i]);
        picture.addText(texts_, graph.plot, styles[i], graph.name, unitOf(graph));
    }
}

bool PerfGraphView::draw(terrain::OverlayResources & resources, const PerfLayout & layout) const
{
    const terrain::OverlayScope overlay(resources, int(layout.viewport.x), int(layout.viewport.y));
    if (!overlay.canDraw()) return false;
    overlay.drawRectangles(grounds_.vertices());
    overlay.drawLines(curves_, curveLengths_, lineWidth_);
    overlay.drawText(texts_.vertices());
    return true;
}

std::vector<std::string> PerfGraphView::unknownNames() const
{
    std::vector<std::string> names;
    if (frames_ < kPatienceFrames) return names;
    for (const Graph & graph : graphs_)
        if (graph.source == COUNTER && graph.counter->kind == PerfCounter::NOTHING_YET) names.push_back(graph.name);
    return names;
}
