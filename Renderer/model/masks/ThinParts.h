#pragma once
// Thin parts and narrow gaps of a mask, found by morphology on bits.

#include "model/volume/Mask.h"

namespace fenestra::core {

/// Voxels of a region, x fastest.
struct ThinParts {
  std::vector<std::uint8_t> places; ///< 1 in and near thin parts and narrow gaps; empty: none
  std::vector<std::size_t> inside;  ///< linear indices of the voxels in thin parts, ascending
};

/// Finds parts of a mask, and gaps in it, into which a ball of `radius` mm does not fit: voxels
/// that are more than 2 * radius from the center of any such ball. Corners and steps are nearer to
/// one. Near is within 2 * radius. `first`, `size`: region of the mask's index space; outside the
/// mask's grid the nearest voxel repeats.
ThinParts findThinParts(const Mask& mask, const Size3& first, const Size3& size, double radius);

} // namespace fenestra::core
