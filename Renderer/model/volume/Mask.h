#pragma once
// A mask of segments, such as the focus: their interpolated indicator on a grid of its own.

#include "model/volume/Grid.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace fenestra::core {

/// The indicator at a voxel center is 1 in a chosen segment, else 0; in a smoothed label map it is
/// between 0 and 1. It is trilinear between centers, and its 1/2 level is the surface. Readers crop
/// the mask to the segments' extent plus one voxel. Outside the grid the indicator is 0, and it
/// falls linearly to 0 within one voxel of the outermost centers. Where the label map ends at a
/// face of the volume, the extra voxel repeats the edge voxel; callers must stay in the volume.
struct Mask {
  Grid grid;
  std::vector<std::uint8_t> voxels; ///< 0 to `maxValue`, x fastest
  std::int64_t count = 0;           ///< number of voxels in the segments
  std::vector<std::string> names;   ///< names of the segments, for messages
  std::uint8_t maxValue = 1;        ///< voxel value of indicator 1; 255 in a smoothed mask
  double smoothing = 0.0;           ///< sigma of the Gaussian applied to it, mm; 0: none
  double volumeChange = 0.0;        ///< by smoothing, relative to the labels' volume

  /// Number of voxels whose centers are inside the surface.
  std::int64_t countInside() const {
    return std::ranges::count_if(
        voxels, [half = threshold()](std::uint8_t voxel) { return voxel >= half; });
  }

  /// True if the voxel is in the grid and inside the surface.
  bool contains(const Size3& voxel) const {
    return (voxel.array() >= 0).all() && (voxel.array() < grid.size.array()).all() &&
           voxels[linearIndex(voxel, grid.size)] >= threshold();
  }

  /// Smallest voxel value inside the surface: maxValue / 2, rounded up.
  std::uint8_t threshold() const { return static_cast<std::uint8_t>(maxValue - maxValue / 2); }
};

} // namespace fenestra::core
