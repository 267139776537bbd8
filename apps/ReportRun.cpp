#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "BenchProcess.h"
#include "ChildProcess.h"
#include "Clock.h"
#include "Report.h"

namespace app {

namespace {

constexpr const char* program = "soterrain-report";

// Plots and the page take their time, too.
constexpr double lastSeconds = 15.0;

std::string minutesAndSeconds(double seconds) {
    const int whole = std::max(0, int(seconds + 0.5));
    char text[32];
    std::snprintf(text, sizeof text, "%d:%02d", whole / 60, whole % 60);
    return text;
}

/// Tells how far the measurements are: one line that changes in a terminal, else a line for each.
class Progress {
public:
    explicit Progress(const ReportPlan& plan) : plan_(plan), terminal_(isatty(STDERR_FILENO)) {
        for (const Measurement& m : plan.measurements) all_ += m.weight;
    }

    double seconds() const { return (nowMs() - start_) / 1000.0; }

    void begin(const Measurement& m) {
        std::string left;
        if (done_ > 0.0) left = ", about " + minutesAndSeconds(seconds() / done_ * (all_ - done_)) + " left";
        std::fprintf(stderr, "%s%3zu of %zu  %3.0f %%  %s%s  %s%s", terminal_ ? "\r\033[K" : "", ++count_,
                     plan_.measurements.size(), 100.0 * done_ / all_, minutesAndSeconds(seconds()).c_str(), left.c_str(),
                     m.label.c_str(), terminal_ ? "" : "\n");
        std::fflush(stderr);
        done_ += m.weight;
    }

    void say(const std::string& text) { std::fprintf(stderr, "%s%s\n", terminal_ ? "\r\033[K" : "", text.c_str()); }
    void end() { say(minutesAndSeconds(seconds()) + " for all measurements"); }

private:
    const ReportPlan& plan_;
    bool terminal_;
    double start_ = nowMs();
    double all_ = 0.0;
    double done_ = 0.0;
    std::size_t count_ = 0;
};

// So that every plot has some points, should time be over before the last measurement.
std::vector<Measurement*> inOrder(ReportPlan& plan) {
    std::vector<Measurement*> order;
    for (Measurement& m : plan.measurements) order.push_back(&m);
    std::stable_sort(order.begin(), order.end(), [](const Measurement* a, const Measurement* b) { return a->rank < b->rank; });
    return order;
}

// A reason without the name of this program before it.
std::string plainReason(const std::string& reason) {
    const std::string prefix = std::string(program) + ": ";
    return reason.starts_with(prefix) ? reason.substr(prefix.size()) : reason;
}

}  // namespace

bool measureReport(const ReportOptions& options, ReportPlan& plan) {
    Progress progress(plan);
    const double end = 60.0 * options.minutes - std::min(lastSeconds, 6.0 * options.minutes);
    for (Measurement* next : inOrder(plan)) {
        Measurement& m = *next;
        const double left = end - progress.seconds();
        if (left <= 0.0) {
            m.problem = "no time was left for it";
            m.leftOut = true;
            continue;
        }
        progress.begin(m);
        BenchOutcome outcome = benchInProcess(m.request, left, false);
        if (interrupted()) {
            progress.say(std::string(program) + ": interrupted, nothing is written");
            return false;
        }
        m.result = std::move(outcome.result);
        m.problem = plainReason(outcome.problem);
        m.leftOut = outcome.late;
        if (!m.problem.empty()) progress.say(std::string(program) + ": " + m.label + " is not measured: " + m.problem);
    }
    plan.seconds = progress.seconds();
    progress.end();
    const auto leftOut =
        std::count_if(plan.measurements.begin(), plan.measurements.end(), [](const Measurement& m) { return m.leftOut; });
    if (leftOut)
        progress.say(std::string(program) + ": there was no time for " + std::to_string(leftOut) + " of " +
                     std::to_string(plan.measurements.size()) + " measurements; --minutes gives more");
    return true;
}

}  // namespace app
