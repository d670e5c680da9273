#pragma once
// Where a ray first meets a labelmap's segment, found by looking: short steps and bisection on the
// interpolated indicator. Shares no code with the renderer's search (clip/focus/FocusCells.h).

#include "base/Vector.h"

#include <cstdint>
#include <vector>

namespace fenestra::accuracy {

/// 1 where a voxel belongs to the focus, x fastest, on the volume's own grid; of smoothed labels
/// what there is of the focus, of 255.
struct Indicator {
  Size3 size;
  Affine indexToWorld; ///< RAS mm; whole numbers are voxel centres
  std::vector<std::uint8_t> voxels;
  double full = 1.0; ///< what a voxel is that belongs to the focus entirely
};

class FocusField {
public:
  explicit FocusField(const Indicator& indicator);

  /// The least distance, mm, at which a ray of unit direction is in the focus (trilinear indicator
  /// at least 0.5) and in the box that the volume's voxels fill; infinite where it never is.
  double firstMeeting(const Vec3& origin, const Vec3& direction) const;

  /// Of the focus's voxels, world mm.
  Vec3 centre() const { return m_centre; }
  double radius() const { return m_radius; } ///< around the centre, of a sphere that holds them
  double longestEdge() const { return m_longestEdge; } ///< of a voxel, mm

private:
  /// Trilinear; beyond the outermost voxel centres as at these.
  double at(const Vec3& index) const;
  bool isIn(const Vec3& index) const { return at(index) >= 0.5; }
  std::size_t cell(const Vec3& index) const;
  void markEmptiness();

  /// Cell c lies between the voxel centres c - 1 and c of the part that is kept, which is as large
  /// as the focus and two voxels on every side, or less at the volume's faces.
  Size3 m_size, m_cells;
  Vec3 m_lower, m_upper; ///< of the part, index space of its own voxels
  Affine m_worldToIndex; ///< of the part
  std::vector<std::uint8_t> m_voxels;
  double m_full;                         ///< what is 1
  std::vector<std::uint8_t> m_emptiness; ///< of each cell: how many cells around it hold nothing
  Vec3 m_centre;
  double m_radius = 0.0, m_longestEdge = 0.0;
};

} // namespace fenestra::accuracy
