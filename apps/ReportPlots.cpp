#include "Report.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>

#include "ChildProcess.h"

namespace app {

using nlohmann::ordered_json;
using terrain::Error;
using terrain::Result;

namespace {

struct Point {
    double x = 0.0;
    double y = 0.0;
    std::string mark;
};

struct Curve {
    Plot::Key key;
    std::vector<Point> points;
};

std::string quoted(const std::string& text) {
    std::string result = "'";
    for (const char c : text) result += c == '\'' ? std::string("''") : std::string(1, c);
    return result + "'";
}

// 1, 2 and 5 of each decade from 0.001 to 10 million, of which gnuplot takes those in range.
std::string ticks(const char* axis) {
    std::ostringstream out;
    out << "set logscale " << axis << "\nset " << axis << "tics (";
    const char* separator = "";
    for (int decade = -3; decade <= 7; ++decade)
        for (const int digit : {1, 2, 5}) {
            const double value = digit * std::pow(10.0, decade);
            const double shown = value >= 1e6 ? value / 1e6 : value >= 1e3 ? value / 1e3 : value;
            out << separator << '\'' << shown << (value >= 1e6 ? " M" : value >= 1e3 ? " k" : "") << "' " << value;
            separator = ", ";
        }
    out << ")\n";
    return out.str();
}

// Without what stands from `from` to the first `to` after it.
void cut(std::string& text, const std::string& from, const std::string& to) {
    const std::size_t begin = text.find(from), end = text.find(to, begin);
    if (begin != std::string::npos && end != std::string::npos) text.erase(begin, end + to.size() - begin);
}

void replaceAll(std::string& text, const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) text.replace(at, from.size(), to);
}

// The element alone, without names that lead out of it, and with identifiers that are its own on a page with others.
std::string forPage(std::string svg, const Plot& plot) {
    svg.erase(0, std::min(svg.find("<svg"), svg.size()));
    const std::size_t viewBox = svg.find("viewBox"), begin = svg.find('>', viewBox);
    if (viewBox == std::string::npos || begin == std::string::npos) return {};
    const std::size_t quote = svg.find('"', svg.find('"', viewBox) + 1);
    const std::string box = svg.substr(viewBox, quote + 1 - viewBox);
    svg = "<svg class=\"plot\" role=\"img\" aria-label=\"" + escaped(plot.alt) + "\" " + box + ">" + svg.substr(begin + 1);
    cut(svg, "<title>", "</title>");
    cut(svg, "<desc>", "</desc>");
    replaceAll(svg, "id=\"", "id=\"" + plot.name + '-');
    replaceAll(svg, "id='", "id='" + plot.name + '-');
    replaceAll(svg, "xlink:href='#", "href='#" + plot.name + '-');
    replaceAll(svg, "xlink:href=\"#", "href=\"#" + plot.name + '-');
    replaceAll(svg, "url(#", "url(#" + plot.name + '-');
    return svg;
}

class Plotter {
public:
    explicit Plotter(const std::string& folder) : folder_(folder) {}

    /// `settings`: gnuplot commands, one a line.
    void draw(Plot plot, const std::string& settings, const std::vector<Curve>& curves) {
        const bool empty = std::all_of(curves.begin(), curves.end(), [](const Curve& c) { return c.points.size() < 2; });
        if (problem_ || empty) return;
        for (const Curve& curve : curves)
            if (!curve.points.empty()) plot.keys.push_back(curve.key);
        std::ofstream(folder_ + '/' + plot.name + ".gp") << script(plot, settings, curves);
        const ProcessEnd end = runProcess({"gnuplot", plot.name + ".gp"}, folder_);
        std::ifstream file(folder_ + '/' + plot.name + ".svg");
        plot.svg = forPage(std::string(std::istreambuf_iterator<char>(file), {}), plot);
        if (!end.succeeded() || plot.svg.empty()) {
            problem_ = Error{"gnuplot", "a plot \"" + plot.title + '"', end.reason()};
            return;
        }
        plots_.push_back(std::move(plot));
    }

