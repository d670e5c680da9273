#pragma once
// Built-in bitmap font for text in images: ASCII, 5 by 7 dots, plus 2 dots for descenders.

#include <string>
#include <string_view>
#include <vector>

namespace fenestra {

/// Rasterized line of text; row 0 is at the top.
struct TextBitmap {
  int width = 0, height = 0;   ///< pixels
  std::vector<float> coverage; ///< coverage of each pixel, 0 to 1
};

/// Advance width of a glyph and height of a line, gaps included, in dots.
inline constexpr int glyphWidth = 6, lineHeight = 11;

/// Converts UTF-8 to one ASCII character per code point. Latin-1 letters lose their accents; any
/// other character becomes DEL, which is drawn as an empty box.
std::string toAscii(std::string_view text);

/// Rasterizes a text with antialiasing; each dot is `dotSize` pixels wide.
TextBitmap rasterizeText(std::string_view text, double dotSize);

} // namespace fenestra
