#include "lod/GeoMipmapShape.h"

#include <algorithm>
#include <bit>

#include "lod/BruteForceMesh.h"

namespace terrain {

namespace {

int blocksAlong(int cells, int tileSize) {
    const int whole = cells / tileSize, rest = cells % tileSize;
    return std::max(1, whole + (rest > 1 ? 1 : 0));
}

}  // namespace

BlockLayout::BlockLayout(int gridColumns, int gridRows, int size)
    : tileSize(size), exponent(std::countr_zero(unsigned(size))), columns(gridColumns), rows(gridRows),
      blockColumns(blocksAlong(gridColumns - 1, size)), blockRows(blocksAlong(gridRows - 1, size)) {}

GeoMipmapShape::GeoMipmapShape(int width, int height, int exponent)
    : width_(width), height_(height), exponent_(exponent), levels_(std::size_t(exponent) + 1) {
    for (int level = 0; level <= exponent; ++level) {
        Level& l = levels_[std::size_t(level)];
        const bool wide = std::min(width, height) > 1 << level;
        l.exists = level == 0 || level == exponent || wide;
        for (auto& side : l.sides) side.resize(std::size_t(exponent) + 1);
        if (level == exponent || !wide) continue;
        cutInner(level);
        for (int side = 0; side < 4; ++side)
            for (int border = level; border <= exponent; ++border)
                l.sides[std::size_t(side)][std::size_t(border)] = cutSide(side, level, border);
    }
    const Place corner[4] = {place({0, 0}), place({width, 0}), place({width, height}), place({0, height})};
    flat_[0] = {{corner[0], corner[1], corner[2]}, {corner[0], corner[2], corner[3]}};
    flat_[1] = {{corner[0], corner[1], corner[3]}, {corner[1], corner[2], corner[3]}};
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column)
            for (const auto& t : kCellTriangles) {
                const auto corner = [&](int i) { return place({column + t[i][0], row + t[i][1]}); };
                cells_.push_back({corner(0), corner(1), corner(2)});
            }
    // Without sides, a block too narrow for them is nothing but cells.
    if (std::min(width, height) == 1) levels_[0].inner = cells_;
}

std::vector<int> GeoMipmapShape::lines(int length, int level) const {
    std::vector<int> result;
    if (level < exponent_)
        for (int at = 0; at < length; at += 1 << level) result.push_back(at);
    else
        result.push_back(0);
    result.push_back(length);
    return result;
}

void GeoMipmapShape::cutInner(int level) {
    const std::vector<int> x = lines(width_, level), y = lines(height_, level);
    for (std::size_t row = 1; row + 2 < y.size(); ++row)
        for (std::size_t column = 1; column + 2 < x.size(); ++column) {
            const Place a = place({x[column], y[row]}), b = place({x[column + 1], y[row]});
            const Place c = place({x[column + 1], y[row + 1]}), d = place({x[column], y[row + 1]});
            auto& inner = levels_[std::size_t(level)].inner;
            if ((row + column) % 2 == 0)
                inner.insert(inner.end(), {{a, b, c}, {a, c, d}});
            else
                inner.insert(inner.end(), {{a, b, d}, {b, c, d}});
        }
}

glm::ivec2 GeoMipmapShape::onSide(int side, int along, int across) const {
    switch (side) {
    case Bottom:
        return {along, across};
    case Right:
        return {width_ - across, along};
    case Top:
        return {width_ - along, height_ - across};
    default:
        return {across, height_ - along};
    }
}

std::vector<int> GeoMipmapShape::linesAlong(int side, int level) const {
    std::vector<int> result = lines(sideLength(side), level);
    if (side == Top || side == Left) {
        std::reverse(result.begin(), result.end());
        for (int& at : result) at = sideLength(side) - at;
    }
    return result;
}

std::vector<GeoMipmapShape::Triangle> GeoMipmapShape::cutSide(int side, int level, int borderLevel) const {
    const std::vector<int> outer = linesAlong(side, borderLevel), own = linesAlong(side, level);
    const std::vector<int> inner(own.begin() + 1, own.end() - 1);
    // The line next to the side: the far sides' may be nearer than a step.
    const int across = linesAlong((side + 1) % 4, level)[1];
    const auto outerPlace = [&](std::size_t i) { return place(onSide(side, outer[i], 0)); };
    const auto innerPlace = [&](std::size_t i) { return place(onSide(side, inner[i], across)); };
    std::vector<Triangle> triangles;
    std::size_t o = 0, i = 0;
    while (o + 1 < outer.size() || i + 1 < inner.size()) {
        // Whichever edge has its middle first; of opposite edges in turns, for diagonals that alternate.
        const int outerMiddle = o + 1 < outer.size() ? outer[o] + outer[o + 1] : 4 * kLargestTile;
        const int innerMiddle = i + 1 < inner.size() ? inner[i] + inner[i + 1] : 4 * kLargestTile;
        if (outerMiddle < innerMiddle || (outerMiddle == innerMiddle && o % 2 == 1)) {
            triangles.push_back({outerPlace(o), outerPlace(o + 1), innerPlace(i)});
            ++o;
        } else {
            triangles.push_back({outerPlace(o), innerPlace(i + 1), innerPlace(i)});
            ++i;
        }
    }
    return triangles;
}

}  // namespace terrain
