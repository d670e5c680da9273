#pragma once
// Estimates of an image's pixels, with their variances.

#include "base/Vector.h"

#include <cstdint>
#include <vector>

namespace fenestra::core::oracle {

/// Contribution of one path to its pixel.
struct PathEstimate {
  Rgb radiance = Rgb::Zero();
  bool collides = false;
  double depth = 0.0;       ///< of the first collision, mm; 0: no collision
  Rgb albedo = Rgb::Zero(); ///< at the first collision; 0: no collision
};

/// First collision as numbers, or means of them: collided (0 or 1), depth (mm; 0: no collision),
/// mean albedo.
using FirstCollision = Array<double, 3>;

struct PixelEstimate {
  double samples = 0.0;
  /// Radiance: mean, and sums of squared and of cubed deviations from it (Pébay 2008).
  Rgb mean = Rgb::Zero(), m2 = Rgb::Zero(), m3 = Rgb::Zero();
  FirstCollision first = FirstCollision::Zero(), firstM2 = FirstCollision::Zero();

  void add(const PathEstimate& path) {
    samples += 1.0;
    const Rgb before = path.radiance - mean;
    const Rgb step = before / samples;
    const Rgb added = before * step * (samples - 1.0);
    mean += step;
    m3 += added * step * (samples - 2.0) - 3.0 * step * m2;
    m2 += added;
    const FirstCollision value(path.collides ? 1.0 : 0.0, path.depth, path.albedo.mean());
    const FirstCollision delta = value - first;
    first += delta / samples;
    firstM2 += delta * (value - first);
  }

  /// Variance of the mean; 0 below two samples.
  Rgb variance() const {
    return samples > 1.0 ? Rgb(m2 / (samples * (samples - 1.0))) : Rgb(Rgb::Zero());
  }
  FirstCollision firstVariance() const {
    return samples > 1.0 ? FirstCollision(firstM2 / (samples * (samples - 1.0)))
                         : FirstCollision(FirstCollision::Zero());
  }
};

struct Estimates {
  int width, height;
  std::uint64_t samples;             ///< per pixel
  std::vector<PixelEstimate> pixels; ///< row by row from the top

  Estimates(int widthIn, int heightIn, std::uint64_t samplesIn)
      : width(widthIn),
        height(heightIn),
        samples(samplesIn),
        pixels(static_cast<std::size_t>(widthIn * heightIn)) {}
};

} // namespace fenestra::core::oracle
