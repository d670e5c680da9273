#pragma once
// Bounds of the projections of many equal boxes.

#include "model/camera/Camera.h"

namespace fenestra {

/// Boxes [i, i + 1], i three whole numbers, in a space that an affine map takes to the world.
class BoxProjection {
public:
  BoxProjection(const Camera& camera, const Affine& boxesToWorld);

  /// Every eye ray that meets the box crosses the plane through the target between `lower` and
  /// `upper` (mm), and is inside the box at `depths` (mm) only. Perspective: `lower` and `upper`
  /// are infinite if the box reaches behind the eye, and `depths` is empty if all of the box does.
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

} // namespace fenestra
