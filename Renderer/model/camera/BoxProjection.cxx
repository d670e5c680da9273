#include "model/camera/BoxProjection.h"

namespace fenestra::core {

BoxProjection::BoxProjection(const Camera& camera, const Affine& boxesToWorld)
    : m_perspective(camera.pose().projection == Projection::perspective),
      m_targetDepth(camera.targetDepth()) {
  const Mat3 toView = Mat3::FromRows(camera.right(), camera.up(), camera.forward());
  m_boxesToView.translation() = camera.toView(boxesToWorld.translation());
  m_boxesToView.linear() = toView * boxesToWorld.linear();
  // Half a box, enlarged by far more than rounding errors.
  m_half = 0.5001 * m_boxesToView.linear().cwiseAbs().rowSums() +
           Vec3::Constant(1e-12 * m_boxesToView.translation().norm());
}

BoxProjection::Bounds BoxProjection::project(const Size3& box) const {
  const Vec3 center = m_boxesToView * (box.cast<double>().array() + 0.5).matrix();
  Bounds bounds{{center.z() - m_half.z(), center.z() + m_half.z()},
                center.head<2>() - m_half.head<2>(),
                center.head<2>() + m_half.head<2>()};
  if (!m_perspective)
    return bounds;
  if (bounds.depths.end < 0.0) // behind the camera: empty
    return {{infinity, -infinity}, Vec2::Constant(infinity), Vec2::Constant(-infinity)};
  if (!(bounds.depths.begin > 0.0)) // partly behind it: unbounded
    return {bounds.depths, Vec2::Constant(-infinity), Vec2::Constant(infinity)};
  const double beginScale = m_targetDepth / bounds.depths.begin;
  const double endScale = m_targetDepth / bounds.depths.end;
  bounds.lower = (bounds.lower * beginScale).cwiseMin(bounds.lower * endScale);
  bounds.upper = (bounds.upper * beginScale).cwiseMax(bounds.upper * endScale);
  return bounds;
}

} // namespace fenestra::core
