// Statistics of frames as JSON and CSV.
#include <algorithm>
#include <cmath>
#include <locale>
#include <sstream>

#include <SoTerrain/SoTerrain.h>
#include <nlohmann/json.hpp>

#include "base/ProfileScope.h"

#include "FrameStatistics.h"
#include "ProcessMemory.h"

namespace app {

namespace {

using nlohmann::ordered_json;
using Terrain = FrameFigures::Terrain;

// Four digits after the point are more than any clock here knows.
double rounded(double value) {
    return std::round(value * 1e4) / 1e4;
}

double frameMs(const FrameFigures& f) {
    return f.frameMs;
}
double cpuMs(const FrameFigures& f) {
    return f.cpuMs;
}
double triangles(const FrameFigures& f) {
    return double(f.triangles);
}
template <double Terrain::*Time>
double part(const FrameFigures& f) {
    return f.terrain ? (*f.terrain).*Time : 0.0;
}

ordered_json toJson(const Summary& s) {
    return {{"median", rounded(s.median)}, {"p95", rounded(s.p95)}, {"worst", rounded(s.worst)}, {"mean", rounded(s.mean)}};
}

std::string quoted(std::string text) {
    for (std::size_t at = 0; (at = text.find('"', at)) != text.npos; at += 2) text.insert(at, 1, '"');
    return '"' + text + '"';
}

}  // namespace

std::string FrameStatistics::json(const RunInfo& info) const {
    const Summary count = summary(triangles);
    ordered_json out;
    out["algorithm"] = info.algorithm;
    out["renderer"] = info.renderer;
    out["version"] = SoTerrain::getVersion();
    out["size_px"] = {info.sizePixels.x, info.sizePixels.y};
    for (const auto& [name, value] : info.settings) out["settings"][name] = value;
    out["frames"] = frames();
    out["repetitions"] = flights_.size();
    out["frame_ms"] = toJson(summary(frameMs));
    out["fps"] = rounded(framesPerSecond());
    out["cpu_ms"] = toJson(summary(cpuMs));
    out["triangles"] = {{"mean", rounded(count.mean)}, {"max", count.worst}, {"same_in_all", sameTriangles()}};
    if (hasTerrain()) {
        out["select_ms"] = {{"median", rounded(summary(part<&Terrain::selectMs>).median)}};
        out["upload_ms"] = {{"median", rounded(summary(part<&Terrain::uploadMs>).median)}};
        out["draw_ms"] = {{"median", rounded(summary(part<&Terrain::drawMs>).median)}};
        out["error_px"] = {{"bound_max", nullptr}};
        if (const auto bound = errorBound()) out["error_px"]["bound_max"] = rounded(*bound);
        out["unfinished_frames"] = unfinished();
        out["bytes"] = {{"memory", most(&Terrain::memoryBytes)}, {"buffers", most(&Terrain::bufferBytes)}};
    }
    out["resident_bytes"] = {{"now", std::uint64_t(processBytes("VmRSS:"))}, {"most", std::uint64_t(processBytes("VmHWM:"))}};
    if (!errors_.frames.empty()) {
        out["measured_error_px"] = {{"rms", rounded(errors_.rms())},
                                    {"p999", rounded(errors_.quantile(0.999))},
                                    {"max", rounded(errors_.maximum())},
                                    {"samples", errors_.samples()},
                                    {"not_drawn", errors_.missing}};
    }
    if (!animations_.empty()) {
        const AnimationTime time = animation();
        out["animation_ms"] = {{"wanted", rounded(time.wantedMs)},
                               {"lasted", rounded(time.lastedMs)},
                               {"longest_frame", rounded(time.longestFrameMs)}};
    }
    out["start_ms"] = {{"load", rounded(loadMs_)}, {"first_frame", rounded(firstFrameMs_)}};
    for (const terrain::ScopeTotal& scope : terrain::profileTotals())
        out["scopes"][scope.name] = {{"count", scope.count}, {"ms", scope.milliseconds}};
    // File names may hold any bytes; JSON only UTF-8.
    return out.dump(2, ' ', false, ordered_json::error_handler_t::replace);
}

std::string FrameStatistics::csv(const RunInfo& info) const {
    const Summary frame = summary(frameMs), cpu = summary(cpuMs), count = summary(triangles);
    const AnimationTime time = animation();
    std::string settings;
    for (const auto& [name, value] : info.settings) settings += (settings.empty() ? "" : "; ") + name + " " + value;
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out.precision(10);
    out << "algorithm,renderer,version,width,height,frames,repetitions,frame_ms_median,frame_ms_p95,frame_ms_worst,frame_ms_mean,"
           "fps,"
           "cpu_ms_median,cpu_ms_mean,triangles_mean,triangles_max,same_triangles,error_px_bound,unfinished_frames,memory_bytes,"
           "buffer_bytes,resident_bytes,animation_ms,settings\n";
    out << quoted(info.algorithm) << ',' << quoted(info.renderer) << ',' << SoTerrain::getVersion() << ',' << info.sizePixels.x
        << ',' << info.sizePixels.y << ',' << frames() << ',' << flights_.size() << ',' << rounded(frame.median) << ','
        << rounded(frame.p95) << ',' << rounded(frame.worst) << ',' << rounded(frame.mean) << ',' << rounded(framesPerSecond())
        << ',' << rounded(cpu.median) << ',' << rounded(cpu.mean) << ',' << rounded(count.mean) << ',' << count.worst << ','
        << (sameTriangles() ? "yes" : "no") << ',';
    if (const auto bound = errorBound()) out << rounded(*bound);
    out << ',';
    if (hasTerrain())
        out << unfinished() << ',' << most(&Terrain::memoryBytes) << ',' << most(&Terrain::bufferBytes) << ',';
    else
        out << ",,,";
    out << std::uint64_t(processBytes("VmHWM:")) << ',' << rounded(time.lastedMs) << ',' << quoted(settings) << '\n';
    return out.str();
}

}  // namespace app
