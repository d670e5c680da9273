#pragma once
// Fills closed contours that lie in parallel planes, as structure sets (DICOM RTSTRUCT) have them.

#include "model/masks/Voxelize.h"

#include <optional>
#include <vector>

namespace fenestra::core {

/// Closed polygons in the plane z of a grid's index space. Inside is what an odd number of polygons
/// encloses: holes may be polygons of their own, or joined to the outline (keyhole).
struct ContourPlane {
  double z = 0.0;
  std::vector<std::vector<Vec2>> polygons = {};
};

/// How far contours reach along z, in index space.
struct ContourReach {
  double widestGap = 1.0; ///< wider gaps between planes separate parts of a structure
  double halfSlab = 0.5;  ///< beside such a gap, a contour holds for [z - halfSlab, z + halfSlab)
};

/// Voxels of a grid of `size` whose centers (at integers) are inside, sorted by row. `planes` are
/// sorted by z, each of another z. Between two planes, at the fraction f of their distance, the
/// signed distances a and b to their outlines are interpolated: (1 - f) a + f b < 0 is inside (Raya
/// and Udupa 1990, "Shape-based interpolation of multidimensional objects"). `spacing`: mm between
/// columns and rows. nullopt: the contours are too complex.
std::optional<std::vector<VoxelRun>> fillContours(const std::vector<ContourPlane>& planes,
                                                  const Size3& size, const Vec2& spacing,
                                                  const ContourReach& reach);

} // namespace fenestra::core
