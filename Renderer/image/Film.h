#pragma once
// What a render accumulates, pixel by pixel, and what it shows.

#include "base/Vector.h"

#include <cstdint>
#include <vector>

namespace fenestra {

/// What one path contributes to its pixel.
struct PathSample {
  Rgb radiance = Rgb::Zero(); ///< premultiplied, background included where it is opaque
  double alpha = 1.0;         ///< 0 where an eye ray passes through to a transparent background
  double depth = infinity;    ///< of the first collision, mm in view space; infinity where none
  Rgb albedo = Rgb::Zero();   ///< at the first collision
  Vec3 normal = Vec3::Zero(); ///< unit, world axes, at the first collision; zero where none
  double scatterings = 0.0;   ///< of the path: what it cost
};

/// Running sums of one pixel, in double. Samples are added in their own order, so that the sums do
/// not depend on how passes or threads cut them.
struct PixelSums {
  std::uint64_t samples = 0;
  Rgb mean = Rgb::Zero();      ///< of radiance
  Rgb deviation = Rgb::Zero(); ///< sum of squared deviations from the mean (Welford 1962)
  double alpha = 0.0;
  double depth = 0.0; ///< over samples that collide
  std::uint64_t collided = 0;
  Rgb albedo = Rgb::Zero();
  Vec3 normal = Vec3::Zero();
  double scatterings = 0.0;
  bool isCertain = false; ///< more samples would be equal to the one that there is

  void add(const PathSample& sample);
  /// Standard error of the mean radiance; 0 below two samples, where it is certain rightly so.
  Rgb standardError() const;
};

/// Of the pixels that are not certain; of all where all are.
struct SampleCounts {
  std::uint64_t least = 0, greatest = 0;
  double mean = 0.0;
  std::size_t certainPixels = 0;
};

/// Row 0 is the top row.
class Film {
public:
  Film(int width, int height)
      : m_width(width),
        m_height(height),
        m_pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

  int width() const { return m_width; }
  int height() const { return m_height; }
  std::size_t pixelCount() const { return m_pixels.size(); }
  PixelSums& at(int column, int row) { return m_pixels[index(column, row)]; }
  const PixelSums& at(int column, int row) const { return m_pixels[index(column, row)]; }
  const std::vector<PixelSums>& pixels() const { return m_pixels; }

  /// sqrt(mean over pixels and channels of se^2 / (x^2 + 0.01)); infinity below two samples a
  /// pixel that is not certain.
  double noise() const;
  SampleCounts sampleCounts() const;

private:
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(m_width) +
           static_cast<std::size_t>(column);
  }

  int m_width, m_height;
  std::vector<PixelSums> m_pixels;
};

} // namespace fenestra
