#pragma once
// Mask of a focus from labels.

#include "files/segments/SegmentationReader.h"

namespace fenestra {

/// Inclusive range of voxels; empty until one is added.
struct VoxelExtent {
  Size3 lower = Size3::Constant(std::numeric_limits<std::int64_t>::max());
  Size3 upper = Size3::Constant(-1);

  bool empty() const { return upper.x() < 0; }
  void add(const VoxelExtent& more) {
    lower = lower.cwiseMin(more.lower);
    upper = upper.cwiseMax(more.upper);
  }
};

/// Sets grid, voxels and their count of `mask` to the `chosen` segments of a labelmap, cropped to
/// them and continued over the faces that the labelmap shares with `volume`, as Segmentation::mask
/// says. Leaves `mask` unchanged where the segments have no voxel.
void fillMask(const Grid& labelmap, std::size_t layerCount, const Segmentation::Labels& labels,
              const std::vector<SegmentInfo>& chosen, const Grid& volume, Mask& mask);

} // namespace fenestra
