#pragma once
// The region of the medium: the volume's box, or its intersection with a cropping box.

#include "model/volume/Grid.h"

#include <optional>
#include <vector>

namespace fenestra {

/// A parallelepiped anywhere in the world; the medium is empty outside.
struct CropBox {
  Affine boxToWorld; ///< maps [-1, 1]^3 onto the parallelepiped, RAS mm
  Affine worldToBox;

  /// `boxToWorldIn` must be invertible; mirroring is allowed.
  explicit CropBox(const Affine& boxToWorldIn)
      : boxToWorld(boxToWorldIn), worldToBox(boxToWorldIn.inverse()) {}
};

class Domain {
public:
  /// Not explicit: an uncropped volume's domain is its grid.
  Domain(const Grid& grid, const std::optional<CropBox>& crop = {});

  const Grid& grid() const { return m_grid; }
  /// Box of the grid, in index space.
  const Box& box() const { return m_box; }
  /// Map from index space to crop space, where the cropping box is [-1, 1]^3; null without a crop.
  const Affine* toCrop() const { return m_crop ? &m_crop->fromIndex : nullptr; }

  /// Part of `range` in which a ray (index space) is inside the domain: one interval, as both boxes
  /// are convex. A ray that lies exactly in a face counts as inside.
  Interval clip(const Ray& indexRay, const Interval& range = {}) const {
    const Interval inside = m_box.clip(indexRay, range);
    return m_crop ? m_crop->box.clip(transformRay(m_crop->fromIndex, indexRay), inside) : inside;
  }

  /// True if a point (index space) lies strictly inside the domain, not in a face.
  bool contains(const Vec3& indexPoint) const {
    const auto isInside = [](const Box& box, const Vec3& p) {
      return (p.array() > box.lower.array()).all() && (p.array() < box.upper.array()).all();
    };
    return isInside(m_box, indexPoint) &&
           (!m_crop || isInside(m_crop->box, m_crop->fromIndex * indexPoint));
  }

  /// Part of the domain inside `box` (index space); may be empty.
  Domain intersect(const Box& box) const;

  /// Points in index space whose convex hull is the domain (to rounding), with duplicates; empty if
  /// the boxes do not meet, or for an empty part.
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

} // namespace fenestra
