#include "files/images/BitmapFont.h"

#include "io/MessageText.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace fenestra {
namespace {

constexpr int glyphColumns = 5, glyphRows = 9;
constexpr int glyphsPerBand = 16; ///< glyphs per band of `glyphs`

/// Glyphs from space to DEL: bands of 16 glyphs, each band 9 rows. The text starts with a newline.
constexpr std::string_view glyphs = R"(
..... ..#.. .#.#. .#.#. ..#.. ##... .##.. ..#.. ...#. .#... ..... ..... ..... ..... ..... .....
..... ..#.. .#.#. .#.#. .#### ##..# #..#. ..#.. ..#.. ..#.. ..#.. ..#.. ..... ..... ..... ....#
..... ..#.. .#.#. ##### #.#.. ...#. #.#.. ..#.. .#... ...#. #.#.# ..#.. ..... ..... ..... ...#.
..... ..#.. ..... .#.#. .###. ..#.. .#... ..... .#... ...#. .###. ##### ..... ##### ..... ..#..
..... ..#.. ..... ##### ..#.# .#... #.#.# ..... .#... ...#. #.#.# ..#.. ..... ..... ..... .#...
..... ..... ..... .#.#. ####. #..## #..#. ..... ..#.. ..#.. ..#.. ..#.. .##.. ..... .##.. #....
..... ..#.. ..... .#.#. ..#.. ...## .##.# ..... ...#. .#... ..... ..... ..#.. ..... .##.. .....
..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... .#... ..... ..... .....
..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... .....
.###. ..#.. .###. ##### ...#. ##### ..##. ##### .###. .###. ..... ..... ...#. ..... .#... .###.
#...# .##.. #...# ...#. ..##. #.... .#... ....# #...# #...# .##.. .##.. ..#.. ..... ..#.. #...#
#..## ..#.. ....# ..#.. .#.#. ####. #.... ...#. #...# #...# .##.. .##.. .#... ##### ...#. ....#
#.#.# ..#.. ...#. ...#. #..#. ....# ####. ..#.. .###. .#### ..... ..... #.... ..... ....# ...#.
##..# ..#.. ..#.. ....# ##### ....# #...# .#... #...# ....# .##.. ..... .#... ##### ...#. ..#..
#...# ..#.. .#... #...# ...#. #...# #...# .#... #...# ...#. .##.. .##.. ..#.. ..... ..#.. .....
.###. .###. ##### .###. ...#. .###. .###. .#... .###. .##.. ..... ..#.. ...#. ..... .#... ..#..
..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... .#... ..... ..... ..... .....
..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... .....
.###. .###. ####. .###. ###.. ##### ##### .###. #...# .###. ..### #...# #.... #...# #...# .###.
#...# #...# #...# #...# #..#. #.... #.... #...# #...# ..#.. ...#. #..#. #.... ##.## #...# #...#
#.### #...# #...# #.... #...# #.... #.... #.... #...# ..#.. ...#. #.#.. #.... #.#.# ##..# #...#
#.#.# #...# ####. #.... #...# ####. ####. #.### ##### ..#.. ...#. ##... #.... #.#.# #.#.# #...#
#.### ##### #...# #.... #...# #.... #.... #...# #...# ..#.. ...#. #.#.. #.... #...# #..## #...#
#.... #...# #...# #...# #..#. #.... #.... #...# #...# ..#.. #..#. #..#. #.... #...# #...# #...#
.###. #...# ####. .###. ###.. ##### #.... .#### #...# .###. .##.. #...# ##### #...# #...# .###.
..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... .....
..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... .....
####. .###. ####. .#### ##### #...# #...# #...# #...# #...# ##### .###. ..... .###. ..#.. .....
#...# #...# #...# #.... ..#.. #...# #...# #...# #...# #...# ....# .#... #.... ...#. .#.#. .....
#...# #...# #...# #.... ..#.. #...# #...# #...# .#.#. #...# ...#. .#... .#... ...#. #...# .....
####. #...# ####. .###. ..#.. #...# #...# #.#.# ..#.. .#.#. ..#.. .#... ..#.. ...#. ..... .....
#.... #.#.# #.#.. ....# ..#.. #...# #...# #.#.# .#.#. ..#.. .#... .#... ...#. ...#. ..... .....
#.... #..#. #..#. ....# ..#.. #...# .#.#. #.#.# #...# ..#.. #.... .#... ....# ...#. ..... .....
#.... .##.# #...# ####. ..#.. .###. ..#.. .#.#. #...# ..#.. ##### .###. ..... .###. ..... .....
..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... #####
..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... .....
.#... ..... #.... ..... ....# ..... ..##. ..... #.... ..#.. ...#. #.... .##.. ..... ..... .....
..#.. ..... #.... ..... ....# ..... .#..# ..... #.... ..... ..... #.... ..#.. ..... ..... .....
...#. .###. #.##. .###. .##.# .###. .#... .#### #.##. .##.. ..##. #..#. ..#.. ##.#. #.##. .###.
..... ....# ##..# #.... #..## #...# ###.. #...# ##..# ..#.. ...#. #.#.. ..#.. #.#.# ##..# #...#
..... .#### #...# #.... #...# ##### .#... #...# #...# ..#.. ...#. ##... ..#.. #.#.# #...# #...#
..... #...# #...# #...# #...# #.... .#... #...# #...# ..#.. ...#. #.#.. ..#.. #...# #...# #...#
..... .#### ####. .###. .#### .###. .#... .#### #...# .###. ...#. #..#. .###. #...# #...# .###.
..... ..... ..... ..... ..... ..... ..... ....# ..... ..... #..#. ..... ..... ..... ..... .....
..... ..... ..... ..... ..... ..... ..... .###. ..... ..... .##.. ..... ..... ..... ..... .....
..... ..... ..... ..... .#... ..... ..... ..... ..... ..... ..... ...#. ..#.. .#... ..... #####
..... ..... ..... ..... .#... ..... ..... ..... ..... ..... ..... ..#.. ..#.. ..#.. ..... #...#
####. .#### #.##. .###. ###.. #...# #...# #...# #...# #...# ##### ..#.. ..#.. ..#.. .#... #...#
#...# #...# ##..# #.... .#... #...# #...# #...# .#.#. #...# ...#. .#... ..#.. ...#. #.#.# #...#
#...# #...# #.... .###. .#... #...# #...# #.#.# ..#.. #...# ..#.. ..#.. ..#.. ..#.. ...#. #...#
#...# #...# #.... ....# .#..# #..## .#.#. #.#.# .#.#. #...# .#... ..#.. ..#.. ..#.. ..... #...#
####. .#### #.... ####. ..##. .##.# ..#.. .#.#. #...# .#### ##### ...#. ..#.. .#... ..... #####
#.... ....# ..... ..... ..... ..... ..... ..... ..... ....# ..... ..... ..... ..... ..... .....
#.... ....# ..... ..... ..... ..... ..... ..... ..... .###. ..... ..... ..... ..... ..... .....
)";
constexpr std::size_t rowLength = glyphs.find('\n', 1); ///< includes the newline

