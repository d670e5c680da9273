#pragma once
// Renders a combination of the matrix with Fenestra and with the oracle (../Oracle), and tests
// their difference at three scales: pixels, tiles of 4 x 4 pixels, complete image.

#include "Matrix.h"
#include "Oracle/Estimates.h"
#include "Significance.h"
#include "integrator/render/Render.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace fenestra::core::testing {

/// Seeds and budget of a run over the matrix.
struct MatrixSettings {
  std::uint64_t samples = 128; ///< per pixel, of each renderer
  std::uint64_t seed = 1;
  Integrator integrator = Integrator::simd; ///< of Fenestra
  /// Renders instead of Fenestra, if set.
  std::function<Film(const TestScene&, const RenderSettings&)> renderer = {};
};

struct Outcome {
  Combination combination;
  /// Corrected p-values of the largest difference: over all pixels and channels; over all tiles and
  /// channels; over the image's channels, fraction of colliding paths, depth and albedo.
  double pixels = 1.0, tiles = 1.0, image = 1.0;
  /// p-values of one channel per tile, and of the image: independent, so uniform in [0, 1]. Only of
  /// means of many paths (hasManyPaths): those of few paths are too rarely near 0 or 1.
  std::vector<double> tileProbabilities;
  std::optional<double> imageProbability;
  /// One channel of the image: (Fenestra - oracle) / oracle, and / the difference's standard error.
  double difference = 0.0, z = 0.0;
  /// Largest difference of the two depth buffers, mm, over samples that both classify alike as
  /// focus or not; and number of samples that they classify differently.
  double depthDifference = 0.0;
  int depthDisagreements = 0;
  oracle::Estimates fenestra, reference; ///< for error images

  /// Corrected p-value of all three scales.
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

/// Test of a hypothesis about all combinations: `probability` is its p-value.
struct HypothesisTest {
  std::string name;
  double count;
  double probability;
};

/// Tests the largest differences of pixels, tiles and images, the uniformity of the tiles' and of
/// the images' p-values, and the images' mean z.
std::vector<HypothesisTest> testHypotheses(const std::vector<Outcome>& outcomes);

} // namespace fenestra::core::testing
