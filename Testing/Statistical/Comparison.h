#pragma once
// One combination of the matrix, rendered by the product and by the oracle, and what their
// difference says at three scales: pixels, tiles of 4 x 4 pixels, and the whole picture.

#include "Matrix.h"
#include "Oracle/Estimates.h"
#include "Significance.h"
#include "transport/render/Render.h"

#include <optional>
#include <string>
#include <vector>

namespace fenestra::testing {

/// Seeds and budget of a run over the matrix.
struct MatrixSettings {
  std::uint64_t samples = 128; ///< a pixel, of each renderer
  std::uint64_t seed = 1;
  Transport transport = Transport::fast; ///< of the product
};

struct Outcome {
  Combination combination;
  /// How probable the largest difference is: over all pixels and channels; over all tiles and
  /// channels; over the picture's channels, share of paths that collide, depth and albedo.
  double pixels = 1.0, tiles = 1.0, picture = 1.0;
  /// One channel a tile, and of the picture: independent of each other, so uniform in [0, 1]. Only
  /// of even paths (isEven): others' are too rarely near 0 or 1.
  std::vector<double> tileProbabilities;
  std::optional<double> pictureProbability;
  /// Of the same channel: the picture's difference over the oracle's mean, and over its own error.
  double difference = 0.0, deviate = 0.0;
  /// Largest difference of the two depth buffers, mm, over samples that the two agree to be focus
  /// or not; and how many they do not agree on.
  double depthDifference = 0.0;
  int depthDisagreements = 0;
  oracle::Estimates product, truth; ///< for error images

  /// Of all three scales together.
  double probability() const;
};

/// What the oracle makes of a combination.
struct Truth {
  oracle::Estimates picture;
  std::vector<double> depths; ///< of a depth clip's buffer, mm, row by row
};

Truth renderTruth(const Combination& c, const MatrixSettings& settings);
Outcome compareWithOracle(const Combination& c, const MatrixSettings& settings, Truth truth);

/// A hypothesis about all combinations together, and how probable what was seen is under it.
struct Verdict {
  std::string name;
  double count;
  double probability;
};

/// Pixels, tiles, pictures; uniformity of the tiles' and the pictures' probabilities; the pictures'
/// mean deviate.
std::vector<Verdict> verdicts(const std::vector<Outcome>& outcomes);

} // namespace fenestra::testing
