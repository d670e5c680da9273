#pragma once
// Letters of our own, for words in pictures: ASCII, 5 by 7 dots, and 2 dots below the line.

#include <string>
#include <string_view>
#include <vector>

namespace fenestra {

/// A line of text as shares of ink, row 0 at the top.
struct TextBitmap {
  int width = 0, height = 0;   ///< pixels
  std::vector<float> coverage; ///< 0 to 1, a value a pixel
};

/// Width of a letter with the gap behind it, and height of a line with the gap below it, in dots.
inline constexpr int glyphWidth = 6, lineHeight = 11;

/// Letters of a UTF-8 text, an ASCII character each: letters of Latin-1 lose their accents, and
/// any other character is DEL, which is drawn as an empty box.
std::string toAscii(std::string_view text);

/// Draws a text, of dots `size` pixels wide, smoothed.
TextBitmap rasterizeText(std::string_view text, double dotSize);

} // namespace fenestra
