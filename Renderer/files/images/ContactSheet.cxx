#include "files/images/ContactSheet.h"

#include "base/Color.h"
#include "base/Error.h"
#include "base/Text.h"
#include "files/images/ImageReader.h"
#include "files/images/TextBitmap.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fenestra::core {
namespace {

constexpr int boxWidth = 336, maxBoxHeight = 504, minBoxHeight = 168; ///< pixels
constexpr int gap = 20;
constexpr int titleSize = 28, nameSize = 19, textSize = 14; ///< em, pixels

constexpr std::uint32_t sheetColor = 0x17191b, panelColor = 0x222527, white = 0xf0f0f0,
                        gray = 0xa2a8ad, errorColor = 0xff9d7a;

/// Opaque image to draw on, linear Rec. 709. Colors are given as sRGB hex.
class Canvas {
public:
  Canvas(int width, int height, std::uint32_t color) : m_width(width), m_height(height) {
    for (Plane& plane : m_planes)
      plane.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    fill(0, 0, width, height, color);
  }

  int width() const { return m_width; }
  int height() const { return m_height; }
  /// Fills a rectangle, clipped to the canvas.
  void fill(int left, int top, int width, int height, std::uint32_t color) {
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        blend(left + x, top + y, toLinear(color), 1.0F);
  }
  /// Draws a line of left-aligned text; text wider than `width` pixels ends in an ellipsis.
  void drawText(int left, int top, const std::string& text, int size, std::uint32_t color,
                int width) {
    const TextBitmap line = rasterizeText(text, {.size = 1.0 * size, .maxWidth = 1.0 * width});
    const int baseline = top + static_cast<int>(fontAscent * size);
    auto coverage = line.coverage.begin();
    for (int y = 0; y < line.height; ++y)
      for (int x = 0; x < line.width; ++x)
        blend(left + line.left + x, baseline + line.top + y, toLinear(color), *coverage++);
  }
  void drawImage(int left, int top, const Canvas& source) {
    for (int y = 0; y < source.m_height; ++y)
      for (int x = 0; x < source.m_width; ++x)
        blend(left + x, top + y, source.at(x, y), 1.0F);
  }
  /// Blends a color over a pixel; `coverage` is its opacity.
  void blend(int x, int y, const Rgb& color, float coverage) {
    if (x < 0 || y < 0 || x >= m_width || y >= m_height)
      return;
    for (std::size_t c = 0; c < m_planes.size(); ++c) {
      float& value = m_planes[c][index(x, y)];
      value += coverage * (static_cast<float>(color[static_cast<int>(c)]) - value);
    }
  }
  Image takeImage() && {
    Image image{m_width, m_height, {}, {}};
    for (std::size_t c = 0; c < m_planes.size(); ++c)
      image.channels[std::string(1, "RGB"[c])] = std::move(m_planes[c]);
    return image;
  }

private:
  static Rgb toLinear(std::uint32_t color) { return decodeSrgb(hexToRgb(color)); }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(m_width) +
           static_cast<std::size_t>(x);
  }
  Rgb at(int x, int y) const {
    const std::size_t i = index(x, y);
    return Rgb(m_planes[0][i], m_planes[1][i], m_planes[2][i]);
  }

  int m_width, m_height;
  std::array<Plane, 3> m_planes;
};

/// Scales an image of display values with straight alpha to the box, composited over the panel.
/// Averages in linear light when it shrinks the image.
Canvas scaleToBox(const Image& image) {
  const double scale = std::min(1.0 * boxWidth / image.width, 1.0 * maxBoxHeight / image.height);
  const auto scaled = [scale](int size) {
    return std::max(1, static_cast<int>(size * scale + 0.5));
  };
  Canvas canvas(scaled(image.width), scaled(image.height), panelColor);
  const Plane* const alpha = image.find("A");
  const std::array<const Plane*, 3> planes = {image.find("R"), image.find("G"), image.find("B")};
  const auto toSource = [](int at, int size, int sourceSize) {
    return static_cast<int>(std::int64_t{at} * sourceSize / size);
  };
  for (int y = 0; y < canvas.height(); ++y)
    for (int x = 0; x < canvas.width(); ++x) {
      const int top = toSource(y, canvas.height(), image.height);
      const int left = toSource(x, canvas.width(), image.width);
      const int bottom = std::max(top + 1, toSource(y + 1, canvas.height(), image.height));
      const int right = std::max(left + 1, toSource(x + 1, canvas.width(), image.width));
      Rgb sum = Rgb::Zero();
      double alphaSum = 0.0;
      for (int v = top; v < bottom; ++v)
        for (int u = left; u < right; ++u) {
          const std::size_t i =
              static_cast<std::size_t>(v) * static_cast<std::size_t>(image.width) +
              static_cast<std::size_t>(u);
          const double weight = alpha ? static_cast<double>((*alpha)[i]) : 1.0;
          sum += weight * decodeSrgb(Rgb((*planes[0])[i], (*planes[1])[i], (*planes[2])[i]));
          alphaSum += weight;
        }
      const double area = 1.0 * (bottom - top) * (right - left); // source pixels
      if (alphaSum > 0.0)
        canvas.blend(x, y, sum / alphaSum, static_cast<float>(alphaSum / area));
    }
  return canvas;
}

