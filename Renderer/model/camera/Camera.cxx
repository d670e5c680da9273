#include "model/camera/Camera.h"

namespace fenestra {
namespace {

Vec3 sideOf(const Vec3& forward, const Vec3& up) {
  return forward.cross(up.stableNormalized());
}

} // namespace

CameraPose checkedPose(const CameraPose& pose, const MakeError& makeError) {
  constexpr double farthest = 1e12; // mm
  const auto isPlace = [&](const Vec3& p) { return (p.array().abs() <= farthest).all(); };
  const Vec3 view = pose.target - pose.position;
  if (!isPlace(pose.position) || !isPlace(pose.target) || !(view.norm() > 0.0))
    throw makeError("position and target must be two different points within 1e12 mm");
  if (!(sideOf(view / view.norm(), pose.up).norm() > 1e-12))
    throw makeError("up must not be zero or along the viewing direction");
  return pose;
}

CameraPose turnedAroundTarget(const CameraPose& pose, double degrees) {
  CameraPose turned = pose;
  const Mat3 turn = makeRotation(degrees * pi / 180.0, pose.up.stableNormalized()).linear();
  if (degrees != 0.0)
    turned.position = pose.target + turn * (pose.position - pose.target);
  return turned;
}

Camera::Camera(const CameraPose& pose, int width, int height)
    : m_pose(checkedPose(pose,
                         [](const std::string& what) {
                           return usageError("--position, --target, --up: " + what);
                         })),
      m_width(width),
      m_height(height) {
  const Vec3 view = pose.target - pose.position;
  m_targetDepth = view.norm();
  m_forward = view / m_targetDepth;
  const Vec3 side = sideOf(m_forward, pose.up);
  m_right = side.normalized();
  m_up = m_right.cross(m_forward);
  const double halfHeight = pose.projection == Projection::orthographic
                                ? pose.scale
                                : m_targetDepth * std::tan(pose.angle * pi / 360.0);
  m_pixelPitch = 2.0 * halfHeight / height;
}

} // namespace fenestra
