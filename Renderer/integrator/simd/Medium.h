#pragma once
// A volume and its clip in the form that lanes read.

#include "base/Narrow.h"
#include "integrator/simd/MajorantGrid.h"
#include "integrator/simd/Mixture.h"
#include "integrator/simd/PiecewiseLinear.h"

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

namespace fenestra {

class SilhouetteCells;

/// Voxels for interpolation in lanes.
struct SimdField {
  const void* voxels = nullptr;
  std::int64_t count = 0;
  SimdAxes axes = {};
};

/// Plain numbers and pointers, in float and index space. Built by SimdTracker.
struct SimdMedium {
  /// First voxel, of Voxels' types.
  using FirstVoxel =
      std::variant<const std::uint8_t*, const std::int16_t*, const std::uint16_t*, const float*>;
  /// Cells along one axis.
  struct Axis {
    float cellEdge;      ///< voxels
    float cellsPerVoxel; ///< 1 / cellEdge
    float insideCells;   ///< greatest float below `cells`
    float cellStride;    ///< offset of the next cell in SimdMajorants::codes
  };
  /// Samples of the clip's depth buffer along one axis (clip/focus/DepthBuffer.h).
  struct DepthAxis {
    float perPitch, start, lastInside, before, perFactor, last;
  };
  enum class ClipKind { none, plane, depthLinear, depthNearest };
  /// ContextStyle (model/medium/ContextStyle.h) in float.
  struct Context {
    SimdField focus;
    AffineRows toFocus = {}; ///< index space to the focus's index space
    float level = 0.0F;      ///< voxel value at the focus's surface
    float extinction = 1.0F, saturation = 1.0F;
  };

  FirstVoxel voxels;
  SimdField field; ///< of `voxels`
  std::array<Axis, 3> axes;
  /// Domain: the box [lower, upper] in index space and, if cropped, [-1, 1]^3 in crop space.
  std::array<float, 3> lower, upper;
  std::optional<AffineRows> toCrop = {};

  SimdLines extinctions; ///< mm^-1 over the scalar: of all matter, or of a mixture's components
  std::optional<SimdMixture> mixture = {};

  SimdMajorants cells;    ///< fewer than 2^23
  float firstCell = 0.0F; ///< index in SimdMajorants::codes of the first cell inside the border
  float lastCell = 0.0F;  ///< index of the last one, the border's
  /// Way, mm, that a ray goes on behind a face before it looks for its cell: half of
  /// MajorantGrid::margin at most, so that the new cell is not the old one, whatever rounding does.
  float overshoot = 0.0F;

  std::optional<Context> context = {};

  ClipKind clipKind = ClipKind::none;
  float ghost = 0.0F;                  ///< ClipEdge
  float softness = 0.0F;               ///< mm
  float perSoftness = 0.0F;            ///< 1 / mm; 0: sharp edge
  float cutSlope = 0.0F;               ///< cutShading / softness, mm^-1; 0: sharp edge
  std::array<float, 3> cutNormal = {}; ///< into matter, world: a plane's; else the view's axis
  bool perspective = false;
  /// Rows of the map from index space to view space, depth counted from the target.
  AffineRows toView = {};
  AffineRows fromView = {};          ///< directions: view space to world
  std::array<float, 4> toPlane = {}; ///< distance from the plane, mm; > 0: removed
  float targetDepth = 0.0F;
  DepthAxis depthX = {}, depthY = {};
  const float* depths = nullptr; ///< mm, counted from the target
  std::int32_t depthColumns = 0;
  const SilhouetteCells* silhouette = nullptr; ///< for an exact boundary; else null
};

} // namespace fenestra
