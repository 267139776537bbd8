// Finds diamonds by their centre.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

namespace terrain {

/// Hash table from a diamond's centre to its number, 8 bytes a place, so that a search mostly reads one cache line. Open addressing
/// with linear probing; erasing shifts later entries back, so that no tombstones pile up over a long flight.
class DiamondTable {
public:
    static constexpr std::uint32_t kNone = 0xffffffffu;

    DiamondTable() : places_(1024) {}

    /// Coordinates of a centre are below 2^16 - 1, as those of any grid are.
    std::uint32_t find(glm::ivec2 centre) const {
        const std::uint32_t key = keyOf(centre);
        for (std::size_t at = home(key);; at = next(at))
            if (places_[at].number == kNone || places_[at].key == key) return places_[at].number;
    }

    /// The centre must not be in the table.
    void insert(glm::ivec2 centre, std::uint32_t number) {
        if (4 * (count_ + 1) > 3 * places_.size()) grow();
        put({keyOf(centre), number});
        ++count_;
    }

    /// The centre must be in the table.
    void erase(glm::ivec2 centre) {
        const std::uint32_t key = keyOf(centre);
        std::size_t hole = home(key);
        while (places_[hole].key != key) hole = next(hole);
        for (std::size_t at = next(hole); places_[at].number != kNone; at = next(at)) {
            // An entry may fill the hole unless its home lies between the hole and where it stands.
            if (distance(home(places_[at].key), at) < distance(hole, at)) continue;
            places_[hole] = places_[at];
            hole = at;
        }
        places_[hole] = Place{};
        --count_;
    }

    std::size_t bytes() const { return places_.capacity() * sizeof(Place); }

private:
    struct Place {
        std::uint32_t key = kNone;  ///< this one is no centre's
        std::uint32_t number = kNone;
    };

    static std::uint32_t keyOf(glm::ivec2 c) { return std::uint32_t(c.y) << 16 | std::uint32_t(c.x); }
    std::size_t next(std::size_t at) const { return at + 1 < places_.size() ? at + 1 : 0; }
    /// Steps of next() from one place to another.
    std::size_t distance(std::size_t from, std::size_t to) const { return to >= from ? to - from : to + places_.size() - from; }
    std::size_t home(std::uint32_t key) const {
        // The upper half of the product, scaled to the number of places.
        const std::uint64_t mixed = (key * 0x9e3779b97f4a7c15u) >> 32;
        return std::size_t((mixed * places_.size()) >> 32);
    }

    void put(const Place& place) {
        std::size_t at = home(place.key);
        while (places_[at].number != kNone) at = next(at);
        places_[at] = place;
    }

    void grow() {
        // By less than doubling: for large meshes this table is a good part of what they hold.
        std::vector<Place> old(places_.size() + places_.size() / 3);
        old.swap(places_);
        for (const Place& place : old)
            if (place.number != kNone) put(place);
    }

    std::vector<Place> places_;
    std::size_t count_ = 0;
};

}  // namespace terrain
