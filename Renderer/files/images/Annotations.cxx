#include "files/images/Annotations.h"

#include "base/Text.h"
#include "files/images/TextBitmap.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fenestra::core {
namespace {

/// Rectangle, pixels from the image's top left corner.
struct Rectangle {
  double left, top, right, bottom;
};

struct TextMark {
  std::string text;
  int left, baseline; ///< start of the baseline, pixels
};

/// Sizes of marks, pixels.
struct MarkSizes {
  explicit MarkSizes(int width, int height)
      : text(std::max(10.0, 0.036 * std::min(width, height))) {}

  double text;                                       ///< em
  double outline = std::max(1.0, 0.09 * text);       ///< around every mark
  double margin = 0.5 * text;                        ///< to the image's edges
  double line = std::max(1.0, std::round(text / 8)); ///< thickness of the scale bar
  double tick = std::round(text / 2);                ///< height of its ends
};

class MarkPainter {
public:
  MarkPainter(int width, int height, std::vector<float>& rgba)
      : m_sizes(width, height), m_width(width), m_height(height), m_rgba(rgba) {}

  const MarkSizes& sizes() const { return m_sizes; }
  int width() const { return m_width; }
  int height() const { return m_height; }

  void add(const Rectangle& rectangle) { m_rectangles.push_back(rectangle); }
  /// Adds text centered at `center`, with its baseline at `baseline`, moved to inside the margins.
  void add(const std::string& text, double center, double baseline) {
    const double advance = rasterizeText(text, {.size = m_sizes.text}).advance;
    const double left = std::min(center - advance / 2, m_width - m_sizes.margin - advance);
    m_texts.push_back({text, static_cast<int>(std::lround(std::max(left, m_sizes.margin))),
                       static_cast<int>(std::lround(baseline))});
  }

  /// Draws all outlines below all marks.
  void draw() {
    drawAll(m_sizes.outline, 0.0F);
    drawAll(0.0, 1.0F);
  }

private:
  void drawAll(double outline, float gray) {
    for (const Rectangle& rectangle : m_rectangles)
      fill({rectangle.left - outline, rectangle.top - outline, rectangle.right + outline,
            rectangle.bottom + outline},
           gray);
    for (const TextMark& mark : m_texts) {
      const TextBitmap line = rasterizeText(mark.text, {.size = m_sizes.text, .outline = outline});
      auto coverage = line.coverage.begin();
      for (int y = 0; y < line.height; ++y)
        for (int x = 0; x < line.width; ++x)
          blend(mark.left + line.left + x, mark.baseline + line.top + y, gray, *coverage++);
    }
  }

  /// Length of the part of pixel `at` between `first` and `last`.
  static double overlap(int at, double first, double last) {
    return std::clamp(std::min(at + 1.0, last) - std::max(1.0 * at, first), 0.0, 1.0);
  }
  void fill(const Rectangle& area, float gray) {
    for (int y = static_cast<int>(std::floor(area.top)); y < area.bottom; ++y)
      for (int x = static_cast<int>(std::floor(area.left)); x < area.right; ++x)
        blend(x, y, gray,
              static_cast<float>(overlap(x, area.left, area.right) *
                                 overlap(y, area.top, area.bottom)));
  }

  /// Blends gray over a pixel with straight alpha; `coverage` is its opacity.
  void blend(int x, int y, float gray, float coverage) {
    if (x < 0 || y < 0 || x >= m_width || y >= m_height || coverage == 0.0F)
      return;
    float* const pixel =
        &m_rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(m_width) +
                     static_cast<std::size_t>(x))];
    const float below = pixel[3] * (1.0F - coverage);
    pixel[3] = coverage + below;
    for (int c = 0; c < 3; ++c)
      pixel[c] = (coverage * gray + below * pixel[c]) / pixel[3];
  }

  MarkSizes m_sizes;
  int m_width, m_height;
  std::vector<float>& m_rgba;
  std::vector<Rectangle> m_rectangles;
  std::vector<TextMark> m_texts;
};

/// Adds a bar with ends at the bottom right, and its length above it.
void addScale(double pixelWidth, MarkPainter& painter) {
  const MarkSizes& sizes = painter.sizes();
  const double length = chooseScaleLength(pixelWidth * painter.width());
  const double right = std::floor(painter.width() - sizes.margin);
  const double bottom = std::floor(painter.height() - sizes.margin);
  const double left = right - length / pixelWidth;
  const double top = bottom - sizes.tick;
  painter.add({left, bottom - sizes.line, right, bottom});
  painter.add({left, top, left + sizes.line, bottom - sizes.line});
  painter.add({right - sizes.line, top, right, bottom - sizes.line});
  painter.add(toString(length) + " mm", (left + right) / 2, top - 0.3 * sizes.text);
}

void addOrientation(const ImagePlane& plane, MarkPainter& painter) {
  const MarkSizes& sizes = painter.sizes();
  const double middle = painter.width() / 2.0, ascent = fontCapHeight * sizes.text;
  const double centered = (painter.height() + ascent) / 2.0;
  painter.add(toPatientLetters(-plane.columnStep), 0.0, centered);
  painter.add(toPatientLetters(plane.columnStep), painter.width(), centered);
  painter.add(toPatientLetters(-plane.rowStep), middle, sizes.margin + ascent);
  painter.add(toPatientLetters(plane.rowStep), middle, painter.height() - sizes.margin);
}

} // namespace

std::string toPatientLetters(const Vec3& direction) {
  std::array<int, 3> axes = {0, 1, 2};
  std::ranges::stable_sort(axes, std::greater{},
                           [&](int axis) { return std::abs(direction[axis]); });
  std::string letters, best;
  double sum = 0.0, nearest = 0.0; // cosines, times the length of `direction`
  for (const int axis : axes) {
    sum += std::abs(direction[axis]);
    letters += direction[axis] < 0.0 ? "LPI"[axis] : "RAS"[axis];
    const double cosine = sum / std::sqrt(static_cast<double>(letters.size()));
    if (cosine <= nearest)
      break;
    nearest = cosine;
    best = letters;
  }
  return best;
}

double chooseScaleLength(double imageWidth) {
  const double wanted = imageWidth / 5.0;
  const double power = std::pow(10.0, std::floor(std::log10(wanted)));
  constexpr std::array factors = {1.0, 2.0, 5.0, 10.0};
  const auto ratio = [&](double factor) { return std::abs(std::log(factor * power / wanted)); };
  return power * *std::ranges::min_element(factors, {}, ratio);
}

void drawAnnotations(const Annotations& annotations, const ImagePlane& plane, int width, int height,
                     std::vector<float>& rgba) {
  MarkPainter painter(width, height, rgba);
  if (annotations.scale)
    addScale(plane.columnStep.norm(), painter);
  if (annotations.orientation)
    addOrientation(plane, painter);
  painter.draw();
}

} // namespace fenestra::core
