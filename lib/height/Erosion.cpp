#include "height/Erosion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <queue>
#include <string>
#include <utility>
#include <vector>

namespace terrain {

namespace {

std::optional<Error> problemOf(const HeightMap& map) {
    const std::string size = std::to_string(map.columns) + " x " + std::to_string(map.rows);
    if (map.columns < 2 || map.rows < 2) return Error{"erosion", "at least 2 x 2 samples", size};
    if (map.heights.size() != std::size_t(map.columns) * std::size_t(map.rows))
        return Error{"erosion", size + " samples", std::to_string(map.heights.size())};
    return std::nullopt;
}

/// The first of the (name, value, least, most) rows that is out of its range or NaN.
struct Range {
    const char* name;
    double value;
    double least;
    double most;
};

std::optional<Error> problemOf(std::initializer_list<Range> ranges) {
    for (const Range& range : ranges)
        if (!(range.value >= range.least && range.value <= range.most))
            return Error{std::string("erosion: ") + range.name,
                         "a number from " + std::to_string(range.least) + " to " + std::to_string(range.most),
                         std::to_string(range.value)};
    return std::nullopt;
}

/// Offsets of the eight neighbours of a sample.
constexpr std::array<std::array<int, 2>, 8> neighbours{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}}};

/// A small generator of its own (PCG-XSH-RR, O'Neill 2014), since those of the standard library differ in their distributions.
class Random {
public:
    explicit Random(std::uint32_t seed) : state_(seed * 6364136223846793005ull + 1442695040888963407ull) { next(); }

    /// In [0, 1), of 24 bits.
    float unit() { return float(next() >> 8) * (1.0f / 16777216.0f); }

private:
    std::uint32_t next() {
        const std::uint64_t old = state_;
        state_ = old * 6364136223846793005ull + 1442695040888963407ull;
        const auto shifted = std::uint32_t(((old >> 18) ^ old) >> 27);
        const auto turn = unsigned(old >> 59);
        return (shifted >> turn) | (shifted << ((32 - turn) & 31));
    }

    std::uint64_t state_;
};

/// Which way the water of every sample goes, and in which order samples follow from the border upwards.
class Drainage {
public:
    explicit Drainage(const HeightMap& map) : map_(map), flooded_(map.heights.size()), receiver_(map.heights.size(), none) {}

    void flood();
    void drain(Random& random);
    const std::vector<std::size_t>& upwards() const { return order_; }
    std::size_t receiver(std::size_t sample) const { return receiver_[sample]; }
    double distance(std::size_t from, std::size_t to) const;
    /// Samples whose water passes each sample, itself included.
    std::vector<float> drainedSamples() const;

private:
    static constexpr std::size_t none = std::size_t(-1);
    using Entry = std::pair<float, std::size_t>;
    using Heap = std::priority_queue<Entry, std::vector<Entry>, std::greater<>>;

    template <class Visit>
    void forNeighbours(std::size_t sample, Visit visit) const;
    bool isMouth(int column, int row) const;

    const HeightMap& map_;
    std::vector<float> flooded_;         ///< height of the water surface once every pit is full
    std::vector<std::size_t> receiver_;  ///< itself at a mouth
    std::vector<std::size_t> order_;
};

template <class Visit>
void Drainage::forNeighbours(std::size_t sample, Visit visit) const {
    const int column = int(sample % std::size_t(map_.columns));
    const int row = int(sample / std::size_t(map_.columns));
    for (const auto& offset : neighbours) {
        const int c = column + offset[0];
        const int r = row + offset[1];
        if (c >= 0 && c < map_.columns && r >= 0 && r < map_.rows)
            visit(std::size_t(r) * std::size_t(map_.columns) + std::size_t(c));
    }
}

bool Drainage::isMouth(int column, int row) const {
    return column == 0 || row == 0 || column == map_.columns - 1 || row == map_.rows - 1;
}

void Drainage::flood() {
    Heap heap;
    for (int row = 0; row < map_.rows; ++row)
        for (int column = 0; column < map_.columns; ++column) {
            const std::size_t sample = std::size_t(row) * std::size_t(map_.columns) + std::size_t(column);
            if (!isMouth(column, row) || std::isnan(map_.heights[sample])) continue;
            receiver_[sample] = sample;
            flooded_[sample] = map_.heights[sample];
            heap.push({flooded_[sample], sample});
        }
    order_.reserve(map_.heights.size());
    while (!heap.empty()) {
        const auto [level, sample] = heap.top();
        heap.pop();
        order_.push_back(sample);
        forNeighbours(sample, [&, level = level, sample = sample](std::size_t next) {
            if (receiver_[next] != none || std::isnan(map_.heights[next])) return;
            receiver_[next] = sample;
            flooded_[next] = std::max(level, map_.heights[next]);
            heap.push({flooded_[next], next});
        });
    }
}

