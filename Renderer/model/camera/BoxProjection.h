#pragma once
// Projected bounds of many boxes of equal size.

#include "model/camera/Camera.h"

namespace fenestra::core {

/// Boxes [i, i + 1] for integer triples i, in a space with an affine map to world space.
class BoxProjection {
public:
  BoxProjection(const Camera& camera, const Affine& boxesToWorld);

  /// Every camera ray that hits the box crosses the plane through the target between `lower` and
  /// `upper` (mm), and is inside the box only at `depths` (mm). In perspective, `lower` and `upper`
  /// are infinite if part of the box is behind the camera; `depths` is empty if all of it is.
  struct Bounds {
    Interval depths;
    Vec2 lower, upper;
  };
  Bounds project(const Size3& box) const;

private:
  bool m_perspective;
  double m_targetDepth;
  Affine m_boxesToView;
  Vec3 m_half; ///< half extent of any box in view space, mm
};

} // namespace fenestra::core
