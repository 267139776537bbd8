// Numbers and lists in command lines.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>

namespace app {

/// All of the text as a number from `lowest` to `highest`; false leaves `number` as it was.
template <class Number>
bool readNumber(std::string_view text, Number lowest, Number highest, Number& number) {
    Number read{};
    const auto [stop, problem] = std::from_chars(text.data(), text.data() + text.size(), read);
    if (problem != std::errc() || stop != text.data() + text.size() || !(read >= lowest && read <= highest)) return false;
    number = read;
    return true;
}

/// The parts between commas that are not empty.
inline std::vector<std::string> splitList(std::string_view list) {
    std::vector<std::string> words;
    while (!list.empty()) {
        const std::size_t comma = std::min(list.find(','), list.size());
        if (comma > 0) words.emplace_back(list.substr(0, comma));
        list.remove_prefix(std::min(comma + 1, list.size()));
    }
    return words;
}

/// "X,Y" or "X" for both, above zero.
inline bool readSpacing(std::string_view text, std::optional<glm::dvec2>& spacing) {
    constexpr double least = 1e-9, most = 1e9;
    const std::size_t comma = text.find(',');
    glm::dvec2 read{0.0};
    if (!readNumber(text.substr(0, comma), least, most, read.x)) return false;
    read.y = read.x;
    if (comma != std::string_view::npos && !readNumber(text.substr(comma + 1), least, most, read.y)) return false;
    spacing = read;
    return true;
}

/// A factor other than zero.
inline bool readFactor(std::string_view text, std::optional<double>& factor) {
    double read = 0.0;
    if (!readNumber(text, -1e9, 1e9, read) || read == 0.0) return false;
    factor = read;
    return true;
}

}  // namespace app
