// What the height tools find, in words and files.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <iomanip>
#include <locale>
#include <sstream>
#include <string_view>

#include "HeightTools.h"

namespace app {

using terrain::Error;
using terrain::Result;

namespace {

constexpr std::string_view markersHeader = "x,y,name";

std::string number(double value, int digits) {
    char text[64];
    // No -0.00.
    const double unit = std::pow(10.0, -digits);
    if (std::fabs(value) < 0.5 * unit) value = 0.0;
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
}

const char* compass(double degrees) {
    static const char* const names[] = {"N", "NE", "E", "SE", "S", "SW", "W", "NW"};
    return names[std::size_t(std::lround(degrees / 45.0)) % 8];
}

std::string quoted(const std::string& name) {
    std::string text = "\"";
    for (const char c : name) {
        if (c == '"') text += c;
        text += c;
    }
    text += '"';
    return text;
}

// The text between the first quotes after a place.
std::string quotedAfter(const std::string& text, std::size_t at) {
    const std::size_t first = text.find('"', at);
    const std::size_t last = first == text.npos ? text.npos : text.find('"', first + 1);
    return last == text.npos ? "" : text.substr(first + 1, last - first - 1);
}

std::optional<double> readNumber(std::string_view text) {
    while (text.starts_with(' ')) text.remove_prefix(1);
    while (text.ends_with(' ')) text.remove_suffix(1);
    double value = 0.0;
    const auto [stop, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc() || stop != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

// A name as CSV has it: in quotes, with doubled ones inside, or as it is.
std::string readName(std::string_view text) {
    if (text.size() < 2 || !text.starts_with('"') || !text.ends_with('"')) return std::string(text);
    std::string name(text.substr(1, text.size() - 2));
    for (std::size_t at = 0; (at = name.find("\"\"", at)) != name.npos; ++at) name.erase(at, 1);
    return name;
}

}  // namespace

std::string systemName(const std::string& wkt) {
    if (wkt.empty()) return "";
    std::string name = quotedAfter(wkt, 0);
    // The last one is that of the whole.
    for (const char* key : {"AUTHORITY[\"EPSG\",", "ID[\"EPSG\","}) {
        const std::size_t at = wkt.rfind(key);
        if (at == wkt.npos) continue;
        std::string code;
        for (std::size_t i = at + std::string_view(key).size(); i < wkt.size() && wkt[i] != ']'; ++i)
            if (wkt[i] >= '0' && wkt[i] <= '9') code += wkt[i];
        // What comes after it belongs to the whole, too.
        const bool isOfWhole = std::count(wkt.begin() + std::ptrdiff_t(at), wkt.end(), ']') <= 2;
        if (!code.empty() && isOfWhole) return name + " (EPSG:" + code + ")";
    }
    return name;
}

bool isGeographic(const std::string& wkt) {
    return wkt.starts_with("GEOGCS") || wkt.starts_with("GEOGCRS");
}

std::string lengthUnit(const std::string& wkt) {
    if (wkt.empty() || isGeographic(wkt)) return "";
    const std::size_t wkt1 = wkt.rfind("UNIT[");
    if (wkt1 == wkt.npos) return "";
    const std::string name = quotedAfter(wkt, wkt1);
    if (name == "metre" || name == "meter" || name == "Meter" || name == "m") return "m";
    return name.find("foot") != name.npos || name.find("Foot") != name.npos ? "ft" : "";
}

GroundText::GroundText(const Ground& ground, std::optional<Georeference> reference)
    : lattice_(ground.lattice()), reference_(std::move(reference)), unit_(reference_ ? reference_->unit : "") {
    const double cell = lattice_.columns > 1 ? std::min(lattice_.spacing.x, lattice_.spacing.y) : 0.01;
    digits_ = std::clamp(int(std::ceil(2.0 - std::log10(cell))), 0, 8);
}

std::string GroundText::length(double value) const {
    return number(value, digits_) + (unit_.empty() ? "" : " " + unit_);
}

std::optional<glm::dvec2> GroundText::worldAt(glm::dvec2 place) const {
    if (!reference_ || lattice_.columns < 2) return std::nullopt;
    return reference_->origin + reference_->spacing * ((place - lattice_.origin) / lattice_.spacing);
}

std::string GroundText::label(const Spot& spot) const {
    std::string text = "height " + length(spot.at.z) + ", slope " + number(spot.slopeDegrees, 1) + "\u00b0";
    if (spot.aspectDegrees)
        text += " to " + number(std::fmod(std::round(*spot.aspectDegrees), 360.0), 0) + "\u00b0 " + compass(*spot.aspectDegrees);
    return text;
}

std::string GroundText::spot(const Spot& spot) const {
    std::string text = "x " + number(spot.at.x, digits_) + ", y " + number(spot.at.y, digits_) + ", " + label(spot);
    const auto world = worldAt(spot.at);
    if (!world) return text;
    if (reference_->isGeographic)
        text += "; longitude " + number(world->x, 6) + "\u00b0, latitude " + number(world->y, 6) + "\u00b0";
    else
        text += "; E " + number(world->x, 2) + ", N " + number(world->y, 2);
    return reference_->system.empty() ? text : text + ", " + reference_->system;
}

std::string GroundText::line(const MeasuredLine& line) const {
    if (!line.hasGround()) return "no ground under the line: it lies outside of the map or in holes";
    std::string text = "ground " + length(line.ground) + ", horizontal " + length(line.horizontal) + ", climb " +
                       length(line.climb) + ", descent " + length(line.descent) + ", steepest " + number(line.steepestDegrees, 1) +
                       "\u00b0, heights " + length(*line.lowest) + " to " + length(*line.highest);
    if (line.withoutGround > 1e-9 * line.horizontal) text += "; " + length(line.withoutGround) + " of it without ground";
    return text;
}

std::string GroundText::nothing(glm::dvec2 place) const {
    const std::string where = "x " + number(place.x, digits_) + ", y " + number(place.y, digits_) + ": ";
    if (lattice_.columns < 2) return where + "no ground here";
    const glm::dvec2 sample = (place - lattice_.origin) / lattice_.spacing;
    const bool inside = sample.x >= 0.0 && sample.y >= 0.0 && sample.x <= lattice_.columns - 1 && sample.y <= lattice_.rows - 1;
    return where + (inside ? "a hole in the map" : "outside of the map");
}

std::string profileCsv(const MeasuredLine& line, const GroundText& text) {
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out.precision(12);
    const bool hasWorld = !line.points.empty() && text.worldAt(line.points.front().at);
    out << "distance,x,y,height" << (hasWorld ? ",east,north\n" : "\n");
    for (const ProfilePoint& point : line.points) {
        out << point.distance << ',' << point.at.x << ',' << point.at.y << ',';
        // Heights are single precision.
        if (point.height) out << std::setprecision(7) << *point.height << std::setprecision(12);
        if (const auto world = text.worldAt(point.at)) out << ',' << world->x << ',' << world->y;
        out << '\n';
    }
    return out.str();
}

std::string markersCsv(const std::vector<Marker>& markers) {
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out.precision(12);
    out << markersHeader << '\n';
    for (const Marker& marker : markers) out << marker.at.x << ',' << marker.at.y << ',' << quoted(marker.name) << '\n';
    return out.str();
}

std::optional<Marker> readMarker(const std::string& text) {
    const std::size_t first = text.find(','), second = first == text.npos ? text.npos : text.find(',', first + 1);
    if (first == text.npos) return std::nullopt;
    const auto x = readNumber(std::string_view(text).substr(0, first));
    const auto y = readNumber(std::string_view(text).substr(first + 1, second == text.npos ? text.npos : second - first - 1));
    if (!x || !y) return std::nullopt;
    return Marker{{*x, *y}, second == text.npos ? "" : readName(std::string_view(text).substr(second + 1))};
}

Result<std::vector<Marker>> readMarkersCsv(const std::string& text, const std::string& name) {
    std::vector<Marker> markers;
    std::istringstream in(text);
    std::string row;
    for (int line = 1; std::getline(in, row); ++line) {
        while (!row.empty() && (row.back() == '\r' || row.back() == ' ')) row.pop_back();
        if (row.empty() || (line == 1 && row == markersHeader)) continue;
        const auto marker = readMarker(row);
        if (!marker) return Error{name + ":" + std::to_string(line), "x,y,name", "\"" + row.substr(0, 80) + "\""};
        markers.push_back(*marker);
    }
    return markers;
}

std::optional<std::vector<glm::dvec2>> readPlaces(const std::string& text) {
    std::vector<double> numbers;
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t end = std::min(text.find(',', at), text.size());
        const auto value = readNumber(std::string_view(text).substr(at, end - at));
        if (!value) return std::nullopt;
        numbers.push_back(*value);
        at = end + 1;
    }
    if (numbers.size() % 2 != 0) return std::nullopt;
    std::vector<glm::dvec2> places;
    for (std::size_t i = 0; i < numbers.size(); i += 2) places.emplace_back(numbers[i], numbers[i + 1]);
    return places;
}

}  // namespace app
