#include "files/images/TextBitmap.h"

#include "io/EmbeddedResources.h"
#include "io/MessageText.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_GLYPH_H
#include FT_STROKER_H

namespace fenestra::core {
namespace {

constexpr double fixed6 = 64.0, fixed16 = 65536.0; ///< units of FreeType's fixed-point numbers

/// The font is valid, so only memory can be missing.
void require(FT_Error error) {
  if (error != 0)
    throw std::bad_alloc();
}

template <typename Handle, auto done>
struct Done {
  using pointer = Handle;
  void operator()(Handle handle) const { done(handle); }
};
template <typename Handle, auto done>
using Unique = std::unique_ptr<Handle, Done<Handle, done>>;

using UniqueGlyph = Unique<FT_Glyph, FT_Done_Glyph>;

/// Code point at the start of `text`, which it removes; 0 for a byte that is not UTF-8.
char32_t takeCodePoint(std::string_view& text) {
  const std::size_t size = characterSize(text);
  const auto byte = [&text](std::size_t i) {
    return static_cast<char32_t>(static_cast<unsigned char>(text[i]));
  };
  char32_t code = 0;
  if (size == 1)
    code = byte(0);
  else if (size > 1)
    code = byte(0) & (0xffU >> (size + 1));
  for (std::size_t i = 1; i < size; ++i)
    code = code << 6U | (byte(i) & 0x3fU);
  text.remove_prefix(std::max<std::size_t>(size, 1));
  return code;
}

/// The font at one size. FreeType's objects belong to one thread.
class Font {
public:
  explicit Font(const TextStyle& style) {
    FT_Library library = nullptr;
    require(FT_Init_FreeType(&library));
    m_library.reset(library);
    const std::string_view file = findResource("fonts/DejaVuSans.ttf");
    FT_Face face = nullptr;
    require(FT_New_Memory_Face(library, reinterpret_cast<const FT_Byte*>(file.data()),
                               static_cast<FT_Long>(file.size()), 0, &face));
    m_face.reset(face);
    require(FT_Set_Char_Size(face, 0, std::lround(style.size * fixed6), 0, 0)); // 72 dpi
    if (style.outline == 0.0)
      return;
    FT_Stroker stroker = nullptr;
    require(FT_Stroker_New(library, &stroker));
    m_stroker.reset(stroker);
    FT_Stroker_Set(stroker, std::lround(style.outline * fixed6), FT_STROKER_LINECAP_ROUND,
                   FT_STROKER_LINEJOIN_ROUND, 0);
  }

  /// Pixels from a glyph's origin to the next one's.
  double measureAdvance(char32_t code) const {
    load(code);
    return static_cast<double>(m_face->glyph->linearHoriAdvance) / fixed16;
  }

  /// A glyph whose origin is `shift` pixels, 0 to 1, right of a pixel's left edge.
  UniqueGlyph rasterize(char32_t code, double shift) const {
    load(code);
    FT_Glyph glyph = nullptr;
    require(FT_Get_Glyph(m_face->glyph, &glyph));
    UniqueGlyph shape(glyph);
    if (m_stroker) {
      require(FT_Glyph_StrokeBorder(&glyph, m_stroker.get(), 0, 0)); // its outer border
      shape.reset(glyph);
    }
    const FT_Vector origin = {std::lround(shift * fixed6), 0};
    require(FT_Glyph_To_Bitmap(&glyph, FT_RENDER_MODE_NORMAL, &origin, 0));
    return UniqueGlyph(glyph);
  }

private:
  void load(char32_t code) const {
    require(FT_Load_Glyph(m_face.get(), FT_Get_Char_Index(m_face.get(), code),
                          FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP));
  }

  Unique<FT_Library, FT_Done_FreeType> m_library;
  Unique<FT_Face, FT_Done_Face> m_face;
  Unique<FT_Stroker, FT_Stroker_Done> m_stroker;
};

struct PlacedCharacter {
  char32_t code;
  double start; ///< pixels from the start of the text
};

struct Layout {
  std::vector<PlacedCharacter> characters;
  double advance = 0.0; ///< pixels

  void add(char32_t code, const Font& font) {
    characters.push_back({code, advance});
    advance += font.measureAdvance(code);
  }
};

/// Places characters side by side, with an ellipsis instead of those that do not fit.
Layout layOut(std::string_view text, const Font& font, double maxWidth) {
  constexpr char32_t ellipsis = 0x2026;
  const double room = maxWidth - font.measureAdvance(ellipsis);
  Layout layout;
  while (!text.empty() && layout.advance <= maxWidth)
    layout.add(takeCodePoint(text), font);
  if (layout.advance <= maxWidth)
    return layout;
  while (!layout.characters.empty() && layout.advance > room) {
    layout.advance = layout.characters.back().start;
    layout.characters.pop_back();
  }
  layout.add(ellipsis, font);
  return layout;
}

/// Glyph with its origin at the pixel `column` columns right of the start of the baseline.
struct PlacedGlyph {
  UniqueGlyph glyph;
  int column;

  const FT_BitmapGlyphRec& raster() const {
    return *reinterpret_cast<const FT_BitmapGlyphRec*>(glyph.get());
  }
  int left() const { return column + raster().left; }
  int top() const { return -raster().top; }
  int width() const { return static_cast<int>(raster().bitmap.width); }
  int height() const { return static_cast<int>(raster().bitmap.rows); }
};

/// Adds a glyph. Where outlines overlap, the larger coverage counts.
void addGlyph(const PlacedGlyph& glyph, TextBitmap& line) {
  const FT_Bitmap& bitmap = glyph.raster().bitmap;
  for (int y = 0; y < glyph.height(); ++y)
    for (int x = 0; x < glyph.width(); ++x) {
      const std::int64_t row = std::int64_t{glyph.top()} - line.top + y;
      const std::int64_t column = std::int64_t{glyph.left()} - line.left + x;
      float& coverage = line.coverage[static_cast<std::size_t>(row * line.width + column)];
      coverage =
          std::max(coverage, static_cast<float>(bitmap.buffer[y * bitmap.pitch + x]) / 255.0F);
    }
}

} // namespace

TextBitmap rasterizeText(std::string_view text, const TextStyle& style) {
  const Font font(style);
  const Layout layout = layOut(text, font, style.maxWidth);
  std::vector<PlacedGlyph> glyphs;
  for (const auto& [code, start] : layout.characters)
    glyphs.push_back({font.rasterize(code, start - std::floor(start)), static_cast<int>(start)});
  TextBitmap line{.advance = layout.advance};
  int right = 0, bottom = 0;
  for (const PlacedGlyph& glyph : glyphs) {
    line.left = std::min(line.left, glyph.left());
    line.top = std::min(line.top, glyph.top());
    right = std::max(right, glyph.left() + glyph.width());
    bottom = std::max(bottom, glyph.top() + glyph.height());
  }
  line.width = right - line.left;
  line.height = bottom - line.top;
  line.coverage.resize(static_cast<std::size_t>(line.width) *
                       static_cast<std::size_t>(line.height));
  for (const PlacedGlyph& glyph : glyphs)
    addGlyph(glyph, line);
  return line;
}

} // namespace fenestra::core
