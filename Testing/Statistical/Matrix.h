#pragma once
// Matrix of small scenes in which the product is compared with the oracle: all kinds of views,
// clips, lights and media, in combinations that a Latin design spreads evenly.
//
// Each factor runs through its levels in blocks, every block in its own order: over n combinations
// every level occurs n / levels times, and every pair of levels of two factors about n / levels^2
// times. Every eighth combination has hybrid shading and, if it has a clip, a soft edge, whatever
// the design says of these two: by itself it makes too few for each kind of clip. Combination i is
// always the same scene; only the estimators' seeds change.
//
// Every other combination has segments, half of these of matter. Beyond the first `shortCount` two
// of three have segments of matter, so that over 640 combinations more than 320 have.

#include "Oracle/OracleScene.h"
#include "Support.h"

#include <string>

namespace fenestra::testing {

enum class ViewFactor { orthographic, perspective, orthographicInside, perspectiveInside };
enum class ClipFactor { none, plane, cutaway, surface, exactSurface, hole };
/// Sharpness of a clip's edge.
enum class EdgeFactor { sharp, ghost, soft, softGhost };
/// Look of the context.
enum class StyleFactor { none, thin, desaturated, thinDesaturated };
enum class LightFactor { constant, map, directional, rectangle, disk, several, sky, sphere };
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
enum class GridFactor { cubes, thickSlices, rotated, shearedMirrored, fine };
enum class BackgroundFactor { color, transparent, environment };

/// How segments lie.
enum class SegmentFactor { overlapping, nested, disjoint };

struct Combination {
  int index = 0;
  ViewFactor view{};
  ClipFactor clip{};
  LightFactor light{};
  double g = 0.0;
  AlbedoFactor albedo{};
  TransferFactor transfer{};
  bool isHybrid = false;
  bool isCoated = false; ///< where hybrid
  VoxelFactor voxels{};
  GridFactor grid{};
  bool isCropped = false;
  BackgroundFactor background{};
  std::uint64_t bounces = 0; ///< maximum of the type: unlimited
  EdgeFactor edge{};
  StyleFactor style{};
  double offset = 0.0; ///< of the clip, mm
  int segmentCount = 0;
  SegmentFactor segments{};
  bool haveSoftEdges = false;  ///< segments, at their borders
  bool areMedia = false;       ///< segments: all of their matter is their own, not albedo alone
  bool haveInterfaces = false; ///< segments: some borders are surfaces
};

/// Combinations of the short version of the suite, and of the long one.
inline constexpr int shortCount = 240, longCount = 640;

/// First `count` combinations of an endless list.
std::vector<Combination> makeCombinations(int count);

/// "12 perspective surface map g 0.9 ..."
std::string describe(const Combination& c);

/// One scene for both renderers.
struct MatrixScene {
  TestScene product;
  RenderSettings settings; ///< background and bounces
  oracle::ClipDescription clip = {};
  std::optional<oracle::StyleDescription> style = {};
  std::optional<oracle::ComponentsDescription> components = {};
  /// Depth clip's buffer, mm, row by row, for comparison with the oracle's.
  std::vector<double> productDepths = {};

  oracle::OracleScene toOracleScene() const;
};

MatrixScene makeMatrixScene(const Combination& c);

} // namespace fenestra::testing
