#pragma once
// The domain of the medium: the volume's box, or its intersection with an oriented cropping box. A
// crop belongs to the domain, not to the clip: both boxes are convex, so that each ray has one
// interval in the domain and needs no test per point.

#include "model/volume/Grid.h"

#include <optional>
#include <vector>

namespace fenestra::core {

/// A parallelepiped in world space; the medium is empty outside of it.
struct CropBox {
  Affine boxToWorld; ///< maps [-1, 1]^3 onto the parallelepiped, RAS mm
  Affine worldToBox;

  /// `boxToWorldIn` must be invertible; reflections are allowed.
  explicit CropBox(const Affine& boxToWorldIn)
      : boxToWorld(boxToWorldIn), worldToBox(boxToWorldIn.inverse()) {}
};

class Domain {
public:
  /// Implicit conversion: the domain of an uncropped volume is its grid.
  Domain(const Grid& grid, const std::optional<CropBox>& crop = {});

  const Grid& grid() const { return m_grid; }
  /// The grid's box, in index space.
  const Box& box() const { return m_box; }
  /// Map from index space to crop space, where the cropping box is [-1, 1]^3; null without a crop.
  const Affine* toCrop() const { return m_crop ? &m_crop->fromIndex : nullptr; }

  /// Interval of `range` in which a ray (index space) is inside the domain. A ray that lies exactly
  /// in a face counts as inside.
  Interval clip(const Ray& indexRay, const Interval& range = {}) const {
    const Interval inside = m_box.clip(indexRay, range);
    return m_crop ? m_crop->box.clip(transformRay(m_crop->fromIndex, indexRay), inside) : inside;
  }

  /// True if a point (index space) is strictly inside the domain, not on a face.
  bool contains(const Vec3& indexPoint) const {
    const auto isInside = [](const Box& box, const Vec3& p) {
      return (p.array() > box.lower.array()).all() && (p.array() < box.upper.array()).all();
    };
    return isInside(m_box, indexPoint) &&
           (!m_crop || isInside(m_crop->box, m_crop->fromIndex * indexPoint));
  }

  /// Intersection of the domain with `box` (index space); may be empty.
  Domain intersect(const Box& box) const;

  /// Points in index space whose convex hull is the domain (up to rounding), with duplicates. Empty
  /// if the boxes do not intersect, or if the domain is an empty intersection.
  std::vector<Vec3> indexCorners() const;

private:
  struct Crop {
    Affine fromIndex, toIndex; ///< between index space and crop space
    Box box{-Vec3::Ones(), Vec3::Ones()};
  };

  Grid m_grid;
  Box m_box;
  std::optional<Crop> m_crop;
};

} // namespace fenestra::core
