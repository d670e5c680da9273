#pragma once
// One combination of the matrix, rendered by the product and by the oracle, and the significance of
// their difference at three scales: pixels, tiles of 4 x 4 pixels, the whole picture.

#include "Matrix.h"
#include "Oracle/Estimates.h"
#include "Significance.h"
#include "integrator/render/Render.h"

#include <optional>
#include <string>
#include <vector>

namespace fenestra::testing {

/// Seeds and budget of a run over the matrix.
struct MatrixSettings {
  std::uint64_t samples = 128; ///< a pixel, of each renderer
  std::uint64_t seed = 1;
  Integrator integrator = Integrator::simd; ///< of the product
};

struct Outcome {
  Combination combination;
  /// Probability of the largest difference: over all pixels and channels; over all tiles and
  /// channels; over the picture's channels, share of colliding paths, depth and albedo.
  double pixels = 1.0, tiles = 1.0, image = 1.0;
  /// Probabilities of one channel a tile, and of the picture: independent, hence uniform in [0, 1].
  /// Only from even means (isEven): those of uneven means are too rarely near 0 or 1.
  std::vector<double> tileProbabilities;
  std::optional<double> imageProbability;
  /// Picture's channel: (product - oracle) / oracle's mean, and / standard error of the difference.
  double difference = 0.0, z = 0.0;
  /// Largest difference of the two depth buffers, mm, over samples on whose kind (focus or not)
  /// both agree; and number of samples on which they disagree.
  double depthDifference = 0.0;
  int depthDisagreements = 0;
  oracle::Estimates product, reference; ///< for error images

  /// Probability of all three scales together.
  double probability() const;
};

/// Oracle's render of a combination.
struct OracleRender {
  oracle::Estimates image;
  std::vector<double> depths; ///< depth clip's buffer, mm, row by row
};

OracleRender renderOracle(const Combination& c, const MatrixSettings& settings);
Outcome compareWithOracle(const Combination& c, const MatrixSettings& settings,
                          OracleRender oracleRender);

/// Hypothesis about all combinations together, and the probability of the observation under it.
struct HypothesisTest {
  std::string name;
  double count;
  double probability;
};

/// Verdicts on pixels, tiles and pictures; on uniformity of the tiles' and the pictures'
/// probabilities; on the pictures' mean deviate.
std::vector<HypothesisTest> testHypotheses(const std::vector<Outcome>& outcomes);

} // namespace fenestra::testing
