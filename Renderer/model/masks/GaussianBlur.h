#pragma once
// Narrow Gaussian of a mask, a few slices at a time: little memory, and rows without matter cost
// nothing. Time and memory grow with the deviation.

#include "model/volume/Mask.h"

namespace fenestra {

/// Indicator of a part of the mask's index space, 255: 1, convolved with a Gaussian of `deviations`
/// voxels along each axis, sampled at voxels and cut off at three deviations. Outside the mask's
/// grid the nearest voxel repeats. `first`: voxel of the mask where the part begins.
std::vector<std::uint8_t> blurMask(const Mask& mask, const Size3& first, const Size3& size,
                                   const Vec3& sigmas);

} // namespace fenestra
