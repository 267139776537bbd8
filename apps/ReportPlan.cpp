#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include "Report.h"

#include <algorithm>
#include <cmath>

namespace app {

namespace {

// Hues after Okabe and Ito, whom nearly everybody can tell apart, of a lightness between white and black. Coin's shapes are grey.
const std::vector<Subject>& knownSubjects() {
    static const std::vector<Subject> subjects = {
        {"SoIndexedFaceSet", "", "SoIndexedFaceSet", "#7c8794", true},
        {"SoQuadMesh", "", "SoQuadMesh", "#a9a18f", true},
        {"SoBruteForceTerrain", "", "SoBruteForceTerrain", "#d9a300", false},
        {"SoROAMTerrain", "", "SoROAMTerrain", "#e0601e", false},
        {"SoChunkedLoDTerrain", "", "SoChunkedLoDTerrain", "#16a37a", false},
        {"SoGeoMipmapTerrain", "", "SoGeoMipmapTerrain", "#cc6aa6", false},
        {"SoGeometryClipmapTerrain", "clipmapSize 127", "SoGeometryClipmapTerrain, clipmapSize 127", "#5ab4ea", false},
        {"SoGeometryClipmapTerrain", "clipmapSize 255", "SoGeometryClipmapTerrain, clipmapSize 255", "#2f7fd0", false},
    };
    return subjects;
}

constexpr const char* clipmap = "SoGeometryClipmapTerrain";
constexpr const char* shades[] = {"#7cc4f2", "#4a9be0", "#3b74d1", "#6c5bd0", "#9b4fc4"};

std::string number(double value) {
    std::string text = std::to_string(value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.ends_with('.')) text.pop_back();
    return text;
}

bool sameScene(const BenchRequest& a, const BenchRequest& b) {
    return a.className == b.className && a.fields == b.fields && a.pixelError == b.pixelError && a.decimate == b.decimate;
}

class Planner {
public:
    explicit Planner(const ReportOptions& options) : options_(options) {}

    ReportPlan plan() {
        chooseSubjects();
        addNodes();
        addErrors();
        addSizes();
        addClipmaps();
        return std::move(plan_);
    }

private:
    void chooseSubjects() {
        if (options_.nodes.empty()) plan_.subjects = knownSubjects();
        for (const std::string& name : options_.nodes) {
            const std::size_t before = plan_.subjects.size();
            for (const Subject& subject : knownSubjects())
                if (subject.className == name) plan_.subjects.push_back(subject);
            if (plan_.subjects.size() == before) plan_.subjects.push_back({name, "", name, "#888888", true});
        }
    }

    bool has(const std::string& className) const {
        return std::any_of(plan_.subjects.begin(), plan_.subjects.end(),
                           [&](const Subject& s) { return s.className == className; });
    }

    BenchRequest request(const std::string& className, const std::string& fields) const {
        BenchRequest request = options_.request;
        request.className = className;
        request.fields = fields;
        // So that shapes that take seconds a frame leave time for the others.
        request.seconds = 60.0 * options_.minutes / 30.0;
        return request;
    }

    // Each at most once: a place that has the request already is used again.
    std::size_t add(const std::string& label, const BenchRequest& request, int rank) {
        auto place = std::find_if(plan_.measurements.begin(), plan_.measurements.end(),
                                  [&](const Measurement& m) { return sameScene(m.request, request); });
        if (place == plan_.measurements.end()) {
            place = plan_.measurements.insert(place, Measurement{label, request, rank, weight(request), nullptr, {}});
        } else {
            place->request.framesOnly = place->request.framesOnly && request.framesOnly;
            place->rank = std::min(place->rank, rank);
        }
        return std::size_t(place - plan_.measurements.begin());
    }

    // Loading, and frames: full detail takes longer.
    double weight(const BenchRequest& r) const {
        const double samples = double(options_.columns) * options_.rows / double(r.decimate) / double(r.decimate);
        const bool full =
            std::none_of(std::begin(keepErrors), std::end(keepErrors), [&](const char* name) { return r.className == name; }) &&
            r.className != clipmap;
        const double perFrame = full ? 3.0e-7 * samples : 0.03;
        const double perError = r.framesOnly ? 0.0 : 3e-8 * samples;
        return 0.3 + 6e-7 * samples + r.frames * ((r.framesOnly ? 0.4 : 1.0) * perFrame + perError);
    }

