#pragma once
// First intersection of a ray with a labelmap's segment, by short steps and bisection on the
// interpolated indicator. Shares no code with the renderer's search (clip/focus/FocusCells.h).

#include "base/Vector.h"

#include <cstdint>
#include <vector>

namespace fenestra::accuracy {

/// Indicator of the focus on the volume's own grid, x fastest: 1 in the focus, 0 outside; for
/// smoothed labels the share of the focus, out of 255.
struct Indicator {
  Size3 size;
  Affine indexToWorld; ///< to RAS mm; integer indices are voxel centres
  std::vector<std::uint8_t> voxels;
  double full = 1.0; ///< value of a voxel entirely in the focus
};

class FocusField {
public:
  explicit FocusField(const Indicator& indicator);

  /// Least distance, mm, at which a ray of unit direction is in the focus (trilinear indicator >=
  /// 0.5) and in the volume's box; infinity: ray misses.
  double firstHit(const Vec3& origin, const Vec3& direction) const;

  /// Centre of the focus's voxels, world mm.
  Vec3 center() const { return m_center; }
  double radius() const { return m_radius; }           ///< mm, bounding sphere around the centre
  double longestEdge() const { return m_longestEdge; } ///< longest edge of a voxel, mm

private:
  /// Trilinear indicator, 0 to 1; constant beyond the outermost voxel centres.
  double at(const Vec3& index) const;
  bool isInside(const Vec3& index) const { return at(index) >= 0.5; }
  std::size_t cell(const Vec3& index) const;
  void computeEmptyRadii();

  /// Cell c lies between the voxel centres c - 1 and c of the stored part: the focus and two voxels
  /// on every side, fewer at the volume's faces.
  Size3 m_size, m_cells;
  Vec3 m_lower, m_upper;           ///< box of the part, in its own index space
  Affine m_worldToIndex;           ///< index space of the part
  std::vector<double> m_fractions; ///< of the focus in each voxel, 0 to 1
  /// Radius, in cells, of each cell's neighbourhood in which no share reaches 1/2: nor does the
  /// field.
  std::vector<std::uint8_t> m_emptyRadius;
  Vec3 m_center;
  double m_radius = 0.0, m_longestEdge = 0.0;
};

} // namespace fenestra::accuracy
