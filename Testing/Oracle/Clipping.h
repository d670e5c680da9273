#pragma once
// Clip weight at a point, computed from a clip's description.

#include "Medium.h"
#include "View.h"

#include <optional>

namespace fenestra::core::oracle {

/// The interpolated indicator of a mask, which must outlive the object.
class FocusField {
public:
  explicit FocusField(const Mask& mask);

  /// Trilinear indicator at a world point; 0 outside the mask's voxels.
  double at(const Vec3& world) const;
  /// Interval of a world ray, t >= 0, outside which the indicator is 0; empty: the ray misses.
  Interval boxInterval(const Ray& ray) const;
  double shortestEdge() const { return m_mask.grid.spacing().minCoeff(); } ///< of a voxel, mm

private:
  const Mask& m_mask;
  Affine m_worldToIndex;
  Vec3 m_lower, m_upper; ///< box in index space outside which the indicator is 0
};

class Clipping {
public:
  /// Builds the complete buffer of a depth clip.
  Clipping(const ClipDescription& description, const View& view, const Medium& medium);

  /// Factor on the extinction, 0 to 1.
  double clipWeight(const Vec3& world) const;

  /// Gradient that a soft cut adds to the scalar's, in spans (Medium.h) per mm. From 0 to
  /// `softness` behind the cut, its length is 0.8 per mm and its direction the cut's normal
  /// into the medium. A depth clip's normal is that of the bilinear surface, by finite differences;
  /// where the surface has steps, it is the view axis.
  Vec3 cutGradient(const Vec3& world) const;

  /// Depth buffer of a depth clip, mm, row by row; -infinity: a cutaway removes nothing there.
  const std::vector<double>& depths() const { return m_depths; }

private:
  double depthClipWeight(double depth, const Vec2& at) const;
  /// Depth of sample (column, row), clamped to the last row and column.
  double sampleDepth(std::size_t column, std::size_t row) const;
  /// Depth of a surface without steps, by bilinear interpolation between samples.
  double linearSurface(const Vec2& at) const;
  double silhouetteSurface(const DepthClip::SilhouetteCell& cell, const Vec2& at,
                           double linearDepth) const;

  const ClipDescription& m_description;
  const View& m_view;
  const Medium& m_medium;
  std::optional<FocusField> m_focus; ///< of a depth clip
  std::vector<double> m_depths;
  std::vector<double> m_interpolated; ///< m_depths, but of exact surfaces beside the focus
};

} // namespace fenestra::core::oracle
