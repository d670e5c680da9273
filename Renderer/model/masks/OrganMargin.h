#pragma once
// Margin of an organ in CT: removes voxels of its label that contain another tissue, by partial
// volume or because the label reaches into fat, lung or bone. It removes sheets along the surface,
// and preserves lesions: bodies of another tissue within the organ.

#include "model/volume/Mask.h"
#include "model/volume/Volume.h"

namespace fenestra::core {

/// Thinner voxels have margins, mm. Thick ones would leave steps as deep as what is removed.
inline constexpr double thickestVoxel = 3.0;

struct OrganMargin {
  /// False: the organ is too small, not of one tissue, or a bone; voxels are too thick; or more
  /// than a third would be removed. `kept` is then the segment.
  bool isApplied = false;
  Mask kept;                    ///< the segment without the removed voxels, on its grid
  double volume = 0.0;          ///< removed, mm^3
  double mean = 0.0, p95 = 0.0; ///< distance by which the segment's surface moved, mm
};

/// Compares the voxels of a binary mask within 6 mm of its surface with those deeper than 8 mm, and
/// removes, from the surface inward, what differs by more than 3.5 robust standard deviations (at
/// least 25 HU). Not removed, with a rim of 3 mm, are bodies: soft tissue or calcification that is
/// thicker than 2.5 mm plus a voxel and no larger than 20 mm, or thicker than 5 mm plus a voxel;
/// and any other tissue thicker than 8 mm plus a voxel. Those no larger than 20 mm may reach beyond
/// the mask if at least a third is inside (neighboring organs have a few percent inside). Applies
/// only if at least 500 voxels are deeper than 8 mm, and their median is above -30 HU with a robust
/// standard deviation of at most 60 HU, or below -500 HU (lung) with at most 120 HU. Bones are
/// excluded: more than a third of what would be removed is brighter than their inside. `volume`:
/// CT, with or without noise. Time and memory grow with the mask's grid.
OrganMargin findOrganMargin(const Mask& segment, const Volume& volume);

} // namespace fenestra::core
