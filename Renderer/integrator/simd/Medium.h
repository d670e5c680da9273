#pragma once
// A volume and its clip in SIMD form.

#include "base/Narrow.h"
#include "integrator/simd/MajorantGrid.h"
#include "integrator/simd/Mixture.h"
#include "integrator/simd/PiecewiseLinear.h"

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

namespace fenestra::core {

class SilhouetteCells;

/// Tables of the formulas in float.
namespace single {
using Real = float;
#include "formulas/ClipTable.inl"
} // namespace single

/// Voxels for interpolation.
struct SimdField {
  const void* voxels = nullptr;
  std::int64_t count = 0;
  SimdAxes axes = {};
};

/// Numbers and pointers alone, in float and index space. SimdTracker builds it.
struct SimdMedium {
  /// Pointer to the first voxel, of one of the types of Voxels.
  using FirstVoxel =
      std::variant<const std::uint8_t*, const std::int16_t*, const std::uint16_t*, const float*>;
  /// Cells along one axis.
  struct Axis {
    float cellEdge;      ///< voxels
    float cellsPerVoxel; ///< 1 / cellEdge
    float insideCells;   ///< largest float below the number of cells
    float cellStride;    ///< offset of the next cell in SimdMajorants::codes
  };
  enum class ClipKind { none, plane, depthLinear, depthNearest };
  /// ContextStyle (model/medium/ContextStyle.h) in float.
  struct Context {
    SimdField focus;
    AffineRows toFocus = {}; ///< from the volume's index space to the focus's
    float level = 0.0F;      ///< voxel value on the focus's surface
    float extinction = 1.0F, saturation = 1.0F;
  };

  FirstVoxel voxels;
  SimdField field; ///< of `voxels`
  std::array<Axis, 3> axes;
  /// Domain: the box [lower, upper] in index space and, if cropped, [-1, 1]^3 in crop space.
  std::array<float, 3> lower, upper;
  std::optional<AffineRows> toCrop = {};

  SimdLines extinctions; ///< mm^-1 over the scalar: one function, or one per mixture component
  std::optional<SimdMixture> mixture = {};

  SimdMajorants cells;    ///< fewer than 2^23
  float firstCell = 0.0F; ///< index in SimdMajorants::codes of the first cell inside the border
  float lastCell = 0.0F;  ///< index of the last cell, which belongs to the border
  /// Distance, mm, by which a ray steps past a face before its position gives the next cell. It
  /// exceeds rounding errors, so that rays cannot get stuck; MajorantGrid::margin is twice as much.
  float overshoot = 0.0F;

  std::optional<Context> context = {};

  ClipKind clipKind = ClipKind::none;
  single::ClipTable clip = {};
  float cutSlope = 0.0F;               ///< length of the cut's gradient, mm^-1; 0: sharp edge
  std::array<float, 3> cutNormal = {}; ///< world, into the medium: of a plane; else view axis
  AffineRows fromView = {};            ///< directions: view space to world
  std::array<float, 4> toPlane = {};   ///< distance from the plane, mm; > 0: removed
  const float* depths = nullptr;       ///< mm, relative to the target
  std::size_t depthCount = 0;
  std::int32_t depthColumns = 0;
  const SilhouetteCells* silhouette = nullptr; ///< for an exact boundary; else null
};

} // namespace fenestra::core