/// Turns each sample to its steepest neighbour; the flood's own direction remains where the water stands level. Diagonals count as
/// between 1 and 2 long, by chance, or else all valleys would run in eight directions (rho 8: Fairfield and Leymarie, "Drainage
/// networks from grid digital elevation models", Water Resources Research 27, 1991).
void Drainage::drain(Random& random) {
    for (const std::size_t sample : order_) {
        if (receiver_[sample] == sample) continue;
        const double stretch = (2.0 - random.unit()) / std::sqrt(2.0);
        double steepest = 0.0;
        forNeighbours(sample, [&](std::size_t next) {
            if (receiver_[next] == none) return;
            const auto gap = next > sample ? next - sample : sample - next;
            const bool diagonal = gap != 1 && gap != std::size_t(map_.columns);
            const double slope =
                (double(flooded_[sample]) - flooded_[next]) / (distance(sample, next) * (diagonal ? stretch : 1.0));
            if (slope <= steepest) return;
            steepest = slope;
            receiver_[sample] = next;
        });
    }
}

double Drainage::distance(std::size_t from, std::size_t to) const {
    const auto columns = std::int64_t(map_.columns);
    const double dx = double(std::int64_t(from) % columns - std::int64_t(to) % columns) * map_.spacing.x;
    const double dy = double(std::int64_t(from) / columns - std::int64_t(to) / columns) * map_.spacing.y;
    return std::sqrt(dx * dx + dy * dy);
}

std::vector<float> Drainage::drainedSamples() const {
    std::vector<float> samples(map_.heights.size(), 1.0f);
    for (auto it = order_.rbegin(); it != order_.rend(); ++it)
        if (receiver_[*it] != *it) samples[receiver_[*it]] += samples[*it];
    return samples;
}

void stepRivers(HeightMap& map, const HeightMap& upliftMap, const RiverParameters& p, Random& random) {
    Drainage drainage(map);
    drainage.flood();
    drainage.drain(random);
    const std::vector<float> drained = drainage.drainedSamples();
    const double cellArea = map.spacing.x * map.spacing.y;
    for (const std::size_t sample : drainage.upwards()) {
        const std::size_t lower = drainage.receiver(sample);
        if (lower == sample) continue;
        const double distance = drainage.distance(sample, lower);
        const double factor = p.erosion * std::sqrt(drained[sample] * cellArea) / distance;
        const double rise = std::isnan(upliftMap.heights[sample]) ? 0.0 : p.uplift * upliftMap.heights[sample];
        const double height = (map.heights[sample] + rise + factor * map.heights[lower]) / (1.0 + factor);
        map.heights[sample] = float(std::min(height, map.heights[lower] + p.talus * distance));
    }
}

/// Soil creeps: dz/dt = D * (d2z/dx2 + d2z/dy2), in as many explicit parts as keep that stable. The border stays.
void creep(HeightMap& map, double diffusion) {
    const double weightX = diffusion / (map.spacing.x * map.spacing.x);
    const double weightY = diffusion / (map.spacing.y * map.spacing.y);
    const int parts = int(std::ceil((weightX + weightY) / 0.4));
    const auto x = float(weightX / std::max(parts, 1));
    const auto y = float(weightY / std::max(parts, 1));
    const auto columns = std::size_t(map.columns);
    std::vector<float> before;
    for (int part = 0; part < parts; ++part) {
        before.assign(map.heights.begin(), map.heights.end());
        for (int row = 1; row < map.rows - 1; ++row)
            for (int column = 1; column < map.columns - 1; ++column) {
                const std::size_t i = std::size_t(row) * columns + std::size_t(column);
                const float change = x * (before[i - 1] + before[i + 1] - 2.0f * before[i]) +
                                     y * (before[i - columns] + before[i + columns] - 2.0f * before[i]);
                if (!std::isnan(change)) map.heights[i] += change;
            }
    }
}

