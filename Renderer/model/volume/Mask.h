#pragma once
// The focus: the interpolated indicator of some segments, in a grid of its own.

#include "model/volume/Grid.h"

#include <cstdint>
#include <string>
#include <vector>

namespace fenestra {

/// 1 where a voxel belongs to a chosen segment, else 0, or something between where the labelmap was
/// smoothed; trilinear between voxel centres; its surface is the 0.5 level. Readers crop it to the
/// segments' extent plus a margin of one voxel: outside its grid the indicator is 0, reached
/// linearly within one voxel of the outermost centres. Where the file's labelmap ends at the
/// volume's own face, the reader's margin voxel repeats the edge voxel instead, and whoever meets
/// the mask stays inside the volume's box there.
struct Mask {
  Grid grid;
  std::vector<std::uint8_t> voxels; ///< 0 to `full`, x fastest
  std::int64_t count = 0;           ///< voxels of the segments
  std::vector<std::string> names;   ///< of the segments, for messages
  std::uint8_t full = 1;            ///< what is 1: 255 in a smoothed mask

  /// The least voxel that is in the focus.
  std::uint8_t half() const { return static_cast<std::uint8_t>(full - full / 2); }
};

/// Whether any indicator between voxel centres around a box in the mask's index space can reach
/// 0.5. Beyond the mask its outermost voxels go on.
bool meetsMask(const Mask& mask, const Box& box);

} // namespace fenestra
