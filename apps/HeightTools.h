// What a user asks of the ground: height, slope, the length of a way and its profile. All by the full-resolution samples.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "base/Result.h"

namespace app {

/// Ground over the (x, y) plane, in the terrain's own coordinates; z is up.
class Ground {
public:
    struct Surface {
        double height = 0.0;
        glm::dvec3 normal{0.0, 0.0, 1.0};  ///< unit, of the triangle there, upwards
    };
    /// Where samples stand: origin + spacing * (column, row). Without columns it is not known.
    struct Lattice {
        int columns = 0;
        int rows = 0;
        glm::dvec2 origin{0.0, 0.0};
        glm::dvec2 spacing{1.0, 1.0};
    };

    virtual ~Ground() = default;
    /// Nothing outside of the ground and in holes.
    virtual std::optional<Surface> at(glm::dvec2 place) const = 0;
    virtual Lattice lattice() const = 0;
};

/// A place on the ground.
struct Spot {
    glm::dvec3 at{0.0};
    double slopeDegrees = 0.0;
    std::optional<double> aspectDegrees;  ///< where the ground falls to: 0 north (y), 90 east (x); none where it is level
};

std::optional<Spot> spotAt(const Ground& ground, glm::dvec2 place);

/// Where a profile has a corner.
struct ProfilePoint {
    double distance = 0.0;  ///< from the start, horizontal
    glm::dvec2 at{0.0, 0.0};
    std::optional<double> height;  ///< none outside of the ground and in holes
};

/// A polyline on the ground.
struct MeasuredLine {
    std::vector<glm::dvec2> corners;
    std::vector<ProfilePoint>
        points;                    ///< wherever the ground has an edge under the line; between two that have heights it is straight
    double horizontal = 0.0;       ///< length seen from above
    double withoutGround = 0.0;    ///< of it, over holes and outside of the map
    double ground = 0.0;           ///< length along the ground, where there is some
    double climb = 0.0;            ///< sum of what it rises
    double descent = 0.0;          ///< sum of what it falls
    double steepestDegrees = 0.0;  ///< greatest slope along the line
    std::optional<double> lowest;
    std::optional<double> highest;

    bool hasGround() const { return lowest.has_value(); }
    /// The place at a horizontal distance from the start, between 0 and `horizontal`.
    glm::dvec2 placeAt(double distance) const;
    std::optional<double> heightAt(double distance) const;
};

/// Measures the way through these corners, of which there are at least two. It is cut at every row, column and diagonal of cells,
/// so that its figures are those of the surface itself; where the lattice is not known, into 4096 pieces a leg. Cost: a few queries
/// of the ground for each piece.
MeasuredLine measureLine(const Ground& ground, std::vector<glm::dvec2> corners);

/// Where a map lies in the world, as its file says.
struct Georeference {
    glm::dvec2 origin{0.0, 0.0};   ///< of sample (0, 0)
    glm::dvec2 spacing{1.0, 1.0};  ///< between samples
    std::string system;            ///< name of its coordinate system; empty: none is named
    bool isGeographic = false;     ///< longitudes and latitudes
    std::string unit;              ///< of lengths in the scene: "m", "ft"; empty: not known
};

/// The name of a coordinate system in well-known text, with its EPSG code where it has one; empty for an empty text.
std::string systemName(const std::string& wkt);
/// Whether well-known text is of longitudes and latitudes.
bool isGeographic(const std::string& wkt);
/// "m" or "ft" for the lengths of a projected system; empty where it is another unit.
std::string lengthUnit(const std::string& wkt);

/// Turns what was found into words.
class GroundText {
public:
    GroundText(const Ground& ground, std::optional<Georeference> reference);

    /// "123.4 m"
    std::string length(double value) const;
    /// "x 12.5 y 30 height 17.2 m   slope 12.3° to 270° (W)   E 500012 N 4649020 WGS 84 / UTM zone 33N (EPSG:32633)"
    std::string spot(const Spot& spot) const;
    /// Height and slope alone, for a label.
    std::string label(const Spot& spot) const;
    std::string line(const MeasuredLine& line) const;
    /// Why nothing is there.
    std::string nothing(glm::dvec2 place) const;
    /// Coordinates in the file's system; none without one.
    std::optional<glm::dvec2> worldAt(glm::dvec2 place) const;
    const std::string& unit() const { return unit_; }

private:
    Ground::Lattice lattice_;
    std::optional<Georeference> reference_;
    std::string unit_;
    int digits_ = 2;  ///< after the point: a hundredth of a sample's distance, or less
};

/// The profile as CSV: distance,x,y,height; with a georeference also east,north. Empty heights where there is no ground.
std::string profileCsv(const MeasuredLine& line, const GroundText& text);

/// A named place.
struct Marker {
    glm::dvec2 at{0.0, 0.0};
    std::string name;
};

/// x,y,name with that header; names in quotes.
std::string markersCsv(const std::vector<Marker>& markers);
/// Reads it back. Errors name the line.
terrain::Result<std::vector<Marker>> readMarkersCsv(const std::string& text, const std::string& name);

/// "X,Y[,X,Y...]" as pairs. Nothing when it is no list of finite numbers in pairs.
std::optional<std::vector<glm::dvec2>> readPlaces(const std::string& text);
/// "X,Y[,NAME]"
std::optional<Marker> readMarker(const std::string& text);

}  // namespace app
