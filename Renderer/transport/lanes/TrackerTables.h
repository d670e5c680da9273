#pragma once
// Tables of a volume and its clip that lanes read.

#include "base/Narrow.h"
#include "transport/lanes/MajorantGrid.h"
#include "transport/lanes/Medium.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace fenestra {

class Seams;

/// Voxels that lanes interpolate between.
struct WideField {
  struct Axis {
    float last;            ///< index of the last voxel
    std::int32_t lastCell; ///< of the last pair of voxels that interpolation may begin with
    std::int32_t stride;   ///< voxels to the next in this axis, 0 where there is none
  };
  const void* voxels = nullptr;
  std::int64_t count = 0;
  std::array<Axis, 3> axes = {};
};

/// Plain numbers and pointers, in float and index space. Built by WideTracker.
struct WideScene {
  /// Order: that of Voxels' alternatives.
  enum class VoxelType { uint8, int16, uint16, float32 };
  /// Cells along one axis.
  struct Axis {
    float cellEdge;      ///< voxels
    float cellsPerVoxel; ///< 1 / cellEdge
    float cells;         ///< how many, without the border
    float insideCells;   ///< the greatest number below that
    float cellStride;    ///< of the cells, in their bordered array
  };
  /// The clipping depth's samples along one axis (clip/focus/DepthBuffer.h).
  struct DepthAxis {
    float perPitch, start, lastInside, before, perFactor, last;
  };
  enum class ClipKind { none, plane, depthLinear, depthNearest };
  /// model/medium/ContextStyle.h.
  struct Context {
    WideField focus;
    AffineRows toFocus = {}; ///< index space to the focus's
    float level = 0.0F;      ///< of its voxels, at its surface
    float extinction = 1.0F, saturation = 1.0F;
  };

  VoxelType type;
  WideField field;
  std::array<Axis, 3> axes;
  /// Bounds that rays cannot leave: the box in index space and, where there is a crop, [-1, 1]^3 of
  /// the crop's own space.
  std::array<float, 3> lower, upper;
  bool cropped = false;
  AffineRows toCrop = {};

  WideTable extinction; ///< mm^-1 over the scalar

  WideCells cells;        ///< fewer than 2^24
  float firstCell = 0.0F; ///< its place there, beyond the border

  std::optional<Context> context = {};

  ClipKind clipKind = ClipKind::none;
  float ghost = 0.0F;       ///< ClipEdge
  float softness = 0.0F;    ///< mm
  float perSoftness = 0.0F; ///< 1 / mm; 0 where the edge is sharp
  bool perspective = false;
  /// Rows of the map from index space to view space, depth counted from the target.
  AffineRows toView = {};
  std::array<float, 4> toPlane = {}; ///< distance from a plane, positive where it removes
  float targetDepth = 0.0F;
  DepthAxis depthX = {}, depthY = {};
  const float* depths = nullptr; ///< counted from the target
  std::int32_t depthColumns = 0;
  const Seams* seams = nullptr; ///< of an exact boundary; null elsewhere
};

} // namespace fenestra
