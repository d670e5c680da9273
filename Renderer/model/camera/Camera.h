#pragma once
// The camera, and view space: origin at the camera position (perspective) or on the camera plane
// (orthographic), x right, y up, depth z along the viewing direction, mm.

#include "base/CheckAffine.h"

namespace fenestra::core {

enum class Projection { orthographic, perspective };

/// Camera parameters as the user states them: world space, mm, degrees.
struct CameraPose {
  Projection projection = Projection::orthographic;
  Vec3 position = Vec3::Zero();
  Vec3 target = Vec3::UnitY();
  Vec3 up = Vec3::UnitZ();
  double scale = 100.0; ///< orthographic: half the viewport's height, mm
  double angle = 30.0;  ///< perspective: full vertical angle, degrees
};

/// Returns `pose` if it is valid: position and target differ and lie within 1e12 mm, and up is
/// neither zero nor parallel to the viewing direction. Throws otherwise.
CameraPose validatePose(const CameraPose& pose, const MakeError& makeError);

/// Turntable pose: rotates the camera around the axis through the target along `up`,
/// counterclockwise as seen from the tip of `up`, at constant distance and height. 0 degrees
/// returns `pose` unchanged, bit for bit.
CameraPose rotateAroundTarget(const CameraPose& pose, double degrees);

class Camera {
public:
  /// Throws Error (request) if validatePose() rejects `pose`.
  Camera(const CameraPose& pose, int width, int height);

  int width() const { return m_width; }
  int height() const { return m_height; }
  const CameraPose& pose() const { return m_pose; }
  const Vec3& right() const { return m_right; }
  const Vec3& up() const { return m_up; }
  const Vec3& forward() const { return m_forward; }
  /// Depth of the target plane, which contains the target and faces the camera, mm.
  double targetDepth() const { return m_targetDepth; }
  /// Distance between pixel centers on the target plane, mm.
  double pixelPitch() const { return m_pixelPitch; }

  /// Camera ray through raster position (column, row), both continuous; (0, 0) is the top left
  /// corner of the top left pixel. Unit direction, world space; starts at depth 0.
  Ray makeRay(double column, double row) const { return makePlaneRay(toPlane(column, row)); }

  /// Point (x, y) where the camera ray through a raster position meets the target plane, mm.
  Vec2 toPlane(double column, double row) const {
    return {(column - 0.5 * m_width) * m_pixelPitch, (0.5 * m_height - row) * m_pixelPitch};
  }

  /// Raster position (column, row) of (x, y) on the target plane.
  Vec2 toRaster(const Vec2& plane) const {
    return {plane.x() / m_pixelPitch + 0.5 * m_width, 0.5 * m_height - plane.y() / m_pixelPitch};
  }

  /// Camera ray through (x, y) on the target plane.
  Ray makePlaneRay(const Vec2& plane) const {
    const Vec3 offset = plane.x() * m_right + plane.y() * m_up;
    if (m_pose.projection == Projection::orthographic)
      return {m_pose.position + offset, m_forward};
    return {m_pose.position, (offset + m_targetDepth * m_forward).normalized()};
  }

  Vec3 toView(const Vec3& world) const {
    const Vec3 d = world - m_pose.position;
    return {d.dot(m_right), d.dot(m_up), d.dot(m_forward)};
  }

  /// Depth per length along a camera ray: depth = t * depthPerLength(ray).
  double depthPerLength(const Ray& cameraRay) const { return cameraRay.direction.dot(m_forward); }

private:
  CameraPose m_pose;
  int m_width, m_height;
  Vec3 m_right, m_up, m_forward;
  double m_targetDepth, m_pixelPitch;
};

} // namespace fenestra::core
