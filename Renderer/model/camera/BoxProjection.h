#pragma once
// What eye rays see of many boxes that are alike: bounds of their projections.

#include "model/camera/Camera.h"

namespace fenestra {

/// Boxes [i, i + 1]^3 of some space, i whole numbers, that an affine map takes to the world.
class BoxProjection {
public:
  BoxProjection(const Camera& camera, const Affine& boxesToWorld);

  /// Every eye ray that meets the box passes the plane through the target between `lower` and
  /// `upper` (mm), and is in the box at these depths alone. All are infinite where a perspective
  /// box reaches behind the eye, and `depths` is empty where it lies there whole.
  struct Bounds {
    Interval depths;
    Vec2 lower, upper;
  };
  Bounds of(const Size3& box) const;

private:
  bool m_perspective;
  double m_targetDepth;
  Affine m_boxesToView;
  Vec3 m_half; ///< extent of any box in view space
};

} // namespace fenestra