    Result<std::vector<Plot>> take() {
        if (problem_) return *problem_;
        return std::move(plots_);
    }

private:
    std::string script(const Plot& plot, const std::string& settings, const std::vector<Curve>& curves) const {
        std::ostringstream out;
        out << "set encoding utf8\nset terminal svg size 560,340 dynamic font 'sans-serif,14'\nset output '" << plot.name
            << ".svg'\n"
            << "unset key\nset border 3 lc rgb '#010203' lw 0.8\nset tics nomirror scale 0.5\nset grid lc rgb '#010204' lw 0.6 lt "
               "1\n"
            << "set lmargin 8.5\nset rmargin 2\nset tmargin 0.8\nset bmargin 3.2\nset autoscale fix\nset offsets graph 0.02, graph "
               "0.02, graph 0.05, graph 0.05\n"
            << settings;
        std::string separator = "plot ";
        for (std::size_t i = 0; i < curves.size(); ++i) {
            const Curve& curve = curves[i];
            if (curve.points.empty()) continue;
            const std::string data = plot.name + '-' + std::to_string(i) + ".dat";
            std::ofstream file(folder_ + '/' + data);
            const bool marked =
                std::any_of(curve.points.begin(), curve.points.end(), [](const Point& p) { return !p.mark.empty(); });
            for (const Point& p : curve.points) file << p.x << ' ' << p.y << ' ' << (p.mark.empty() ? "-" : p.mark) << '\n';
            const std::string color = quoted(curve.key.color);
            out << separator << quoted(data) << " using 1:2 notitle with " << (curve.points.size() > 20 ? "lines" : "linespoints")
                << " lw 2 pt 7 ps 0.5 lc rgb " << color << (curve.key.dashed ? " dt (8,4)" : "");
            separator = ", ";
            if (marked)
                out << separator << quoted(data) << " using 1:2:3 notitle with labels font ',11' left offset 0.6,0.5 tc rgb "
                    << color;
        }
        out << '\n';
        return out.str();
    }

    std::string folder_;
    std::vector<Plot> plots_;
    std::optional<Error> problem_;
};

using Value = std::function<std::optional<Point>(const Use&, const Measurement&)>;

/// The curves of a chapter, in the order in which they are first used.
std::vector<Curve> curvesOf(const ReportPlan& plan, Chapter chapter, const Value& value) {
    std::vector<Curve> curves;
    for (const Use& use : plan.uses) {
        const Measurement& m = plan.measurements[use.measurement];
        if (use.chapter != chapter || !m.measured()) continue;
        auto curve = std::find_if(curves.begin(), curves.end(), [&](const Curve& c) { return c.key.name == use.curve; });
        if (curve == curves.end()) curve = curves.insert(curves.end(), Curve{{use.curve, use.color, use.dashed}, {}});
        if (const auto point = value(use, m)) curve->points.push_back(*point);
    }
    return curves;
}

/// What each frame took, of every subject.
std::vector<Curve> seriesOf(const ReportPlan& plan, const char* key) {
    std::vector<Curve> curves;
    for (const Subject& subject : plan.subjects) {
        const Measurement& m = plan.of(subject);
        Curve& curve = curves.emplace_back(Curve{{subject.label, subject.color, subject.dashed}, {}});
        if (!m.measured()) continue;
        double frame = 0.0;
        for (const ordered_json& value : m.result["series"][key]) {
            if (value.is_array())
                curve.points.push_back({value[0].get<double>(), value[1].get<double>(), {}});
            else
                curve.points.push_back({frame++, value.get<double>(), {}});
        }
    }
    return curves;
}

std::optional<Point> framesASecond(const Use& use, const Measurement& m) {
    return Point{use.x, 1000.0 / std::max(1e-3, m.result["frame_ms"]["median"].get<double>()), {}};
}

std::optional<Point> megabytes(const Use& use, const Measurement& m) {
    const double bytes = m.result["growth_bytes"].get<double>();
    return bytes > 0.0 ? std::optional(Point{use.x, bytes / 1048576.0, {}}) : std::nullopt;
}

std::optional<Point> trade(const Use& use, const Measurement& m) {
    const double error = m.result["error_px"]["max"].get<double>();
    constexpr double fullDetail = 0.01;
    return error > fullDetail ? std::optional(Point{m.result["triangles"].get<double>(), error, use.mark}) : std::nullopt;
}

// A tick for each map.
std::string sizeTicks(const std::vector<Curve>& curves) {
    std::ostringstream out;
    out << "set logscale x 2\nset xlabel 'samples a side'\nset xtics (";
    std::set<double> sizes;
    for (const Curve& curve : curves)
        for (const Point& point : curve.points) sizes.insert(point.x);
    const char* separator = "";
    for (const double size : sizes) {
        out << separator << '\'' << size << "' " << size;
        separator = ", ";
    }
    out << ")\n";
    return out.str();
}

// "Lines over ...: SoROAMTerrain from 1 to 5, ..."
std::string described(const std::string& what, const std::vector<Curve>& curves) {
    std::string text = what;
    const char* separator = ": ";
    for (const Curve& curve : curves) {
        if (curve.points.empty()) continue;
        const auto [low, high] =
            std::minmax_element(curve.points.begin(), curve.points.end(), [](const Point& a, const Point& b) { return a.y < b.y; });
        const auto shown = [](double value) { return grouped(value, value < 10.0 ? 2 : 0); };
        text += separator + curve.key.name + " from " + shown(low->y) + " to " + shown(high->y);
        separator = "; ";
    }
    return text + '.';
}

void drawFlight(Plotter& plotter, const ReportPlan& plan) {
    const std::string overFrames = "set xlabel 'frame of the flight'\n";
    const auto draw = [&](const char* key, const char* name, const char* title, const char* text, const char* what,
                          const std::string& settings) {
        const auto curves = seriesOf(plan, key);
        plotter.draw({name, title, text, described(what, curves), {}, {}}, overFrames + settings, curves);
    };
    draw("frame_ms", "frames", "Time of each frame",
         "Milliseconds from the begin of the traversal until GL has finished all drawing.", "Milliseconds of each frame",
         ticks("y") + "set ylabel 'ms'\n");
    draw("cpu_ms", "cpu", "Processor time of each frame",
         "Of the traversing thread, with rasterisation off: what an application's own thread is kept from other work.",
         "Milliseconds of processor time in each frame", ticks("y") + "set ylabel 'ms'\n");
    draw("triangles", "triangles", "Triangles of each frame", "Counted by GL.", "Triangles of each frame",
         ticks("y") + "set ylabel 'triangles'\n");
    draw("error_px", "errors", "Largest error on screen",
         "How far any sample in view is drawn from where it belongs, by the full data, in the frames in which it was measured.",
         "Largest error in pixels", "set ylabel 'px'\n");
}

}  // namespace

