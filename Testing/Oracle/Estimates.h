#pragma once
// What a picture's pixels are believed to be, and how sure that is.

#include "base/Vector.h"

#include <cstdint>
#include <vector>

namespace fenestra::oracle {

/// What one path says of its pixel.
struct PathEstimate {
  Rgb radiance = Rgb::Zero();
  bool collides = false;
  double depth = 0.0;       ///< of the first collision, mm; 0 where there is none
  Rgb albedo = Rgb::Zero(); ///< at the first collision; 0 where there is none
};

/// The first collision, as numbers to compare: how often, how deep (0 where none), how bright.
using FirstCollision = Array<double, 3>;

struct PixelEstimate {
  double samples = 0.0;
  /// Of radiance: mean, and sums of its deviation's square and cube (Pébay 2008).
  Rgb mean = Rgb::Zero(), squares = Rgb::Zero(), cubes = Rgb::Zero();
  FirstCollision first = FirstCollision::Zero(), firstSquares = FirstCollision::Zero();

  void add(const PathEstimate& path) {
    samples += 1.0;
    const Rgb before = path.radiance - mean;
    const Rgb step = before / samples;
    const Rgb added = before * step * (samples - 1.0);
    mean += step;
    cubes += added * step * (samples - 2.0) - 3.0 * step * squares;
    squares += added;
    const FirstCollision value(path.collides ? 1.0 : 0.0, path.depth, path.albedo.mean());
    const FirstCollision ahead = value - first;
    first += ahead / samples;
    firstSquares += ahead * (value - first);
  }

  /// Of the mean; 0 below two samples.
  Rgb variance() const {
    return samples > 1.0 ? Rgb(squares / (samples * (samples - 1.0))) : Rgb(Rgb::Zero());
  }
  FirstCollision firstVariance() const {
    return samples > 1.0 ? FirstCollision(firstSquares / (samples * (samples - 1.0)))
                         : FirstCollision(FirstCollision::Zero());
  }
};

struct Estimates {
  int width, height;
  std::uint64_t samples;             ///< a pixel
  std::vector<PixelEstimate> pixels; ///< row by row from the top

  Estimates(int widthIn, int heightIn, std::uint64_t samplesIn)
      : width(widthIn),
        height(heightIn),
        samples(samplesIn),
        pixels(static_cast<std::size_t>(widthIn * heightIn)) {}
};

} // namespace fenestra::oracle
