#pragma once
// What is done to the labels of a focus before it is shown: margins, and no stairs.

#include "model/volume/Mask.h"

#include <vector>

namespace fenestra {

struct MaskShaping {
  /// mm by which each chosen segment grows (or shrinks, negative), in their order; or one for all
  /// of them as a whole; or none.
  std::vector<double> margins = {};
  /// mm, standard deviation of a Gaussian, before which thick slices are interpolated
  /// (betweenSlices); 0 leaves the labels' own steps.
  double smoothing = 0.0;

  bool operator==(const MaskShaping&) const = default;
};

/// The mask of all voxels whose centre is at most `margin` mm away from a voxel of `mask`; or for a
/// negative margin, more than that away from all others. It reaches one voxel beyond the volume at
/// most. Throws Error (resources) for more than 2^31 voxels.
Mask grown(const Mask& mask, double margin, const Grid& volume);

/// The union of masks on voxels of one labelmap; at least one.
Mask united(const std::vector<Mask>& masks);

/// The indicator convolved with a Gaussian: `full` is 255, and what is thinner than about the
/// deviation goes.
Mask smoothed(const Mask& mask, double deviation, const Grid& volume);

} // namespace fenestra
