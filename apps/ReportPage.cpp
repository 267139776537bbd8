#include <algorithm>
#include <cctype>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <thread>

#include "Report.h"
#include "ReportStyle.h"

namespace app {

namespace {

using nlohmann::ordered_json;

std::string base64(const std::string& bytes) {
    static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve(bytes.size() * 4 / 3 + 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t three = 0;
        for (std::size_t k = 0; k < 3; ++k) three = three << 8 | (i + k < bytes.size() ? std::uint8_t(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : digits[three >> (18 - 6 * k) & 63u];
    }
    return text;
}

std::string contentsOf(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
}

std::string nameOf(const std::string& path) {
    return escaped(path.substr(path.find_last_of('/') + 1));
}

// A class name that may be broken before its words.
std::string breakable(const std::string& name) {
    std::string result;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const bool word = i > 0 && std::isupper(std::uint8_t(name[i])) && std::islower(std::uint8_t(name[i - 1]));
        result += (word ? "<wbr>" : "") + escaped(name.substr(i, 1));
    }
    return result;
}

// A sample of a curve's colour, as all plots have it.
std::string chip(const std::string& color, bool dashed) {
    return "<i class=\"chip" + std::string(dashed ? " dashed" : "") + "\" style=\"--c:" + color + "\"></i>";
}

class Page {
public:
    Page(const ReportOptions& options, const ReportPlan& plan, const std::vector<Plot>& plots)
        : options_(options), plan_(plan), plots_(plots) {
        const bool cut = std::any_of(plan.subjects.begin(), plan.subjects.end(),
                                     [&](const Subject& s) { return framesOf(s) < options.request.frames; });
        for (const Figure& figure : reportFigures())
            if (cut || std::string_view(figure.name) != "frames") figures_.push_back(figure);
    }

    std::string write() {
        writeHead();
        writeFindings();
        writeTable();
        out_ << "<section><h2>Over the flight</h2><div class=\"plots\">\n";
        for (const char* name : {"frames", "cpu", "triangles", "errors"}) writePlot(name);
        out_ << "</div></section>\n<section><h2>What an error costs, and what size does</h2><div class=\"plots\">\n";
        for (const char* name : {"trade", "sizes", "memory", "clipmaps"}) writePlot(name);
        out_ << "</div></section>\n";
        writePictures();
        writeMethod();
        writeMachine();
        out_ << "</main></body></html>\n";
        return out_.str();
    }

private:
    void writeHead();
    void writeFindings();
    void writeTable();
    void writeTableHead();
    void writeRow(const Subject& subject);
    void writePlot(const std::string& name);
    void writePictures();
    void writePicture(const Subject& subject, const char* name, const char* what);
    void writeMethod();
    void writeMachine();
    std::string picture(const Subject& subject, const char* name) const;
    int framesOf(const Subject& subject) const;
    void writeNotes();
    bool isBest(const Figure& figure, const Subject& subject) const;

    const ReportOptions& options_;
    const ReportPlan& plan_;
    const std::vector<Plot>& plots_;
    std::vector<Figure> figures_;  ///< the columns of the table
    std::ostringstream out_;
};

std::string Page::picture(const Subject& subject, const char* name) const {
    const Measurement& m = plan_.of(subject);
    const std::string bytes =
        m.measured() && !m.request.pictures.empty() ? contentsOf(m.request.pictures + name + ".jpg") : std::string();
    return bytes.empty() ? bytes : "data:image/jpeg;base64," + base64(bytes);
}

void Page::writeHead() {
    const std::string map = nameOf(options_.request.map);
    out_ << "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<meta name=\"viewport\" "
            "content=\"width=device-width, "
            "initial-scale=1\">\n<meta name=\"color-scheme\" content=\"light dark\">\n<title>"
         << map << ": terrain report</title>\n<style>" << reportStyle
         << "</style></head><body><main>\n<header><div><p class=\"kind\">Terrain report</p><h1>" << map
         << "</h1>\n<p class=\"summary\">" << escaped(summarySentence(plan_)) << "</p>\n<p class=\"errors\">"
         << escaped(errorSentence(options_, plan_)) << "</p>\n<ul class=\"facts\"><li>" << grouped(options_.columns) << " × "
         << grouped(options_.rows) << " samples</li><li>"
         << (options_.request.flight.empty() ? std::string("standard flight") : "flight " + nameOf(options_.request.flight)) << ", "
         << options_.request.frames << " frames</li><li>1024 × 768 pixels</li><li>pixelError " << options_.request.pixelError
         << "</li>"
         << (options_.request.texture.empty() ? std::string() : "<li>texture " + nameOf(options_.request.texture) + "</li>")
         << "</ul></div>\n";
    const auto found = findings(plan_);
    const std::string shaded = found.empty() ? std::string() : picture(*found.front().subject, "shaded");
    if (!shaded.empty())
        out_ << "<figure><img width=\"512\" height=\"384\" alt=\"The terrain a third of the way through the flight\" src=\""
             << shaded << "\"></figure>";
    out_ << "</header>\n";
    if (plan_.load > 0.5)
        out_ << "<p class=\"note\">When measurements began, the machine had other work to do (load " << format(plan_.load, 1)
             << " on " << std::thread::hardware_concurrency()
             << " processors): times are longer than they need be. Triangles and errors do not depend on that.</p>\n";
}

void Page::writeFindings() {
    out_ << "<section class=\"findings\">\n";
    for (const Finding& finding : findings(plan_))
        out_ << "<div class=\"finding\" style=\"--c:" << finding.subject->color << "\"><h3>" << finding.head
             << "</h3><p class=\"value\">" << finding.value << (finding.unit.empty() ? "" : " <small>" + finding.unit + "</small>")
             << "</p><p class=\"who\">" << breakable(finding.subject->label) << "</p><p>" << escaped(finding.text)
             << "</p></div>\n";
    out_ << "</section>\n";
}

bool Page::isBest(const Figure& figure, const Subject& subject) const {
    const auto value = figure.value(plan_.of(subject).result);
    if (!figure.lessIsBetter || !value) return false;
    return std::all_of(plan_.subjects.begin(), plan_.subjects.end(), [&](const Subject& other) {
        const Measurement& m = plan_.of(other);
        const auto theirs = m.measured() ? figure.value(m.result) : std::nullopt;
        return !theirs || format(*value, figure.digits) == format(*theirs, figure.digits) || *value < *theirs;
    });
}

void Page::writeTableHead() {
    const auto& figures = figures_;
    out_ << "<thead><tr><th rowspan=\"2\" scope=\"col\">Node</th>";
    for (std::size_t i = 0; i < figures.size();) {
        const std::size_t first = i;
        while (i < figures.size() && std::string_view(figures[i].group) == figures[first].group) ++i;
        out_ << "<th class=\"group\" scope=\"colgroup\" colspan=\"" << i - first << "\">" << figures[first].group << "</th>";
    }
    out_ << "</tr><tr>";
    const char* group = "";
    for (const Figure& figure : figures) {
        out_ << "<th scope=\"col\"" << (std::string_view(group) == figure.group ? "" : " class=\"first\"") << '>' << figure.head
             << "</th>";
        group = figure.group;
    }
    out_ << "</tr></thead>";
}

void Page::writeRow(const Subject& subject) {
    const Measurement& m = plan_.of(subject);
    out_ << "<tr><th scope=\"row\">" << chip(subject.color, subject.dashed) << breakable(subject.className)
         << (subject.fields.empty() ? "" : "<small>" + escaped(subject.fields) + "</small>") << "</th>";
    if (!m.measured()) {
        out_ << "<td class=\"problem\" colspan=\"" << figures_.size() << "\">not measured: " << escaped(m.problem)
             << "</td></tr>\n";
        return;
    }
    const char* group = "";
    for (const Figure& figure : figures_) {
        const auto value = figure.value(m.result);
        const bool over = std::string_view(figure.name) == "error_px_max" && value && *value > 1.005 * m.request.pixelError;
        std::string kinds = std::string_view(group) == figure.group ? "" : "first";
        if (isBest(figure, subject)) kinds += " best";
        if (over) kinds += " over";
        group = figure.group;
        out_ << "<td" << (kinds.empty() ? "" : " class=\"" + kinds + '"') << '>' << (value ? grouped(*value, figure.digits) : "–")
             << "</td>";
    }
    out_ << "</tr>\n";
}

// All of them where it was not measured.
int Page::framesOf(const Subject& subject) const {
    const Measurement& m = plan_.of(subject);
    return m.measured() ? m.result["frame_ms"]["frames"].get<int>() : options_.request.frames;
}

void Page::writeNotes() {
    for (const Subject& subject : plan_.subjects) {
        const Measurement& m = plan_.of(subject);
        const int incomplete = m.measured() ? m.result.value("incomplete_frames", 0) : 0;
        if (incomplete)
            out_ << "<p class=\"note\">" << escaped(subject.label) << ": " << incomplete << " of " << framesOf(subject)
                 << " frames were timed while it was still refining what it shows.</p>\n";
    }
    const auto left =
        std::count_if(plan_.measurements.begin(), plan_.measurements.end(), [](const Measurement& m) { return !m.measured(); });
    if (left)
        out_ << "<p class=\"note\">" << left << " of " << plan_.measurements.size()
             << " measurements are missing in the plots; report.csv says which, and why.</p>\n";
}

void Page::writeTable() {
    out_ << "<section><h2>Every node over the same flight</h2>\n<div class=\"wide\"><table id=\"nodes\">";
    writeTableHead();
    out_ << "<tbody>\n";
    for (const Subject& subject : plan_.subjects) writeRow(subject);
    out_ << "</tbody></table></div>\n<p class=\"caption\">Bold: the least of a column. Red: more than pixelError; geometry "
            "clipmaps do not keep it but "
            "report their error. –: Coin's shapes do not tell. <a href=\"#method\">How it was measured</a></p>\n";
    writeNotes();
    out_ << "</section>\n";
}

void Page::writePlot(const std::string& name) {
    const auto plot = std::find_if(plots_.begin(), plots_.end(), [&](const Plot& p) { return p.name == name; });
    if (plot == plots_.end()) return;
    out_ << "<figure><h3>" << escaped(plot->title) << "</h3>\n<ul class=\"keys\">";
    for (const Plot::Key& key : plot->keys) out_ << "<li>" << chip(key.color, key.dashed) << escaped(key.name) << "</li>";
    out_ << "</ul>\n" << plot->svg << "<figcaption>" << escaped(plot->text) << "</figcaption></figure>\n";
}

void Page::writePicture(const Subject& subject, const char* name, const char* what) {
    const std::string data = picture(subject, name);
    if (!data.empty())
        out_ << "<img loading=\"lazy\" width=\"512\" height=\"384\" alt=\"" << escaped(subject.label) << ": " << what << "\" src=\""
             << data << "\">";
}

void Page::writePictures() {
    // A build without OpenImageIO takes none.
    if (std::all_of(plan_.subjects.begin(), plan_.subjects.end(), [this](const Subject& s) { return picture(s, "lines").empty(); }))
        return;
    out_ << "<section><h2>Pictures</h2><p class=\"caption\">The frame a third of the way through the flight, at half its size: "
            "textured and "
            "lit, and the triangles that were drawn for it.</p><div class=\"pictures\">\n";
    for (const Subject& subject : plan_.subjects) {
        const Measurement& m = plan_.of(subject);
        if (!m.measured()) continue;
        out_ << "<figure><div class=\"pair\">";
        writePicture(subject, "shaded", "the picture");
        writePicture(subject, "lines", "its triangles");
        out_ << "</div><figcaption>" << chip(subject.color, subject.dashed) << "<b>" << escaped(subject.label) << "</b>";
        const ordered_json& triangles = m.result["series"]["triangles"];
        const std::size_t frame = std::size_t(options_.request.frames / 3);
        if (frame < triangles.size()) out_ << ", " << grouped(triangles[frame].get<double>()) << " triangles";
        out_ << "</figcaption></figure>\n";
    }
    out_ << "</div></section>\n";
}

void Page::writeMethod() {
    const BenchRequest& r = options_.request;
    out_ << "<section id=\"method\"><h2>How it was measured</h2><dl>"
            "<dt>Scene</dt><dd>Each node in a process of its own, with the same texture, texture coordinates, coordinates, "
            "normals, camera and "
            "light, over the same flight. Tiles that other threads build are there before times are taken.</dd>"
            "<dt>Frame</dt><dd>From the begin of the traversal until GL has finished (glFinish).</dd>"
            "<dt>CPU</dt><dd>Processor time of the traversing thread in a frame, with rasterisation off.</dd>"
            "<dt>Triangles</dt><dd>Counted by GL.</dd>"
            "<dt>Error on screen</dt><dd>How far each sample of the full data in view is drawn from where it belongs, in every "
         << r.errorEvery
         << (r.errorEvery == 1   ? "st"
             : r.errorEvery == 2 ? "nd"
             : r.errorEvery == 3 ? "rd"
                                 : "th")
         << " frame. Reported: the bound that the node itself gives, over all frames.</dd>"
            "<dt>Bytes a sample</dt><dd>Process: by how much its resident memory grew when the node was first drawn, with what GL "
            "took. "
            "Node, GL: "
            "what the node tells, in the last frame. Coin's coordinates, normals and texture coordinates take 32 bytes a "
            "sample besides, which a "
            "node after SoHeightMap does without.</dd>"
            "<dt>Start</dt><dd>What the first frame took longer than the same frame again.</dd>"
            "<dt>Sent</dt><dd>Uploads: what was sent to GL in a frame after the first, on average.</dd>"
            "<dt>Frames</dt><dd>How many of "
         << r.frames << " were drawn before " << format(60.0 * options_.minutes / 30.0, 0)
         << " seconds were over; means and medians are of those.</dd></dl>\n"
            "<p>The same figures in a terminal, times as far as times agree: <code>soterrain-bench --map "
         << nameOf(r.map) << (r.texture.empty() ? "" : " --texture " + nameOf(r.texture))
         << (r.flight.empty() ? "" : " --flight " + nameOf(r.flight)) << " --frames " << r.frames << " --pixel-error "
         << r.pixelError << " --error-every " << r.errorEvery
         << "</code></p><p>All measurements are in report.csv and report.json beside this page.</p></section>\n";
}

void Page::writeMachine() {
    out_ << "<section><h2>Machine and versions</h2><dl>";
    for (const auto& [name, value] : describeMachine(plan_))
        out_ << "<dt>" << escaped(name) << "</dt><dd>" << escaped(value) << "</dd>";
    const std::size_t measured = std::size_t(
        std::count_if(plan_.measurements.begin(), plan_.measurements.end(), [](const Measurement& m) { return m.measured(); }));
    out_ << "<dt>Measurements</dt><dd>" << measured << " of " << plan_.measurements.size() << ", in "
         << format(plan_.seconds / 60.0, 1) << " minutes</dd></dl></section>\n";
}

}  // namespace

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        const char* entity = c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : nullptr;
        result += entity ? std::string(entity) : std::string(1, c);
    }
    return result;
}

std::string reportPage(const ReportOptions& options, const ReportPlan& plan, const std::vector<Plot>& plots) {
    return Page(options, plan, plots).write();
}

}  // namespace app
