#pragma once
// Corrects CT volumes that store HU + 1024 without a rescale intercept, so that air is at 0.

#include "model/volume/Volume.h"

namespace fenestra::core {

/// Subtracts 1024 from a CT without rescaling under three conditions: the minimum is at least -200;
/// the mode of the voxels on the volume's sides is within 50 of 0 (air); the median of the voxels
/// above 200 is from 800 to 1300 (soft tissue). Warns when it does so, and also if air is at 0 but
/// the tissue does not match.
void correctHounsfieldOffset(Volume& volume);

} // namespace fenestra::core
