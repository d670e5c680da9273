#pragma once
// Labels between slices that lie far apart.

#include "model/volume/Mask.h"

namespace fenestra {

/// The mask on voxels that are nearly cubes: slices that are at least twice as thick as their
/// pixels are wide are divided. The mask's own slices stay; what lies between two of them is inside
/// where the distances to the outlines in the two, interpolated linearly, are (Raya and Udupa 1990:
/// shape based interpolation). The labels of a surface that leans across slices are a stair with
/// treads as wide as the slices are shifted, which only a Gaussian as wide as that would smooth.
Mask betweenSlices(const Mask& mask);

} // namespace fenestra
