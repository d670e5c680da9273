#include "model/camera/Camera.h"

namespace fenestra::core {
namespace {

Vec3 computeRight(const Vec3& forward, const Vec3& up) {
  return forward.cross(up.stableNormalized());
}

} // namespace

CameraPose validatePose(const CameraPose& pose, const MakeError& makeError) {
  constexpr double maxCoordinate = 1e12; // mm
  const auto isInRange = [&](const Vec3& p) { return (p.array().abs() <= maxCoordinate).all(); };
  const Vec3 view = pose.target - pose.position;
  if (!isInRange(pose.position) || !isInRange(pose.target) || !(view.norm() > 0.0))
    throw makeError("position and target must be two different points within 1e12 mm");
  if (!(computeRight(view / view.norm(), pose.up).norm() > 1e-12))
    throw makeError("up must not be zero or parallel to the viewing direction");
  return pose;
}

CameraPose rotateAroundTarget(const CameraPose& pose, double degrees) {
  CameraPose rotated = pose;
  const Mat3 rotation = makeRotation(degrees * pi / 180.0, pose.up.stableNormalized()).linear();
  if (degrees != 0.0)
    rotated.position = pose.target + rotation * (pose.position - pose.target);
  return rotated;
}

Camera::Camera(const CameraPose& pose, int width, int height)
    : m_pose(validatePose(pose,
                          [](const std::string& what) {
                            return requestError(ErrorCode::invalidCamera, "camera", what);
                          })),
      m_width(width),
      m_height(height) {
  const Vec3 view = pose.target - pose.position;
  m_targetDepth = view.norm();
  m_forward = view / m_targetDepth;
  const Vec3 side = computeRight(m_forward, pose.up);
  m_right = side.normalized();
  m_up = m_right.cross(m_forward);
  const double halfHeight = pose.projection == Projection::orthographic
                                ? pose.scale
                                : m_targetDepth * std::tan(pose.angle * pi / 360.0);
  m_pixelPitch = 2.0 * halfHeight / height;
}

} // namespace fenestra::core
