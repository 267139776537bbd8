// Tiles of any size that are nothing but a number.
#pragma once

#include <cstddef>

#include "lod/TileCache.h"

namespace terrain::test {

struct TestTile {
    int number = 0;
    std::size_t size = 0;
    std::size_t bytes() const { return size; }
};
using Cache = TileCache<TestTile>;

inline TileKey key(int number)
{
    return {.level = 0, .column = number, .row = 0};
}

}  // namespace terrain::test
