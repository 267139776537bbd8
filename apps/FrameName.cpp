#include "FrameName.h"

#include <cctype>
#include <cstddef>

namespace app {

namespace {

struct Number {
    std::size_t begin = std::string::npos;
    std::size_t end = 0;
    bool zeros = false;
    std::size_t width = 0;
};

// Returns false for anything but %% and one %d. User text never reaches printf.
bool scan(const std::string& pattern, Number& number) {
    for (std::size_t i = 0; i < pattern.size(); ++i) {
        if (pattern[i] != '%') continue;
        const std::size_t begin = i++;
        if (i < pattern.size() && pattern[i] == '%') continue;
        const bool zeros = i < pattern.size() && pattern[i] == '0';
        std::size_t width = 0;
        for (; i < pattern.size() && std::isdigit(static_cast<unsigned char>(pattern[i])); ++i) {
            width = width * 10 + std::size_t(pattern[i] - '0');
            if (width > 20) return false;
        }
        if (i >= pattern.size() || pattern[i] != 'd' || number.begin != std::string::npos) return false;
        number = {begin, i + 1, zeros, width};
    }
    return true;
}

std::string unescape(std::string text) {
    for (std::size_t i = text.find("%%"); i != std::string::npos; i = text.find("%%", i + 1)) text.erase(i, 1);
    return text;
}

}  // namespace

std::optional<terrain::Error> checkFrameName(const std::string& pattern) {
    Number number;
    if (scan(pattern, number)) return std::nullopt;
    return terrain::Error{"--output", "a file name with at most one frame number such as %d or %04d", pattern};
}

bool hasFrameNumber(const std::string& pattern) {
    Number number;
    return scan(pattern, number) && number.begin != std::string::npos;
}

std::string frameName(const std::string& pattern, int frame) {
    Number number;
    if (!scan(pattern, number) || number.begin == std::string::npos) return unescape(pattern);
    std::string digits = std::to_string(frame);
    if (digits.size() < number.width) digits.insert(0, number.width - digits.size(), number.zeros ? '0' : ' ');
    return unescape(pattern.substr(0, number.begin)) + digits + unescape(pattern.substr(number.end));
}

}  // namespace app
