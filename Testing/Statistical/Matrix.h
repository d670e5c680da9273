#pragma once
// The matrix of small scenes in which the product is compared with the oracle: every kind of
// everything, in combinations that the design below spreads evenly.
//
// Each factor runs through its levels in blocks, every block in an order of its own (a Latin
// design): over n combinations every level stands n / levels times, and every pair of levels of two
// factors about n / (levels * levels) times. Combination i is always the same scene; only the
// estimators' seeds change.

#include "Oracle/OracleScene.h"
#include "Support.h"

#include <string>

namespace fenestra::testing {

enum class ViewFactor { orthographic, perspective, orthographicInside, perspectiveInside };
enum class ClipFactor { none, plane, cutaway, surface, exactSurface, hole };
/// How sharp a clip's edge is.
enum class EdgeFactor { sharp, ghost, soft, softGhost };
/// What is not focus looks like.
enum class StyleFactor { none, thin, pale, thinAndPale };
enum class LightFactor { constant, map, directional, rectangle, disk, several };
enum class AlbedoFactor { black, half, nearlyOne, one, perChannel, byScalar };
enum class TransferFactor {
  linear,
  step,
  spike,
  nonMonotone,
  gradientOpacity,
  steepGradientOpacity
};
enum class VoxelFactor { uint8, int16, uint16, float32 };
enum class GridFactor { cubes, thickSlices, turned, shearedMirrored, fine };
enum class BackgroundFactor { color, transparent, environment };

struct Combination {
  int index = 0;
  ViewFactor view{};
  ClipFactor clip{};
  LightFactor light{};
  double g = 0.0;
  AlbedoFactor albedo{};
  TransferFactor transfer{};
  bool isHybrid = false;
  VoxelFactor voxels{};
  GridFactor grid{};
  bool isCropped = false;
  BackgroundFactor background{};
  std::uint64_t bounces = 0; ///< the greatest number: unlimited
  EdgeFactor edge{};
  StyleFactor style{};
  double offset = 0.0; ///< of the clip, mm
};

/// The first `count` of an endless list.
std::vector<Combination> combinations(int count);

/// "12 perspective surface map g 0.9 ..."
std::string describe(const Combination& c);

/// The same scene for both renderers.
struct MatrixScene {
  TestScene product;
  RenderSettings settings; ///< background and bounces
  oracle::ClipDescription clip = {};
  std::optional<oracle::StyleDescription> style = {};
  /// Of a depth clip's buffer, mm, row by row: to be compared with the oracle's.
  std::vector<double> productDepths = {};

  oracle::OracleScene forOracle() const;
};

MatrixScene matrixScene(const Combination& c);

} // namespace fenestra::testing
