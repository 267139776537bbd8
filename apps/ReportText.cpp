#include <algorithm>
#include <sstream>

#include "Report.h"

namespace app {

namespace {

constexpr double tolerance = 1.005;

std::optional<double> figureOf(const ReportPlan& plan, const Subject& subject, const char* name) {
    const Measurement& m = plan.of(subject);
    if (!m.measured()) return std::nullopt;
    for (const Figure& figure : reportFigures())
        if (std::string_view(figure.name) == name) return figure.value(m.result);
    return std::nullopt;
}

bool kept(const ReportPlan& plan, const Subject& subject) {
    const auto error = figureOf(plan, subject, "error_px_max");
    return error && *error <= tolerance * plan.of(subject).request.pixelError;
}

/// The least of a figure among the subjects that are wanted.
template <class Wanted>
const Subject* least(const ReportPlan& plan, const char* name, const Wanted& wanted) {
    const Subject* best = nullptr;
    for (const Subject& subject : plan.subjects) {
        const auto value = figureOf(plan, subject, name);
        if (value && wanted(subject) && (!best || *value < *figureOf(plan, *best, name))) best = &subject;
    }
    return best;
}

const Subject* leastOfCoin(const ReportPlan& plan, const char* name) {
    return least(plan, name, [](const Subject& s) { return s.dashed; });
}

// Nodes with another error would be compared with what they do not draw.
const Subject* leastOfOurs(const ReportPlan& plan, const char* name) {
    const Subject* best = least(plan, name, [&](const Subject& s) { return !s.dashed && kept(plan, s); });
    return best ? best : least(plan, name, [](const Subject& s) { return !s.dashed; });
}

std::string significant(double value) {
    return grouped(value, value == 0.0 ? 0 : value < 1.0 ? 2 : value < 20.0 ? 1 : 0);
}

std::string shortest(double value) {
    std::ostringstream out;
    out << value;
    return out.str();
}

std::string listed(const std::vector<std::string>& names) {
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i) text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
    return text;
}

void addFinding(std::vector<Finding>& all, const ReportPlan& plan, const char* name, const char* head, const char* unit,
                const char* comparison) {
    const Subject* best = leastOfOurs(plan, name);
    if (!best) return;
    const double value = *figureOf(plan, *best, name);
    Finding finding{head, significant(value), unit, best, {}};
    const Subject* coin = leastOfCoin(plan, name);
    if (coin) {
        const double other = *figureOf(plan, *coin, name);
        finding.text = coin->label + ": " + significant(other);
        if (value > 0.0 && other / value >= 1.05)
            finding.text = significant(other / value) + " times " + comparison + " than " + finding.text;
    }
    all.push_back(finding);
}

}  // namespace

std::vector<Finding> findings(const ReportPlan& plan) {
    std::vector<Finding> all;
    addFinding(all, plan, "frame_ms_median", "Quickest frame", "ms", "quicker");
    addFinding(all, plan, "triangles", "Fewest triangles", "", "fewer");
    addFinding(all, plan, "cpu_ms_median", "Least processor time", "ms", "less");
    addFinding(all, plan, "growth_bytes_a_sample", "Least memory", "bytes a sample", "less");
    addFinding(all, plan, "start_ms", "Soonest on screen", "ms", "sooner");
    return all;
}

std::string summarySentence(const ReportPlan& plan) {
    const Subject* best = leastOfOurs(plan, "frame_ms_median");
    if (!best) return "None of SoTerrain's nodes could be measured.";
    const double ms = *figureOf(plan, *best, "frame_ms_median"), triangles = *figureOf(plan, *best, "triangles");
    std::string text = best->label + " was quickest: " + significant(ms) + " ms a frame with " + grouped(triangles) + " triangles";
    if (const Subject* coin = leastOfCoin(plan, "frame_ms_median")) {
        const double other = *figureOf(plan, *coin, "frame_ms_median");
        text += other > ms ? ", " + significant(other / ms) + " times as fast as " : ", while it took ";
        text += "Coin's " + coin->label + " (" + significant(other) + " ms, " + grouped(*figureOf(plan, *coin, "triangles")) +
                " triangles)";
    }
    return text + ".";
}

std::string errorSentence(const ReportOptions& options, const ReportPlan& plan) {
    std::vector<std::string> keepers, others;
    for (const Subject& subject : plan.subjects) {
        const auto error = figureOf(plan, subject, "error_px_max");
        const bool full = subject.dashed || subject.className == "SoBruteForceTerrain";
        if (!error || full) continue;
        if (kept(plan, subject)) keepers.push_back(subject.label);
        if (!kept(plan, subject)) others.push_back(subject.label + " was off by up to " + grouped(*error, 2) + " px");
    }
    std::string text;
    if (!keepers.empty())
        text += listed(keepers) + " kept every sample in view within " + shortest(options.request.pixelError) + " px.";
    if (!others.empty()) text += (text.empty() ? "" : " ") + listed(others) + ".";
    return text;
}

}  // namespace app
