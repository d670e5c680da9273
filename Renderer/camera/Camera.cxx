#include "camera/Camera.h"

#include "core/Error.h"

namespace fenestra {

Camera::Camera(const CameraPose& pose, int width, int height)
    : m_pose(pose), m_width(width), m_height(height) {
  const Vec3 view = pose.target - pose.position;
  m_targetDepth = view.norm();
  if (!(m_targetDepth > 0.0) || !std::isfinite(m_targetDepth))
    throw usageError("--position and --target: must be two different finite points");
  m_forward = view / m_targetDepth;
  const Vec3 side = m_forward.cross(pose.up.stableNormalized());
  if (!(side.norm() > 1e-12))
    throw usageError("--up: must not be zero or along the viewing direction");
  m_right = side.normalized();
  m_up = m_right.cross(m_forward);
  const double halfHeight = pose.projection == Projection::orthographic
                                ? pose.scale
                                : m_targetDepth * std::tan(pose.angle * pi / 360.0);
  m_pixelPitch = 2.0 * halfHeight / height;
}

} // namespace fenestra
