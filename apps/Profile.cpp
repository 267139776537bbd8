#include "Profile.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <locale>

#include <nlohmann/json.hpp>

#include "base/ProfileScope.h"

#include "Statistics.h"

namespace app {

namespace {

// Four digits after the point are more than any clock here knows.
double rounded(double value) {
    return std::round(value * 1e4) / 1e4;
}

double roundedMedian(const std::vector<double>& values) {
    return rounded(summarize(values).median);
}

}  // namespace

terrain::Result<ProfileWriter> ProfileWriter::open(const std::string& path) {
    ProfileWriter writer;
    writer.file_.open(path, std::ios::trunc);
    if (!writer.file_) return terrain::Error{path, "a file that can be written", "no permission, or no such folder"};
    writer.file_.imbue(std::locale::classic());
    writer.file_ << "frame,time_ms,frame_ms,select_ms,upload_ms,draw_ms,triangles,patches,error_px,resident_bytes\n";
    return writer;
}

void ProfileWriter::write(const FrameFigures& f) {
    file_ << f.frame << ',' << f.timeMs << ',' << f.frameMs << ',';
    if (f.terrain)
        file_ << f.terrain->selectMs << ',' << f.terrain->uploadMs << ',' << f.terrain->drawMs << ',';
    else
        file_ << ",,,";
    file_ << f.triangles << ',';
    if (f.terrain)
        file_ << f.terrain->patches << ',' << f.terrain->errorPixels << ',' << f.terrain->memoryBytes + f.terrain->bufferBytes;
    else
        file_ << ",,";
    file_ << '\n';
}

bool ProfileWriter::close() {
    file_.close();
    return !file_.fail();
}

void FrameStatistics::add(const FrameFigures& figures) {
    frame_.push_back(figures.frameMs);
    triangles_.push_back(double(figures.triangles));
    if (!figures.terrain) return;
    const FrameFigures::Terrain& t = *figures.terrain;
    select_.push_back(t.selectMs);
    upload_.push_back(t.uploadMs);
    draw_.push_back(t.drawMs);
    // A tile that stands in for others and reaches behind the eye has none.
    if (std::isfinite(t.errorPixels)) errorBound_ = std::max(errorBound_.value_or(0.0), t.errorPixels);
    unfinished_ += t.isComplete ? 0 : 1;
    memoryBytes_ = std::max(memoryBytes_, t.memoryBytes);
    bufferBytes_ = std::max(bufferBytes_, t.bufferBytes);
}

void FrameStatistics::setStart(double loadMs, double firstFrameMs) {
    loadMs_ = loadMs;
    firstFrameMs_ = firstFrameMs;
}

std::string FrameStatistics::line() const {
    char text[160];
    std::snprintf(text, sizeof text, "%zu %s, median %.2f ms, mean %.0f triangles", frame_.size(),
                  frame_.size() == 1 ? "frame" : "frames", summarize(frame_).median, summarize(triangles_).mean);
    std::string line = text;
    if (!select_.empty()) {
        if (errorBound_) {
            std::snprintf(text, sizeof text, ", worst error bound %.2f px", *errorBound_);
            line += text;
        }
        if (unfinished_ > 0) line += ", " + std::to_string(unfinished_) + " not complete";
    }
    return line;
}

std::string FrameStatistics::json(const std::string& algorithm, const std::string& renderer) const {
    const Summary frame = summarize(frame_), triangles = summarize(triangles_);
    nlohmann::ordered_json out;
    out["algorithm"] = algorithm;
    out["renderer"] = renderer;
    out["frames"] = frame_.size();
    out["frame_ms"] = {{"median", rounded(frame.median)}, {"p95", rounded(frame.p95)}, {"worst", rounded(frame.worst)}};
    out["triangles"] = {{"mean", rounded(triangles.mean)}, {"max", triangles.worst}};
    if (!select_.empty()) {
        out["select_ms"] = {{"median", roundedMedian(select_)}};
        out["upload_ms"] = {{"median", roundedMedian(upload_)}};
        out["draw_ms"] = {{"median", roundedMedian(draw_)}};
        out["error_px"] = {{"bound_max", nullptr}};
        if (errorBound_) out["error_px"]["bound_max"] = rounded(*errorBound_);
        out["unfinished_frames"] = unfinished_;
        out["bytes"] = {{"memory", memoryBytes_}, {"buffers", bufferBytes_}};
    }
    if (!errors_.frames.empty()) {
        out["measured_error_px"] = {{"rms", rounded(errors_.rms())},
                                    {"p999", rounded(errors_.quantile(0.999))},
                                    {"max", rounded(errors_.maximum())},
                                    {"samples", errors_.samples()},
                                    {"not_drawn", errors_.missing}};
    }
    out["start_ms"] = {{"load", rounded(loadMs_)}, {"first_frame", rounded(firstFrameMs_)}};
    // File names may hold any bytes; JSON only UTF-8.
    for (const terrain::ScopeTotal& scope : terrain::profileTotals())
        out["scopes"][scope.name] = {{"count", scope.count}, {"ms", scope.milliseconds}};
    return out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace app
