#pragma once
// Outer layer of a body: the air around it and the first millimeters below its surface, found from
// the scalars alone. It replaces a skin segment if the segmentation has none.

#include "model/volume/Mask.h"
#include "model/volume/Volume.h"

namespace fenestra::core {

/// Indicator, 255 for 1, of the air around the body and of its tissue less than `depth` mm below
/// the surface, with an edge about a millimeter wide. Air: scalars below `airBelow` connected with
/// a side of the volume. The two ends along the patient's long axis (S) do not count, since lungs
/// and bowel may be cut open there. The mask has voxels of its own, about 2 mm wide, to be small
/// compared to the volume. If there is no air, or only air, count is 0 and no voxel is stored.
Mask findOuterLayer(const Volume& volume, double airBelow, double depth);

/// Resamples the mask on the lattice of `labels`, in a grid that covers `volume`. A grid of more
/// than 2^24 voxels and of more than eight per voxel of the volume is replaced by a single 0.
Mask resampleMask(const Mask& layer, const Grid& labels, const Grid& volume);

} // namespace fenestra::core
