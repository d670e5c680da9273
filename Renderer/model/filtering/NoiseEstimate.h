#pragma once
// Noise of a volume, from the volume alone.

#include "model/volume/Volume.h"

namespace fenestra::core {

/// Standard deviation of the noise in scalar units; for ultrasound, whose speckle is
/// multiplicative, that of log(1 + scalar - minimum). 0 if the volume has too few voxels of tissue.
/// From windows of 5x5x3 voxels, the 3 along the axis of greatest spacing, at up to 300,000 places:
/// - CT, windows whose mean is -150 to 150 HU: the mode of their standard deviations, or 1.5 times
///   the deviation of pseudo-residuals if that is less. (Gasser, Sroka, Jennen-Steinmetz 1986:
///   voxel minus mean of its four neighbors in the slice, times sqrt(4/5). 1.5 and 1.2 allow for
///   noise that is correlated between neighbors. The deviation is 1.4826 times the median of
///   absolute values.)
/// - MR, windows whose mean exceeds that of all windows: 1.2 times the deviation of
///   pseudo-residuals.
/// - ultrasound, the same windows: the mode of their standard deviations.
double estimateNoise(const Volume& volume, Modality modality);

/// Axis with the greatest distance between voxels; the last of equal ones.
int findSliceAxis(const Grid& grid);

} // namespace fenestra::core
