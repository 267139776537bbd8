#include "OptionValues.h"

#include "Options.h"

namespace app {

namespace {

constexpr struct {
    const char* name;
    terrain::RawType type;
} rawTypes[] = {
    {"uint8", terrain::RawType::UInt8},
    {"uint16le", terrain::RawType::UInt16LittleEndian},
    {"uint16be", terrain::RawType::UInt16BigEndian},
};

}  // namespace

std::optional<glm::dvec2> readPair(std::string_view text, char separator) {
    const std::size_t middle = text.find(separator);
    const auto first = readNumber<double>(text.substr(0, middle));
    const auto second = middle == text.npos ? first : readNumber<double>(text.substr(middle + 1));
    if (!first || !second) return std::nullopt;
    return glm::dvec2(*first, *second);
}

std::optional<glm::ivec2> readSize(std::string_view text, int lowest, int highest) {
    const std::size_t middle = text.find('x');
    if (middle == text.npos) return std::nullopt;
    const auto width = readNumber<int>(text.substr(0, middle)), height = readNumber<int>(text.substr(middle + 1));
    const auto fits = [&](std::optional<int> side) { return side && *side >= lowest && *side <= highest; };
    return fits(width) && fits(height) ? std::optional(glm::ivec2(*width, *height)) : std::nullopt;
}

const char* rawTypeName(terrain::RawType type) {
    for (const auto& raw : rawTypes) {
        if (raw.type == type) return raw.name;
    }
    return "";
}

std::optional<terrain::RawType> findRawType(std::string_view name) {
    for (const auto& raw : rawTypes) {
        if (raw.name == name) return raw.type;
    }
    return std::nullopt;
}

std::string rawTypeNames() {
    std::string names;
    for (const auto& raw : rawTypes) names += (names.empty() ? "" : ", ") + std::string(raw.name);
    return names;
}

}  // namespace app
