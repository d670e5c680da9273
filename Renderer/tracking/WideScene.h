#pragma once
// What lanes read of a volume and its clip.

#include "core/Narrow.h"
#include "medium/WideTable.h"
#include "tracking/WideCells.h"

#include <cstdint>
#include <vector>

namespace fenestra {

/// What the lanes read: plain numbers and pointers, in float and index space. Built by WideTracker.
struct WideScene {
  /// In the order of Voxels' alternatives.
  enum class VoxelType { uint8, int16, uint16, float32 };
  /// Cells and voxels along one axis.
  struct Axis {
    float last;            ///< index of the last voxel
    std::int32_t lastCell; ///< of the last pair of voxels that interpolation may begin with
    std::int32_t stride;   ///< voxels to the next in this axis, 0 where there is none
    float cellEdge;        ///< voxels
    float cellsPerVoxel;   ///< 1 / cellEdge
    float cells;           ///< how many, without the border
    float insideCells;     ///< the greatest number below that
    float cellStride;      ///< of the cells, in their bordered array
  };
  /// The clipping depth's samples along one axis (clipping/DepthBuffer.h).
  struct DepthAxis {
    float perPitch, start, lastInside, before, perFactor, last;
  };
  enum class ClipKind { none, plane, depthLinear, depthNearest };

  VoxelType type;
  const void* voxels;
  std::int64_t voxelCount;
  std::array<Axis, 3> axes;
  /// What rays cannot leave: index space within the box, and where there is a crop within [-1, 1]^3
  /// of its own space, too.
  std::array<float, 3> lower, upper;
  bool cropped = false;
  AffineRows toCrop = {};

  WideTable extinction; ///< mm^-1 over the scalar

  WideCells cells;        ///< fewer than 2^24
  float firstCell = 0.0F; ///< its place there, beyond the border

  ClipKind clipKind = ClipKind::none;
  bool perspective = false;
  /// Rows of the map from index space to view space, depth counted from the target.
  AffineRows toView = {};
  std::array<float, 4> toPlane = {}; ///< distance from a plane, positive where it removes
  float targetDepth = 0.0F;
  DepthAxis depthX = {}, depthY = {};
  const float* depths = nullptr; ///< counted from the target
  std::int32_t depthColumns = 0;
};

} // namespace fenestra
