#pragma once
// Where the medium is: the box that a volume's voxels fill, or what a cropping box leaves of it.

#include "model/volume/Grid.h"

#include <optional>
#include <vector>

namespace fenestra {

/// A parallelepiped anywhere in the world; what is outside it is empty.
struct CropBox {
  Affine boxToWorld; ///< maps [-1, 1]^3 onto it, RAS mm
  Affine worldToBox;

  /// The map has to be invertible; a mirrored one is ordinary.
  explicit CropBox(const Affine& boxToWorldIn)
      : boxToWorld(boxToWorldIn), worldToBox(boxToWorldIn.inverse()) {}
};

class Domain {
public:
  /// Not explicit: an uncropped volume's domain is its grid.
  Domain(const Grid& grid, const std::optional<CropBox>& crop = {});

  const Grid& grid() const { return m_grid; }
  /// Of the grid, in index space.
  const Box& box() const { return m_box; }
  /// From index space to the one where the cropping box is [-1, 1]^3; none where nothing is
  /// cropped.
  const Affine* toCrop() const { return m_crop ? &m_crop->fromIndex : nullptr; }

  /// The part of `range` in which a ray, in index space, is inside. One interval, as both boxes
  /// are convex; a ray that lies exactly in a face counts as inside.
  Interval clip(const Ray& indexRay, const Interval& range = {}) const {
    const Interval inside = m_box.clip(indexRay, range);
    return m_crop ? m_crop->box.clip(transformed(m_crop->fromIndex, indexRay), inside) : inside;
  }

  /// Whether a point in index space lies inside, not in a face.
  bool contains(const Vec3& indexPoint) const {
    const auto isIn = [](const Box& box, const Vec3& p) {
      return (p.array() > box.lower.array()).all() && (p.array() < box.upper.array()).all();
    };
    return isIn(m_box, indexPoint) &&
           (!m_crop || isIn(m_crop->box, m_crop->fromIndex * indexPoint));
  }

  /// Points in index space whose convex hull is the domain (to rounding), some of them more than
  /// once. None where the boxes do not meet.
  std::vector<Vec3> indexCorners() const;

private:
  struct Crop {
    Affine fromIndex, toIndex; ///< between index space and the one where it is `box`
    Box box{-Vec3::Ones(), Vec3::Ones()};
  };

  Grid m_grid;
  Box m_box;
  std::optional<Crop> m_crop;
};

} // namespace fenestra