/// A border sample that stands above the one behind it would wall the land in.
void lowerBorder(HeightMap& map) {
    const auto lower = [&](int column, int row) {
        const float behind = map.at(std::clamp(column, 1, map.columns - 2), std::clamp(row, 1, map.rows - 2));
        float& height = map.heights[std::size_t(row) * std::size_t(map.columns) + std::size_t(column)];
        if (behind < height) height = behind;
    };
    if (map.columns < 3 || map.rows < 3) return;
    for (int column = 0; column < map.columns; ++column) lower(column, 0), lower(column, map.rows - 1);
    for (int row = 0; row < map.rows; ++row) lower(0, row), lower(map.columns - 1, row);
}

class Rain {
public:
    Rain(HeightMap& map, const DropletParameters& parameters)
        : map_(map), p_(parameters), cell_(float(0.5 * (map.spacing.x + map.spacing.y))) {}
    void fall(Random& random);

private:
    struct Surface {
        float height;
        float slopeX;
        float slopeY;
    };

    bool isInside(float x, float y) const {
        return x >= 0.0f && y >= 0.0f && x < float(map_.columns - 1) && y < float(map_.rows - 1);
    }
    float& at(int column, int row) { return map_.heights[std::size_t(row) * std::size_t(map_.columns) + std::size_t(column)]; }
    Surface surface(float x, float y);
    void change(float x, float y, float amount);

    HeightMap& map_;
    DropletParameters p_;
    float cell_;               ///< distance of a step, in the unit of heights
    std::vector<float> bell_;  ///< of the last change, kept for its memory
};

Rain::Surface Rain::surface(float x, float y) {
    const int column = int(x);
    const int row = int(y);
    const float u = x - float(column);
    const float v = y - float(row);
    const float sw = at(column, row), se = at(column + 1, row), nw = at(column, row + 1), ne = at(column + 1, row + 1);
    return {(sw * (1 - u) + se * u) * (1 - v) + (nw * (1 - u) + ne * u) * v, ((se - sw) * (1 - v) + (ne - nw) * v) / cell_,
            ((nw - sw) * (1 - u) + (ne - se) * u) / cell_};
}

/// Adds `amount` around (x, y) under a round bell. It is centred between the samples, not on one, or lattices of mounds would grow.
void Rain::change(float x, float y, float amount) {
    const float reach = float(p_.radius) + 1.0f;
    const int firstColumn = std::max(0, int(std::ceil(x - reach))), lastColumn = std::min(map_.columns - 1, int(x + reach));
    const int firstRow = std::max(0, int(std::ceil(y - reach))), lastRow = std::min(map_.rows - 1, int(y + reach));
    float total = 0.0f;
    bell_.clear();
    for (int row = firstRow; row <= lastRow; ++row)
        for (int column = firstColumn; column <= lastColumn; ++column) {
            const float dx = (float(column) - x) / reach;
            const float dy = (float(row) - y) / reach;
            const float part = std::max(0.0f, 1.0f - dx * dx - dy * dy);
            bell_.push_back(part * part);
            total += bell_.back();
        }
    std::size_t i = 0;
    for (int row = firstRow; row <= lastRow; ++row)
        for (int column = firstColumn; column <= lastColumn; ++column) at(column, row) += amount * bell_[i++] / total;
}

void Rain::fall(Random& random) {
    float x = random.unit() * float(map_.columns - 1);
    float y = random.unit() * float(map_.rows - 1);
    float directionX = 0.0f, directionY = 0.0f, speed = 1.0f, water = 1.0f, sediment = 0.0f;
    const auto inertia = float(p_.inertia);
    for (int step = 0; step < p_.lifetime && isInside(x, y); ++step) {
        const Surface here = surface(x, y);
        directionX = directionX * inertia - here.slopeX * (1.0f - inertia);
        directionY = directionY * inertia - here.slopeY * (1.0f - inertia);
        const float length = std::sqrt(directionX * directionX + directionY * directionY);
        if (!(length > 1e-6f)) break;
        directionX /= length;
        directionY /= length;
        const float nextX = x + directionX;
        const float nextY = y + directionY;
        if (!isInside(nextX, nextY)) return;
        const float drop = here.height - surface(nextX, nextY).height;
        if (std::isnan(drop)) return;
        const float slope = std::max(drop / cell_, 0.01f);
        const float capacity = slope * speed * water * float(p_.capacity);
        if (drop < 0.0f || sediment > capacity * cell_) {
            // Uphill: fill the hollow, but no higher than its rim.
            const float amount = drop < 0.0f ? std::min(-drop, sediment) : (sediment - capacity * cell_) * float(p_.deposition);
            sediment -= amount;
            change(x, y, amount);
        } else {
            // No deeper than the next point lies, or the droplet would dig a pit.
            const float amount = std::min((capacity * cell_ - sediment) * float(p_.erosion), drop);
            sediment += amount;
            change(x, y, -amount);
        }
        speed = std::sqrt(std::max(0.0f, speed * speed + 4.0f * drop / cell_));
        water *= 1.0f - float(p_.evaporation);
        x = nextX;
        y = nextY;
    }
    if (isInside(x, y)) change(x, y, sediment);
}

