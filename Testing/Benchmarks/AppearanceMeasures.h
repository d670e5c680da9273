#pragma once
// Measures of the appearance of an image: functions of colors, depths and masks per pixel.
// README.md in this folder states why each is measured, and its bounds.

#include "image/ColorVision.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace fenestra::core::benchmarks {

/// One value per pixel, row 0 at the top.
template <typename Value>
struct Raster {
  int width = 0, height = 0;
  std::vector<Value> values = {};

  Raster(int widthIn, int heightIn, const Value& value = {})
      : width(widthIn),
        height(heightIn),
        values(static_cast<std::size_t>(widthIn) * static_cast<std::size_t>(heightIn), value) {}

  bool contains(int column, int row) const {
    return column >= 0 && column < width && row >= 0 && row < height;
  }
  Value& at(int column, int row) { return values[index(column, row)]; }
  const Value& at(int column, int row) const { return values[index(column, row)]; }

private:
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(column);
  }
};

/// 1: the pixel belongs to a region, else 0.
using PixelMask = Raster<std::uint8_t>;

std::size_t countPixels(const PixelMask& mask);
/// Pixels of both masks; of the first but not of the second.
PixelMask intersect(PixelMask a, const PixelMask& b);
PixelMask subtract(PixelMask a, const PixelMask& b);
/// Pixels whose centers are within `radius` pixels of one in the mask.
PixelMask dilate(const PixelMask& mask, double radius);
/// Pixels farther than `radius` pixels from every pixel outside. The image border is no outline.
PixelMask erode(const PixelMask& mask, double radius);
/// Pixels that differ from a neighbor to the right or below by more than `step`, and that neighbor.
PixelMask findJumps(const Raster<double>& depth, double step);

/// Value below which the fraction `p`, 0 to 1, of the values lies, interpolated linearly. NaN
/// without values.
double quantile(std::vector<double> values, double p);

/// CIELAB of display-encoded colors.
Raster<Lab> toLabRaster(const Raster<Rgb>& display);

/// Angles, degrees.
struct AngleSpread {
  double rms, p95;
};

/// Stairs (A1): angles between the normals of a depth map, mm, and those of its Gaussian of 4 mm,
/// in the focus; `pitch`: mm per pixel. Depths are filtered by a median of 3x3 pixels first. The
/// Gaussian is a weighted plane fit, whose slope is that of the convolution, without its error at
/// the outline. Pixels within 4 mm of the outline, and within 12 mm of a jump of 5 mm, where one
/// part of the focus hides another, do not count. Empty: fewer than 100 pixels count.
std::optional<AngleSpread> measureStairs(const Raster<double>& depth, const PixelMask& focus,
                                         double pitch);

/// Mottle (A2): root mean square of the color difference (CIE 1976) between a region and its
/// Gaussian of 3 mm. Only the region's own pixels enter the Gaussian, and pixels count whose
/// Gaussian lies in the region by at least half. Empty: fewer than 100 pixels count.
std::optional<double> measureMottle(const Raster<Lab>& image, const PixelMask& region,
                                    double pitch);

/// Quantiles 0.05, 0.5 and 0.95 of lightness, 0.5 and 0.95 of chroma (A5).
struct Tone {
  double dark, median, light, chroma, chroma95;
};

/// Pixels at or below L* 14 do not count: deep shadows, and holes that show the background.
Tone measureTone(const Raster<Lab>& image, const PixelMask& covered);

/// Highlights (A6): fraction of the focus, 6 mm inside its outline, that is over 6 L* lighter than
/// the median of a square of 20 mm, and less chromatic than its median. Empty: no such pixels.
std::optional<double> measureHighlights(const Raster<Lab>& image, const PixelMask& focus,
                                        double pitch);

/// Dark edge (A7): fraction of the pixels within 3 of the outline of the focus that are over 10 L*
/// darker than the quantile 0.3 of the 15x15 pixels around. Parts of the focus narrower than 5
/// pixels have no outline. Empty: no outline in the image.
std::optional<double> measureDarkEdge(const Raster<Lab>& image, const PixelMask& focus);

/// Color differences (CIE 1976) between the mean colors 3 to 8 pixels inside and outside the
/// outline of the focus, and these colors.
struct EdgeContrast {
  double deltaE, deltaEProtan, deltaEDeutan, deltaLightness;
  Lab focus, context;
};

/// `covered`: pixels that may count. Empty: none inside or none outside.
std::optional<EdgeContrast> measureContrast(const Raster<Rgb>& display, const PixelMask& focus,
                                            const PixelMask& covered);

} // namespace fenestra::core::benchmarks
