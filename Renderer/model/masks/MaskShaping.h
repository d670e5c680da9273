#pragma once
// Margins, interpolation between slices, and smoothing of focus masks. Masks are smoothed by
// shape-based interpolation first, then by a Gaussian: label maps are binary samples, and the
// Gaussian alone would leave a staircase wherever a surface shifts by more than about two sigmas
// per slice. Stripes that remain in an image come from the volume, which is trilinear between
// slices, where a voxel contains two tissues. They vanish under a constant transfer function.

#include "model/volume/Mask.h"

#include <optional>
#include <vector>

namespace fenestra::core {

struct MaskShaping {
  /// Margin per chosen segment, in their order, or a single one for their union, mm; > 0 grows, < 0
  /// shrinks; empty: none.
  std::vector<double> margins = {};
  /// Sigma of a Gaussian, mm, applied after thick slices are interpolated (interpolateSlices). 0:
  /// neither is done; nullopt: smoothMaskAuto().
  std::optional<double> smoothing = 0.0;

  bool operator==(const MaskShaping&) const = default;
};

/// Grows the mask to all voxels whose centers are within `margin` mm of its voxels; margin < 0
/// shrinks it to those more than -margin from every voxel outside. Extends at most one voxel beyond
/// the volume. Throws Error (output) for more than 2^31 voxels.
Mask applyMargin(Mask mask, double margin, const Grid& volume);

/// True if the voxel centers of `a` are also those of `b`, continued in all directions.
bool isSameLattice(const Grid& a, const Grid& b);

/// Voxel of `other` where a mask on the same lattice begins.
Size3 findOffset(const Mask& mask, const Mask& other);

/// True if the masks are on the same lattice and have a voxel, or a face of voxels, in common.
bool areAdjacent(const Mask& a, const Mask& b);

/// Union of one or more masks on the same label map's lattice.
Mask uniteMasks(std::vector<Mask> masks);

/// Resamples a mask to nearly cubic voxels: divides slices at least twice as thick as their pixels
/// are wide. The original slices remain. Between two of them a voxel is inside if the linearly
/// interpolated signed distance to their outlines is < 0 (Raya and Udupa 1990: shape-based
/// interpolation). A surface oblique to the slices would otherwise form stairs, each as wide as the
/// outline's shift per slice; only a Gaussian of that width would smooth them.
Mask interpolateSlices(Mask mask);

/// Convolves the indicator with a Gaussian, `sigma` in mm; maxValue becomes 255. Structures thinner
/// than about sigma disappear.
Mask smoothMask(const Mask& mask, double sigma, const Grid& volume);
/// Removes the stairs of labels that were made on voxels `native` mm wide: a Gaussian of 1.25 *
/// native at equal volume (EqualVolume.h). Parts and gaps narrower than about four native voxels
/// get 0.4 of that sigma. Structures that even this would erase, such as vessels one voxel wide,
/// remain. Masks with extremely anisotropic voxels stay unchanged.
Mask smoothMaskAuto(const Mask& mask, double native, const Grid& volume);

} // namespace fenestra::core