/// Moves what is above the talus from each sample to its lower neighbours, in proportion to how far each is above it.
void slide(const HeightMap& map, std::vector<float>& change, const ThermalParameters& p) {
    const double diagonal = std::sqrt(map.spacing.x * map.spacing.x + map.spacing.y * map.spacing.y);
    for (int row = 0; row < map.rows; ++row)
        for (int column = 0; column < map.columns; ++column) {
            const float height = map.at(column, row);
            std::array<float, 8> surplus{};
            float sum = 0.0f;
            float largest = 0.0f;
            for (std::size_t i = 0; i < neighbours.size(); ++i) {
                const int c = column + neighbours[i][0];
                const int r = row + neighbours[i][1];
                if (c < 0 || c >= map.columns || r < 0 || r >= map.rows) continue;
                const double distance = i < 2 ? map.spacing.x : i < 4 ? map.spacing.y : diagonal;
                const float above = height - map.at(c, r) - float(p.talus * distance);
                if (!(above > 0.0f)) continue;
                surplus[i] = above;
                sum += above;
                largest = std::max(largest, above);
            }
            if (sum <= 0.0f) continue;
            const float moved = 0.5f * float(p.rate) * largest;
            const std::size_t sample = std::size_t(row) * std::size_t(map.columns) + std::size_t(column);
            change[sample] -= moved;
            for (std::size_t i = 0; i < neighbours.size(); ++i)
                if (surplus[i] > 0.0f)
                    change[std::size_t(std::ptrdiff_t(sample) + neighbours[i][1] * std::ptrdiff_t(map.columns) +
                                       neighbours[i][0])] += moved * surplus[i] / sum;
        }
}

}  // namespace

Result<HeightMap> erodeByRivers(HeightMap map, const HeightMap& upliftMap, const RiverParameters& p) {
    if (const auto problem = problemOf(map)) return *problem;
    if (upliftMap.heights.size() != map.heights.size())
        return Error{"erosion: uplift", std::to_string(map.heights.size()) + " samples", std::to_string(upliftMap.heights.size())};
    if (const auto problem = problemOf({{"steps", double(p.steps), 0, 1e6},
                                        {"uplift", p.uplift, -1e6, 1e6},
                                        {"erosion", p.erosion, 0, 1e6},
                                        {"creep", p.creep, 0, 1000 * map.spacing.x * map.spacing.y},
                                        {"talus", p.talus, 0, 1e6}}))
        return *problem;
    Random random(1);
    for (int step = 0; step < p.steps; ++step) {
        stepRivers(map, upliftMap, p, random);
        creep(map, p.creep);
        lowerBorder(map);
    }
    return map;
}

Result<HeightMap> erodeByDroplets(HeightMap map, const DropletParameters& p) {
    if (const auto problem = problemOf(map)) return *problem;
    if (const auto problem = problemOf({{"droplets", double(p.droplets), 0, 1e9},
                                        {"lifetime", double(p.lifetime), 1, 1e6},
                                        {"radius", double(p.radius), 0, 64},
                                        {"inertia", p.inertia, 0, 1},
                                        {"capacity", p.capacity, 0, 1e6},
                                        {"erosion part", p.erosion, 0, 1},
                                        {"deposition part", p.deposition, 0, 1},
                                        {"evaporation part", p.evaporation, 0, 1}}))
        return *problem;
    Random random(p.seed);
    Rain rain(map, p);
    for (int i = 0; i < p.droplets; ++i) rain.fall(random);
    return map;
}

Result<HeightMap> erodeThermally(HeightMap map, const ThermalParameters& p) {
    if (const auto problem = problemOf(map)) return *problem;
    if (const auto problem =
            problemOf({{"iterations", double(p.iterations), 0, 1e6}, {"talus", p.talus, 0, 1e6}, {"rate", p.rate, 0, 1}}))
        return *problem;
    std::vector<float> change(map.heights.size());
    for (int iteration = 0; iteration < p.iterations; ++iteration) {
        std::fill(change.begin(), change.end(), 0.0f);
        slide(map, change, p);
        for (std::size_t i = 0; i < change.size(); ++i) map.heights[i] += change[i];
    }
    return map;
}

}  // namespace terrain
