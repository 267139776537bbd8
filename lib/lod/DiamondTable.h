// Finds diamonds by their centre.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

namespace terrain {

/// Hash table from a diamond's centre to its number. It holds numbers only, 4 bytes a place: `centreOf(number)` gives the centre
/// back. Open addressing with linear probing; erasing shifts later entries back, so that no tombstones pile up over a long flight.
class DiamondTable {
public:
    static constexpr std::uint32_t kNone = 0xffffffffu;

    DiamondTable() : places_(1024, kNone) {}

    template <class CentreOf>
    std::uint32_t find(glm::ivec2 centre, CentreOf centreOf) const {
        for (std::size_t at = home(centre);; at = next(at))
            if (places_[at] == kNone || centreOf(places_[at]) == centre) return places_[at];
    }

    /// The centre must not be in the table.
    template <class CentreOf>
    void insert(std::uint32_t number, CentreOf centreOf) {
        if (3 * (count_ + 1) > 2 * places_.size()) grow(centreOf);
        put(number, centreOf);
        ++count_;
    }

    /// The number must be in the table.
    template <class CentreOf>
    void erase(std::uint32_t number, CentreOf centreOf) {
        std::size_t hole = home(centreOf(number));
        while (places_[hole] != number) hole = next(hole);
        for (std::size_t at = next(hole); places_[at] != kNone; at = next(at)) {
            // An entry may fill the hole unless its home lies between the hole and where it stands.
            const std::size_t distanceHome = (at - home(centreOf(places_[at]))) & mask(), distanceHole = (at - hole) & mask();
            if (distanceHome < distanceHole) continue;
            places_[hole] = places_[at];
            hole = at;
        }
        places_[hole] = kNone;
        --count_;
    }

    std::size_t bytes() const { return places_.capacity() * sizeof(std::uint32_t); }

private:
    std::size_t mask() const { return places_.size() - 1; }
    std::size_t next(std::size_t at) const { return (at + 1) & mask(); }
    std::size_t home(glm::ivec2 c) const {
        const std::uint64_t key = std::uint64_t(std::uint32_t(c.y)) << 32 | std::uint32_t(c.x);
        return std::size_t((key * 0x9e3779b97f4a7c15u) >> 32) & mask();
    }

    template <class CentreOf>
    void put(std::uint32_t number, CentreOf centreOf) {
        std::size_t at = home(centreOf(number));
        while (places_[at] != kNone) at = next(at);
        places_[at] = number;
    }

    template <class CentreOf>
    void grow(CentreOf centreOf) {
        std::vector<std::uint32_t> old(places_.size() * 2, kNone);
        old.swap(places_);
        for (const std::uint32_t number : old)
            if (number != kNone) put(number, centreOf);
    }

    std::vector<std::uint32_t> places_;
    std::size_t count_ = 0;
};

}  // namespace terrain
