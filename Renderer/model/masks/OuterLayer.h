#pragma once
// Outer layer of a body in a volume: the air around it and the first millimetres under its surface,
// found from the scalars alone. Where a segmentation has no skin, this is where it lies.

#include "model/volume/Mask.h"
#include "model/volume/Volume.h"

namespace fenestra {

/// Indicator, 255: 1, of the air around the body and of what lies less than `depth` mm under its
/// surface, softened by about a millimetre. Air: scalars below `airBelow` that are connected with a
/// side of the volume. Its two ends along the patient's longest axis (S) are no sides, for lungs
/// and bowel are cut open there. On voxels of its own, about 2 mm wide, so that it is small beside
/// the volume; count is 0, and no voxel held, where no air or nothing else is found.
Mask findOuterLayer(const Volume& volume, double airBelow, double depth);

/// Mask on the lattice of `labels`, in a grid that covers `volume`; a single voxel of 0 where that
/// grid has more than 2^24 voxels and eight for each of the volume's.
Mask resampleMask(const Mask& layer, const Grid& labels, const Grid& volume);

} // namespace fenestra