Result<std::vector<Plot>> drawPlots(const ReportOptions& options, const ReportPlan& plan) {
    Plotter plotter(options.work);
    drawFlight(plotter, plan);
    const auto draw = [&](Chapter chapter, const Value& value, Plot plot, const std::string& settings) {
        const auto curves = curvesOf(plan, chapter, value);
        plot.alt = described(plot.alt, curves);
        plotter.draw(std::move(plot), (chapter == Chapter::Size ? sizeTicks(curves) : std::string()) + settings, curves);
    };
    draw(Chapter::Error, trade,
         {"trade",
          "Triangles against error",
          "The largest error on screen over the mean number of triangles. Each point is a flight with the pixelError that stands "
          "beside it, "
          "for clipmaps with that clipmapSize. Left and below is better.",
          "Largest error in pixels over triangles",
          {},
          {}},
         ticks("x") + ticks("y") + "set rmargin 5\nset xlabel 'triangles, mean'\nset ylabel 'largest error, px'\n");
    draw(Chapter::Size, framesASecond,
         {"sizes",
          "Frames a second over the size of the map",
          "Medians. The same ground with every second, fourth, ... sample of it.",
          "Frames a second over samples a side",
          {},
          {}},
         ticks("y") + "set ylabel 'frames a second'\n");
    draw(Chapter::Size, megabytes,
         {"memory",
          "Memory over the size of the map",
          "By how much the process grew when the node was first drawn, with what GL took (without a graphics card all of it), "
          "without Coin's "
          "coordinates and normals.",
          "Megabytes over samples a side",
          {},
          {}},
         ticks("y") + "set ylabel 'MB'\n");
    draw(Chapter::Clipmap, framesASecond,
         {"clipmaps",
          "Clipmaps: frames a second over size and levels",
          "Medians, for each clipmapSize with one level, two, and so on, until they cover the map; fewer do not reach its end.",
          "Frames a second over levels",
          {},
          {}},
         ticks("y") + "set xlabel 'levels'\nset xtics 1\nset ylabel 'frames a second'\n");
    return plotter.take();
}

}  // namespace app