/// Grid of dots, true where the glyph is set.
struct DotMatrix {
  int width, height;
  std::vector<bool> isSet;

  bool at(int x, int y) const {
    return x >= 0 && y >= 0 && x < width && y < height &&
           isSet[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                 static_cast<std::size_t>(x)];
  }
};

DotMatrix rasterizeDots(const std::string& text) {
  DotMatrix dots{glyphWidth * static_cast<int>(text.size()), lineHeight, {}};
  for (int y = 0; y < dots.height; ++y)
    for (int x = 0; x < dots.width; ++x) {
      const int letter = text[static_cast<std::size_t>(x / glyphWidth)] - ' ';
      const int row = glyphRows * (letter / glyphsPerBand) + y;
      const int column = glyphWidth * (letter % glyphsPerBand) + x % glyphWidth;
      const bool isInside = x % glyphWidth < glyphColumns && y < glyphRows;
      const std::size_t dot =
          static_cast<std::size_t>(row) * rowLength + static_cast<std::size_t>(column) + 1;
      dots.isSet.push_back(isInside && glyphs[dot] == '#');
    }
  return dots;
}

/// Doubles the resolution and smooths diagonals: A. Mazzoleni, Scale2x (2001).
DotMatrix scale2x(const DotMatrix& dots) {
  DotMatrix twice{2 * dots.width, 2 * dots.height, {}};
  for (int y = 0; y < twice.height; ++y)
    for (int x = 0; x < twice.width; ++x) {
      const int i = x / 2, j = y / 2;
      const bool here = dots.at(i, j);
      const bool beside = dots.at(i + (x % 2 == 0 ? -1 : 1), j);
      const bool opposite = dots.at(i + (x % 2 == 0 ? 1 : -1), j);
      const bool above = dots.at(i, j + (y % 2 == 0 ? -1 : 1));
      const bool below = dots.at(i, j + (y % 2 == 0 ? 1 : -1));
      const bool isCorner = beside == above && beside != below && above != opposite;
      twice.isSet.push_back(isCorner ? beside : here);
    }
  return twice;
}

} // namespace

std::string toAscii(std::string_view text) {
  constexpr char box = 0x7f;
  constexpr std::string_view latin1 = // U+00C0 to U+00FF without accents
      "AAAAAAACEEEEIIIIDNOOOOOxOUUUUYTsaaaaaaaceeeeiiiidnooooo/ouuuuyty";
  std::string ascii;
  while (!text.empty()) {
    const std::size_t size = std::max<std::size_t>(characterSize(text), 1);
    const auto byte = [&text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    if (size == 2 && byte(0) == 0xc3)
      ascii += latin1[byte(1) & 0x3fU];
    else
      ascii += size == 1 && byte(0) >= ' ' && byte(0) < box ? text[0] : box;
    text.remove_prefix(size);
  }
  return ascii;
}

TextBitmap rasterizeText(std::string_view text, double dotSize) {
  constexpr int subdotsPerDot = 8; // scale2x three times
  const DotMatrix dots = scale2x(scale2x(scale2x(rasterizeDots(toAscii(text)))));
  const auto pixels = [dotSize](int subdots) {
    return static_cast<int>(std::ceil(subdots * dotSize / subdotsPerDot));
  };
  TextBitmap result{pixels(dots.width), pixels(dots.height), {}};
  const auto toSubdot = [dotSize](int pixel) {
    return static_cast<int>(std::lround(pixel * subdotsPerDot / dotSize));
  };
  for (int y = 0; y < result.height; ++y)
    for (int x = 0; x < result.width; ++x) {
      int covered = 0, all = 0;
      for (int v = toSubdot(y); v < toSubdot(y + 1); ++v)
        for (int u = toSubdot(x); u < toSubdot(x + 1); ++u, ++all)
          covered += dots.at(u, v) ? 1 : 0;
      result.coverage.push_back(static_cast<float>(covered) / static_cast<float>(std::max(all, 1)));
    }
  return result;
}

} // namespace fenestra
