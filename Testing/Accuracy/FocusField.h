#pragma once
// First intersection of a ray with a segment of a label map, by short steps and bisection on the
// interpolated indicator. Independent of the renderer's search (clip/focus/FocusCells.h).

#include "base/Vector.h"

#include <cstdint>
#include <vector>

namespace fenestra::core::accuracy {

/// Indicator of the focus on the volume's grid, x fastest: 1 in the focus, 0 outside. With smoothed
/// labels, it is the weight of the focus, 0 to 255.
struct Indicator {
  Size3 size;
  Affine indexToWorld; ///< to RAS mm; integer indices are voxel centers
  std::vector<std::uint8_t> voxels;
  double full = 1.0; ///< value of a voxel entirely in the focus
};

class FocusField {
public:
  explicit FocusField(const Indicator& indicator);

  /// Smallest distance, mm, at which a ray of unit direction is in the focus (trilinear indicator
  /// >= 0.5) and in the volume's box; infinity: the ray misses.
  double findFirstHit(const Vec3& origin, const Vec3& direction) const;

  /// Center of the focus voxels' bounding box, world mm.
  Vec3 center() const { return m_center; }
  double radius() const { return m_radius; }           ///< mm, bounding sphere around the center
  double longestEdge() const { return m_longestEdge; } ///< longest edge of a voxel, mm

private:
  /// Trilinear indicator, 0 to 1; constant beyond the outermost voxel centers.
  double at(const Vec3& index) const;
  bool isInside(const Vec3& index) const { return at(index) >= 0.5; }
  std::size_t cell(const Vec3& index) const;
  void computeEmptyRadii();

  /// Cell c lies between the voxel centers c - 1 and c of the stored part, which is the focus with
  /// a margin of two voxels, less at the faces of the volume.
  Size3 m_size, m_cells;
  Vec3 m_lower, m_upper;           ///< box of the part, in its own index space
  Affine m_worldToIndex;           ///< index space of the part
  std::vector<double> m_fractions; ///< weight of the focus in each voxel, 0 to 1
  /// Radius, in cells, of each cell's neighborhood in which all weights are below 1/2. The
  /// interpolated indicator is below 1/2 there, too.
  std::vector<std::uint8_t> m_emptyRadius;
  Vec3 m_center;
  double m_radius = 0.0, m_longestEdge = 0.0;
};

} // namespace fenestra::core::accuracy
