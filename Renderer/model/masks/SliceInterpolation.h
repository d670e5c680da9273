#pragma once
// Interpolation of labels between slices that lie far apart.

#include "model/volume/Mask.h"

namespace fenestra {

/// Mask on voxels that are nearly cubes: divides slices that are at least twice as thick as their
/// pixels are wide. The mask's own slices stay; between two of them a voxel is inside if the signed
/// distance to their outlines, interpolated linearly, is < 0 (Raya and Udupa 1990: shape based
/// interpolation). Labels of a surface that is oblique to the slices form a stair: each tread is as
/// wide as the outline's shift from slice to slice, and only a Gaussian of that width smooths it.
Mask betweenSlices(const Mask& mask);

} // namespace fenestra
