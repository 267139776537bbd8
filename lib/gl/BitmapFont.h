// A small font as bitmaps.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace terrain {

constexpr int kGlyphWidth = 6, kGlyphHeight = 13;
/// What the font has: printable ASCII, then the upper half of ISO 8859-1.
constexpr int kGlyphCount = 95 + 96;

/// Rows of a character from its top; bit 5 is the leftmost pixel. The font is "6x13" of X11's misc-fixed fonts, which are in the
/// public domain.
const std::array<std::uint8_t, kGlyphHeight>& glyphRows(int glyph);

/// The font's glyphs for a text in UTF-8, one for each character; '?' for those that it lacks and for bytes that are no UTF-8.
std::basic_string<std::uint8_t> glyphsOf(std::string_view text);

}  // namespace terrain
