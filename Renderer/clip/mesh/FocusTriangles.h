#pragma once
// The surface of a focus as triangles, for views that do not trace rays and for other programs.

#include "clip/mesh/SurfaceMesh.h"
#include "model/volume/Mask.h"

namespace fenestra::core {

/// Triangulates the 1/2 level of a mask: closed, counterclockwise as seen from outside, without
/// depths. Each cell between voxel centers that the level crosses has one point: the mean of its
/// crossings of the cell's edges (Gibson 1998, "Constrained elastic surface nets", without
/// relaxation), moved to the level. Points outside the box of `volume` are moved to its faces.
SurfaceMesh triangulate(const Mask& mask, const Grid& volume);

} // namespace fenestra::core
