#pragma once
// Margins, interpolation between slices, and smoothing of a focus's labels.

#include "model/volume/Mask.h"

#include <optional>
#include <vector>

namespace fenestra {

struct MaskShaping {
  /// Margin of each chosen segment in their order, or one of their union, mm; > 0 grows, < 0
  /// shrinks; empty: none.
  std::vector<double> margins = {};
  /// Standard deviation of a Gaussian, mm, applied after thick slices are interpolated
  /// (interpolateSlices); 0: neither is done; nothing: smoothMaskAuto().
  std::optional<double> smoothing = 0.0;

  bool operator==(const MaskShaping&) const = default;
};

/// Mask of the voxels whose centres are at most `margin` mm from a voxel of `mask`; margin < 0:
/// more than -margin from every voxel that is not in `mask`. Reaches at most one voxel beyond the
/// volume. Throws Error (output) for more than 2^31 voxels.
Mask applyMargin(Mask mask, double margin, const Grid& volume);

/// Union of at least one mask, all on voxels of one labelmap.
Mask uniteMasks(std::vector<Mask> masks);

/// Mask on voxels that are nearly cubes: divides slices that are at least twice as thick as their
/// pixels are wide. The mask's own slices stay; between two of them a voxel is inside if the signed
/// distance to their outlines, interpolated linearly, is < 0 (Raya and Udupa 1990: shape based
/// interpolation). Labels of a surface that is oblique to the slices form a stair: each tread is as
/// wide as the outline's shift from slice to slice, and only a Gaussian of that width smooths it.
Mask interpolateSlices(Mask mask);

/// Deviation, mm, that takes the stairs off a label map and leaves the shapes: 0.6 of the longest
/// edge of its voxels, after interpolateSlices. `labels`: before it or after, which makes no
/// difference.
double chooseSmoothing(const Grid& labels);

/// Indicator convolved with a Gaussian, `deviation` in mm; `full` is 255. Parts thinner than about
/// the deviation vanish.
Mask smoothMask(const Mask& mask, double sigma, const Grid& volume);
/// Indicator convolved by chooseSmoothing(); but parts that it would erase, such as vessels a
/// voxel wide, stay as they are labelled; and all of a mask does whose voxels are more than ten
/// times as long as they are wide.
Mask smoothMaskAuto(const Mask& mask, const Grid& volume);

} // namespace fenestra
