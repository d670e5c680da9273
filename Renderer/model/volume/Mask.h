#pragma once
// The focus: the interpolated indicator of some segments, in a grid of its own.

#include "model/volume/Grid.h"

#include <cstdint>
#include <string>
#include <vector>

namespace fenestra {

/// Indicator at a voxel centre: 1 in a chosen segment, else 0, between 0 and 1 in a smoothed
/// labelmap; trilinear between centres; the surface is the 1/2 level. Readers crop the mask to the
/// segments' extent plus a margin of one voxel: outside the grid the indicator is 0, reached
/// linearly within one voxel of the outermost centres. Where the file's labelmap ends at the
/// volume's own face, the reader's margin voxel repeats the edge voxel instead, and users of the
/// mask stay inside the volume's box there.
struct Mask {
  Grid grid;
  std::vector<std::uint8_t> voxels; ///< 0 to `full`, x fastest
  std::int64_t count = 0;           ///< number of voxels in the segments
  std::vector<std::string> names;   ///< names of the segments, for messages
  std::uint8_t maxValue = 1;        ///< voxel of indicator 1; 255 in a smoothed mask
  double smoothing = 0.0;           ///< deviation of the Gaussian that made it, mm; 0: none

  /// Least voxel in the focus: full / 2, rounded up.
  std::uint8_t threshold() const { return static_cast<std::uint8_t>(maxValue - maxValue / 2); }
};

} // namespace fenestra
