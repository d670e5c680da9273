#pragma once
// Interpolation of labels between slices that lie far apart.

#include "model/volume/Mask.h"

namespace fenestra {

/// Mask on voxels that are nearly cubes: divides slices that are at least twice as thick as their
/// pixels are wide. The mask's own slices stay; between two of them a voxel is inside if the signed
/// distance to their outlines, interpolated linearly, is < 0 (Raya and Udupa 1990: shape based
/// interpolation). The labels of a surface that leans across slices are a stair with treads as wide
/// as the slices are shifted, which only a Gaussian of that width would smooth.
Mask betweenSlices(const Mask& mask);

} // namespace fenestra
