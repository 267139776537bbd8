#include "HeightSession.h"

#include <algorithm>
#include <fstream>

#include <glm/geometric.hpp>

namespace app {

using terrain::Error;
using terrain::Result;

std::optional<Georeference> HeightSession::reference() const {
    return scene_.grid() ? scene_.grid()->georeference : std::nullopt;
}

bool HeightSession::follow() {
    const bool isAnother = scene_.root() != root_.get();
    if (isAnother) {
        root_ = NodePtr<SoSeparator>(scene_.root());
        line_ = {};
        markers_.clear();
        drawing_.forget();
    }
    drawing_.follow();
    return isAnother;
}

std::string HeightSession::pick(glm::dvec2 place) {
    drawing_.follow();
    const auto spot = spotAt(ground_, place);
    const GroundText words = text();
    drawing_.showSpot(spot, spot ? words.label(*spot) : "");
    return spot ? words.spot(*spot) : words.nothing(place);
}

void HeightSession::forgetPick() {
    drawing_.showSpot(std::nullopt, "");
}

void HeightSession::addCorner(glm::dvec2 place) {
    line_.corners.push_back(place);
    measure();
}

void HeightSession::setLine(std::vector<glm::dvec2> corners) {
    line_.corners = std::move(corners);
    measure();
}

void HeightSession::measure() {
    drawing_.follow();
    line_ = measureLine(ground_, line_.corners);
    drawing_.showCursor(std::nullopt);
    drawing_.showLine(line_.corners, line_.hasGround() ? text().length(line_.ground) : "");
}

std::string HeightSession::lineText() const {
    return line_.corners.size() < 2 ? "" : text().line(line_);
}

std::optional<Error> HeightSession::writeProfile(const std::string& path) const {
    std::ofstream file(path, std::ios::trunc);
    file << profileCsv(line_, text());
    file.close();
    return file ? std::nullopt : std::optional(Error{path, "a file that can be written", "no permission, or no such folder"});
}

std::string HeightSession::showAt(std::optional<double> distance) {
    if (!distance || line_.points.empty()) {
        drawing_.showCursor(std::nullopt);
        return "";
    }
    const glm::dvec2 place = line_.placeAt(*distance);
    const auto spot = spotAt(ground_, place);
    drawing_.showCursor(spot ? std::optional(place) : std::nullopt);
    const GroundText words = text();
    return "at " + words.length(*distance) + ": " + (spot ? words.spot(*spot) : words.nothing(place));
}

std::string HeightSession::addMarker(Marker marker) {
    drawing_.follow();
    const auto spot = spotAt(ground_, marker.at);
    if (!spot) return text().nothing(marker.at);
    if (marker.name.empty()) marker.name = std::to_string(markers_.size() + 1);
    markers_.push_back(marker);
    drawing_.showMarkers(markers_);
    return marker.name + ": " + text().spot(*spot);
}

bool HeightSession::removeMarker(glm::dvec2 near) {
    const auto closer = [near](const Marker& a, const Marker& b) { return glm::distance(a.at, near) < glm::distance(b.at, near); };
    const auto nearest = std::min_element(markers_.begin(), markers_.end(), closer);
    if (nearest == markers_.end()) return false;
    markers_.erase(nearest);
    drawing_.showMarkers(markers_);
    return true;
}

void HeightSession::setMarkers(std::vector<Marker> markers) {
    drawing_.follow();
    markers_ = std::move(markers);
    drawing_.showMarkers(markers_);
}

Result<std::string> HeightSession::apply(const Options& options) {
    std::string said;
    for (const glm::dvec2& place : options.picks) said += "pick: " + pick(place) + "\n";
    for (const Marker& marker : options.markers) said += "marker " + addMarker(marker) + "\n";
    if (options.profileLine.empty()) return said;
    setLine(options.profileLine);
    said += "line: " + lineText() + "\n";
    if (options.lineOut.empty()) return said;
    if (auto problem = writeProfile(options.lineOut)) return *problem;
    return said;
}

}  // namespace app
