#pragma once
// Text for images, in DejaVu Sans, which is compiled in.

#include "base/Vector.h"

#include <string_view>
#include <vector>

namespace fenestra::core {

/// Height of capital letters, height above the baseline, and distance of lines, in em.
inline constexpr double fontCapHeight = 0.73, fontAscent = 0.93, fontLineHeight = 1.18;

struct TextStyle {
  double size = 16.0;         ///< em, pixels
  double outline = 0.0;       ///< thickens the glyphs by this distance to all sides, pixels
  double maxWidth = infinity; ///< longer text ends in an ellipsis, pixels
};

/// Rasterized line of text.
struct TextBitmap {
  int left = 0, top = 0;     ///< its top left pixel, from the start of the baseline
  int width = 0, height = 0; ///< pixels
  double advance = 0.0;      ///< from the start of the text to its end, without outline, pixels
  std::vector<float> coverage = {}; ///< of each pixel, 0 to 1; row 0 is at the top
};

/// Rasterizes UTF-8 with antialiasing and without hinting, so that shapes do not depend on the
/// size. What the font lacks, control characters and bytes that are not UTF-8 become empty boxes.
/// Throws std::bad_alloc.
TextBitmap rasterizeText(std::string_view text, const TextStyle& style);

} // namespace fenestra::core
