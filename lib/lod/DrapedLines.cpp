#include "lod/DrapedLines.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "lod/BruteForceMesh.h"

namespace terrain {

namespace {

/// A cell's surface, cut along the diagonal that gives the higher one.
class CellSurface {
public:
    CellSurface(const SampleGrid& grid, int column, int row)
        : column_(column), row_(row), z00_(grid.height(column, row)), z10_(grid.height(column + 1, row)),
          z01_(grid.height(column, row + 1)), z11_(grid.height(column + 1, row + 1)), rising_(z00_ + z11_ > z10_ + z01_) {}

    /// Whether the diagonal goes from (0, 0) to (1, 1).
    bool isRising() const { return rising_; }

    glm::dvec2 gradient(const glm::dvec2& place) const {
        const double x = place.x - column_, y = place.y - row_;
        if (rising_) return x >= y ? glm::dvec2(z10_ - z00_, z11_ - z10_) : glm::dvec2(z11_ - z01_, z01_ - z00_);
        return x + y <= 1.0 ? glm::dvec2(z10_ - z00_, z01_ - z00_) : glm::dvec2(z11_ - z01_, z11_ - z10_);
    }

    double height(const glm::dvec2& place) const {
        const double x = place.x - column_, y = place.y - row_;
        const glm::dvec2 g = gradient(place);
        if (rising_ || x + y <= 1.0) return z00_ + g.x * x + g.y * y;
        return z11_ - g.x * (1.0 - x) - g.y * (1.0 - y);
    }

private:
    int column_, row_;
    double z00_, z10_, z01_, z11_;
    bool rising_;
};

/// Of the cells that a place lies in or on the border of, one that is there.
std::optional<glm::ivec2> cellAt(const SampleGrid& grid, const glm::dvec2& place) {
    const int column = int(std::floor(place.x)), row = int(std::floor(place.y));
    for (const int r : {row, place.y == row ? row - 1 : row})
        for (const int c : {column, place.x == column ? column - 1 : column})
            if (c >= 0 && r >= 0 && c < grid.columns() - 1 && r < grid.rows() - 1 && !isCellHole(grid, c, r))
                return glm::ivec2(c, r);
    return std::nullopt;
}

/// The part of the segment that lies in [0, limit] on one axis.
void clip(double from, double delta, double limit, double& first, double& last) {
    if (delta == 0.0) {
        if (from < 0.0 || from > limit) last = -1.0;
        return;
    }
    const double a = -from / delta, b = (limit - from) / delta;
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
}

/// Parameters in (first, last) at which from + t delta is a whole number.
void addCrossings(double from, double delta, double first, double last, std::vector<double>& crossings) {
    if (delta == 0.0) return;
    const double a = from + first * delta, b = from + last * delta;
    for (double line = std::ceil(std::min(a, b)); line <= std::max(a, b); line += 1.0) {
        const double t = (line - from) / delta;
        if (t > first && t < last) crossings.push_back(t);
    }
}

/// Where the segment crosses the diagonal of a cell between two parameters.
std::optional<double> diagonalCrossing(const CellSurface& surface, const glm::ivec2& cell, const glm::dvec2& from,
                                       const glm::dvec2& delta, double first, double last) {
    const double sign = surface.isRising() ? -1.0 : 1.0;
    const double speed = delta.x + sign * delta.y;
    if (speed == 0.0) return std::nullopt;
    const double line = surface.isRising() ? double(cell.x) - cell.y : double(cell.x) + cell.y + 1.0;
    const double t = (line - (from.x + sign * from.y)) / speed;
    // Nearer to the border it is the border.
    const double margin = 1e-9 * (last - first);
    return t > first + margin && t < last - margin ? std::optional<double>(t) : std::nullopt;
}

bool isPlace(const glm::dvec2& place) {
    return std::isfinite(place.x) && std::isfinite(place.y);
}

}  // namespace

DrapedLines::DrapedLines(const SampleGrid& grid, const DrapeInput& input) : offset_(input.offset) {
    int first = 0, polyline = 0;
    for (const int count : input.counts) {
        const auto place = [&](int i) { return input.places[std::size_t(first + i)]; };
        if (input.lines) {
            const int segments = input.closed && count > 2 ? count : count - 1;
            for (int i = 0; i < segments; ++i) {
                const int next = (i + 1) % count;
                if (isPlace(place(i)) && isPlace(place(next)))
                    addSegment(grid, place(i), place(next), Run{0, 0, polyline, i, first + i, first + next, false});
            }
        } else {
            for (int i = 0; i < count; ++i)
                if (isPlace(place(i))) addPoint(grid, place(i), polyline, i, first + i);
        }
        first += count;
        ++polyline;
    }
    deviations_.assign(vertices_.size(), 0.0f);
    for (const Run& run : runs_)
        if (run.count > 2) measure(run.first, run.first + run.count - 1);
}

void DrapedLines::addPoint(const SampleGrid& grid, const glm::dvec2& place, int polyline, int index, int number) {
    const auto cell = cellAt(grid, place);
    if (!cell) return;
    const CellSurface surface(grid, cell->x, cell->y);
    runs_.push_back({std::uint32_t(vertices_.size()), 1, polyline, index, number, number, false});
    vertices_.push_back({glm::vec3(place, surface.height(place) + offset_), glm::vec2(surface.gradient(place)), 0.0f});
}

void DrapedLines::addSegment(const SampleGrid& grid, const glm::dvec2& a, const glm::dvec2& b, Run run) {
    const glm::dvec2 delta = b - a;
    double first = 0.0, last = 1.0;
    clip(a.x, delta.x, grid.columns() - 1.0, first, last);
    clip(a.y, delta.y, grid.rows() - 1.0, first, last);
    if (!(first < last)) return;
    std::vector<double> crossings{first, last};
    addCrossings(a.x, delta.x, first, last, crossings);
    addCrossings(a.y, delta.y, first, last, crossings);
    std::sort(crossings.begin(), crossings.end());
    bool open = false;
    for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
        const double from = crossings[i], to = crossings[i + 1];
        if (!(from < to)) continue;
        const auto cell = cellAt(grid, a + delta * ((from + to) * 0.5));
        if (!cell) {
            open = false;
            continue;
        }
        const CellSurface surface(grid, cell->x, cell->y);
        const auto add = [&](double t, double inside) {
            const glm::dvec2 place = a + delta * t;
            vertices_.push_back(
                {glm::vec3(place, surface.height(place) + offset_), glm::vec2(surface.gradient(a + delta * inside)), float(t)});
            ++runs_.back().count;
        };
        if (!open) {
            run.first = std::uint32_t(vertices_.size());
            // What ends at the segment's first place is the run before, of the same polyline.
            run.continues = from == 0.0 && !runs_.empty() && runs_.back().polyline == run.polyline &&
                            runs_.back().segment == run.segment - 1 && vertices_.back().along == 1.0f;
            runs_.push_back(run);
            add(from, (from + to) * 0.5);
            open = true;
        }
        if (const auto t = diagonalCrossing(surface, *cell, a, delta, from, to)) add(*t, (*t + to) * 0.5);
        add(to, (from + to) * 0.5);
    }
}

void DrapedLines::measure(std::uint32_t first, std::uint32_t last) {
    if (last - first < 2) return;
    const Vertex &a = vertices_[first], &b = vertices_[last];
    float largest = 0.0f;
    for (std::uint32_t i = first + 1; i < last; ++i) {
        const float weight = (vertices_[i].along - a.along) / (b.along - a.along);
        largest = std::max(largest, std::fabs(vertices_[i].position.z - (a.position.z + weight * (b.position.z - a.position.z))));
    }
    const std::uint32_t middle = halfway(first, last);
    deviations_[middle] = largest;
    measure(first, middle);
    measure(middle, last);
}

std::size_t DrapedLines::bytes() const {
    return vertices_.capacity() * sizeof(Vertex) + runs_.capacity() * sizeof(Run) + deviations_.capacity() * sizeof(float);
}

}  // namespace terrain
