#pragma once
// Film: accumulates the samples of each pixel, and estimates their noise.

#include "base/Vector.h"

#include <array>
#include <cstdint>
#include <vector>

namespace fenestra::core {

/// Contribution of one path to its pixel.
struct PathSample {
  Rgb radiance = Rgb::Zero(); ///< premultiplied; includes an opaque background
  double alpha = 1.0;         ///< 0: the camera ray reaches a transparent background
  double depth = infinity;    ///< of the first collision, mm in view space; infinity: no collision
  Rgb albedo = Rgb::Zero();   ///< at the first collision
  Vec3 normal = Vec3::Zero(); ///< unit, world axes, at the first collision; zero: none
  double scatterings = 0.0;   ///< number along the path, a measure of its cost
};

/// Half buffers of a pixel: means over its samples of even and of odd index.
struct HalfMeans {
  Rgb even, odd; ///< radiance
  double evenAlpha, oddAlpha;
};

/// Sums over the samples of one pixel, or means where stated, in double. Samples are added in the
/// order of their indices, so that sums do not depend on passes or threads.
///
/// Samples of the same block may be correlated, since they share strata; blocks are independent.
/// The first `blockSize` samples of even index are a block, the next `blockSize` another, and
/// likewise for odd indices. The last block of each half may be incomplete.
struct PixelSums {
  std::uint64_t samples = 0;
  Rgb mean = Rgb::Zero(); ///< of radiance
  Rgb m2 = Rgb::Zero();   ///< sum of squared deviations from the mean (Welford 1962)
  double alpha = 0.0;
  double depth = 0.0; ///< sum over samples that collide
  std::uint64_t collidedSamples = 0;
  Rgb albedo = Rgb::Zero();
  Vec3 normal = Vec3::Zero();
  double scatterings = 0.0;
  Rgb evenMean = Rgb::Zero(); ///< of radiance, over the samples of even index
  double evenAlpha = 0.0;     ///< sum over the samples of even index
  /// Of radiance: sums over the incomplete last block of each half, and the sum of squared
  /// deviations of the complete blocks' means from their mean.
  std::array<Rgb, 2> partialSums = {Rgb::Zero(), Rgb::Zero()};
  Rgb blockM2 = Rgb::Zero();
  std::uint32_t blockSize = 1;  ///< samples
  bool isDeterministic = false; ///< all further samples would equal the first

  void add(const PathSample& sample);
  /// Half buffers: two independent estimates of the pixel. They depend on the samples only, not on
  /// passes. Needs two samples.
  HalfMeans halfMeans() const;
  /// Standard error of the mean radiance; 0 below two samples, which is correct only if
  /// isDeterministic. For N samples in blocks of m_b samples, with sums S_b,
  ///   variance = sum of (S_b - m_b mean)^2 / (N^2 - sum of m_b^2).
  /// This is unbiased if all blocks are complete, or none has more than one sample. Otherwise it is
  /// too large on average, by a few percent: within a block the noise of samples partly cancels, in
  /// incomplete blocks less than in complete ones.
  Rgb standardError() const;

private:
  void finishBlock(std::uint64_t half);
  double completeBlockCount() const;
  /// Mean over all samples in complete blocks; there must be at least one.
  Rgb completeBlockMean() const;
  /// Samples in the incomplete block of a half: 0 even, 1 odd.
  std::uint64_t partialBlockSize(std::uint64_t half) const {
    return (samples + 1 - half) / 2 % blockSize;
  }
};

/// Samples per pixel, over the pixels that are not deterministic, or over all pixels if all are.
struct SampleCounts {
  std::uint64_t min = 0, max = 0;
  double mean = 0.0;
  std::size_t deterministicPixels = 0;
};

/// Row 0 is the top row.
class Film {
public:
  /// `hasIndependentHalves`: samples of even index share no random numbers with those of odd index.
  /// `blockSize`: PixelSums::blockSize.
  Film(int width, int height, bool hasIndependentHalves = true, std::uint32_t blockSize = 1)
      : m_width(width),
        m_height(height),
        m_hasIndependentHalves(hasIndependentHalves),
        m_pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
    for (PixelSums& pixel : m_pixels)
      pixel.blockSize = blockSize;
  }

  int width() const { return m_width; }
  int height() const { return m_height; }
  /// Required by the filter's error estimate (denoise/filter/ErrorEstimate.h).
  bool hasIndependentHalves() const { return m_hasIndependentHalves; }
  /// Index of a pixel in pixels().
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(m_width) +
           static_cast<std::size_t>(column);
  }
  std::size_t pixelCount() const { return m_pixels.size(); }
  PixelSums& at(int column, int row) { return m_pixels[index(column, row)]; }
  const PixelSums& at(int column, int row) const { return m_pixels[index(column, row)]; }
  const std::vector<PixelSums>& pixels() const { return m_pixels; }

  /// sqrt(mean over pixels and channels of se^2 / (x^2 + 0.01)). Deterministic pixels count as 0.
  /// Infinity if any other pixel has fewer than two samples.
  double noise() const;
  SampleCounts sampleCounts() const;

private:
  int m_width, m_height;
  bool m_hasIndependentHalves;
  std::vector<PixelSums> m_pixels;
};

} // namespace fenestra::core
