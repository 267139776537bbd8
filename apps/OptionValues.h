// Values of the command line as numbers.
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include <glm/vec2.hpp>

namespace app {

/// A finite number that is all of the text.
template <class Number>
std::optional<Number> readNumber(std::string_view text) {
    Number value{};
    const char* end = text.data() + text.size();
    const auto [stop, problem] = std::from_chars(text.data(), end, value);
    if (problem != std::errc() || stop != end) return std::nullopt;
    if constexpr (std::is_floating_point_v<Number>) {
        if (!std::isfinite(value)) return std::nullopt;
    }
    return value;
}

/// Two numbers with the separator between, or one that stands for both.
std::optional<glm::dvec2> readPair(std::string_view text, char separator);
/// Two whole numbers from lowest to highest with an x between.
std::optional<glm::ivec2> readSize(std::string_view text, int lowest, int highest);
/// What findRawType() knows, for errors.
std::string rawTypeNames();

}  // namespace app
