#include "Report.h"

#include <algorithm>
#include <cstdio>
#include <sstream>

namespace app {

using nlohmann::ordered_json;

namespace {

using Value = std::optional<double>;

// Infinity, of a node that does not know its bound, is null in JSON.
Value numberOf(const ordered_json& value, double unit) {
    return value.is_number() ? Value(value.get<double>() / unit) : std::nullopt;
}

Value of(const ordered_json& r, const char* group, const char* key) {
    return r.contains(group) ? numberOf(r[group][key], 1.0) : std::nullopt;
}

Value scaled(const ordered_json& r, const char* key, double unit) {
    return r.contains(key) ? numberOf(r[key], unit) : std::nullopt;
}

Value perSample(const ordered_json& r, const char* key) {
    return scaled(r, key, r["samples"].get<double>());
}

std::string inQuotes(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
    return result + '"';
}

}  // namespace

const std::vector<Figure>& reportFigures() {
    static const std::vector<Figure> figures = {
        {"Frame, ms", "median", "frame_ms_median", 2, true, [](const ordered_json& r) { return of(r, "frame_ms", "median"); }},
        {"Frame, ms", "p95", "frame_ms_p95", 2, true, [](const ordered_json& r) { return of(r, "frame_ms", "p95"); }},
        {"Frame, ms", "worst", "frame_ms_worst", 2, true, [](const ordered_json& r) { return of(r, "frame_ms", "worst"); }},
        {"CPU, ms", "median", "cpu_ms_median", 2, true, [](const ordered_json& r) { return of(r, "cpu_ms", "median"); }},
        {"Triangles", "mean", "triangles", 0, true, [](const ordered_json& r) { return scaled(r, "triangles", 1.0); }},
        {"Error on screen, px", "rms", "error_px_rms", 3, false, [](const ordered_json& r) { return of(r, "error_px", "rms"); }},
        {"Error on screen, px", "p99.9", "error_px_p999", 3, false,
         [](const ordered_json& r) { return of(r, "error_px", "p999"); }},
        {"Error on screen, px", "largest", "error_px_max", 3, false,
         [](const ordered_json& r) { return of(r, "error_px", "max"); }},
        {"Error on screen, px", "reported", "bound_px", 2, false, [](const ordered_json& r) { return scaled(r, "bound_px", 1.0); }},
        {"Bytes a sample", "process", "growth_bytes_a_sample", 1, true,
         [](const ordered_json& r) { return perSample(r, "growth_bytes"); }},
        {"Bytes a sample", "node", "memory_bytes_a_sample", 1, false,
         [](const ordered_json& r) { return perSample(r, "memory_bytes"); }},
        {"Bytes a sample", "GL", "buffer_bytes_a_sample", 1, false,
         [](const ordered_json& r) { return perSample(r, "buffer_bytes"); }},
        {"Start, ms", "first", "start_ms", 0, true, [](const ordered_json& r) { return scaled(r, "start_ms", 1.0); }},
        {"Sent, kB", "a frame", "sent_kb", 1, false, [](const ordered_json& r) { return scaled(r, "sent_bytes", 1024.0); }},
        {"Frames", "drawn", "frames", 0, false, [](const ordered_json& r) { return of(r, "frame_ms", "frames"); }},
    };
    return figures;
}

std::string format(double value, int digits) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
}

std::string grouped(double value, int digits) {
    std::string text = format(value, digits);
    const std::size_t whole = std::min(text.find('.'), text.size());
    for (std::size_t i = whole; i > 3 && text[i - 4] != '-'; i -= 3) text.insert(i - 3, ",");
    return text;
}

std::string reportTable(const ReportPlan& plan) {
    std::ostringstream out;
    out << "measurement,class,fields,pixel_error,columns,rows";
    for (const Figure& figure : reportFigures()) out << ',' << figure.name;
    out << ",problem\n";
    for (const Measurement& m : plan.measurements) {
        out << inQuotes(m.label) << ',' << m.request.className << ',' << inQuotes(m.request.fields) << ',' << m.request.pixelError
            << ',';
        if (m.measured()) out << m.result["columns"] << ',' << m.result["rows"];
        if (!m.measured()) out << ',';
        for (const Figure& figure : reportFigures()) {
            const auto value = m.measured() ? figure.value(m.result) : std::nullopt;
            out << ',' << (value ? format(*value, figure.digits) : std::string());
        }
        out << ',' << (m.problem.empty() ? std::string() : inQuotes(m.problem)) << '\n';
    }
    return out.str();
}

ordered_json reportJson(const ReportOptions& options, const ReportPlan& plan) {
    ordered_json all;
    all["map"] = options.request.map;
    all["columns"] = options.columns;
    all["rows"] = options.rows;
    for (const auto& [name, value] : describeMachine(plan)) all["machine"][name] = value;
    all["summary"] = summarySentence(plan);
    for (const Measurement& m : plan.measurements) {
        ordered_json request = toJson(m.request);
        request.erase("pictures");
        ordered_json one = {{"measurement", m.label}, {"request", request}, {"result", m.result}};
        if (!m.problem.empty()) one["problem"] = m.problem;
        all["measurements"].push_back(one);
    }
    return all;
}

}  // namespace app
