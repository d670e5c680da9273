#pragma once
// The focus: the interpolated indicator of some segments, in a grid of its own.

#include "volume/Grid.h"

#include <cstdint>
#include <string>
#include <vector>

namespace fenestra {

/// 1 where a voxel belongs to a chosen segment, else 0; trilinear between voxel centres; its
/// surface is the 0.5 level. Readers crop it to the segments' extent plus a margin of one voxel:
/// outside its grid the indicator is 0, reached linearly within one voxel of the outermost centres.
/// Where the file's labelmap ends at the volume's own face, the reader's margin voxel repeats the
/// edge voxel instead, and whoever meets the mask stays inside the volume's box there.
struct Mask {
  Grid grid;
  std::vector<std::uint8_t> voxels; ///< 0 or 1, x fastest
  std::int64_t count = 0;           ///< voxels of the segments
  std::vector<std::string> names;   ///< of the segments, for messages
};

} // namespace fenestra
