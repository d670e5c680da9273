#pragma once
// Matrix of small scenes in which Fenestra is compared with the oracle: all kinds of views,
// clips, lights and media, in evenly distributed combinations (a Latin design).
//
// Each factor runs through its levels in blocks, and each block has its own order. Over n
// combinations, every level occurs n / levels times, and every pair of levels of two factors about
// n / levels^2 times. The design alone has too few soft edges with hybrid shading per kind of clip.
// So every eighth combination has hybrid shading and, if it has a clip, a soft edge. Combination i
// is always the same scene; only the seeds of the renderers change.
//
// Every other combination has segments, half of them with media of their own. After the first
// `shortCount` combinations, two of three have such segments: more than 320 of all 640.

#include "Oracle/OracleScene.h"
#include "Support.h"

#include <string>

namespace fenestra::core::testing {

enum class ViewFactor { orthographic, perspective, orthographicInside, perspectiveInside };
enum class ClipFactor { none, plane, cutaway, surface, exactSurface, hole };
/// Sharpness of a clip's edge.
enum class EdgeFactor { sharp, ghost, soft, softGhost };
/// Appearance of the context.
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

/// Arrangement of the segments.
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
  GradientKind gradient{};
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
  bool hasSoftSegments = false; ///< segments have soft edges
  bool hasSegmentMedia = false; ///< segments have media of their own; false: only albedos
  bool hasInterfaces = false;   ///< some segments' interfaces are surfaces
};

/// Numbers of combinations of the short and of the long version of the suite.
inline constexpr int shortCount = 240, longCount = 640;

/// First `count` combinations of an infinite list.
std::vector<Combination> makeCombinations(int count);

/// Levels of the factors, separated by " | ": "perspective | surface | map | 0.9 | ..."
std::string describe(const Combination& c);

/// One scene for both renderers.
struct MatrixScene {
  TestScene fenestra;      ///< Fenestra's input
  RenderSettings settings; ///< background and bounces
  oracle::ClipDescription clip = {};
  std::optional<oracle::StyleDescription> style = {};
  std::optional<oracle::ComponentsDescription> components = {};
  /// Buffer of a depth clip, mm, row by row, for comparison with the oracle's.
  std::vector<double> fenestraDepths = {};

  oracle::OracleScene toOracleScene() const;
};

MatrixScene makeMatrixScene(const Combination& c);

} // namespace fenestra::core::testing