/// Distance of the baselines of two lines, pixels.
constexpr int computeLineHeight(int size) {
  return static_cast<int>(fontLineHeight * size);
}

constexpr int textLine = computeLineHeight(textSize) + 2; ///< pixels

/// Entry with its image scaled to display size.
struct Thumbnail {
  const SheetEntry* entry;
  std::string problem;
  std::optional<Canvas> image = {};
};

Thumbnail makeThumbnail(const SheetEntry& entry) {
  Thumbnail thumbnail{&entry, entry.problem};
  if (entry.image.empty())
    return thumbnail;
  try {
    thumbnail.image = scaleToBox(readImage(entry.image));
  } catch (const Error& error) {
    thumbnail.problem = error.what();
  }
  return thumbnail;
}

/// Chooses columns for a sheet somewhat wider than high, with few empty cells in the last row.
int chooseColumns(int count) {
  const int wide = std::max(1, static_cast<int>(std::ceil(std::sqrt(1.4 * count))));
  const int narrow = std::max(1, wide - 1);
  const auto countEmpty = [count](int columns) { return (columns - count % columns) % columns; };
  return countEmpty(narrow) < countEmpty(wide) ? narrow : wide;
}

/// Draws an entry into its cell.
void drawEntry(Canvas& sheet, int left, int top, int boxHeight, const Thumbnail& thumbnail) {
  constexpr int margin = 14;
  sheet.fill(left, top, boxWidth, boxHeight, panelColor);
  if (const auto& image = thumbnail.image)
    sheet.drawImage(left + (boxWidth - image->width()) / 2, top + (boxHeight - image->height()) / 2,
                    *image);
  int line = top + margin;
  constexpr double characterWidth = 0.6 * textSize; // less for most texts
  constexpr auto lineLength = static_cast<std::size_t>((boxWidth - 2 * margin) / characterWidth);
  if (!thumbnail.problem.empty())
    for (const std::string& text : split(wrapLines(thumbnail.problem, lineLength), '\n')) {
      if (line + textLine > top + boxHeight)
        break;
      sheet.drawText(left + margin, line, text, textSize, errorColor, boxWidth - 2 * margin);
      line += textLine;
    }
  line = top + boxHeight + 8;
  sheet.drawText(left, line, thumbnail.entry->name, nameSize,
                 thumbnail.problem.empty() ? white : errorColor, boxWidth);
  line += computeLineHeight(nameSize);
  for (const std::string& text : thumbnail.entry->lines) {
    sheet.drawText(left, line, text, textSize, gray, boxWidth);
    line += textLine;
  }
}

} // namespace

Image makeContactSheet(const std::string& title, const std::string& subtitle,
                       std::span<const SheetEntry> entries, int maxColumns) {
  std::vector<Thumbnail> thumbnails;
  int boxHeight = minBoxHeight;
  std::size_t lines = 0;
  for (const SheetEntry& entry : entries) {
    thumbnails.push_back(makeThumbnail(entry));
    lines = std::max(lines, entry.lines.size());
    if (const auto& image = thumbnails.back().image)
      boxHeight = std::max(boxHeight, image->height());
  }
  const int count = static_cast<int>(entries.size());
  const int columns = std::min(maxColumns, chooseColumns(count));
  const int rows = (count + columns - 1) / columns;
  const int captionHeight = 8 + computeLineHeight(nameSize) + static_cast<int>(lines) * textLine;
  const int headerHeight = computeLineHeight(titleSize) + computeLineHeight(textSize) + 2 * gap;
  const int cellWidth = boxWidth + gap, cellHeight = boxHeight + captionHeight + gap;
  Canvas sheet(gap + std::max(columns, 2) * cellWidth, headerHeight + rows * cellHeight + gap / 2,
               sheetColor);
  const int width = sheet.width() - 2 * gap;
  sheet.drawText(gap, gap, title, titleSize, white, width);
  sheet.drawText(gap, gap + computeLineHeight(titleSize), subtitle, textSize, gray, width);
  for (int i = 0; i < count; ++i)
    drawEntry(sheet, gap + i % columns * cellWidth, headerHeight + i / columns * cellHeight,
              boxHeight, thumbnails[static_cast<std::size_t>(i)]);
  return std::move(sheet).takeImage();
}

} // namespace fenestra::core
