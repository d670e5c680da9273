#pragma once
// Volumes of labels and of the trilinear surfaces of their smoothed masks, in `volume` only.

#include "model/volume/Mask.h"

namespace fenestra::core {

/// Volume in the smoothed mask's surface divided by the labels' volume, minus 1. `labels` may be
/// interpolated; then its volumeChange is included.
double measureVolumeChange(const Mask& labels, const Mask& smooth, const Grid& volume);

/// Maps the voxel values of a smoothed mask (maxValue 255) so that its surface encloses the labels'
/// volume, with 0 and 255 unchanged.
void equalizeVolume(const Mask& labels, const Grid& volume, Mask& smooth);

} // namespace fenestra::core
