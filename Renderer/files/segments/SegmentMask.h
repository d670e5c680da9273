#pragma once
// From labels to the mask of a focus. For io's own sources.

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

/// The grid, the voxels and their count of the mask that `chosen` segments have in a labelmap,
/// cropped to them and continued over the faces that the labelmap shares with `volume`, as
/// Segmentation::mask says. Leaves the mask as it is where they have no voxel.
void fillMask(const Grid& labelmap, std::size_t layerCount, const Segmentation::Labels& labels,
              const std::vector<SegmentInfo>& chosen, const Grid& volume, Mask& mask);

} // namespace fenestra