    void addNodes() {
        for (const Subject& subject : plan_.subjects) {
            BenchRequest r = request(subject.className, subject.fields);
            r.series = true;
#ifdef HAVE_OPENIMAGEIO
            r.pictures = options_.work + "/picture" + std::to_string(plan_.measurements.size()) + "-";
#endif
            // Twice the same in --nodes are two rows.
            plan_.measurements.push_back({subject.label, r, 0, weight(r), nullptr, {}});
        }
    }

    void addErrors() {
        std::vector<double> errors = options_.quick ? std::vector{1.0, 4.0} : std::vector{0.5, 1.0, 2.0, 4.0, 8.0};
        errors.push_back(options_.request.pixelError);
        std::sort(errors.begin(), errors.end());
        errors.erase(std::unique(errors.begin(), errors.end()), errors.end());
        for (const Subject& subject : plan_.subjects) {
            if (std::find(std::begin(keepErrors), std::end(keepErrors), subject.className) == std::end(keepErrors)) continue;
            for (const double error : errors) {
                BenchRequest r = request(subject.className, "");
                r.pixelError = error;
                const std::size_t place =
                    add(subject.label + ", pixelError " + number(error), r, error == 1.0 || error == 4.0 ? 1 : 2);
                plan_.uses.push_back({Chapter::Error, subject.label, subject.color, false, error, number(error), place});
            }
        }
        if (!has(clipmap)) return;
        for (const int size : {63, 127, 255, 511}) {
            if (size > shorterSide() || (options_.quick && size != 63)) continue;
            const std::size_t place = add(clipmapLabel(size), request(clipmap, "clipmapSize " + std::to_string(size)), 1);
            plan_.uses.push_back(
                {Chapter::Error, clipmap, knownSubjects().back().color, false, double(size), std::to_string(size), place});
        }
    }

    // Level by level, as in the thesis that the node follows (its figure 5.1); pixelError 0 leaves none of them out.
    void addClipmaps() {
        constexpr int mostLevels = 5;
        if (!has(clipmap)) return;
        std::size_t shade = 0;
        for (const int size : {31, 63, 127, 255, 511}) {
            if (size > shorterSide() || (options_.quick && size > 63)) break;
            const char* color = shades[shade++];
            // Levels beyond those that cover the map would be the same again.
            int levels = 1;
            while ((size << (levels - 1)) < std::max(options_.columns, options_.rows) && levels < mostLevels) ++levels;
            for (int level = 1; level <= levels; ++level) {
                BenchRequest r = request(clipmap, "clipmapSize " + std::to_string(size) + " levels " + std::to_string(level));
                r.pixelError = 0.0;
                r.framesOnly = true;
                const std::size_t place =
                    add(clipmapLabel(size) + ", levels " + std::to_string(level), r, size == 63 || size == 255 ? 2 : 1);
                plan_.uses.push_back({Chapter::Clipmap, "clipmapSize " + std::to_string(size), color, false, double(level),
                                      std::to_string(level), place});
            }
        }
    }

    // From the smallest: should time be over, the plots begin.
    void addSizes() {
        constexpr int smallest = 17, largest = 2049;
        std::vector<int> steps;
        const int most = options_.quick ? 2 : 5;
        for (int step = 1; shorterSide() / step + 1 >= smallest && int(steps.size()) < most; step *= 2)
            if (std::max(options_.columns, options_.rows) / step + 1 <= largest || step == 1) steps.push_back(step);
        std::reverse(steps.begin(), steps.end());
        for (const int step : steps)
            for (const Subject& subject : plan_.subjects) {
                const int columns = (options_.columns - 1) / step + 1, rows = (options_.rows - 1) / step + 1;
                BenchRequest r = request(subject.className, subject.fields);
                r.decimate = step;
                r.framesOnly = true;
                const std::string size = std::to_string(columns) + " x " + std::to_string(rows);
                const std::size_t place = add(subject.label + ", " + size, r, step == 4 || step == 16 ? 1 : 2);
                plan_.uses.push_back(
                    {Chapter::Size, subject.label, subject.color, subject.dashed, double(std::max(columns, rows)), size, place});
            }
    }

    static std::string clipmapLabel(int size) {
        return std::string(clipmap) + ", clipmapSize " + std::to_string(size);
    }
    int shorterSide() const {
        return std::min(options_.columns, options_.rows);
    }

    static constexpr const char* keepErrors[] = {"SoROAMTerrain", "SoChunkedLoDTerrain", "SoGeoMipmapTerrain"};
    const ReportOptions& options_;
    ReportPlan plan_;
};

}  // namespace

ReportPlan planReport(const ReportOptions& options) {
    ReportPlan plan = Planner(options).plan();
    plan.load = loadAverage();
    return plan;
}

}  // namespace app
