#pragma once
// Gaussian blur of a mask with a small kernel. It processes a few slices at a time to save memory,
// and skips empty rows. Time and memory grow with sigma.

#include "model/volume/Mask.h"

namespace fenestra::core {

/// Blurs a region of the mask's index space, from voxel `first` on; 255 is an indicator of 1.
/// `sigmas`: standard deviation along each axis, voxels. The Gaussian is sampled at voxels and
/// truncated at three sigmas. Outside the mask's grid the nearest voxel repeats.
std::vector<std::uint8_t> blurMask(const Mask& mask, const Size3& first, const Size3& size,
                                   const Vec3& sigmas);
/// `to`: the voxels of the region, all 0 before.
void blurMask(const Mask& mask, const Size3& first, const Size3& size, const Vec3& sigmas,
              std::uint8_t* to);

} // namespace fenestra::core
