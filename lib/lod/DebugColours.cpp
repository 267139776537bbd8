#include "lod/DebugColours.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace terrain {

namespace {

constexpr Colour rgb(unsigned hex) {
    return {float(hex >> 16 & 255u) / 255.0f, float(hex >> 8 & 255u) / 255.0f, float(hex & 255u) / 255.0f};
}

constexpr std::array<Colour, kCoarsestLevel + 1> kLevels{rgb(0xfde725), rgb(0xaadc32), rgb(0x5ec962), rgb(0x27ad81), rgb(0x21918c),
                                                         rgb(0x2c728e), rgb(0x3b528b), rgb(0x472d7b), rgb(0x440154), rgb(0x2a0134)};

/// Four for each size, by the parities of column and row.
constexpr std::array<Colour, 16> kPatches{rgb(0x4e79a7), rgb(0xf28e2b), rgb(0x59a14f), rgb(0xb07aa1), rgb(0x76b7b2), rgb(0xe15759),
                                          rgb(0xedc948), rgb(0x9c755f), rgb(0xa0cbe8), rgb(0xffbe7d), rgb(0x8cd17d), rgb(0xd4a6c8),
                                          rgb(0x2f4b7c), rgb(0xff9d9a), rgb(0xb6992d), rgb(0x79706e)};

constexpr std::array<Colour, 5> kErrors{rgb(0x0a1a5c), rgb(0x0b6fb8), rgb(0x1faa59), rgb(0xf7d93c), rgb(0xd01c0b)};

}  // namespace

int levelOf(glm::vec2 a, glm::vec2 b, glm::vec2 c) {
    const glm::vec2 ab = b - a, ac = c - a, bc = c - b;
    // Half a cell of s x s samples has half of s squared.
    float squared = std::fabs(ab.x * ac.y - ab.y * ac.x);
    if (squared == 0.0f) squared = std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(bc, bc)});
    if (squared == 0.0f) return 0;
    constexpr float kAboveRounding = 1e-3f;
    return int(std::floor(0.5f * std::log2(squared) + kAboveRounding));
}

Colour levelColour(int level) {
    if (level >= 0) return kLevels[std::size_t(std::min(level, kCoarsestLevel))];
    const float pale = 0.22f * float(std::min(-level, -kFinestLevel));
    return glm::mix(kLevels[0], Colour(1.0f), pale);
}

Colour patchColour(const DrawnPatch& patch) {
    if (patch.closesGaps) return kGapColour;
    return kPatches[std::size_t((patch.size & 3) << 2 | (patch.place.y & 1) << 1 | (patch.place.x & 1))];
}

std::span<const Colour> errorRamp() {
    return kErrors;
}

Colour errorColour(float part) {
    // Also where it is no number.
    if (!(part <= 1.0f + kRounding)) return kBrokenColour;
    const float at = std::clamp(part, 0.0f, 1.0f) * float(kErrors.size() - 1);
    const std::size_t step = std::min(std::size_t(at), kErrors.size() - 2);
    return glm::mix(kErrors[step], kErrors[step + 1], at - float(step));
}

Colour loadingColour(const DrawnPatch& patch) {
    if (patch.isNew) return patch.standsIn ? kNewStandInColour : kNewColour;
    return patch.standsIn ? kStandInColour : kSettledColour;
}

float slopeShade(const glm::vec3& normal, const glm::vec3& up) {
    // Any direction across will do, as long as it is the same for all faces.
    const glm::vec3 across = std::fabs(up.x) < 0.7f ? glm::vec3(-1.0f, 0.0f, 0.0f) : glm::vec3(0.0f, 1.0f, 0.0f);
    const glm::vec3 light = glm::normalize(up + across + 0.5f * glm::cross(across, up));
    return kDarkest + (1.0f - kDarkest) * std::max(0.0f, glm::dot(normal, light));
}

Colour lineColourOn(const Colour& colour) {
    return glm::dot(colour, Colour(0.30f, 0.59f, 0.11f)) > 0.35f ? Colour(0.0f) : Colour(1.0f);
}

}  // namespace terrain
